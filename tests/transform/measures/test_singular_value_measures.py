"""Manipulability, dynamic manipulability, smallest singular value: closed forms, gradients, kinks."""

from dataclasses import replace

import numpy as np
import pytest

from irlx.robot.description import Inertial, JointKind
from irlx.transform.measures.dynamic_manipulability import DynamicManipulability
from irlx.transform.measures.inertia import inertia_matrix
from irlx.transform.measures.jacobian_derivative import jacobian_derivative
from irlx.transform.measures.manipulability import Manipulability
from irlx.transform.measures.scaled_jacobian import scaled_jacobian
from irlx.transform.measures.smallest_singular_value import SmallestSingularValue

MEASURES = (Manipulability, SmallestSingularValue, DynamicManipulability)
X, Y, Z, POINT = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
TURN, SLIDE = JointKind.REVOLUTE, JointKind.PRISMATIC
ELBOW = 3


@pytest.fixture(params=MEASURES, ids=lambda kind: kind.name)
def kind(request):
    return request.param


def body(mass):
    return Inertial(mass, POINT, POINT, (0.1, 0.0, 0.0, 0.1, 0.0, 0.1))


def test_values_by_numpy(robot):
    """The Jacobian by differences of another forward kinematics."""
    for q in robot.postures(8, 4):
        jacobian = robot.jacobian(q)
        response = jacobian @ np.linalg.inv(inertia_matrix(robot.kinematics, q))
        gram = [a @ a.T if robot.n >= 6 else a.T @ a for a in (jacobian, response)]
        expected = np.sqrt(np.linalg.det(gram[0]))
        assert Manipulability(robot.kinematics).value(q) == pytest.approx(expected, rel=1e-5)
        smallest = np.sqrt(np.linalg.eigvalsh(gram[0])[0])
        assert SmallestSingularValue(robot.kinematics).value(q) == pytest.approx(smallest, rel=1e-5)
        dynamic = np.prod(np.linalg.svd(response, compute_uv=False))
        assert DynamicManipulability(robot.kinematics).value(q) == pytest.approx(dynamic, rel=1e-5)


@pytest.mark.parametrize("q", [(0.0, 0.0), (0.3, -1.2), (2.0, np.pi / 2)])
def test_planar_arm(pendulum, q):
    q, kinematics = np.array(q), pendulum.robot.kinematics
    assert Manipulability(kinematics).value(q) == pytest.approx(pendulum.volume(q), rel=1e-13)
    dynamic = pendulum.volume(q) / np.linalg.det(pendulum.inertia(q))
    assert DynamicManipulability(kinematics).value(q) == pytest.approx(dynamic, rel=1e-12)


@pytest.mark.parametrize("q", [(0.1, 0.7, 1.1, 0.2, 0.8, -0.4), (0.5, -1.0, -0.3, 2.0, -1.3, 0.0)])
def test_two_links_a_lift_and_a_wrist(make, q):
    """w = l1 l2 |sin q2| |sin b| / reach^3 and its gradient, the tool in the centre of a z-y-z wrist."""
    stroke, l1, l2 = 0.9, 0.6, 0.5
    axes = [(SLIDE, POINT, Z), (TURN, POINT, Z), (TURN, (l1, 0.0, 0.0), Z)]
    wrist = [(TURN, (l2, 0.0, 0.0), Z), (TURN, POINT, Y), (TURN, POINT, Z)]
    measure = Manipulability(make.chain_of(*axes, *wrist, stroke=stroke).kinematics)
    q, scale = np.array(q), l1 * l2 / (l1 + l2 + stroke) ** 3
    assert measure.value(q) == pytest.approx(scale * abs(np.sin(q[2]) * np.sin(q[4])), rel=1e-12)
    expected = np.zeros(6)
    expected[2], expected[4] = measure.value(q) / np.tan(q[2]), measure.value(q) / np.tan(q[4])
    assert np.allclose(measure.gradient(q), expected, rtol=1e-11, atol=1e-14)


def test_three_slides(make):
    """Constant everywhere: w = 1 / reach^3, dynamic divided by the masses that each slide moves."""
    slides = [(SLIDE, POINT, axis) for axis in (X, Y, Z)]
    masses = {i: body(mass) for i, mass in enumerate((3.0, 2.0, 1.0))}
    kinematics = make.chain_of(*slides, masses=masses).kinematics
    q = np.array([0.1, -0.3, 0.7])
    for kind, expected in zip(MEASURES, (1 / 27, 1 / 3, 1 / 27 / (6.0 * 3.0 * 1.0)), strict=True):
        assert kind(kinematics).value(q) == pytest.approx(expected, rel=1e-14)
        assert np.array_equal(kind(kinematics).gradient(q), np.zeros(3))


def assert_gradient(measure, q, make, h=1e-4):
    expected = make.derivative(measure.value, q, h)
    assert measure.value(q) > 0.0
    assert np.abs(measure.gradient(q) - expected).max() <= 1e-6 * np.abs(expected).max()


def test_gradient(robot, kind, make):
    for q in robot.postures(9, 5):
        assert_gradient(kind(robot.kinematics), q, make, 2e-5)


