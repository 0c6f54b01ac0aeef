"""Step bounds of a tick against simulation: counted from its start, always leaving a way to brake."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from irlx.promises import rounding_allowance
from irlx.robot.limits import JointLimits
from irlx.transform.precision import BOUND_RESERVE
from irlx.transform.step_bounds import BoundSource, StepBounds, StepLimiter, braking_speed
from long_run import chequered, first

TICKS = [0.00025, 0.001, 0.01, 0.05]


def room_used(speed: Fraction, deceleration: Fraction, dt: Fraction) -> Fraction:
    """Way of whole ticks from one step at `speed` down to rest, each tick slower by a dt."""
    way = Fraction(0)
    while speed > 0:
        way += speed * dt
        speed -= deceleration * dt
    return way


@pytest.mark.req("TRF-03")
@pytest.mark.parametrize("dt", TICKS)
@pytest.mark.parametrize("seed", range(10))
def test_braking_speed_uses_the_room_exactly(seed: int, dt: float) -> None:
    """Exact arithmetic: from that speed whole ticks stop in the room, a millionth faster they do not."""
    rng = np.random.default_rng(seed)
    deceleration = float(rng.uniform(0.5, 50.0))
    room = float(rng.uniform(0.0, 400.0)) * deceleration * dt**2
    speed = float(braking_speed(np.array([room]), np.array([deceleration]), dt)[0])
    way = room_used(Fraction(speed), Fraction(deceleration), Fraction(dt))
    assert float(way) == pytest.approx(room, rel=1e-12), f"seed {seed}"
    faster = room_used(Fraction(speed * (1 + 1e-6)), Fraction(deceleration), Fraction(dt))
    assert float(faster) > room, f"seed {seed}"


@pytest.mark.req("TRF-03")
def test_braking_speed_at_whole_numbers_of_ticks() -> None:
    """Room for m steps of a, 2a, ... m a (times dt^2): the speed is m a dt."""
    m = np.arange(0.0, 40.0)
    found = braking_speed(m * (m + 1) / 2 * 3.0 * 0.01**2, np.full(40, 3.0), 0.01)
    np.testing.assert_allclose(found, m * 3.0 * 0.01, rtol=1e-12)


@pytest.mark.req("TRF-03")
def test_braking_speed_of_unknown_and_impossible_decelerations() -> None:
    room = np.array([1.0, np.inf, 1.0, 0.0, -1e-16])
    found = braking_speed(room, np.array([np.inf, 2.0, 0.0, 2.0, 2.0]), 0.01)
    assert found.tolist() == [np.inf, np.inf, 0.0, 0.0, 0.0]


@pytest.mark.req("TRF-02")
def test_bounds_are_those_of_the_formula(making) -> None:
    """Position, speed and acceleration from the start of the tick, each where it is the narrowest."""
    limits = making.limits(4, [1.0, 100.0, 100.0, 100.0], [50.0, 2.0, 50.0, 50.0], [1e4, 1e4, 3.0, np.inf])
    q, speed, dt = np.array([0.99, 0.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.5, -7.0]), 0.01
    bounds = StepLimiter(limits, dt, reserve=0.0).bounds(q, speed)
    assert bounds.upper[0] == 1.0 - 0.99
    assert bounds.upper_source[0] in (BoundSource.POSITION, BoundSource.BRAKING)
    assert bounds.upper[1] == pytest.approx(dt * 2.0, rel=1e-15)
    assert bounds.lower[1] == pytest.approx(-dt * 2.0, rel=1e-15)
    assert bounds.upper_source[1] == bounds.lower_source[1] == BoundSource.SPEED
    assert bounds.upper[2] == pytest.approx(dt * 0.5 + dt**2 * 3.0, rel=1e-14)
    assert bounds.lower[2] == pytest.approx(dt * 0.5 - dt**2 * 3.0, rel=1e-14)
    assert bounds.upper_source[2] == bounds.lower_source[2] == BoundSource.ACCELERATION
    assert bounds.upper[3] == pytest.approx(dt * 50.0)


@pytest.mark.req("TRF-02")
def test_speed_and_acceleration_keep_a_reserve_and_positions_none(making) -> None:
    limits = making.limits(1, 0.001, 1.0, 5.0)
    wide = making.limits(1, np.inf, 1.0, 5.0)
    bounds = StepLimiter(wide, 0.5).bounds(np.zeros(1), np.zeros(1))
    assert bounds.upper[0] == pytest.approx(0.5 * (1.0 - BOUND_RESERVE), rel=1e-15)
    bounds = StepLimiter(wide, 0.01).bounds(np.zeros(1), np.zeros(1))
    assert bounds.upper[0] == pytest.approx(5.0e-4 * (1.0 - BOUND_RESERVE), rel=1e-12)
    assert StepLimiter(limits, 1.0).bounds(np.zeros(1), np.zeros(1)).upper[0] == 0.001


@pytest.mark.req("TRF-03")
def test_a_joint_on_its_limit_may_leave_it(making) -> None:
    limits = making.limits(2, [1.0, 0.3], 2.0, 5.0)
    bounds = StepLimiter(limits, 0.01).bounds(np.array([1.0, -0.3]), np.zeros(2))
    assert bounds.upper[0] == 0.0
    assert bounds.lower[0] == pytest.approx(-5.0e-4, rel=1e-5)
    assert bounds.lower[1] == 0.0
    assert bounds.upper[1] == pytest.approx(5.0e-4, rel=1e-5)


def simulate(limits: JointLimits, dt: float, q: np.ndarray, choose, ticks: int) -> np.ndarray:
    """Rows of joints that follow `choose(bounds, tick)`, clipped into the bounds, from rest."""
    limiter = StepLimiter(limits, dt)
    rows, speed = [q], np.zeros_like(q)
    for tick in range(ticks):
        bounds = limiter.bounds(q, speed)
        assert bounds.conflicts.size == 0, f"tick {tick}: {bounds.lower} above {bounds.upper}"
        step = np.clip(choose(bounds, tick), bounds.lower, bounds.upper)
        speed, q = ((q + step) - q) / dt, q + step
        rows.append(q)
    return np.array(rows)


def check(rows: np.ndarray, limits: JointLimits, dt: float, where: str) -> None:
    rest = np.vstack([rows[:1], rows])
    speeds = np.diff(rest, axis=0) / dt
    accelerations = np.diff(speeds, axis=0) / dt
    speed_slack, acceleration_slack = rounding_allowance(rows, dt)
    # Adding a step to a posture rounds once; that emitted rows are exact is asked of the tick solver.
    unit = np.spacing(np.max(np.abs(rows)))
    assert np.all(rows <= limits.position_upper + unit), where
    assert np.all(rows >= limits.position_lower - unit), where
    assert np.all(speeds <= limits.speed_upper * (1 + 1e-9) + speed_slack), where
    assert np.all(speeds >= limits.speed_lower * (1 + 1e-9) - speed_slack), where
    assert np.all(accelerations <= limits.acceleration_upper * (1 + 1e-9) + acceleration_slack), where
    assert np.all(accelerations >= limits.acceleration_lower * (1 + 1e-9) - acceleration_slack), where


@pytest.mark.req("TRF-03")
@pytest.mark.req("MOT-20")
@pytest.mark.parametrize(
    ("wall", "dt"), chequered([pytest.param("upper", id="upper"), pytest.param("lower", id="lower")], TICKS)
)
def test_largest_steps_towards_a_limit_never_run_out_of_room(wall: str, dt: float) -> None:
    """400 joints take the largest step towards their limit, with spells of others: no empty interval."""
    rng = np.random.default_rng(int(dt * 1e6))
    n = 400
    limit = rng.uniform(0.0, 3.0, n) * rng.choice([0.0, 1.0, 1.0, 1.0], n)
    infinite = np.full(n, np.inf)
    fast, slow = rng.uniform(0.1, 10.0, n), np.full(n, 0.1)
    accelerations = rng.choice([0.3, 5.0, 40.0, 900.0], (2, n))
    start = limit - rng.choice([0.0, 0.01, 1.0, 3.0], n)
    limits = JointLimits(-infinite, limit, -slow, fast, -accelerations[0], accelerations[1])
    if wall == "lower":
        limits = JointLimits(-limit, infinite, -fast, slow, -accelerations[1], accelerations[0])
        start = -start
    towards = np.ones(n, dtype=bool)

    def choose(bounds: StepBounds, tick: int) -> np.ndarray:
        nonlocal towards
        flip = rng.random(n) < np.where(towards, 0.002, 0.02)
        towards = towards ^ flip
        step = np.where(towards == (wall == "upper"), bounds.upper, bounds.lower)
        wild = rng.random(n) < 0.01
        return np.where(wild, bounds.lower + rng.random(n) * (bounds.upper - bounds.lower), step)

    rows = simulate(limits, dt, start, choose, 800)
    check(rows, limits, dt, f"dt {dt}")
    arrived = np.any(np.abs(np.abs(rows) - limit) < 1e-15, axis=0)
    assert np.sum(arrived) > n / 4, "few joints met their limit: the test asks too little"


@pytest.mark.req("TRF-02")
def test_unlimited_joints_have_unlimited_steps(making) -> None:
    bounds = StepLimiter(making.limits(3), 0.01).bounds(np.zeros(3), np.ones(3))
    assert np.all(bounds.upper == np.inf)
    assert np.all(bounds.lower == -np.inf)
    assert bounds.conflicts.size == 0


@pytest.mark.req("TRF-02")
def test_contradicting_bounds_name_the_joint_and_both_limits(making) -> None:
    """Too fast to stop: braking room and acceleration contradict each other."""
    limits = making.limits(2, 1.0, 5.0, 2.0)
    bounds = StepLimiter(limits, 0.01).bounds(np.array([0.0, 0.999]), np.array([0.0, 3.0]))
    assert bounds.conflicts.tolist() == [1]
    assert bounds.upper_source[1] == BoundSource.BRAKING
    assert bounds.lower_source[1] == BoundSource.ACCELERATION


@pytest.mark.req("TRF-03")
@pytest.mark.parametrize("seed", first(15, range(40)))
def test_many_rows_are_judged_as_tick_by_tick(making, seed: int) -> None:
    """Random walks that sooner or later pass a bound: the first row that does is that of `bounds`."""
    rng = np.random.default_rng(seed)
    n, dt = 4, float(rng.choice(TICKS))
    accelerations = rng.choice([0.5, 3.0, np.inf], n) if seed % 3 else np.full(n, np.inf)
    reach = rng.choice([0.01, 0.5, np.inf], n)
    limits = making.limits(n, reach, rng.choice([0.2, 2.0, np.inf], n), accelerations)
    limiter = StepLimiter(limits, dt)
    q, speed = np.zeros(n), np.zeros(n)
    scale = dt * rng.choice([1e-16, 0.01, 0.3]) * np.ones(n)
    steps = np.cumsum(rng.normal(size=(60, n)) * scale * (dt if seed % 2 else 1.0), axis=0)
    steps[rng.integers(60)] = 0.0
    rows = np.cumsum(steps, axis=0)
    if seed % 5 == 0 and np.isfinite(reach[0]):
        rows[10:, 0] = reach[0]
    expected = 0
    for row in rows:
        bounds = limiter.bounds(q, speed)
        step = row - q
        outside = np.any(step < bounds.lower) or np.any(step > bounds.upper)
        if outside or np.any(limiter.into_positions(row) != row):
            break
        q, speed, expected = row, step / dt, expected + 1
    assert limiter.kept(np.zeros(n), np.zeros(n), rows) == expected, f"seed {seed}"


def fastest_towards(room: float, deceleration: float, dt: float) -> float:
    """Largest v with v dt + (v - a dt) dt + ... down to rest within the room, tick by tick."""
    if not np.isfinite(deceleration) or not np.isfinite(room):
        return np.inf
    low, high = 0.0, room / dt + deceleration * dt
    for _ in range(80):
        middle = 0.5 * (low + high)
        used, speed = 0.0, middle
        while speed > 0.0 and used <= room:
            used, speed = used + speed * dt, speed - deceleration * dt
        low, high = (middle, high) if used <= room else (low, middle)
    return low


@pytest.mark.parametrize("seed", range(8))
def test_bounds_beside_position_limits_are_those_of_braking_ticks(making, seed: int) -> None:
    """Next to a limit, far from it, at every speed and with decelerations of any size, on both sides."""
    rng = np.random.default_rng(seed)
    n, dt = 6, float(rng.choice([0.001, 0.01, 0.05]))
    v, a = rng.uniform(0.2, 2.0, n), rng.choice([0.3, 0.8, 5.0, 40.0], n)
    limits = making.limits(n, 1.0, v, a)
    limiter = making.limiter(limits, dt, reserve=0.0)
    for sign in (1.0, -1.0):
        room = rng.uniform(0.0, 1.4, n) * rng.choice([1e-4, 0.1, 1.0], n) * (v**2 / (2.0 * a) + v * dt)
        q = sign * (1.0 - np.minimum(room, 1.0))
        bounds = limiter.bounds(q, np.zeros(n))
        most = np.array(
            [min(v[j], a[j] * dt, fastest_towards(1.0 - sign * q[j], a[j], dt)) * dt for j in range(n)]
        )
        towards = bounds.upper if sign > 0 else -bounds.lower
        away = -bounds.lower if sign > 0 else bounds.upper
        np.testing.assert_allclose(towards, most, rtol=1e-9, atol=1e-13)
        # From the other limit it is far enough to go as fast as the acceleration lets it.
        np.testing.assert_allclose(away, np.minimum(v, a * dt) * dt, rtol=1e-9)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rows_that_lack_the_room_to_brake_are_not_kept(making, sign: float) -> None:
    """At 0.5 per s and 1 per s2 a joint needs 0.125 and a tick: until there such rows are kept."""
    limits = making.limits(2, 1.0, 0.5, 1.0)
    limiter = making.limiter(limits, 0.01)
    q = np.array([sign * 0.8, 0.0])
    steps = np.tile([sign * 0.00499, 0.0], (30, 1))
    rows = q + np.cumsum(steps, axis=0)
    room = 1.0 - sign * np.concatenate([[q[0]], rows[:-1, 0]])
    wanted = [fastest_towards(one, 1.0, 0.01) >= 0.499 * (1 + 1e-6) for one in room].index(False)
    assert 10 < wanted < 20
    assert limiter.kept(q, np.array([sign * 0.499, 0.0]), rows) == wanted


@pytest.mark.req("TRF-03")
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_long_way_to_brake_is_seen_from_afar(making, sign: float) -> None:
    """At 10 per s and 5 per s2 a joint needs 10 and more; 5 before its limit it may go at 7 at most."""
    limiter = making.limiter(making.limits(1, 20.0, 10.0, 5.0), 0.01, reserve=0.0)
    q, speed = np.array([sign * 15.0]), np.array([sign * 10.0])
    most = fastest_towards(5.0, 5.0, 0.01) * 0.01
    assert 0.069 < most < 0.071
    bounds = limiter.bounds(q, np.array([sign * most / 0.01]))
    assert (bounds.upper if sign > 0 else -bounds.lower)[0] == pytest.approx(most, rel=1e-9)
    assert limiter.kept(q, speed, q[None] + sign * 0.0999) == 0
