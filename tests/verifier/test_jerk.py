"""The jerk of S curves, taken from rows: third differences of the way are at most what the program says."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from irlx.blocks import Blend, MoveBlock, Profile
from irlx.promises import PATH_POSITION
from irlx.streams import JointStream
from irlx.verifier import rows, verify_stream
from irlx.verifier.chain_legs import jerk_of
from irlx.verifier.findings.tally import Tally
from irlx.verifier.judges import chained_moves, tool_moves
from irlx.verifier.judges.jerk import add_jerk
from made_chains import DT, LAW, START, STEPS, TURNS, led_in, lin, lines, run, start_of
from passing_moves import postures, way_of

pytestmark = [pytest.mark.req("MOT-03"), pytest.mark.req("STR-06")]

SHORT = [tuple(0.2 * np.array(step)) for step in STEPS]
DISTANCES = [0.01, 0.01]
ROUNDING = 8e-9 / DT**3
"""Jerk that rounding of tool poses may pretend, m/s3."""


def s_curve(jerk: float | None):
    return LAW if jerk is None else replace(LAW, profile=Profile.S_CURVE, jerk=jerk)


def chain_of(kit, jerks, bump: tuple[float | None, float] | None = None) -> tuple[JointStream, np.ndarray]:
    """Three joined lines with so many m/s3 each, and their way at every row, the start first.

    With `bump` (share of the way, None for the first corner, and m) the row nearest to it is further on by so
    much.
    """
    maker = kit.Maker(START.copy())
    curves = lines(start_of(kit), SHORT, TURNS)
    way = way_of(curves, DISTANCES)
    s = way.length * kit.smooth(400)
    if bump is not None:
        place = way.ends[0] if bump[0] is None else bump[0] * way.length
        s[np.argmin(np.abs(s - place))] += bump[1]
    blends = [Blend(distance=DISTANCES[0]), Blend(distance=DISTANCES[1]), None]
    pairs = zip(curves, blends, jerks, strict=True)
    run(maker, way, [lin(curve, blend, law=s_curve(jerk)) for curve, blend, jerk in pairs], s)
    return maker.stream(), s


def jerks_of(s: np.ndarray) -> np.ndarray:
    """Jerk (R + 2,) of ways (R,) from rest to rest, at their rows and two more."""
    return np.abs(np.diff(np.concatenate([np.zeros(3), s, np.full(2, s[-1])]), 3)) / DT**3


def with_law(stream: JointStream, law) -> JointStream:
    records = [replace(record, block=replace(record.block, law=law)) for record in stream.records]
    return replace(stream, records=tuple(records))


def jerk_check(stream: JointStream, robot):
    return verify_stream(stream, robot)["programmed jerk"]


def tallied(jerks, bound) -> Tally:
    """The check of ways with these third differences (R,), bounds (R + 3,) at their rows, a second a tick."""
    outline = SimpleNamespace(header=SimpleNamespace(joint_names=()), block_at=lambda _: 1, lines={})
    tally = Tally("programmed jerk", "m/s3", outline)
    along = np.concatenate([np.zeros(3), np.cumsum(np.cumsum(np.cumsum(jerks)))])
    add_jerk(tally, np.arange(len(jerks)), along, np.array(bound), 1.0)
    return tally


@pytest.mark.parametrize(("more", "offends"), [(1.9e-6, False), (2.1e-6, True)])
def test_of_the_programmed_it_may_be_more_by_two_millionths(more: float, offends: bool) -> None:
    assert (tallied([1.0 + more], np.ones(4)).first is not None) is offends


def test_the_worst_is_what_uses_most_of_its_own_bound() -> None:
    worst = tallied([1.0, *[0.0] * 6, 0.8], [*[10.0] * 4, *[1.0] * 7]).worst
    assert (worst.tick, worst.value, worst.allowed) == (7, pytest.approx(0.8), 1.0)


def test_laws_that_bound_it() -> None:
    """A cell may name a jerk for moves that do not ask for S curves."""
    assert jerk_of(s_curve(60.0)) == 60.0
    assert jerk_of(replace(LAW, profile=Profile.S_CURVE)) == np.inf
    assert jerk_of(replace(LAW, jerk=60.0)) == np.inf


@pytest.mark.parametrize("kind", ["line", "arc"])
def test_a_move_is_judged_by_its_third_differences(gantry_kit, robot, kind: str) -> None:
    """The way of the rows is known: bounds a little above and below what it has tell where it is."""

    def made(jerk: float) -> tuple[JointStream, np.ndarray]:
        maker = gantry_kit.Maker(START.copy())
        law = replace(gantry_kit.LAW, profile=Profile.S_CURVE, jerk=jerk)
        if kind == "line":
            length = 0.5
            maker.lin((0.2, -0.1 + length, 0.3), ticks=50)
        else:
            length = 0.3 * np.pi
            maker.circle((0.2, 0.2), 0.5 * np.pi, np.pi, ticks=100)
        return with_law(maker.stream(), law), length * gantry_kit.smooth(50 if kind == "line" else 100)

    _, s = made(1.0)
    found = jerks_of(s)
    peak = float(np.max(found))
    good, bad = (jerk_check(made(peak * share - ROUNDING)[0], robot) for share in (1.0001, 0.9999))
    assert good.status == "ok"
    assert good.worst.value == pytest.approx(peak, rel=1e-4)
    assert bad.status == "failed"
    # Rows are counted from the start, which is row 0.
    assert bad.first.tick == np.flatnonzero(found > 0.9999 * peak)[0] + 1
    assert bad.first.line == 4


@pytest.mark.parametrize("place", [0.1, 0.35, 0.5, 0.9])
def test_joined_moves_are_judged_on_their_blends_as_well(gantry_kit, robot, place: float) -> None:
    even, s = chain_of(gantry_kit, [60.0] * 3)
    assert np.max(jerks_of(s)) < 3.0
    assert jerk_check(even, robot).status == "ok"
    uneven, s = chain_of(gantry_kit, [60.0] * 3, (place, 2e-6))
    found = jerks_of(s)
    check = jerk_check(uneven, robot)
    assert check.status == "failed"
    assert check.first.tick == np.flatnonzero(found > 60.0 + ROUNDING)[0] + 1
    assert check.worst.value == pytest.approx(np.max(found), abs=ROUNDING)


def test_each_of_joined_moves_has_its_own(gantry_kit, robot) -> None:
    """A trapezoid may jump; a row between two moves has what is allowed on either of them."""
    on_first, on_last = (0.1, 2e-6), (0.9, 2e-6)
    for jerks, bump, status in (
        ([None, 60.0, 60.0], on_first, "ok"),
        ([60.0, 60.0, None], on_first, "failed"),
        ([60.0, 60.0, None], on_last, "ok"),
        ([None, None, 60.0], on_last, "failed"),
        ([100.0, 60.0, 60.0], on_first, "ok"),
        # Three of the four rows that tell of it belong to the second move.
        ([100.0, 20.0, 20.0], (None, 2e-6), "ok"),
        ([20.0, 20.0, 100.0], (None, 2e-6), "failed"),
    ):
        assert jerk_check(chain_of(gantry_kit, jerks, bump)[0], robot).status == status, (jerks, bump)


def passing(kit, distance: float, bend: float, bump: tuple[float, float] | None = None) -> JointStream:
    """Two lines of 50 mm with C_PASS, S curves of 60 m/s3, the second turned by `bend` rad."""
    maker = kit.Maker(START.copy())
    steps = [(0.05, 0.0, 0.0), (0.05 * np.cos(bend), 0.05 * np.sin(bend), 0.0)]
    curves = lines(start_of(kit), steps, [(0, 0, 0), (0, 0, 0)])
    way = way_of(curves, [distance])
    s = way.length * kit.smooth(401)
    if bump is not None:
        s[np.argmin(np.abs(s - bump[0] * way.length))] += bump[1]
    blocks = [lin(curves[0], Blend(), law=s_curve(60.0)), lin(curves[1], law=s_curve(60.0))]
    run(maker, way, blocks, s)
    return maker.stream()


def test_c_pass_leaves_untold_how_long_its_blend_is(gantry_kit, robot) -> None:
    """A blend on which no row lies is taken for another one, 1e-7 m longer or shorter, and more by ticks of
    4 ms than any bound. Beside it the lines are judged."""
    assert jerk_check(passing(gantry_kit, 1e-5, 0.05), robot).status == "ok"
    assert jerk_check(passing(gantry_kit, 0.02, 1.0, (0.5, 2e-6)), robot).status == "ok"
    for place in (0.1, 0.9):
        assert jerk_check(passing(gantry_kit, 1e-5, 0.05, (place, 2e-6)), robot).status == "failed"


def test_the_start_and_the_end_count_and_none_is_asked_of_a_trapezoid(gantry_kit, robot) -> None:
    for place, tick in ((0.0, 1), (1.0, None)):
        stream, s = chain_of(gantry_kit, [20.0] * 3, (place, -2e-6 if place else 2e-6))
        check = jerk_check(stream, robot)
        assert check.status == "failed"
        assert check.first.tick == (tick or np.flatnonzero(jerks_of(s) > 20.0 + ROUNDING)[0] + 1)
    assert jerk_check(chain_of(gantry_kit, [None] * 3)[0], robot).status == "no case"


@pytest.mark.parametrize("count", [1, 2])
def test_the_last_row_counts(gantry_kit, robot, count: int) -> None:
    """A move, or joined ones, that stop within a tick: only differences that reach behind the end tell."""
    maker = gantry_kit.Maker(START.copy())
    curves = lines(start_of(gantry_kit), SHORT[:count], TURNS[:count])
    way = way_of(curves, DISTANCES[: count - 1])
    # It ends in steps of 3, 2 and 1 parts, which a row at rest follows: as if it went on slowing down.
    x = np.arange(1, 201) / 200.5
    s = x**3 * (4.0 - 3.0 * x)
    s *= way.length / s[-1]
    found = jerks_of(s)
    assert np.argmax(found) == len(found) - 1
    assert np.max(found[:-1]) < 0.2 * found[-1]
    law = s_curve(0.5 * float(found[-1]))
    blends = [*(Blend(distance=distance) for distance in DISTANCES[: count - 1]), None]
    run(maker, way, [lin(curve, blend, law=law) for curve, blend in zip(curves, blends, strict=True)], s)
    check = jerk_check(maker.stream(), robot)
    assert check.status == "failed"
    # A row at rest comes before it.
    assert (check.first.tick, check.first.value) == (len(s) + 1, pytest.approx(found[-1], rel=1e-3))


def behind_a_ptp(kit, bump: int | None = None, by: float = 2e-6) -> tuple[JointStream, np.ndarray]:
    """Two joined lines, 20 m/s3 each, into which a PTP of 50 ticks leads round a corner, and their ways.

    With `bump` that row of theirs is further on by so many m.
    """
    maker = led_in(kit)
    curves = lines(kit.pose_of(START), SHORT[:2], TURNS[:2])
    way = way_of(curves, DISTANCES[:1])
    s = way.length * kit.smooth(400)
    s = s[s > 0.008]
    if bump is not None:
        s[bump] += by
    blends = [Blend(distance=DISTANCES[0]), None]
    pairs = zip(curves, blends, strict=True)
    run(maker, way, [lin(curve, blend, law=s_curve(20.0)) for curve, blend in pairs], s)
    return maker.stream(), s


def test_behind_a_corner_to_a_ptp_it_counts_from_the_fourth_row_on_the_way(gantry_kit, robot) -> None:
    """How the tool came to the first ones nobody knows."""
    good, s = behind_a_ptp(gantry_kit)
    report = verify_stream(good, robot)
    assert report["programmed jerk"].status == "ok"
    fourth = 3 + int(np.argmax(s >= report["path position"].worst.allowed - PATH_POSITION))
    for bump, tick in ((fourth - 1, fourth), (fourth, fourth), (fourth + 9, fourth + 9)):
        check = jerk_check(behind_a_ptp(gantry_kit, bump)[0], robot)
        # Fifty rows of the PTP come before, and the start.
        assert (check.status, check.first.tick) == ("failed", 51 + tick)
    # Nor may the third one lie behind the second.
    back = s[fourth - 2] - s[fourth - 1] - 1e-8
    report = verify_stream(behind_a_ptp(gantry_kit, fourth - 1, back)[0], robot)
    assert report["path progress"].first.tick == 51 + fourth - 1


def test_nor_do_portions_behind_a_corner(gantry_kit, robot, monkeypatch) -> None:
    """The first row that has too much is the first one of a portion."""
    stream, _ = behind_a_ptp(gantry_kit, 61)
    due = jerk_check(stream, robot).first
    monkeypatch.setattr(rows, "PORTION", 4)
    assert jerk_check(stream, robot).first == due


def test_of_two_rows_behind_a_corner_nobody_knows_the_jerk(gantry_kit, robot) -> None:
    maker = led_in(gantry_kit)
    (curve,) = lines(gantry_kit.pose_of(START), [(0.1, 0.0, 0.0)], [(0.0, 0.0, 0.0)])
    points, turns = way_of([curve], []).poses(curve.length - np.array([1e-3, 0.0]))
    number = maker.record(MoveBlock, **lin(curve, law=s_curve(20.0)))
    maker.emit(number, postures(points, turns), holds=0)
    assert jerk_check(maker.stream(), robot).status == "no case"


def test_portions_do_not_matter(gantry_kit, robot, monkeypatch) -> None:
    whole = jerk_check(chain_of(gantry_kit, [60.0] * 3, (0.5, 2e-6))[0], robot)
    monkeypatch.setattr(rows, "PORTION", 16)
    parts = jerk_check(chain_of(gantry_kit, [60.0] * 3, (0.5, 2e-6))[0], robot)
    assert parts.first.tick == whole.first.tick
    assert parts.worst.value == pytest.approx(whole.worst.value, rel=1e-6)
    maker = gantry_kit.Maker(START.copy())
    maker.lin((0.2, 0.4, 0.3), ticks=50)
    jerk = 1.01 * float(np.max(jerks_of(0.5 * gantry_kit.smooth(50))))
    alone = with_law(maker.stream(), replace(gantry_kit.LAW, profile=Profile.S_CURVE, jerk=jerk))
    assert jerk_check(alone, robot).status == "ok"


@pytest.mark.parametrize("joined", [True, False])
def test_longer_motions_are_promised_none(gantry_kit, robot, monkeypatch, joined: bool) -> None:
    if joined:
        stream, _ = chain_of(gantry_kit, [60.0] * 3, (0.1, 2e-6))
    else:
        maker = gantry_kit.Maker(START.copy())
        law = replace(gantry_kit.LAW, profile=Profile.S_CURVE, jerk=1.0)
        maker.lin((0.2, 0.1, 0.3), ticks=50)
        stream = with_law(maker.stream(), law)
    judge = chained_moves if joined else tool_moves
    ticks = len(stream.q) - 1
    for most, status in ((ticks, "failed"), (ticks - 1, "no case")):
        monkeypatch.setattr(judge, "JERK_TICKS", most)
        assert jerk_check(stream, robot).status == status
