"""Streams that no robot plays are drawn, or refused by a code: a file may hold any numbers."""

from dataclasses import replace

import pytest

pytest.importorskip("matplotlib")

from drawn_streams import square_and_slow
from irlx.diagnostics import IrlxError
from irlx.plotting import plotted
from irlx.report.plot.figure import draw_figure, save_figure
from irlx.report.plot.terminal import terminal_text
from irlx.streams import write_stream
from long_run import diagonal

pytestmark = [pytest.mark.req("REP-03"), pytest.mark.req("QA-06")]
ROWS = [
    pytest.param(slice(50, 51), id="one"),
    pytest.param(slice(None), id="all"),
    pytest.param(slice(0, 1), id="first"),
]
SHOW = ["position", "acceleration", "path-speed"]


def drawn(folder, stream):
    write_stream(stream, folder / "odd.npz")
    found = plotted([folder / "odd.npz"], ["slide"], SHOW)
    assert terminal_text(found.curves, found.joints, 80)
    save_figure(draw_figure(found.curves, found.joints), folder / "odd.png")


@pytest.mark.parametrize(("rows", "value"), diagonal(ROWS, [1e300, 1e-320, -1e300]))
def test_numbers_of_any_size(tmp_path, rows, value):
    stream = square_and_slow()
    q, tool = stream.q.copy(), stream.tool.copy()
    q[rows], tool[rows] = value, value
    drawn(tmp_path, replace(stream, q=q, tool=tool))


@pytest.mark.parametrize("rows", [1, 2])
def test_hardly_any_rows(tmp_path, rows):
    stream = square_and_slow()
    parts = {name: getattr(stream, name)[:rows] for name in ("ticks", "q", "block", "tool")}
    drawn(tmp_path, replace(stream, records=(), **parts))


def test_no_rows(tmp_path):
    stream = square_and_slow()
    parts = {name: getattr(stream, name)[:0] for name in ("ticks", "q", "block", "tool")}
    with pytest.raises(IrlxError, match=r"IRL006: --from 0: odd\.npz has no sample"):
        drawn(tmp_path, replace(stream, records=(), **parts))


def test_ticks_with_gaps(tmp_path):
    stream = square_and_slow()
    drawn(tmp_path, replace(stream, ticks=stream.ticks * 7 + 3))
