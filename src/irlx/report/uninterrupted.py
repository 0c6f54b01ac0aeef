"""Work that Ctrl-C, or another wish that the process may stop, must not leave half done."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Ctrl-C inside the block is heard behind it, also where the block raises: that is then its context.

    So are SIGTERM and SIGHUP where somebody handles them. Other threads than the main one are never
    interrupted.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handlers = {number: signal.getsignal(number) for number in _SIGNALS}
    before = {number: handler for number, handler in handlers.items() if callable(handler)}
    heard: list[tuple[Any, ...]] = []
    try:
        for number in before:
            signal.signal(number, lambda *args: heard.append(args))
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if heard:
            before[heard[0][0]](*heard[0])
