"""Figures: the right lines with the right data at the right places, and the same bytes twice."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from matplotlib.backends.backend_agg import FigureCanvasAgg

from drawn_streams import DT, DrawnStream, square_and_slow
from irlx.report.plot.curves import Track
from irlx.report.plot.figure import draw_figure, save_figure
from irlx.report.plot.make_curves import Subject, curves_of
from irlx.report.plot.panel import MOST_POINTS, thinned
from irlx.report.plot.quantity import JOINT_QUANTITIES, QUANTITIES, Quantity
from irlx.robot.limits import JointLimits
from irlx.streams.error import StreamError

pytestmark = pytest.mark.req("REP-03")


@pytest.fixture(scope="module")
def curves():
    return curves_of(Subject(square_and_slow(), "a.irdata"), QUANTITIES)[0]


@pytest.fixture(scope="module")
def other():
    """Half as long, at another tick, without the limits of the program."""
    made = DrawnStream(tick_ms=25.0)
    made.move(np.column_stack([np.linspace(0.0, 0.8, 40), np.linspace(0.0, 0.1, 40)]))
    return curves_of(Subject(made.stream(), "b.npz"), QUANTITIES)[0]


@pytest.fixture(scope="module")
def page(curves):
    return draw_figure([curves], [0, 1])


def of(axes, gid):
    return [artist for artist in axes.get_children() if artist.get_gid() == gid]


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_a_row_a_joint_and_a_column_a_quantity(page, curves):
    assert len(page.axes) == 7
    for number, axes in enumerate(page.axes[:6]):
        (line,) = of(axes, "curve 0")
        quantity = JOINT_QUANTITIES[number % 3]
        assert np.array_equal(line.get_xdata(), curves.t)
        assert np.array_equal(line.get_ydata(), curves.values[quantity][:, number // 3])
        assert line.get_drawstyle() == ("default" if quantity is Quantity.POSITION else "steps-pre")
    titles = [axes.get_title() for axes in page.axes[:3]]
    assert titles == ["position, deg or mm", "speed, deg/s or mm/s", "acceleration, deg/s² or mm/s²"]
    names = [text.get_text() for text in page.texts]
    assert names == ["turn, deg", "slide, mm", "tool speed,\nmm/s", "drawn.irl · drawer"]
    assert [axes.get_xlabel() for axes in page.axes] == [""] * 6 + ["time, s"]


def test_limits_are_dashed_where_they_are_in_force(page, curves):
    (line,) = [found for found in of(page.axes[4], "limit") if np.nanmax(found.get_ydata()) > 0.0]
    np.testing.assert_allclose(line.get_xdata(), [0.0, 1.21, 1.21, curves.t[-1]])
    np.testing.assert_allclose(line.get_ydata(), [400.0, 400.0, 100.0, 100.0])
    assert line.is_dashed()
    # A limit far from the curve stands at the edge as a number.
    assert [text.get_text() for text in of(page.axes[1], "far limit")] == ["↓ −171.9", "↑ 171.9"]
    _, high = page.axes[1].get_ylim()
    assert high < 171.9


def test_spans_at_limits_are_shaded(page, curves):
    shaded = [
        [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in of(axes, "active")]
        for axes in page.axes[:6]
    ]
    assert shaded[0] == [pytest.approx(curves.spans(Quantity.POSITION, 0)[0])]
    assert shaded[4] == [pytest.approx(span) for span in curves.spans(Quantity.SPEED, 1)]
    assert [len(spans) for spans in shaded] == [1, 0, 0, 0, 2, 0]


def test_moves_and_slowed_tool(page, curves):
    for axes in page.axes:
        assert [line.get_xdata()[0] for line in of(axes, "move")] == [0.0, 1.21]
    numbers = [text.get_text() for text in page.axes[0].texts if text.get_text().isdecimal()]
    assert numbers == ["10", "30"]
    (patch,) = of(page.axes[6], "slowed")
    assert (patch.get_x(), patch.get_x() + patch.get_width()) == pytest.approx(curves.slowed[0])
    (programmed,) = of(page.axes[6], "programmed")
    assert np.nanmax(programmed.get_ydata()) == pytest.approx(200.0)
    assert legend(page) == [
        "limit in force",
        "programmed",
        "at or near a limit",
        "slower than programmed",
        "move begins, its line above",
    ]


def test_numbers_of_far_limits_stand_inside_and_clear_of_the_curve():
    # On a page of many joints diagrams are low.
    names = tuple(f"joint_{number}" for number in range(1, 11))
    limits = JointLimits.unlimited(10).with_pair("position", np.full(10, -3.0), np.full(10, 3.0))
    made = DrawnStream(names, ("rad",) * 10, limits, start=(0.0,) * 10)
    part = np.linspace(0.0, 1.0, 200)
    # Low on the left and high on the right; high at both ends.
    waves = np.clip(2.0 * np.column_stack([-np.cos(np.pi * part), np.cos(2.0 * np.pi * part)]), -1.0, 1.0)
    made.move(np.tile(waves, 5))
    figure = draw_figure([curves_of(Subject(made.stream(), "a"), [Quantity.POSITION])[0]], list(range(10)))
    renderer = FigureCanvasAgg(figure).get_renderer()
    for axes in figure.axes:
        numbers, (line,) = of(axes, "far limit"), of(axes, "curve 0")
        assert len(numbers) == 2
        points = axes.transData.transform(np.column_stack([line.get_xdata(), line.get_ydata()]))
        for number in numbers:
            box = number.get_window_extent(renderer)
            assert axes.bbox.x0 < box.x0 < box.x1 < axes.bbox.x1
            assert axes.bbox.y0 < box.y0 < box.y1 < axes.bbox.y1
            assert not box.count_contains(points)


def test_programmed_speed_and_margin_are_told_apart(curves):
    t = curves.t
    near = Track("clearance", "mm", t, np.full(len(t), 50.0), np.full(len(t), 20.0), "margin")
    figure = draw_figure([replace(curves, tracks={**curves.tracks, Quantity.CLEARANCE: (near,)})], [])
    handles = {line.get_label(): line for line in figure.legends[0].get_lines()}
    styles = []
    for name in ("programmed", "margin"):
        (drawn,) = [line for axes in figure.axes for line in of(axes, name)]
        told = handles[name]
        assert drawn.get_color() == told.get_color()
        assert drawn._dash_pattern == told._dash_pattern
        styles.append((drawn.get_color(), drawn._dash_pattern))
    assert styles[0][0] != styles[1][0]
    assert styles[0][1] != styles[1][1]


def test_many_short_moves_are_no_barcode():
    made = DrawnStream()
    for number in range(200):
        made.move(np.full((4, 2), 0.001 * number))
    figure = draw_figure([curves_of(Subject(made.stream(), "a"), [Quantity.SPEED])[0]], [0])
    assert [line.get_xdata()[0] for line in of(figure.axes[0], "move")] == pytest.approx([0.0, 199 * 5 * DT])
    assert len([text for text in figure.axes[0].texts if text.get_text().isdecimal()]) == 2


def test_two_streams_over_each_other(curves, other):
    figure = draw_figure([curves, other], [1])
    first, second = of(figure.axes[0], "curve 0")[0], of(figure.axes[0], "curve 1")[0]
    assert np.array_equal(first.get_ydata(), curves.values[Quantity.POSITION][:, 1])
    assert np.array_equal(second.get_ydata(), other.values[Quantity.POSITION][:, 1])
    assert np.array_equal(second.get_xdata(), other.t)
    assert len(curves.t) != len(other.t)
    assert first.get_color() != second.get_color()
    assert figure.axes[0].get_xlim() == (0.0, curves.t[-1])
    assert legend(figure)[:2] == ["a.irdata", "b.npz"]
    # The first stream alone is at a limit of speed, and its limits are others from 1.21 s on.
    bars = of(figure.axes[1], "active bar")
    assert {bar.get_facecolor() for bar in bars} == {bars[0].get_facecolor()}
    assert len(bars) == 2
    assert len(of(figure.axes[1], "limit")) >= 3


def test_pages_of_few_and_of_many_joints(curves):
    few = draw_figure([curves], [1])
    names = tuple(f"joint_{number}" for number in range(1, 21))
    bound = np.full(20, 1.0)
    made = DrawnStream(
        names, ("rad",) * 20, JointLimits(*(bound * side for side in (-1, 1) * 3)), 10.0, (0.0,) * 20
    )
    made.move(np.outer(np.linspace(0.0, 0.5, 20), np.ones(20)))
    many = draw_figure(
        [curves_of(Subject(made.stream(), "m"), [Quantity.POSITION, Quantity.PATH_SPEED])[0]], list(range(20))
    )
    assert few.get_figwidth() == many.get_figwidth() == 10.0
    assert few.get_figheight() < 5.0
    assert many.get_figheight() < 18.0
    heights = [axes.get_position().height * many.get_figheight() for axes in many.axes[:20]]
    assert min(heights) > 0.5
    boxes = sorted(axes.get_position().bounds for axes in many.axes[:20])
    assert all(a[1] + a[3] < b[1] for a, b in pairwise(boxes))


def test_long_curves_are_thinned_and_keep_their_peaks():
    t = np.arange(100_001) * 1e-3
    values = np.sin(t)
    values[[12_345, 70_001]] = 9.0, -7.0
    fewer, shown = thinned(t, values)
    assert len(fewer) <= MOST_POINTS
    assert (fewer[0], fewer[-1]) == (t[0], t[-1])
    assert np.all(np.diff(fewer) > 0.0)
    assert (shown.max(), shown.min()) == (9.0, -7.0)
    assert fewer[shown.argmax()] == t[12_345]
    np.testing.assert_array_equal(shown, values[np.searchsorted(t, fewer)])
    np.testing.assert_array_equal(thinned(t[:100], values[:100])[1], values[:100])


def test_width_in_mm(curves):
    assert draw_figure([curves], [1], 180.0).get_figwidth() == pytest.approx(180.0 / 25.4)


@pytest.mark.parametrize("ending", ["svg", "png", "pdf"])
def test_same_bytes_twice(tmp_path, ending, curves):
    only, _ = curves_of(Subject(square_and_slow(), "a.irdata"), [Quantity.SPEED])
    for name in ("one", "two"):
        save_figure(draw_figure([only], [1]), tmp_path / f"{name}.{ending}")
    one, two = ((tmp_path / f"{name}.{ending}").read_bytes() for name in ("one", "two"))
    assert one == two
    assert len(one) < 100_000
    assert b"Date" not in one.replace(b"/CreationDate", b"") or ending == "png"
    if ending == "svg":
        assert b"<text" not in one


def test_what_cannot_be_written(tmp_path, page):
    with pytest.raises(StreamError, match="IRL003"):
        save_figure(page, tmp_path / "absent" / "a.svg")
