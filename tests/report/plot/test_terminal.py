"""Curves as text: what stands where, in any width, with colour and without."""

import re
from dataclasses import replace

import numpy as np
import pytest

from drawn_streams import DrawnStream, square_and_slow
from irlx.report.plot.make_curves import Subject, curves_of
from irlx.report.plot.quantity import JOINT_QUANTITIES, QUANTITIES, Quantity
from irlx.report.plot.terminal import terminal_text

pytestmark = pytest.mark.req("REP-03")

TEXT = """\
drawn.irl, drawer
turn position, deg
   57.3 │⠁⠈ ⠁⠈ ⠁⢈⡠⠋⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉
        │      ⡰⠋
        │    ⡴⠊
        │  ⡠⠊
      0 │⡠⠊
        └┬────────━━━━━━━━━━┯━━━━━━━━━━━━━━━━━━━━━━━━━━━━━━━
         10                 30                        3.22 s
tool speed, mm/s
    200 │  ⢀⠏⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⢇    ⢀⢿ ⠁⠈ ⠁⠈ ⠁⠈ ⠁⠈ ⠁⠈ ⠁⠈ ⠁⠈ ⠁⠈⢸⡀
        │  ⡜             ⠘⡄   ⡜⢸                        ⢸⢣
        │ ⢰⠁              ⢱  ⢰⠁⠸⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠤⠜⠈⡆
        │ ⡎               ⠈⡆ ⡇                            ⢱
      0 │⡸                 ⠸⡸                              ⢇
        └┬──────────────────┬──━━━━━━━━━━━━━━━━━━━━━━━━━━───
         10                 30                        3.22 s"""
EMPTY = "\u2800"


def shown(*quantities, stream=None):
    return curves_of(Subject(stream or square_and_slow(), "a.irdata"), quantities)[0]


@pytest.fixture(scope="module")
def curves():
    return shown(*QUANTITIES)


def dots(lines):
    """Columns and heights (from below) of all dots of lines of braille."""
    found = []
    for row, line in enumerate(reversed(lines)):
        for place, character in enumerate(line):
            code = ord(character) - 0x2800 if character >= EMPTY else 0
            heights = {0: (3, 2, 1, 7), 1: (6, 5, 4, 8)}
            for column, bits in heights.items():
                order = (bits[3], bits[0], bits[1], bits[2])
                found += [
                    (2 * place + column, 4 * row + height)
                    for height, bit in enumerate(order)
                    if code >> (bit - 1) & 1
                ]
    return np.array(sorted(found))


def test_text_of_a_small_stream():
    assert terminal_text([shown(Quantity.POSITION, Quantity.PATH_SPEED)], [0], 60) == TEXT


def test_dots_lie_on_the_curve():
    made = DrawnStream()
    t = np.arange(1, 127) * 0.01
    made.move(np.column_stack([0.3 - 0.3 * np.cos(5.0 * t), 0.0 * t]))
    curves = shown(Quantity.SPEED, stream=made.stream())
    lines = terminal_text([curves], [0], 80).splitlines()
    found = dots([line[9:] for line in lines[2:7]])
    values, width = curves.values[Quantity.SPEED][:, 0], 71
    assert lines[2].split()[0] == f"{values.max():.4g}"
    assert lines[6].split()[0] == f"{values.min():.4g}"
    times = curves.t[-1] * found[:, 0] / (2 * width - 1)
    due = (np.interp(times, curves.t, values) - values.min()) / np.ptp(values) * 19
    assert np.all(np.abs(found[:, 1] - due) <= 1.5)
    assert set(range(2 * width)) == set(found[:, 0].tolist())


def test_a_peak_of_one_tick_is_seen():
    made = DrawnStream(start=(0.0, 0.0))
    q = np.zeros((3000, 2))
    q[1234] = 0.5, 0.0
    made.move(q)
    curves = shown(Quantity.POSITION, stream=made.stream())
    lines = terminal_text([curves], [0], 40).splitlines()
    top = dots([line[9:] for line in lines[2:7]])[:, 1].max()
    assert top == 19


def test_every_line_fits(curves):
    for width in (20, 40, 61, 80, 133):
        text = terminal_text([curves], [0, 1], width)
        assert max(map(len, text.splitlines())) <= width
        assert "turn acceleration" in text
    assert "\x1b" not in text
    # Three columns side by side where there is room, else below each other.
    assert len(terminal_text([curves], [0], 133).splitlines()) < len(
        terminal_text([curves], [0], 40).splitlines()
    )


def test_headings_fit_as_well(curves):
    long = replace(curves, title="a_longer_name_than_most.irl", name="one.irdata")
    assert terminal_text([long], [0], 30).splitlines()[:2] == ["a_longer_name_than_most.irl,", "drawer"]
    lines = terminal_text([long, replace(curves, name="two.irdata")], [0], 30).splitlines()
    assert lines[:2] == ["one.irdata (dashed)", "and two.irdata, drawer"]


def test_of_many_short_moves_the_axis_is_no_barcode():
    made = DrawnStream()
    for number in range(200):
        made.move(np.full((4, 2), 0.001 * number))
    lines = terminal_text([shown(Quantity.POSITION, stream=made.stream())], [0], 80).splitlines()
    assert lines[7].count("\N{BOX DRAWINGS LIGHT DOWN AND HORIZONTAL}") == 2
    assert lines[8].split() == ["10", "10", "s"]


def test_colour_changes_no_character(curves):
    plain, coloured = (terminal_text([curves], [0, 1], 90, coloured=on) for on in (False, True))
    assert "\x1b[36m" in coloured
    assert re.sub(r"\x1b\[[0-9;]*m", "", coloured) == plain


def test_two_streams_are_told_apart_without_colour():
    made = DrawnStream(tick_ms=25.0)
    made.move(np.column_stack([np.full(40, 0.9), np.zeros(40)]))
    other = curves_of(Subject(made.stream(), "b.npz"), JOINT_QUANTITIES)[0]
    still = DrawnStream(start=(0.3, 0.0))
    still.move(np.column_stack([np.full(40, 0.3), np.zeros(40)]))
    first = curves_of(Subject(still.stream(), "a.irdata"), JOINT_QUANTITIES)[0]
    lines = terminal_text([first, other], [0], 80).splitlines()
    assert lines[0] == "a.irdata (dashed) and b.npz, drawer"
    below = dots([line[9 : 9 + 15] for line in lines[2:7]])
    level = round(0.3 * 19)
    columns = sorted(below[np.abs(below[:, 1] - level) <= 1][:, 0].tolist())
    # Four columns of dots of six are drawn of the first one.
    assert {column % 6 for column in columns if column > 2} == {0, 1, 2, 3}


def test_a_stream_that_stands_still():
    made = DrawnStream()
    made.move(np.zeros((5, 2)))
    text = terminal_text([shown(*QUANTITIES, stream=made.stream())], [0, 1], 80)
    assert "turn position, deg" in text


def test_an_incomplete_one_says_so():
    curves = curves_of(Subject(square_and_slow(), "a"), [Quantity.POSITION])[0]
    assert "INCOMPLETE" not in terminal_text([curves], [0], 80)
    assert terminal_text([replace(curves, complete=False)], [0], 80).startswith(
        "drawn.irl, drawer, INCOMPLETE"
    )
