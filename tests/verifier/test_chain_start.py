"""Where the rows of a chain come out of the corner behind a PTP: rows of hand-made ways behind loose ones."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import made_chains
from irlx.blocks import ArcCourse, Blend, MoveBlock, PoseTarget
from irlx.verifier import verify_stream
from irlx.verifier.geometry.allowance import EXACT
from irlx.verifier.geometry.arcs import arc_shape
from irlx.verifier.geometry.chain_parts import Leg
from irlx.verifier.geometry.corners import Corner
from irlx.verifier.geometry.curves import ArcCurve, LineCurve
from irlx.verifier.judges.chain_start import ChainStart, start_of_chain
from made_chains import led_in, lin, lines, pose_at
from passing_moves import postures, way_of

pytestmark = [pytest.mark.req("MOT-06"), pytest.mark.req("STR-06")]

START = np.array([0.5, 0.0, 0.5])
WAY = lines(
    (START, Rotation.identity()), [(0.1, 0.0, 0.0), (0.0, 0.12, 0.0)], [(0.1, 0.0, 0.0), (0.0, 0.0, 0.2)]
)
BLEND = 0.05
"""Half of the first line, so that it is left where a corner of `REACH` ends."""
REACH = 0.05
STEP = 0.05
"""More than rows lie apart."""

LOOSE = START + np.array(
    [[-0.02, 0.01, 0.03], [0.0, 0.008, 0.02], [0.02, 0.004, 0.008], [0.04, 0.001, 0.001]]
)


def legs(corner: Corner) -> tuple[Leg, ...]:
    ends = [[pose_at(curve, way) for way in (0.0, curve.length)] for curve in WAY]
    first, second = (LineCurve(*((p, r.as_matrix()) for p, r in pair)) for pair in ends)
    return Leg(first, corner), Leg(second, Corner(0.0))


def rows(ways: np.ndarray, loose: np.ndarray = LOOSE) -> tuple[np.ndarray, np.ndarray]:
    """Loose rows in the corner, then those on the way."""
    points, turns = way_of(WAY, [BLEND]).poses(ways)
    attitudes = np.concatenate([Rotation.identity(len(loose)).as_matrix(), turns])
    return np.concatenate([loose, points]), attitudes


TOLD = Corner(BLEND)
CORNERS = {
    "a blend that is told": TOLD,
    "a PATH may stop": Corner(BLEND, may_stop=True),
    "C_PASS": Corner(BLEND, may_be_less=True),
}


@pytest.mark.parametrize("name", CORNERS)
def test_the_first_row_may_lie_on_the_blend_already(name: str) -> None:
    ways = np.linspace(REACH + 0.004, 0.17, 12)
    start = start_of_chain(rows(ways), legs(CORNERS[name]), START, REACH, EXACT, True, STEP)
    assert start is not None
    assert (start.corner, start.placed, start.fresh) == (len(LOOSE), len(LOOSE), 2)
    assert start.ways.tolist() == [REACH, REACH]


@pytest.mark.parametrize(("end_reach", "placed"), [(0.05, 1), (0.04, 2), (0.0, 2)])
def test_the_second_row_may_lie_in_the_corner_to_the_next_ptp_already(end_reach: float, placed: int) -> None:
    """A lone line between two PTPs that a row after the first one leaves, 0.045 m before its end."""
    leaves = START + np.array([[0.055, 0.001, 0.0], [0.06, 0.004, 0.0], [0.06, 0.008, 0.0]])
    point, turned = pose_at(WAY[0], 0.0525)
    attitudes = [Rotation.identity(len(LOOSE)).as_matrix(), [turned.as_matrix()] * (1 + len(leaves))]
    taken = np.concatenate([LOOSE, [point], leaves]), np.concatenate(attitudes)
    start = start_of_chain(taken, legs(TOLD)[:1], START, REACH, EXACT, True, STEP, end_reach)
    assert start is not None
    assert (start.corner, start.placed) == (len(LOOSE), len(LOOSE) + placed)
    assert start.fresh == 2 - placed


def test_a_row_on_the_first_leg_is_taken_though_the_corner_might_reach_farther() -> None:
    ways = np.array([0.047, 0.065, 0.08, 0.1, 0.12, 0.14])
    start = start_of_chain(rows(ways), legs(TOLD), START, REACH, EXACT, False, STEP)
    assert start is not None
    assert (start.corner, start.placed, start.fresh) == (len(LOOSE), len(LOOSE) + 1, 1)
    assert start.ways == pytest.approx([0.047, 0.047], abs=1e-9)


def test_a_row_off_the_way_and_out_of_reach_is_where_it_begins() -> None:
    """It cannot be hidden in the corner: what judges the way finds it off."""
    loose = np.vstack([LOOSE, START + np.array([0.04, 0.05, 0.0])])
    ways = np.linspace(REACH + 0.004, 0.17, 12)
    start = start_of_chain(rows(ways, loose), legs(TOLD), START, REACH, EXACT, True, STEP)
    assert start is not None
    assert (start.corner, start.placed, start.fresh) == (len(LOOSE), len(LOOSE), 2)


def test_rows_that_never_leave_the_corner_may_lie_on_the_way_in_the_end() -> None:
    """Of a way so small that all of it is within reach; and of one that was not run there are no rows."""
    ways, wide = np.array([0.09, 0.13, 0.17, 0.17]), 0.3
    start = start_of_chain(rows(ways), legs(TOLD), START, wide, EXACT, True, STEP)
    assert start is not None
    assert start.corner == len(LOOSE)
    none = start_of_chain(rows(ways[:0]), legs(TOLD), START, wide, EXACT, True, STEP)
    assert none is not None
    assert (none.corner, none.placed) == (len(LOOSE), len(LOOSE))


def test_it_waits_for_rows_that_tell() -> None:
    ways = np.linspace(REACH + 0.004, 0.17, 12)
    positions, attitudes = rows(ways)
    for seen in (3, len(LOOSE) + 2):
        first = positions[:seen], attitudes[:seen]
        assert start_of_chain(first, legs(CORNERS["C_PASS"]), START, REACH, EXACT, False, STEP) is None
    start = start_of_chain((positions, attitudes), legs(CORNERS["C_PASS"]), START, REACH, EXACT, False, STEP)
    assert start is not None
    assert start.corner == len(LOOSE)


CIRCLE_RADIUS, TWICE = 5e-5, 4.0 * np.pi


def round_a_circle(ways: np.ndarray) -> tuple[ChainStart | None, int]:
    """Loose rows, then some twice round a circle, half of which the corner may take; how many are loose."""
    via, end = (np.array([np.sin(a), 1.0 - np.cos(a), 0.0]) * CIRCLE_RADIUS for a in (2.0, 4.0))
    shape = arc_shape(START, START + via, START + end, TWICE)
    assert shape is not None
    circle = ArcCurve(shape, ArcCourse(PoseTarget((0.0, 0.0, 0.0), None)), (np.eye(3),) * 3)
    loose = START + CIRCLE_RADIUS * np.array([[-3.0, 1.0, 2.0], [0.0, -1.0, 1.0], [1.5, 1.0, 0.4]])
    angles = ways[:, None]
    points = START + CIRCLE_RADIUS * np.hstack([np.sin(angles), 1.0 - np.cos(angles), 0.0 * angles])
    positions = np.concatenate([loose, points])
    rows = positions, np.tile(np.eye(3), (len(positions), 1, 1))
    return start_of_chain(
        rows, (Leg(circle, Corner(0.0)),), START, 0.5 * circle.length, EXACT, True, STEP
    ), len(loose)


def test_rounds_of_a_circle_that_the_corner_takes_are_counted_from_its_end() -> None:
    ways = np.append(np.arange(0.5 * TWICE + 0.2, TWICE, 0.4), [TWICE, TWICE])
    start, loose = round_a_circle(ways)
    assert start is not None
    assert (start.corner, start.placed) == (loose, loose + 2)
    assert start.ways == pytest.approx(CIRCLE_RADIUS * ways[:2], abs=1e-12)


def test_more_rounds_than_the_corner_takes_are_missed() -> None:
    """Half a round more is left out than the corner may take, and one row is off: nothing of it is hidden."""
    ways = np.append(np.arange(0.75 * TWICE, TWICE, 0.4), [TWICE, TWICE])
    start, loose = round_a_circle(ways)
    assert start is None or start.ways[-1] < CIRCLE_RADIUS * (ways[start.placed - loose - 1] - 1.0)


def test_a_line_between_two_ptps_may_have_one_row_alone(gantry_kit, robot) -> None:
    maker = led_in(gantry_kit)
    start, turn = gantry_kit.pose_of(made_chains.START)
    (curve,) = lines((start, turn), [(0.1, 0.0, 0.0)], [(0.0, 0.0, 0.0)])
    aside = np.array([[0.0525, 0.0, 0.0], [0.055, 0.001, 0.0], [0.06, 0.004, 0.0], [0.06, 0.008, 0.0]])
    number = maker.record(MoveBlock, **{"law": made_chains.LAW, **lin(curve, Blend(distance=0.05))})
    maker.emit(number, postures(start + aside, np.array([turn.as_matrix()] * len(aside))), holds=0)
    maker.ptp(maker.rows[-1] + 0.05)
    check = verify_stream(maker.stream(), robot)["path position"]
    assert check.status == "ok", check.text
