"""What holds for all tests."""

import compileall
import gc
import os
import shutil
import signal
import sys
import threading
from collections import Counter
from collections.abc import Generator
from pathlib import Path

import pytest

# Small matrices gain nothing by threads, and two test processes at once lose much; as in `irlx` itself.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

SOURCE = Path(__file__).resolve().parents[1] / "src"
SUITE = 5000
"""Tests from which on a run is taken for that of the suite, whose time is watched."""
LONGEST = 15.0
"""Seconds that the tests of a file may take together: the workers share out whole files."""
MEMORY, ROOM = Path("/dev/shm"), 4 << 30
"""Where the files of tests are kept, if so many bytes are free there."""
GARBAGE = 50_000, 20, 20
"""Objects after which Python looks for garbage, a younger generation each."""
FIRST = [
    "report/page/test_in_browser.py",
    "koch/test_experiments.py",
    "test_tolerance.py",
    "test_slowdown_acceptance.py",
    "test_readme.py",
    "test_ptp_beside_paths.py",
    "cli/test_slowed_run.py",
    "cli/test_terminal.py",
    "cli/test_commands.py",
    "test_combined.py",
    "test_obstacle_campaign.py",
    "test_reconfiguration_optimum.py",
    "test_cyclic_campaign.py",
    "test_two_arms.py",
    "test_cycles.py",
    "test_dry_run.py",
    "test_tutorial.py",
    "verifier/test_good_streams.py",
    "verifier/test_sabotage.py",
    "cli/test_pages_true.py",
]
"""Long files begin first: one that began last would keep a worker when the other is done."""
TOGETHER = ("tests/koch/", "tests/report/page/")
"""Folders whose files go to one worker: they share runs, and a browser."""


def pytest_configure(config: pytest.Config) -> None:
    """What tests and the processes that they start find, whoever started the tests."""
    if threading.current_thread() is threading.main_thread():
        # A shell starts its background jobs with interrupts ignored, and children inherit that.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    os.fsync = _asked_to_store
    _keep_files_in_memory()
    gc.disable()
    # Python may have been told to write no bytecode, but to rewrite all assertions anew takes 12 s.
    sys.dont_write_bytecode = False
    if hasattr(config.option, "loadscopereorder"):
        # Workers take files in the order below, not those of most tests first.
        config.option.loadscopereorder = False
    if not hasattr(config, "workerinput"):
        # Some tests start irlx as a process, which writes none.
        compileall.compile_dir(SOURCE, quiet=2)


def _keep_files_in_memory() -> None:
    """Temporary folders are in memory where it has room.

    A disk takes some 5 ms to write a file over another one, thousands of times. The folder of a test that
    passes is removed behind it (`tmp_path_retention_policy` in `pyproject.toml`): together they are small.
    """
    if MEMORY.is_dir() and os.access(MEMORY, os.W_OK) and shutil.disk_usage(MEMORY).free >= ROOM:
        os.environ.setdefault("PYTEST_DEBUG_TEMPROOT", str(MEMORY))


def _asked_to_store(descriptor: int) -> None:
    """In place of `os.fsync` within the tests: what is open counts as stored.

    A disk takes some 10 ms to store a file, thousands of times, and no test can see whether it has. That it
    is asked in time, `streams/test_formats.py` looks at; processes that tests start do ask.
    """
    os.fstat(descriptor)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> object:
    """With `--dist loadfile` the files of some folders stay together."""
    if config.getvalue("dist") != "loadfile":
        return None
    from xdist.scheduler import LoadFileScheduling

    class LoadTogether(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return next(filter(nodeid.startswith, TOGETHER), super()._split_scope(nodeid))

    return LoadTogether(config, log)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Every other worker reads the folders backwards.

    So two of them rewrite the assertions of half of the files each, and find those of the others written:
    six seconds in a fresh clone.
    """
    report = yield
    if isinstance(collector, pytest.Directory) and _reads_backwards(collector.config):
        report.result.reverse()
    return report


def _reads_backwards(config: pytest.Config) -> bool:
    return hasattr(config, "workerinput") and int(config.workerinput["workerid"].removeprefix("gw")) % 2 == 1


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """The long files come first, the others in one order for all workers; that within a file stays."""
    places = {f"tests/{name}": place for place, name in enumerate(FIRST)}
    alone = not hasattr(config, "workerinput")

    def place(item: pytest.Item) -> tuple[int, list[str]]:
        path = item.nodeid.partition("::")[0]
        return places.get(path, len(FIRST)), [] if alone else path.split("/")

    items.sort(key=place)


def pytest_collection_finish() -> None:
    """Garbage is collected from here on, seldom, and none of it among thousands of waiting tests.

    While modules are loaded and tests are made there is none, and to look for it takes a sixth of the time.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(*GARBAGE)
    gc.enable()


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """The files whose tests took longest, after a run of the suite."""
    taken: Counter[str] = Counter()
    reports = [report for found in terminalreporter.stats.values() for report in found]
    for report in reports:
        if isinstance(report, pytest.TestReport):
            taken[report.nodeid.partition("::")[0]] += report.duration
    if sum(getattr(report, "when", None) == "call" for report in reports) < SUITE:
        return
    terminalreporter.section(f"files that took longest, of {taken.total():.0f} s")
    for name, seconds in taken.most_common(10):
        over = f"  more than the {LONGEST:.0f} s of a file" if seconds > LONGEST else ""
        terminalreporter.write_line(f"{seconds:6.1f} s  {name}{over}")
