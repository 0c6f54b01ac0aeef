"""What holds for all tests."""

import compileall
import gc
import os
import signal
import threading
from pathlib import Path

import pytest

# Small matrices gain nothing by threads, and two test processes at once lose much; as in `irlx` itself.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

SOURCE = Path(__file__).resolve().parents[1] / "src"


def pytest_configure(config: pytest.Config) -> None:
    """What tests and the processes that they start find, whoever started the tests."""
    if threading.current_thread() is threading.main_thread():
        # A shell starts its background jobs with interrupts ignored, and children inherit that.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if not hasattr(config, "workerinput"):
        # Some hundred tests start irlx as a process; Python may have been told to write no bytecode.
        compileall.compile_dir(SOURCE, quiet=2)


def pytest_collection_finish() -> None:
    """Thousands of waiting tests are not looked through at every collection of garbage: a twentieth of it."""
    gc.collect()
    gc.freeze()
