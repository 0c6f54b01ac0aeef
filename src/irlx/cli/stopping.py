"""Being told to stop, by Ctrl-C, by another process, or because the terminal was closed."""

from __future__ import annotations

import signal
from types import FrameType
from typing import NoReturn

__all__ = ["Stopped", "heard_signal", "heed_signals", "ignore_signals", "stopped_code"]

_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_BY_A_SIGNAL = 128


class Stopped(KeyboardInterrupt):
    """A signal asks to stop."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number


class _Listener:
    """Handler of a signal: raises Stopped, and remembers that it did; `heard` is the signal's number then."""

    def __init__(self) -> None:
        self.heard: int | None = None

    def __call__(self, number: int, _: FrameType | None) -> NoReturn:
        self.heard = number
        raise Stopped(number)


def heed_signals() -> None:
    """Let Ctrl-C, SIGTERM and SIGHUP end a command, unless who started the process has chosen otherwise."""
    for number in _SIGNALS:
        if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _Listener())


def heard_signal() -> int | None:
    """Number of a signal that was heard, also where a library has made another exception of Stopped."""
    handlers = map(signal.getsignal, _SIGNALS)
    return next((one.heard for one in handlers if isinstance(one, _Listener) and one.heard is not None), None)


def ignore_signals() -> None:
    """All is done, only the process has to end: nothing to be stopped any more."""
    for number in _SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def stopped_code(interrupt: BaseException | None) -> int:
    """Exit code of a command that was stopped: 130 by Ctrl-C, otherwise 128 and the number of the signal."""
    while interrupt is not None:
        if isinstance(interrupt, Stopped):
            return _BY_A_SIGNAL + interrupt.number
        interrupt = interrupt.__cause__
    return _BY_A_SIGNAL + signal.SIGINT
