"""Bounds on time and memory of one input, and every exception as a fault with its place."""

from __future__ import annotations

import logging
import resource
import signal
import sys
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from fuzzing.case import Fault

SECONDS, SECONDS_A_MEGABYTE = 2.0, 20.0
"""Computing time of an input: so much, and so much more by its size (the front end reads 0.2 MB a second)."""
HARD_SECONDS = 30.0
"""Time more, after which the process is killed: code in C does not hear of the first bound."""
MEMORY = 3 << 30
"""Address space of the process, bytes; most of it are libraries."""
GROWTH = 256 << 20
"""Resident memory that one input may add to the most that there was before, bytes."""
_SOURCE = "/src/irlx/"
_FRAMES = 2
"""Functions that a fault is known by."""


class _Spoken(logging.Handler):
    """Gets what libraries log where nobody listens, which would come up on the terminal."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.words: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.words.append(f"{record.name}: {record.getMessage()}")


class TooLong(BaseException):
    """Time is up; no Exception, so that nothing takes it for one of its own."""


def _ring(_signal: int, _frame: FrameType | None) -> None:
    raise TooLong


def bound_process() -> None:
    """Bound the memory of this process, and make warnings errors; for a process of its own."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    warnings.simplefilter("error")


def peak() -> int:
    """Most resident memory that this process ever had, bytes."""
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


@contextmanager
def bounded(size: int, patience: float = 1.0) -> Iterator[None]:
    """Run what is inside within the bounds of an input of `size` bytes. Raises Fault and nothing else.

    `patience` times as long as the bounds say.
    """
    allowed = patience * (SECONDS + SECONDS_A_MEGABYTE * size / 1e6)
    before, spoken, listening = peak(), _Spoken(), (logging.lastResort, logging.root.handlers)
    logging.lastResort, logging.root.handlers = spoken, []
    signal.signal(signal.SIGPROF, _ring)
    signal.setitimer(signal.ITIMER_VIRTUAL, allowed + HARD_SECONDS)
    signal.setitimer(signal.ITIMER_PROF, allowed)
    try:
        yield
    except Fault:
        raise
    except TooLong as cause:
        raise Fault("too long", "", f"{allowed:.3g} s of computing are not enough\n{_words(cause)}") from None
    except BaseException as cause:
        if isinstance(cause, KeyboardInterrupt):
            raise
        raise Fault(type(cause).__name__, place_of(cause), _words(cause)) from None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        logging.lastResort, logging.root.handlers = listening
    if spoken.words:
        raise Fault("a library speaks on the terminal", spoken.words[0], "\n".join(spoken.words))
    grown = peak() - before
    if grown > GROWTH:
        raise Fault("too much memory", "", f"{grown >> 20} MB more than before")


def place_of(cause: BaseException) -> str:
    """Functions of irlx, or else of whatever files, in which an exception came up, the innermost first."""
    frames = traceback.extract_tb(cause.__traceback__)
    own = [frame for frame in frames if _SOURCE in frame.filename] or frames
    if isinstance(cause, RecursionError):
        # Which function of a circle meets the bottom of the stack is chance: the first that comes often.
        names = [(frame.filename, frame.name) for frame in own]
        own = [frame for frame in own if names.count((frame.filename, frame.name)) > 20] or own
        own = own[:1]
    return " < ".join(_function(frame) for frame in own[: -_FRAMES - 1 : -1])


def _function(frame: traceback.FrameSummary) -> str:
    name = frame.filename
    return f"{name.partition(_SOURCE)[2] or Path(name).name} {frame.name}"


def _words(cause: BaseException) -> str:
    lines = traceback.format_exception(cause)
    text = "".join(lines)
    return text if len(text) < 6000 else f"{text[:2000]}\n...\n{text[-3000:]}"
