"""Being told to stop, by Ctrl-C, by another process, or because the terminal was closed."""

from __future__ import annotations

import signal
from types import FrameType
from typing import NoReturn

__all__ = ["heed_signals", "ignore_signals", "stopped_code"]

_SIGNALS = (signal.SIGTERM, signal.SIGHUP)
_BY_A_SIGNAL = 128


class Stopped(KeyboardInterrupt):
    """A signal asks to stop: what Ctrl-C leaves in order, this does."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number


def heed_signals() -> None:
    """Let SIGTERM and SIGHUP do what Ctrl-C does, unless who started the process has chosen otherwise."""
    for number in _SIGNALS:
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _stop)


def ignore_signals() -> None:
    """All is done, only the process has to end: nothing to be stopped any more."""
    for number in (signal.SIGINT, *_SIGNALS):
        signal.signal(number, signal.SIG_IGN)


def stopped_code(interrupt: BaseException | None) -> int:
    """Exit code of a command that was stopped: 130 by Ctrl-C, otherwise 128 and the number of the signal."""
    while interrupt is not None:
        if isinstance(interrupt, Stopped):
            return _BY_A_SIGNAL + interrupt.number
        interrupt = interrupt.__cause__
    return _BY_A_SIGNAL + signal.SIGINT


def _stop(number: int, _: FrameType | None) -> NoReturn:
    raise Stopped(number)
