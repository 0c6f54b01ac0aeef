"""Pieces of work in processes of their own, with bounds on what they may use."""

from __future__ import annotations

import os
import resource
import signal
import sys
from collections.abc import Callable

MEMORY = 6 * 2**30
BROKEN = 99


def fork(work: Callable[[], int]) -> int:
    """Exit status of a piece of work; minus the signal where one ended it, BROKEN where it raised."""
    sys.stdout.flush()
    pid = os.fork()
    if pid == 0:
        status = BROKEN
        try:
            status = work()
        except BaseException as error:
            print(f"{type(error).__name__}: {error}", file=sys.__stderr__)
        finally:
            sys.stdout.flush()
            os._exit(status)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def limited(seconds: float) -> None:
    """Ends this process after so much processor time, or thirty times as much of the clock's."""
    signal.setitimer(signal.ITIMER_PROF, seconds)
    signal.alarm(int(30 * seconds) + 60)


def quiet() -> None:
    """What damaged code prints is nobody's business, and it may not eat all memory."""
    nothing = os.open(os.devnull, os.O_RDWR)
    for known in (1, 2):
        os.dup2(nothing, known)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
