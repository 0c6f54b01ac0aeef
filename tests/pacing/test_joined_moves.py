"""Moves that pass their targets: one motion without a stop, on the programmed path away from the corners."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import ArcCourse, Blend, MoveBlock, MoveKind, PathCourse, Port, PoseTarget, SignalBlock
from irlx.blocks import SignalKind as Kind
from irlx.pacing.executed import Executed
from irlx.pacing.lookahead import Lookahead
from irlx.promises import rounding_allowance
from long_run import first, portions

pytestmark = pytest.mark.req("MOT-06")

ON_THE_LINE = 1e-9
SEEDS, LONG = range(25), range(100, 1100)


def target(point: np.ndarray, turned: Rotation | None = None) -> PoseTarget:
    quaternion = None if turned is None else tuple(turned.as_quat().tolist())
    return PoseTarget(tuple(np.asarray(point, dtype=float).tolist()), quaternion)


class Chain:
    """Moves of a shop, gathered and carried out as a program's are."""

    def __init__(self, shop) -> None:
        self.shop, self.blocks = shop, []

    def lin(self, point, turned=None, blend=0.02, **law) -> Chain:
        return self._add(MoveKind.LIN, target(point, turned), blend, None, law)

    def circle(self, via, point, turned=None, blend=0.02, **law) -> Chain:
        return self._add(MoveKind.CIRCLE, target(point, turned), blend, ArcCourse(target(via)), law)

    def path(self, *points, blend=0.02, kind=MoveKind.LIN, **law) -> Chain:
        course = PathCourse(tuple(target(point) for point in points[:-1]))
        return self._add(kind, target(points[-1]), blend, course, law)

    def output(self) -> Chain:
        data = self.shop._data()
        self.blocks.append(SignalBlock(**data, port=Port("OUT_1", Kind.BOOL), value=1.0))
        return self

    def _add(self, kind, to, blend, course, law) -> Chain:
        passing = None if blend is None else Blend(blend if blend > 0 else None)
        data = self.shop._data()
        self.blocks.append(
            MoveBlock(**data, kind=kind, target=to, law=self.shop.law(**law), course=course, blend=passing)
        )
        return self

    def run(self) -> list[Executed]:
        pacer = self.shop.pacer
        ahead = Lookahead(pacer.locate, pacer.notes)
        groups = [group for block in self.blocks for group in ahead.take(block)]
        done = [
            executed
            for group in [*groups, *ahead.stop(None, "the program ends")]
            for executed in pacer.carry_out(group)
        ]
        self.shop.rows += [executed.rows for executed in done if executed.rows is not None]
        return done


def by(start: np.ndarray, x: float, y: float, z: float) -> np.ndarray:
    return start + np.array([x, y, z])


def tool(rows: np.ndarray) -> np.ndarray:
    return np.stack([rows[:, 0] + rows[:, 1], rows[:, 2], rows[:, 3]], axis=1)


def off_lines(points: np.ndarray, corners: list[np.ndarray]) -> np.ndarray:
    """Distance of points (N, 3) from the nearest of the straight lines between corners."""
    found = []
    for a, b in pairwise(corners):
        way = b - a
        share = np.clip((points - a) @ way / (way @ way), 0.0, 1.0)
        found.append(np.linalg.norm(points - a - share[:, None] * way, axis=1))
    return np.min(found, axis=0)


def test_two_lines_are_one_motion_without_a_stop(kit, shop) -> None:
    start = kit.position(shop.start)
    corners = [start, by(start, 0.3, 0.0, 0.0), by(start, 0.3, 0.3, 0.0)]
    done = Chain(shop).lin(corners[1]).output().lin(corners[2], blend=None).run()
    assert [executed.block.id for executed in done] == [1, 2, 3]
    first, signal, second = done
    assert signal.rows is None
    assert signal.tick == second.tick == len(first.rows)
    points = tool(shop.all_rows())
    rates = np.linalg.norm(np.diff(points, axis=0), axis=1) / shop.dt
    # No stop: only the ramps at both ends are slower than the corner allows.
    middle = rates[30:-30]
    assert middle.min() > 0.1
    assert rates.max() <= 0.5 * (1 + 1e-9)
    away = np.linalg.norm(points - corners[1], axis=1) > 0.0201
    assert off_lines(points[away], corners).max() < ON_THE_LINE
    nearest = np.linalg.norm(points - corners[1], axis=1).min()
    assert 0.004 < nearest < 0.02
    # The next move takes over at the row nearest to the corner.
    handover = int(np.argmin(np.linalg.norm(points - corners[1], axis=1)))
    assert abs(len(first.rows) - handover) <= 1
    np.testing.assert_allclose(points[-1], corners[2], atol=1e-12)
    assert np.array_equal(second.rows.q[-1], second.rows.q[-2])


