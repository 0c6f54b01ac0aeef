"""PTP moves that blend: smooth in joint space, every joint within its limits by differences of the rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from irlx.blocks import Blend, Profile
from irlx.motion.errors import MotionError
from irlx.motion.plan_joint_chain import JointLeg, PlannedJointCurve, plan_joint_chain
from irlx.motion.plan_joint_line import plan_joint_line
from irlx.robot.limits import JointLimits
from long_run import first

pytestmark = [pytest.mark.req("MOT-05"), pytest.mark.req("MOT-06")]

NAMES = ("j1", "j2", "j3", "j4")


def limits(speed, acc, speed_lower=None, acc_lower=None) -> JointLimits:
    speed, acc = np.broadcast_to(speed, 4).astype(float), np.broadcast_to(acc, 4).astype(float)
    low = -speed if speed_lower is None else np.asarray(speed_lower, dtype=float)
    low_acc = -acc if acc_lower is None else np.asarray(acc_lower, dtype=float)
    infinite = np.full(4, np.inf)
    return JointLimits(-infinite, infinite, low, speed, low_acc, acc)


def chain(kit, postures, bounds, blend=None, dt: float = 0.004, laws=None):
    laws = laws or [kit.law()] * (len(postures) - 1)
    legs = [
        JointLeg(np.array(end, dtype=float), law, blend or Blend(share=1.0), kit.place)
        for end, law in zip(postures[1:], laws, strict=True)
    ]
    return plan_joint_chain(legs, np.array(postures[0], dtype=float), bounds, NAMES, dt)


def differences(start: np.ndarray, rows: np.ndarray, dt: float) -> tuple[np.ndarray, np.ndarray]:
    whole = np.vstack([start, start, rows, rows[-1], rows[-1]])
    speeds = np.diff(whole, axis=0) / dt
    return speeds, np.diff(speeds, axis=0) / dt


@pytest.mark.parametrize("profile", list(Profile))
@pytest.mark.parametrize("dt", [0.00025, 0.004, 0.05])
@pytest.mark.parametrize("seed", first(4, range(8)))
def test_rows_keep_every_limit(kit, seed: int, dt: float, profile: Profile) -> None:
    print(f"seed {seed}")
    rng = np.random.default_rng(seed)
    acc = rng.uniform(0.5, 30.0, 4)
    bounds = limits(rng.uniform(0.1, 5.0, 4), acc, -rng.uniform(0.1, 5.0, 4), -rng.uniform(0.5, 2.0) * acc)
    ways = rng.uniform(-2.0, 2.0, (6, 4)) * rng.choice([0.0, 1e-3, 1.0], size=(6, 4), p=[0.2, 0.2, 0.6])
    ways[:, 0] += 0.1
    ways[3] = -ways[2]
    ways[5] = 2.0 * ways[4]
    start = rng.uniform(-3.0, 3.0, 4)
    laws = [
        kit.law(speed_ptp=rng.choice([0.3, 1.0]), acc_ptp=rng.choice([0.5, 1.0]), profile=profile)
        for _ in range(6)
    ]
    planned = chain(kit, [start, *(start + np.cumsum(ways, axis=0))], bounds, Blend(share=0.7), dt, laws)
    assert planned.legs == 6
    rows = planned.motion.postures(dt)
    assert rows[-1].tolist() == (start + np.cumsum(ways, axis=0))[-1].tolist()
    speeds, accelerations = differences(start, rows, dt)
    unit = np.spacing(np.max(np.abs(rows)))
    for values, lower, upper, slack in (
        (speeds, bounds.speed_lower, bounds.speed_upper, 2 * unit / dt),
        (accelerations, bounds.acceleration_lower, bounds.acceleration_upper, 4 * unit / dt**2),
    ):
        assert np.all(values <= upper * (1 + 1e-9) + slack)
        assert np.all(values >= lower * (1 + 1e-9) - slack)
    if dt == 0.00025:
        law = planned.motion.law
        assert np.max(np.abs(accelerations) / acc) > 0.2
        assert law.duration == pytest.approx(planned.motion.ticks * dt, rel=1e-14)


def test_the_path_is_twice_differentiable_and_passes_near_the_corners(kit) -> None:
    postures = [(0, 0, 0, 0), (1, 0.5, 0, 0), (1, 1, -1, 0), (0, 0, 0, 0.5)]
    planned = chain(kit, postures, limits(1.0, 4.0), Blend(share=0.5))
    assert isinstance(planned.motion, PlannedJointCurve)
    path = planned.motion.path
    for step in (1e-4, 1e-5):
        s = np.linspace(2 * step, path.length - 2 * step, 4001)
        rate, bend = path.derivatives(s)
        q = [path.q(s + k * step) for k in (-1, 0, 1)]
        assert np.max(np.abs((q[2] - q[0]) / (2 * step) - rate)) < 20 * step
        assert np.max(np.abs((q[2] - 2 * q[1] + q[0]) / step**2 - bend)) < 100 * step
    assert path.q(np.array([0.0, path.length])).tolist() == [list(postures[0]), list(postures[-1])]
    for join, corner in zip(planned.joins, postures[1:], strict=False):
        assert join.used == pytest.approx(0.5)
        assert np.max(np.abs(path.q(np.array([join.s]))[0] - corner)) == pytest.approx(np.max(join.miss))
    # Both ways take 1 s, the blend reaches 0.25 s to both sides; the quartic misses by 3/16 of that.
    change = np.abs(np.array([1, 0.5, 0, 0]) - np.array([0, 0.5, -1, 0]))
    assert planned.joins[0].miss == pytest.approx(3.0 / 16.0 * 0.25 * change, rel=1e-12)


def test_a_single_move_is_the_line_it_was(kit) -> None:
    bounds = limits(1.0, 4.0)
    start, end = np.zeros(4), np.array([1.0, -0.5, 0.0, 0.2])
    for law in (kit.law(), kit.law(profile=Profile.S_CURVE), kit.law(duration=5.0)):
        alone = plan_joint_line(start, end, law, bounds, NAMES, 0.01, kit.place)
        planned = chain(kit, [start, end], bounds, dt=0.01, laws=[law])
        assert planned.legs == 1
        assert planned.motion.postures(0.01).tolist() == alone.postures(0.01).tolist()


@pytest.mark.parametrize("seed", range(6))
def test_s_curve_of_a_line(kit, seed: int) -> None:
    """All joints together; the acceleration rises in 50 ms, and the time is that of a seven-phase law."""
    rng = np.random.default_rng(seed)
    bounds = limits(rng.uniform(0.5, 2.0, 4), rng.uniform(2.0, 20.0, 4))
    end = rng.uniform(0.1, 2.0, 4)
    planned = plan_joint_line(
        np.zeros(4), end, kit.law(profile=Profile.S_CURVE), bounds, NAMES, 1e-4, kit.place
    )
    plain = plan_joint_line(np.zeros(4), end, kit.law(), bounds, NAMES, 1e-4, kit.place)
    rows = planned.postures(1e-4)
    speeds, accelerations = differences(np.zeros(4), rows, 1e-4)
    jerk = np.diff(accelerations, axis=0) / 1e-4
    assert np.all(np.abs(accelerations) <= bounds.acceleration_upper * (1 + 1e-9) + 1e-6)
    assert np.max(np.abs(jerk) / (bounds.acceleration_upper / 0.05)) == pytest.approx(1.0, rel=2e-2)
    if np.max(np.abs(accelerations) / bounds.acceleration_upper) > 0.999:
        # Reached: the law takes the 50 ms more wherever it also cruises.
        assert planned.law.duration <= plain.law.duration + 0.1 + 2e-4
    assert planned.law.duration > plain.law.duration
    assert np.max(np.abs(speeds)) <= np.max(bounds.speed_upper)


def test_override_and_time(kit) -> None:
    postures = [(0, 0, 0, 0), (1, 0.5, 0, 0), (1, 1, -1, 0), (0, 0, 0, 0.5)]
    bounds = limits(1.0, 4.0)
    full = chain(kit, postures, bounds)
    half = chain(kit, postures, bounds, laws=[kit.law(override=0.5)] * 3)
    assert half.motion.path.length == full.motion.path.length
    assert half.motion.law.duration == pytest.approx(2 * full.motion.law.duration, abs=0.008)
    one = [chain(kit, postures[:2], bounds, laws=[kit.law(override=share)]) for share in (1.0, 0.25)]
    assert one[1].motion.law.duration == pytest.approx(4 * one[0].motion.law.duration, abs=0.016)
    timed = chain(kit, postures, bounds, laws=[kit.law(), kit.law(duration=3.0), kit.law()])
    times = timed.motion.law.times_at(np.array([0.0, *timed.ends]))
    assert np.diff(times)[1] == pytest.approx(3.0, rel=5e-3)
    with pytest.raises(MotionError) as caught:
        chain(kit, postures, bounds, laws=[kit.law(), kit.law(duration=0.1), kit.law()])
    assert caught.value.diagnostics[0].code == "IRL421"


def test_moves_that_do_not_blend(kit) -> None:
    postures = [(0, 0, 0, 0), (1, 0, 0, 0), (1, 0, 0, 0), (1, 1, 0, 0)]
    planned = chain(kit, postures, limits(1.0, 4.0))
    assert planned.legs == 1
    assert planned.notes[0].code == "IRL432"
    assert "the next move has no length" in planned.notes[0].message
    assert chain(kit, postures, limits(1.0, 4.0), Blend(share=0.0)).notes == ()
    held = chain(kit, [postures[0], postures[1], postures[3]], limits((1, 0, 1, 1), 4.0))
    assert held.legs == 1
    assert "speed limit is 0" in held.notes[0].message
    unknown = chain(kit, [postures[0], postures[3], postures[0]], limits(np.inf, 4.0))
    assert unknown.legs == 1
    with pytest.raises(MotionError) as caught:
        chain(kit, [postures[0], postures[1], (2, 0, 0, 0)], limits(1.0, 0.0))
    assert caught.value.diagnostics[0].code == "IRL426"
    legs = [JointLeg(np.ones(4), kit.law(), None, kit.place)] * 2
    assert plan_joint_chain(legs, np.zeros(4), limits(1.0, 4.0), NAMES, 0.01).notes == ()


def test_straight_on_and_back(kit) -> None:
    bounds = limits(1.0, 4.0)
    straight = chain(kit, [(0, 0, 0, 0), (1, 0, 0, 0), (2, 0, 0, 0)], bounds)
    alone = chain(kit, [(0, 0, 0, 0), (2, 0, 0, 0)], bounds)
    assert straight.motion.ticks == alone.motion.ticks
    back = chain(kit, [(0, 0, 0, 0), (1, 0, 0, 0), (0, 0, 0, 0)], bounds, Blend(share=0.5))
    assert back.legs == 2
    rows = back.motion.postures(0.004)
    assert 0.85 < np.max(rows[:, 0]) < 1.0
    assert np.all(rows[:, 1:] == 0.0)


def test_a_later_move_with_other_percentages_takes_over_at_the_corner(kit) -> None:
    laws = [kit.law(), replace(kit.law(), speed_ptp=0.2)]
    planned = chain(
        kit, [(0, 0, 0, 0), (2, 0, 0, 0), (2, 2, 0, 0)], limits(1.0, 4.0), Blend(share=0.2), laws=laws
    )
    law = planned.motion.law
    corner = planned.joins[0].s
    assert law.rates_at(np.array([1.0]))[0] == pytest.approx(1.0, rel=1e-2)
    assert law.rates_at(np.array([corner + 0.3]))[0] == pytest.approx(0.2, rel=1e-2)
