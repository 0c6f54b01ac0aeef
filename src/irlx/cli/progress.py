"""Progress of what takes its time, where somebody looks."""

from __future__ import annotations

import os
import sys
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from irlx.job import Job
    from irlx.report.progress import Progress

__all__ = ["shown_progress", "shown_status"]


def shown_progress(job: Job, quiet: bool = False) -> AbstractContextManager[Progress | None]:
    """What shows how a run comes on; None where that is not wanted or stderr is no terminal."""
    if quiet or not sys.stderr.isatty():
        return nullcontext()
    from irlx.report.progress import Course, LineProgress, LiveProgress

    course = Course(job.tick_ns / 1e9, job.program.move_count, job.program.place)
    return LineProgress(course) if os.environ.get("TERM") == "dumb" else LiveProgress(course)


def shown_status(words: str) -> AbstractContextManager[object]:
    """What says that something is being worked on, where somebody looks."""
    if not sys.stderr.isatty() or os.environ.get("TERM") == "dumb":
        return nullcontext()
    from rich.console import Console

    return Console(stderr=True, highlight=False).status(words)
