"""Random chains with degenerate moves among them: every motion smooth, within its bounds, and complete."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import Blend, MoveKind, Profile
from irlx.motion.chain_path import ChainPath
from irlx.motion.errors import MotionError
from irlx.motion.plan_chain import PlannedChain, plan_chain
from long_run import first

KINDS = ["line", "circle", "spline", "polyline", "back", "turn"]

NO_GEOMETRY = {"IRL422", "IRL425", "IRL427", "IRL428", "IRL434", "IRL435"}


def blend_of(rng: np.random.Generator) -> Blend | None:
    return (None, Blend(), Blend(10.0 ** rng.uniform(-4.0, 0.0)), Blend(0.0), Blend(1e-9))[
        rng.choice(5, p=[0.1, 0.25, 0.55, 0.05, 0.05])
    ]


def legs_of(kit, rng: np.random.Generator, count: int):
    """Legs from the origin on: lines, arcs, splines, polylines, some of no length, back, tiny or long."""
    here, legs = np.zeros(3), []
    for _ in range(count):
        law = kit.law(
            speed=10.0 ** rng.uniform(-2.0, 0.5),
            acc=10.0 ** rng.uniform(-0.5, 1.0),
            profile=rng.choice(list(Profile), p=[0.8, 0.2]),
            override=rng.choice([1.0, 0.3], p=[0.8, 0.2]),
        )
        size = rng.choice([0.0, 1e-9, 1e-6, 1e-3, 0.3, 30.0], p=[0.03, 0.02, 0.02, 0.13, 0.77, 0.03])
        points = here + size * np.cumsum(rng.normal(size=(4, 3)), axis=0)
        if rng.random() < 0.1:
            points[1] = here
        turns = [None if rng.random() < 0.5 else kit.quaternion(rng) for _ in points]
        kind = rng.choice(KINDS, p=[0.5, 0.2, 0.1, 0.1, 0.05, 0.05])
        if kind == "circle":
            block = kit.circle(points[0], points[1], law, turns[:2], turns_through_via=rng.random() < 0.3)
            end = points[1]
        elif kind in ("spline", "polyline"):
            block = kit.path(MoveKind.SPLINE if kind == "spline" else MoveKind.LIN, points, turns, law)
            end = points[-1]
        else:
            previous = legs[-1].block.target.position if kind == "back" and legs else points[0]
            end = here if kind == "turn" else np.array(previous)
            block = kit.block(end, turns[0], law)
        legs.append(kit.leg(block, blend_of(rng)))
        here = end
    return legs


def bounds_at(planned: PlannedChain, laws, way: np.ndarray) -> tuple[np.ndarray, ...]:
    """Programmed speed and acceleration of the leg that carries out each s, the laxer one where two meet."""
    ends = np.array(planned.ends)
    near = 1e-9 * planned.path.length
    legs = [np.clip(np.searchsorted(ends, way + off), 0, len(ends) - 1) for off in (-near, near)]
    values = np.array([(law.speed * law.override, law.acc * law.override**2, law.override) for law in laws])
    return tuple(np.maximum(*(values[leg, column] for leg in legs)) for column in range(3))


def check_joints(path: ChainPath) -> None:
    """Where pieces meet both sides have the same pose, tangent, curvature and turn."""
    for before, behind in pairwise(path.pieces):
        at = np.array([before.length]), np.array([0.0])
        scale = 1.0 + np.max(np.abs(before.poses(at[0]).position))
        for order, (low, high) in enumerate(
            zip(
                (values_at(before, at[0]), before.derivatives(at[0]), before.second_derivatives(at[0])),
                (values_at(behind, at[1]), behind.derivatives(at[1]), behind.second_derivatives(at[1])),
                strict=True,
            )
        ):
            short = min(before.length, behind.length)
            for part in (0, 1):
                largest = 1.0 + np.max(np.abs(low[part]))
                allowed = scale * (1e-12 + 1e-13 / short**order) + 1e-9 * largest
                assert np.max(np.abs(high[part] - low[part])) < allowed, f"derivative {order}, part {part}"


def values_at(piece, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    poses = piece.poses(s)
    return poses.position, poses.rotation


def check(planned: PlannedChain, laws, position: np.ndarray, rotation: np.ndarray) -> None:
    path, law = planned.path, planned.law
    if planned.ticks == 0:
        assert path.is_nothing
        return
    s = np.linspace(0.0, path.length, 801)
    poses, (along, turning) = path.poses(s), path.derivatives(s)
    assert np.max(np.abs(poses.position[0] - position)) < 1e-9 * (1.0 + np.max(np.abs(position)))
    assert np.max(np.abs(poses.rotation[0] - rotation)) < 1e-9
    assert np.all(np.isfinite(along))
    assert np.all(np.isfinite(turning))
    if not path.is_pure_turn:
        assert np.max(np.abs(np.linalg.norm(along, axis=1) - 1.0)) < 1e-12
        # Chords are never longer than the arc length between their ends.
        chords = np.linalg.norm(np.diff(poses.position, axis=0), axis=1)
        assert np.max(chords - np.diff(s)) < 1e-12 * (1.0 + np.max(np.abs(poses.position)))
    t = np.linspace(0.0, law.duration, 2001)
    way, rate = law.evaluate(t)
    assert np.all(np.diff(way) >= 0.0)
    assert (way[0], way[-1]) == (0.0, path.length)
    assert np.max(np.abs(law.evaluate(law.times_at(way))[0] - way)) <= 1e-11 * path.length
    (across, bend), (_, turn) = path.second_derivatives(way), path.derivatives(way)
    speed, acc, stretch = bounds_at(planned, laws, way)
    if not path.is_pure_turn:
        assert np.all(rate <= speed * (1 + 1e-9))
        assert np.all(np.linalg.norm(across, axis=1) * rate**2 <= acc * (1 + 2e-3) + 1e-12)
        inner = np.abs(np.diff(rate) / t[1])
        assert np.all(inner <= np.maximum(acc[1:], acc[:-1]) * (1 + 1e-6))
    if isinstance(path, ChainPath):
        assert np.all(np.linalg.norm(turn, axis=1) * rate <= 1.5 * stretch * (1 + 1e-3))
        assert np.all(np.linalg.norm(bend, axis=1) * rate**2 <= 1.5 * stretch**2 * (1 + 2e-3))
        check_joints(path)
    assert list(planned.ends) == sorted(planned.ends)
    assert planned.ends[-1] == path.length
    for join in planned.joins:
        assert join.used > 0.0
        assert join.miss < 2.0 * join.used


def planned_or_none(legs, rotation: np.ndarray, position: np.ndarray) -> PlannedChain | None:
    try:
        return plan_chain(legs, rotation, position, 0.01)
    except MotionError as error:
        if error.diagnostics[0].code not in NO_GEOMETRY:
            raise
        return None


@pytest.mark.req("MOT-06")
@pytest.mark.parametrize("seed", first(3, range(12)))
def test_random_chains(kit, seed: int) -> None:
    print(f"seed {seed}")
    rng = np.random.default_rng(seed)
    legs = legs_of(kit, rng, 14)
    rotation, position = np.eye(3), np.zeros(3)
    done = 0
    while legs:
        planned = planned_or_none(legs, rotation, position)
        if planned is None:
            # A leg that is none is left out; the one behind it starts where the last motion ended.
            legs = legs[1:]
            continue
        check(planned, [leg.block.law for leg in legs[: len(planned.ends)]], position, rotation)
        done += 1
        rotation, position = planned.path.end_rotation, planned.path.end_position
        assert np.max(np.abs(rotation @ rotation.T - np.eye(3))) < 1e-12
        assert Rotation.from_matrix(rotation).magnitude() <= np.pi
        legs = planned.rest(legs)
    assert done > 0