def test_gradient_on_the_limits(packaged, kind, make):
    q = packaged.postures(10, 1)[0]
    lower, upper = packaged.limits.pair("position")
    q[1], q[-2] = upper[1], lower[-2]
    assert_gradient(kind(packaged.kinematics), q, make, 2e-5)


@pytest.mark.parametrize("away", [1e-2, -1e-2, 1e-4, -1e-4])
def test_gradient_next_to_the_stretched_elbow(arm7, kind, away, make):
    q = arm7.postures(11, 1)[0]
    q[ELBOW] = away
    assert_gradient(kind(arm7.kinematics), q, make, abs(away) / 100)


def test_singular_posture(arm7, kind):
    """0 with gradient 0, the middle of a kink: every way out is as good as its opposite, to first order."""
    measure, q = kind(arm7.kinematics), arm7.postures(12, 1)[0]
    q[ELBOW] = 0.0
    assert measure.value(q) == 0.0
    assert np.array_equal(measure.gradient(q), np.zeros(7))
    rng = np.random.default_rng(12)
    for way in rng.normal(size=(5, 7)):
        values = [[measure.value(q + s * h * way) for s in (1.0, -1.0)] for h in (1e-3, 1e-5)]
        uneven = [abs(ahead - back) / (ahead + back) for ahead, back in values]
        assert min(min(pair) for pair in values) > 0.0
        assert uneven[1] <= max(0.02 * uneven[0], 1e-6)


def test_zero_posture(robot, kind, make):
    measure, q = kind(robot.kinematics), np.zeros(robot.n)
    if measure.value(q) > 0.0:
        # Wrists with their axes in line leave narrow valleys here, some 1e-4 rad wide.
        assert_gradient(measure, q, make, 1e-5)
    else:
        assert np.array_equal(measure.gradient(q), q)


def double_posture(robot, q):
    """Posture near q whose two smallest singular values agree, by Newton steps on the traceless part."""
    for _ in range(40):
        jacobian = scaled_jacobian(robot.kinematics, q)
        left, singular, right = np.linalg.svd(jacobian, full_matrices=False)
        slope = jacobian_derivative(jacobian, robot.kinematics.nearer_tool)
        change = np.einsum("ca,cij,bi->abj", left[:, -2:], slope, right[-2:])
        rows = np.array([0.5 * (change[0, 0] - change[1, 1]), 0.5 * (change[0, 1] + change[1, 0])])
        step = np.linalg.lstsq(rows, np.array([0.5 * (singular[-1] - singular[-2]), 0.0]), rcond=None)[0]
        q = q + step * min(1.0, 0.2 / max(np.abs(step).max(), 1e-20))
    return q, singular


@pytest.mark.parametrize("seed", range(4), ids="seed{}".format)
def test_double_smallest_value(arm7, seed):
    """Given is the limit of the central difference, whatever the direction."""
    measure, drawn = SmallestSingularValue(arm7.kinematics), arm7.postures(100 + seed, 30)
    found = (double_posture(arm7, q) for q in drawn)
    q = next(q for q, s in found if s[-2] - s[-1] < 1e-13 and s[-1] > 0.03 and s[-3] > 1.2 * s[-1])
    gradient = measure.gradient(q)
    for way in np.random.default_rng(seed).normal(size=(6, 7)):
        wide, close = (
            (measure.value(q + h * way) - measure.value(q - h * way)) / (2 * h) for h in (2e-5, 1e-5)
        )
        assert gradient @ way == pytest.approx(2 * close - wide, rel=1e-5, abs=1e-6)
        ahead = (measure.value(q + 1e-6 * way) - measure.value(q)) / 1e-6
        assert ahead < gradient @ way + 1e-5


def test_nearly_double_value_is_treated_alike(arm7):
    """Within the cluster the gradient does not jump with rounding."""
    measure = SmallestSingularValue(arm7.kinematics)
    found = (double_posture(arm7, q) for q in arm7.postures(104, 30))
    q = next(q for q, s in found if s[-2] - s[-1] < 1e-13 and s[-1] > 0.03 and s[-3] > 1.2 * s[-1])
    for way in np.random.default_rng(5).normal(size=(6, 7)):
        assert np.abs(measure.gradient(q + 1e-11 * way) - measure.gradient(q)).max() <= 1e-8


def test_postures_near_a_singular_one_are_worse(arm7, kind):
    measure, bent = kind(arm7.kinematics), arm7.postures(13, 1)[0]
    bent[ELBOW] = 1.2
    stretched = bent.copy()
    stretched[ELBOW] = 0.01
    assert measure.sense * (measure.value(stretched) - measure.value(bent)) > 0.0
    assert measure.sense * measure.gradient(stretched)[ELBOW] < 0.0


def test_massless_joints_are_refused(arm7):
    robot = arm7.description
    last = robot.axes[-1]
    kept = {joint.child for joint in robot.axes[:-1]}
    inertials = {link: inertial for link, inertial in robot.inertials.items() if link in kept}
    kinematics = type(arm7.kinematics)(replace(robot, inertials=inertials))
    with pytest.raises(ValueError, match=f"leave '{last.name}' without inertia"):
        DynamicManipulability(kinematics)
    with pytest.raises(ValueError, match="without inertia"):
        DynamicManipulability(type(kinematics)(replace(robot, inertials={})))