def test_it_is_faster_than_with_a_stop(kit) -> None:
    lengths = []
    for blend in (None, 0.05):
        shop = kit.shop()
        start = kit.position(shop.start)
        Chain(shop).lin(by(start, 0.3, 0, 0), blend=blend).lin(by(start, 0.3, 0.3, 0), blend=None).run()
        lengths.append(len(shop.all_rows()))
    assert lengths[1] < lengths[0] - 10


def test_a_move_without_a_blend_stops(kit, shop) -> None:
    start = kit.position(shop.start)
    done = Chain(shop).lin(by(start, 0.1, 0, 0), blend=None).lin(by(start, 0.1, 0.1, 0), blend=None).run()
    for executed in done:
        assert executed.rows is not None
        assert executed.rows.stops
        assert np.array_equal(executed.rows.q[-1], executed.rows.q[-2])


def test_what_turns_back_stops_with_a_note(kit, shop) -> None:
    start = kit.position(shop.start)
    done = Chain(shop).lin(by(start, 0.1, 0, 0)).lin(start, blend=None).run()
    assert all(executed.rows is not None and executed.rows.stops for executed in done)
    (note,) = shop.pacer.warnings
    assert note.code == "IRL432"
    assert [related.place for related in note.related] == [shop.pacer.locate(done[1].block.origin)]


def test_joined_moves_that_cannot_be_done_are_done_one_by_one(kit) -> None:
    """The second leads beyond the slides: the first is carried out, then the second says why it is not."""
    shop = kit.shop(kit.limits(position=0.6))
    start = kit.position(shop.start)
    chain = Chain(shop).lin(by(start, 0.0, 0.1, 0.0)).lin(by(start, 0.0, 0.1, 0.4), blend=None)
    with pytest.raises(Exception, match="out of reach") as caught:
        chain.run()
    assert caught.value.diagnostics[0].place == shop.pacer.locate(chain.blocks[1].origin)
    np.testing.assert_allclose(kit.position(shop.pacer.q), by(start, 0.0, 0.1, 0.0), atol=1e-12)
    assert [note.code for note in shop.pacer.warnings] == ["IRL432"]


def test_a_path_that_must_stop_inside_comes_in_parts(kit, shop) -> None:
    start = kit.position(shop.start)
    there, up = by(start, 0.1, 0.0, 0.0), by(start, 0.1, 0.0, 0.1)
    chain = Chain(shop).path(there, start, by(start, 0.0, 0.1, 0.0), blend=0.02).lin(up, blend=None)
    done = chain.run()
    assert [(executed.block.id, executed.begins) for executed in done] == [(1, True), (1, False), (2, True)]
    points = tool(shop.all_rows())
    for corner in (there, start):
        assert np.linalg.norm(points - corner, axis=1).min() < 0.02
    assert np.linalg.norm(points - there, axis=1).min() < 1e-12


def test_time_of_a_path_with_stops_is_shared_among_its_parts(kit, shop) -> None:
    start = kit.position(shop.start)
    Chain(shop).path(by(start, 0.1, 0, 0), start, by(start, 0.3, 0, 0), blend=None, duration=3.0).run()
    moving = [rows for rows in shop.rows if rows is not None]
    assert len(moving) == 3
    ticks = sum(len(rows) - 1 for rows in moving)
    assert abs(ticks * shop.dt - 3.0) <= 3 * shop.dt


