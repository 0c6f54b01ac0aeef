"""Files that `irlx run` is asked to write, looked at before anything moves."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

__all__ = ["output_paths", "page_path"]


def output_paths(asked: Sequence[str | Path], inputs: tuple[Path, ...]) -> list[Path]:
    """Files and folders to write, checked before anything moves.

    Raises StreamError: IRL003 not writable, IRL004 unknown ending, IRL005 an input would be overwritten,
    IRL720 a package that the format needs is missing.
    """
    from irlx.diagnostics import report
    from irlx.report.outputs import overwrites
    from irlx.report.replay.names import is_page
    from irlx.streams.error import StreamError
    from irlx.streams.formats import KNOWN_ENDINGS, format_of

    paths = [Path(name) for name in asked]
    for path in paths:
        if is_page(path):
            known_endings, helps = ", ".join(KNOWN_ENDINGS), "a page of the run is asked for with --html"
            found = report("IRL004", help=helps, path=path, ending=path.suffix, known=known_endings)
            raise StreamError(found)
        known = format_of(path, "IRL004")
        if any(overwrites(path, source) for source in inputs):
            raise StreamError(report("IRL005", option="-o", path=path))
        known.check(path)
    return paths


def page_path(asked: Sequence[str], inputs: tuple[Path, ...], outputs: Sequence[Path]) -> Path | None:
    """The page to write, checked before anything moves; None where none is asked for.

    Raises StreamError: IRL003 not writable, IRL005 an input would be overwritten, IRL006 a second page,
    IRL012 a stream of this run has that name, IRL013 another ending.
    """
    from irlx.diagnostics import report
    from irlx.report.file_recording import partial_name
    from irlx.report.outputs import overwrites
    from irlx.report.replay.names import is_page
    from irlx.streams.error import StreamError

    if not asked:
        return None
    if len(asked) > 1:
        raise StreamError(report("IRL006", option="--html", value=asked[1], cause="one page a run"))
    path = Path(asked[0])
    if not is_page(path):
        raise StreamError(report("IRL013", path=path, example=f"{path.stem or 'page'}.html"))
    if any(overwrites(path, source) for source in inputs):
        raise StreamError(report("IRL005", option="--html", path=path))
    # A stream has another ending, and yet two names may lead to one file.
    taken = {os.path.realpath(name) for output in outputs for name in (output, partial_name(output))}
    if {os.path.realpath(path), os.path.realpath(partial_name(path))} & taken:
        raise StreamError(report("IRL012", path=path, what="a stream of this run"))
    _check_page(path)
    return path


def _check_page(path: Path) -> None:
    """Raises StreamError, IRL003, where no page can be put."""
    from irlx.streams.atomic import check_writable
    from irlx.streams.error import StreamError

    try:
        check_writable(path)
    except StreamError as error:
        from dataclasses import replace

        helps = "name another file with --html"
        raise StreamError([replace(found, help=helps) for found in error.diagnostics]) from error
