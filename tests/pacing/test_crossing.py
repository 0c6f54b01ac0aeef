"""Corners between a PTP and a line, on a gantry: what is saved, what is told, and what is kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from irlx.blocks import Blend, JointTarget, MoveBlock, MoveKind, PoseTarget
from irlx.pacing.carried import are_of_one_kind, passes
from irlx.pacing.crossing import _Corner, _Cut
from irlx.pacing.lookahead import Lookahead
from irlx.promises import rounding_allowance

pytestmark = pytest.mark.req("MOT-06")

DT, SPEED, ACC, PROGRAMMED = 0.01, 0.8, 5.0, 0.4


@dataclass
class Tour:
    """A line of 0.3 m along y, a PTP that goes on along z and turns, a line of 0.2 m along x."""

    kit: object
    blend: Blend | None
    done: list
    notes: list
    q: np.ndarray
    corners: tuple[np.ndarray, np.ndarray]

    @property
    def tool(self) -> np.ndarray:
        return np.stack([self.q[:, 0] + self.q[:, 1], self.q[:, 2], self.q[:, 3]], axis=1)

    def rows_of(self, number: int) -> np.ndarray:
        return self.done[number].rows.tool_position

    def told(self, code: str) -> list[dict]:
        return [note.data for note in self.notes if note.code == code]


def tour(kit, of_lines: Blend | None, of_joints: Blend | None) -> Tour:
    shop = type(kit.shop())(kit.limits(5.0, SPEED, ACC), DT)
    first = kit.beyond(0.0, 0.3, 0.0)
    middle = kit.moved(0.0, 0.0, 0.3, 0.25, 0.3, 0.0, 0.0)
    second = kit.position(middle)
    law = shop.law(speed=PROGRAMMED, acc=2.0)
    asked = (
        (MoveKind.LIN, PoseTarget(tuple(first.tolist()), None), of_lines),
        (MoveKind.PTP, JointTarget(tuple(middle.tolist())), of_joints),
        (MoveKind.LIN, PoseTarget(tuple((second + np.array([0.2, 0.0, 0.0])).tolist()), None), None),
    )
    blocks = [
        MoveBlock(**shop._data(), kind=kind, target=to, law=law, blend=blend) for kind, to, blend in asked
    ]
    pacer = shop.pacer
    ahead = Lookahead(pacer.locate, pacer.notes)
    groups = [group for block in blocks for group in ahead.take(block)]
    groups += ahead.stop(None, "the program ends")
    done = [executed for group in groups for executed in pacer.carry_out(group)]
    q = np.vstack([kit.start, *(one.rows.q for one in done)])
    return Tour(kit, of_lines, done, list(pacer.warnings), q, (first, second))


@pytest.fixture(scope="module")
def tours():
    """Each tour once, by its blends."""
    known: dict = {}

    def found(kit, *blends: Blend | None) -> Tour:
        if blends not in known:
            known[blends] = tour(kit, *blends)
        return known[blends]

    return found


PASSING = [
    (Blend(0.05), Blend(None, 0.5)),
    (Blend(None), Blend(None, 1.0)),
    (Blend(0.02), None),
    (None, Blend(None, 0.3)),
]


@pytest.mark.parametrize("blends", PASSING)
def test_limits_hold_and_the_end_is_met(kit, tours, blends) -> None:
    found = tours(kit, *blends)
    q = np.vstack([found.q[:1], found.q])
    speeds = np.diff(q, axis=0) / DT
    slack = rounding_allowance(q, DT)
    assert np.all(np.abs(speeds) <= SPEED + slack[0])
    assert np.all(np.abs(np.diff(speeds, axis=0)) / DT <= ACC + slack[1])
    assert found.tool[-1] == pytest.approx(found.corners[1] + np.array([0.2, 0.0, 0.0]), abs=1e-9)
    np.testing.assert_array_equal(found.q[-1], found.q[-2])
    ticks = [one.tick for one in found.done]
    lengths = [len(one.rows) for one in found.done]
    assert ticks == [0, lengths[0], lengths[0] + lengths[1]]
    assert [one.rows.first_tick for one in found.done] == [tick + 1 for tick in ticks]


@pytest.mark.parametrize("blends", PASSING)
def test_each_corner_that_is_passed_saves_a_stop(kit, tours, blends) -> None:
    found, stopping = tours(kit, *blends), tours(kit, None, None)
    asked = sum(blend is not None for blend in blends)
    assert len(found.told("IRL436")) == asked
    assert len(stopping.q) - len(found.q) >= 5 * asked
    still = np.flatnonzero((found.q[1:] == found.q[:-1]).all(axis=1))
    assert len(still) == 3 - asked


@pytest.mark.parametrize("blends", PASSING)
def test_what_is_told_of_a_corner_is_what_its_rows_do(kit, tours, blends) -> None:
    """Where it is left and joined: rows that the tour with stops has, too, are the own ones of the moves."""
    found, stopping = tours(kit, *blends), tours(kit, None, None)
    known = {row.tobytes() for row in stopping.q}
    own = np.array([row.tobytes() in known for row in found.q])
    told = iter(found.told("IRL436"))
    for corner, blend in zip(found.corners, blends, strict=True):
        if blend is None:
            continue
        data = next(told)
        away = 1e3 * np.linalg.norm(found.tool - corner, axis=1)
        nearest = int(np.argmin(away))
        assert not own[nearest]
        begin = max(np.flatnonzero(own[:nearest]))
        end = nearest + min(np.flatnonzero(own[nearest:]))
        assert float(data["left"]) == pytest.approx(away[begin], rel=1e-3)
        assert float(data["joined"]) == pytest.approx(away[end], rel=1e-3)
        assert float(data["miss"]) == pytest.approx(away[nearest], rel=1e-3)
        if blend.distance is not None:
            assert away[begin] <= 1e3 * blend.distance * (1 + 1e-9)


@pytest.mark.parametrize("blends", PASSING)
def test_the_tool_keeps_to_the_lines_and_their_speed(kit, tours, blends) -> None:
    """Away from the corners both lines are straight, at no more than their speed; a PTP may be faster."""
    found = tours(kit, *blends)
    speeds = np.linalg.norm(np.diff(found.tool, axis=0), axis=1) / DT
    fastest = max(
        PROGRAMMED, np.max(np.linalg.norm(np.diff(tours(kit, None, None).tool, axis=0), axis=1)) / DT
    )
    assert np.max(speeds) <= fastest * (1 + 1e-6)
    reach = 0.05 if blends[0] is None or blends[0].distance else 0.16
    first = found.rows_of(0)
    early = first[np.linalg.norm(first - found.corners[0], axis=1) > reach]
    assert len(early) > 10
    assert np.max(np.abs((early - kit.position(kit.start))[:, [0, 2]])) < 1e-9


def test_half_of_a_move_is_the_most_that_a_corner_takes(kit, tours) -> None:
    found = tours(kit, Blend(5.0), None)
    (cut,) = found.told("IRL433")
    assert (cut["asked"], cut["used"]) == ("5000", "150")
    (passed,) = found.told("IRL436")
    assert float(passed["left"]) <= 150.0


def test_a_corner_of_nothing_is_none(kit, tours) -> None:
    found = tours(kit, Blend(1e-7), None)
    assert found.told("IRL436") == []
    (lost,) = found.told("IRL432")
    assert "next to nothing" in lost["reason"]
    np.testing.assert_array_equal(found.q, tours(kit, None, None).q)


def test_kinds_of_moves(kit) -> None:
    blocks = [one.block for one in tour(kit, Blend(0.05), Blend(None, 0.0)).done]
    assert [passes(block) for block in blocks] == [True, False, False]
    assert are_of_one_kind(blocks[0], blocks[2])
    assert not are_of_one_kind(blocks[0], blocks[1])
    assert not are_of_one_kind(blocks[1], blocks[2])
    assert are_of_one_kind(blocks[1], blocks[1])


@pytest.mark.parametrize("blends", PASSING)
def test_rows_are_marked_that_no_move_has_on_its_own(kit, tours, blends) -> None:
    """Those of a corner; the row nearest to it is the last one of the move that ends there."""
    found, stopping = tours(kit, *blends), tours(kit, None, None)
    known = {row.tobytes() for row in stopping.q}
    first = 1
    for number, one in enumerate(found.done):
        rows = one.rows
        own = [row.tobytes() in known for row in rows.q]
        assert [rows.passes_corner(row) for row in range(len(rows))] == [not mine for mine in own]
        first += len(rows)
        if number < 2 and blends[number] is not None:
            away = np.linalg.norm(found.tool - found.corners[number], axis=1)
            assert int(np.argmin(away)) == first - 1


def test_what_is_told_of_a_corner_is_told_at_the_move_that_passes_it(kit, tours) -> None:
    found = tours(kit, Blend(5.0), None)
    told = [note for note in found.notes if note.code in {"IRL433", "IRL436"}]
    assert sorted(note.code for note in told) == ["IRL433", "IRL436"]
    assert [note.place.line for note in told] == [1, 1]
    assert [note.related[0].place.line for note in told] == [2, 2]


def test_three_ways_are_looked_at_between_the_same_rows(monkeypatch) -> None:
    """The quickest ones that keep the joints' limits: here all those of no less than half the time."""
    corner = object.__new__(_Corner)

    def cut(left: int, joined: int, ticks: int) -> _Cut | None:
        return _Cut(left, joined, ticks, np.zeros((ticks - 1, 1))) if 2 * ticks >= left + joined else None

    monkeypatch.setattr(corner, "_cut", cut)
    found: dict[tuple[int, int], list[int]] = {}
    saved = []
    for one in corner._cuts((100, 50)):
        found.setdefault((one.left, one.joined), []).append(one.ticks)
        saved.append(one.saved)
    assert len(found) == 36
    assert saved == sorted(saved, reverse=True)
    assert found[100, 50] == [76, 87, 97]
    assert all(len(ticks) <= 3 for ticks in found.values())
