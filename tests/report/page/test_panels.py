"""Curves, strip and summary of the replay page where there is much to show, or little room."""

import pytest

from made_page import FRAMES, TICK, made_data

MOVES = 100
LONG = "position  100 %  " + "a row that is much longer than the panel is wide  " * 4
AXIS = 40
"""px of a plot's canvas left of its curves that hold nothing but the numbers of an axis."""

COLUMNS = """([selector, colour, row]) => {
    const canvas = document.querySelector(selector);
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext('2d', { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    const [from, rows] = row === null ? [0, copy.height] : [row, 1];
    const { data } = context.getImageData(0, from, copy.width, rows);
    const seen = Array(copy.width).fill(0);
    for (let k = 0; k < data.length; k += 4) {
        const [red, green, blue, opacity] = data.slice(k, k + 4);
        const [any, solid] = [opacity > 0, opacity > 250];
        const found = { any, solid, violet: any && blue - green > 100, pink: any && red - green > 100 };
        if (found[colour]) seen[(k / 4) % copy.width] += 1 + (k % 997);
    }
    return seen;
}"""
"""Of each column of a canvas 0 where nothing has a colour, else a number that tells where."""


@pytest.fixture(scope="module")
def shown(made, open_page):
    """Obstacles watched from tick 20 on; two pairs, quite apart; and many moves."""
    data = made_data()
    near = range(30, 70)
    frames = {
        **data["frames"],
        "watched": [tick >= 20 for tick in range(FRAMES)],
        "clearance": [(0.05 if tick < 50 else 0.015) if tick in near else None for tick in range(FRAMES)],
        "nearest": [(0 if tick < 50 else 1) if tick in near else -1 for tick in range(FRAMES)],
    }
    with open_page(
        made(
            frames=frames,
            pairs=[*data["pairs"], {"link": "arm", "other": "cart", "margin": 0.02}],
            blocks=[{"tick": k, "id": k + 1, "line": 5, "text": "MOVE LIN p1"} for k in range(MOVES)],
            summary={**data["summary"], "text": f"made.irl: complete, 1 s\nlimit use   {LONG}"},
        ),
        width=1024,
        height=600,
        drawn=False,
    ) as page:
        yield page


def columns(shown, selector, colour, row=None):
    return shown.run(COLUMNS, [selector, colour, row])


def zoom(shown, plot, time):
    """Zoom to a seventh of the run about a time, after all of it has been shown again."""
    over = shown.page.locator(f"[data-plot={plot}] .u-over")
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    where = (box["x"] + box["width"] * time / ((FRAMES - 1) * TICK), box["y"] + box["height"] / 2)
    shown.page.mouse.dblclick(*where)
    shown.page.keyboard.down("Control")
    shown.page.mouse.wheel(0, -600)
    shown.page.keyboard.up("Control")
    shown.page.wait_for_timeout(100)
    shown.settle()


def test_bands_stay_within_the_plot(shown):
    zoom(shown, "path", 0.3)
    violet = columns(shown, "[data-plot=path] canvas", "violet")
    assert any(violet)
    assert not any(violet[:AXIS])
    shown.page.locator("[data-plot=path] .u-over").dblclick()


def test_an_axis_is_not_made_up_where_nothing_is_in_sight(shown):
    canvas = "[data-plot=clearance] canvas"
    whole = columns(shown, canvas, "any")[:AXIS]
    assert any(whole)
    zoom(shown, "clearance", 0.1)
    assert columns(shown, canvas, "any")[:AXIS] == whole
    shown.page.locator("[data-plot=clearance] .u-over").dblclick()


def test_pairs_far_apart_are_not_joined(shown):
    shown.settle()
    pink = columns(shown, "[data-plot=clearance] canvas", "pink")
    drawn = [x for x, seen in enumerate(pink) if seen]
    assert pink[drawn[0] : drawn[-1]].count(0) >= 3


@pytest.mark.parametrize(
    ("frame", "words"),
    [
        (10, "nothing is watched"),
        (25, "nothing within reach of its influence"),
        (40, "hand – wall\n50.0 mm away, 30.0 above margin 20"),
        (60, "arm – cart\n15.0 mm away, 5.0 below margin 20"),
    ],
)
def test_what_the_distance_is_and_what_the_room(shown, frame, words):
    shown.page.mouse.move(5, 5)
    shown.seek(frame)
    assert shown.page.locator("[data-plot=clearance] .plot-value").text_content() == words


def test_many_short_moves_are_one_piece_of_the_strip(shown):
    strip = columns(shown, "#strip", "solid", row=7)
    drawn = [x for x, seen in enumerate(strip) if seen]
    assert strip[drawn[0] : drawn[-1]].count(0) <= 2


def test_many_short_moves_do_not_grey_the_curves(shown):
    # Of the plot whose curve is far below: a row that has grid and marks alone.
    marked = columns(shown, "[data-plot=position] canvas", "any", row=12)
    assert sum(seen > 0 for seen in marked) < len(marked) / 4


def test_tabs_and_curves_share_a_low_window(shown):
    tabs, curves = (shown.page.locator(part).bounding_box()["height"] for part in ("#tabbed", "#curves"))
    assert tabs == pytest.approx(curves, rel=0.1)


def test_rows_of_the_summary_stay_rows(shown):
    shown.page.get_by_role("tab", name="Summary").click()
    assert shown.page.locator(".summary dd").bounding_box()["height"] < 30
    wide, seen = shown.page.locator(".summary").evaluate("list => [list.scrollWidth, list.clientWidth]")
    assert wide > seen + 100
