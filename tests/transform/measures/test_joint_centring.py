"""Joint centring: closed forms, gradients, what happens on the limits and beyond."""

import numpy as np
import pytest

from irlx.robot.limits import JointLimits
from irlx.transform.measures.joint_centring import STEEPEST, JointCentring

FORMS = ("square", "barrier")


def between(lower, upper):
    lower, upper = np.array(lower, dtype=float), np.array(upper, dtype=float)
    return JointLimits.unlimited(lower.size).with_pair("position", lower, upper)


def random_limits(seed):
    rng = np.random.default_rng(seed)
    lower = rng.uniform(-4.0, 3.0, 8)
    return between(lower, lower + rng.uniform(0.01, 6.0, 8)), rng


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("seed", range(8), ids="seed{}".format)
def test_gradient(form, seed, make):
    limits, rng = random_limits(seed)
    lower, upper = limits.pair("position")
    measure = JointCentring(limits, form)
    for _ in range(3):
        q = lower + rng.uniform(0.05, 0.95, 8) * (upper - lower)
        expected = make.derivative(measure.value, q, 1e-6)
        assert np.abs(measure.gradient(q) - expected).max() <= 1e-6 * np.abs(expected).max()


@pytest.mark.parametrize("seed", range(4), ids="seed{}".format)
def test_values(seed):
    limits, rng = random_limits(seed)
    lower, upper = limits.pair("position")
    q = lower + rng.uniform(0.05, 0.95, 8) * (upper - lower)
    middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
    assert JointCentring(limits).value(q) == pytest.approx(np.mean(((q - middle) / half) ** 2), rel=1e-12)
    barrier = np.mean((upper - lower) ** 2 / (4.0 * (upper - q) * (q - lower)))
    assert JointCentring(limits, "barrier").value(q) == pytest.approx(barrier, rel=1e-12)


@pytest.mark.parametrize(("form", "best"), [("square", 0.0), ("barrier", 1.0)])
def test_the_middle_is_best(form, best):
    measure = JointCentring(between([-1.0, 0.0], [3.0, 0.5]), form)
    middle = np.array([1.0, 0.25])
    assert measure.value(middle) == best
    assert np.array_equal(measure.gradient(middle), np.zeros(2))
    assert measure.sense == 1
    assert measure.value(middle + 0.1) > best


@pytest.mark.parametrize("form", FORMS)
def test_joints_without_two_limits_or_range_take_no_part(form):
    lower, upper = [-1.0, -np.inf, -2.0, -np.inf, 0.4], [1.0, np.inf, np.inf, 2.0, 0.4]
    q = np.array([0.5, 7.0, 9.0, -8.0, 0.4])
    some, alone = JointCentring(between(lower, upper), form), JointCentring(between([-1.0], [1.0]), form)
    assert some.value(q) == alone.value(q[:1])
    assert np.array_equal(some.gradient(q), [alone.gradient(q[:1])[0], 0.0, 0.0, 0.0, 0.0])


@pytest.mark.parametrize("form", FORMS)
def test_a_robot_without_limits(form):
    measure = JointCentring(JointLimits.unlimited(3), form)
    assert measure.value(np.ones(3)) == 0.0
    assert np.array_equal(measure.gradient(np.ones(3)), np.zeros(3))


@pytest.mark.parametrize("past", [0.0, 1e-12, 0.3, 50.0])
def test_barrier_on_a_limit_and_beyond(past):
    measure = JointCentring(between([-1.0, -2.0, -3.0], [2.0, 2.0, 3.0]), "barrier")
    q = np.array([2.0 + past, -2.0 - past, 1.0])
    assert measure.value(q) == np.inf
    cap = STEEPEST / (np.array([1.5, 2.0]) * 3)
    assert np.allclose(measure.gradient(q)[:2], [cap[0], -cap[1]], rtol=1e-12)
    inside = JointCentring(between([-3.0], [3.0]), "barrier").gradient(q[2:])[0] / 3
    assert measure.gradient(q)[2] == pytest.approx(inside, rel=1e-12)


def test_barrier_rises_to_its_cap_and_never_passes_it():
    measure = JointCentring(between([-1.0], [1.0]), "barrier")
    room = np.logspace(-17, 0, 200)[::-1]
    slopes = np.array([measure.gradient(np.array([1.0 - left]))[0] for left in room])
    assert np.all(np.diff(slopes) >= 0.0)
    assert slopes.max() == STEEPEST
    exact = room > 7.2e-4
    x = 1.0 - room[exact]
    assert np.allclose(slopes[exact], 2.0 * x / (1.0 - x**2) ** 2, rtol=1e-10)
    assert np.all(slopes[room < 6.9e-4] == STEEPEST)


@pytest.mark.parametrize("joint", [0, 1])
def test_square_on_a_limit(joint, make):
    measure = JointCentring(between([-1.0, -2.0], [3.0, 2.0]))
    q = np.array([1.0, 0.0])
    q[joint] = [3.0, 2.0][joint]
    assert measure.value(q) == pytest.approx(0.5, rel=1e-14)
    assert np.allclose(measure.gradient(q), make.derivative(measure.value, q), rtol=1e-9, atol=1e-9)


def test_unknown_form():
    with pytest.raises(ValueError, match="square, barrier, not 'cubic'"):
        JointCentring(JointLimits.unlimited(2), "cubic")
