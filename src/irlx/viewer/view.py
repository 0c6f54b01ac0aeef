"""`irlx.view`: a run, or a program that is run for it, in the browser."""

from __future__ import annotations

import os
import sys
import webbrowser
from contextlib import suppress
from pathlib import Path

from irlx.job import PathLike, prepare
from irlx.program import Program
from irlx.report.run import Run
from irlx.viewer.serve import free_port, require_viewer
from irlx.viewer.subject import Subject, is_stream, subject_of_job, subject_of_run, subject_of_stream
from irlx.viewer.viewer import Viewer

LOOPBACK = "127.0.0.1"


def view(
    run_or_program: Run | Program | PathLike,
    cell: PathLike | None = None,
    tick_ms: float | None = None,
    port: int | None = None,
    host: str = LOOPBACK,
    block: bool = True,
    open_page: bool = True,
) -> Viewer:
    """Show a run in the browser, or a program, which is run first, or a stream file.

    `cell` as in `run`; of a run or a stream it is looked for by the name that it carries. The page is served
    on `port`, by default the first free one from 8080 on, of `host`, by default this machine alone, and
    opened in a browser where there is a screen. With `block` it returns at Ctrl-C, the page being gone; else
    at once, and `Viewer.stop` ends it.
    Raises IrlxError, IRL010, without the extra `view`, IRL014 for a port that cannot be served on; what `run`
    raises before anything moves. A run that ends in an error is shown as far as it came.
    """
    require_viewer()
    number = free_port(host, port)
    subject = _subject(run_or_program, cell, tick_ms)
    viewer = Viewer(subject.shown, subject.again, host, number)
    if block:
        serve_until_ctrl_c(viewer, open_page)
    else:
        _announce(viewer, open_page)
    return viewer


def serve_until_ctrl_c(viewer: Viewer, open_page: bool) -> None:
    """Tell the viewer's address, open its page where there is a screen, and wait; then it is gone."""
    # Ctrl-C is how it ends, also in the moment before it waits.
    with suppress(KeyboardInterrupt), viewer:
        _announce(viewer, open_page)
        viewer.wait()


def _announce(viewer: Viewer, open_page: bool) -> None:
    print(f"irlx view: {viewer.url} (Ctrl-C ends it)", flush=True)
    if open_page and _has_screen():
        webbrowser.open(viewer.url)


def _has_screen() -> bool:
    """Whether a browser would open a window: in a terminal alone it would take the terminal."""
    if not sys.platform.startswith("linux"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def _subject(given: Run | Program | PathLike, cell: PathLike | None, tick_ms: float | None) -> Subject:
    path = None if cell is None else Path(cell)
    if isinstance(given, Run):
        return subject_of_run(given, path)
    if not isinstance(given, Program) and is_stream(Path(given)):
        return subject_of_stream(Path(given), path)
    return subject_of_job(prepare(given, cell, tick_ms))