def drawn(kit, seed: int) -> tuple[object, list[np.ndarray], Chain]:
    """A chain of lines and circles with turns and limits of joints, from a seed."""
    rng = np.random.default_rng(seed)
    print(f"seed {seed}")
    speed = rng.uniform(0.1, 1.0, 7) if rng.random() < 0.5 else np.inf
    acceleration = rng.uniform(1.0, 8.0, 7) if rng.random() < 0.5 else np.inf
    shop = kit.shop(kit.limits(speed=speed, acceleration=acceleration), dt=float(rng.choice([0.001, 0.01])))
    chain, at, turned = Chain(shop), kit.position(shop.start), kit.rotation(shop.start)
    corners = [at]
    for _ in range(int(rng.integers(2, 6))):
        way = rng.choice([0.0, 1e-9, 1e-4, 0.02, 0.2, 0.2, 0.2]) * rng.normal(size=3)
        if rng.random() < 0.1 and len(corners) > 1:
            way = corners[-2] - corners[-1]
        after = at + way
        if rng.random() < 0.5:
            turned = Rotation.from_rotvec(rng.choice([1e-10, 0.02, 0.3]) * rng.normal(size=3)) * turned
        blend = None if rng.random() < 0.1 else float(rng.choice([0.0, 1e-9, 0.005, 0.05, 1.0]))
        law = {"speed": rng.uniform(0.05, 1.0), "acc": rng.uniform(0.3, 5.0)}
        if np.linalg.norm(way) > 0.01 and rng.random() < 0.3:
            via = at + 0.5 * way + 0.3 * np.linalg.norm(way) * np.cross(way, rng.normal(size=3))
            chain.circle(via, after, turned, blend, **law)
        else:
            chain.lin(after, turned, blend, **law)
        at = after
        corners.append(after)
    return shop, corners, chain


def check(kit, seed: int) -> int:
    """Every bound holds in what comes of the seed; number of motions planned to slow down."""
    shop, corners, chain = drawn(kit, seed)
    done = chain.run()
    rows = shop.all_rows()
    held = np.vstack([rows[:1], rows[:1], rows])
    qd = np.diff(held, axis=0) / shop.dt
    qdd = np.diff(qd, axis=0) / shop.dt
    allowance = rounding_allowance(np.array([np.abs(rows).max()]), shop.dt)
    for values, kind, extra in ((qd, "speed", allowance[0]), (qdd, "acceleration", allowance[1])):
        lower, upper = shop.limits.pair(kind)
        assert np.all(values <= upper * (1 + 1e-9) + extra), kind
        assert np.all(values >= lower * (1 + 1e-9) - extra), kind
    np.testing.assert_allclose(tool(rows)[-1], corners[-1], atol=1e-9)
    points = tool(rows)
    rates = np.linalg.norm(np.diff(points, axis=0), axis=1) / shop.dt
    at = 0
    for executed in done:
        if executed.rows is None:
            continue
        law, ticks = executed.block.law, len(executed.rows)
        # The rows of a handover lie in both moves; inside its own rows a move keeps its own speed.
        assert rates[at + 1 : at + ticks - 1].max(initial=0.0) <= law.speed * (1 + 1e-6) + 1e-9
        at += ticks
    return sum(executed.rows is not None and executed.rows.path.planned for executed in done)


KNOWN: dict[int, int] = {}


def checked(kit, seed: int) -> int:
    """The check of a seed, made once."""
    if seed not in KNOWN:
        KNOWN[seed] = check(kit, seed)
    return KNOWN[seed]


@pytest.mark.parametrize("seed", first(8, SEEDS))
def test_drawn_chains_keep_every_bound(kit, seed) -> None:
    checked(kit, seed)


@pytest.mark.slow
@pytest.mark.parametrize("seeds", portions(LONG), ids=str)
def test_many_drawn_chains_keep_every_bound(kit, seeds) -> None:
    for seed in seeds:
        print("seed", seed)
        check(kit, seed)


def test_some_drawn_chains_are_slowed(kit) -> None:
    assert sum(checked(kit, seed) for seed in list(SEEDS)[:12]) > 3


def test_settled_blocks_are_the_programs(kit, shop) -> None:
    start = kit.position(shop.start)
    chain = Chain(shop).lin(by(start, 0.1, 0, 0)).lin(by(start, 0.1, 0.1, 0), blend=None)
    assert [executed.block for executed in chain.run()] == [replace(block) for block in chain.blocks]
