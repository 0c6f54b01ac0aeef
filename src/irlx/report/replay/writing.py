"""Pages of runs in memory."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from irlx.diagnostics import report
from irlx.report.lines import Line
from irlx.report.replay.data import replay_json
from irlx.report.replay.of_run import replay_of
from irlx.report.replay.packing import packed
from irlx.report.replay.page import page_of
from irlx.report.terminal import summary_lines
from irlx.streams.atomic import AtomicFile
from irlx.streams.error import StreamError

if TYPE_CHECKING:
    from irlx.report.run import Run

SMALL_FRAMES = 300
_HEIGHT = 420
_FRAME = "margin-top: .6em; border: 1px solid rgba(128, 128, 128, .35); border-radius: 6px"
_CAPTION = "caption-side: top; text-align: left; font-weight: 600"
_LABEL = "text-align: left; white-space: nowrap"
_WORDS = "text-align: left; white-space: pre; font-family: monospace"


def write_page(run: Run, path: Path) -> None:
    """Write the page of a run; it appears whole or not at all.

    Raises StreamError: IRL003 not writable, IRL722 for a run without `source`.
    """
    if run.source is None:
        raise StreamError(report("IRL722", path=path))
    with AtomicFile(path) as file:
        data, _ = replay_json(replay_of(run, run.source))
        file.write(page_of(run.header.program_name, data))


def notebook_html(run: Run) -> str:
    """The summary of a run as a table, and a small replay in a frame of its own."""
    table = _table(summary_lines(run.summary))
    if run.source is None:
        return table
    data, _ = replay_json(replay_of(run, run.source, SMALL_FRAMES), small=True)
    page = escape(packed(page_of(run.header.program_name, data)))
    style = f"width: 100%; height: {_HEIGHT}px; {_FRAME}"
    frame = f'<iframe title="replay" sandbox="allow-scripts" style="{style}" srcdoc="{page}"></iframe>'
    return f"{table}\n{frame}"


def _table(lines: Sequence[Line]) -> str:
    """The verdict, and below it a row for each line."""
    caption, rows = "", []
    for line in lines:
        words = escape(line.words)
        if line.label is None:
            caption = f'<caption style="{_CAPTION}">{words}</caption>'
        else:
            label = f'<th scope="row" style="{_LABEL}">{escape(line.label)}</th>'
            rows.append(f'<tr>{label}<td style="{_WORDS}">{words}</td></tr>')
    return f'<table class="irlx-summary">{caption}<tbody>{"".join(rows)}</tbody></table>'
