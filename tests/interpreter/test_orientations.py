"""Orientations made and taken apart, against SciPy's rotations: thousands of cases, also singular ones."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.interpreter.functions import orientation, position, quaternion_of
from irlx.interpreter.rotations import CONVENTIONS, FUNCTIONS

pytestmark = [pytest.mark.req("LANG-32"), pytest.mark.req("LANG-33"), pytest.mark.req("LANG-35")]

CASES = 10_000
SMALL = 1e-12


def apply(name, *values):
    """A built-in on plain numbers, tuples of three and orientations."""
    given = [position(value) if isinstance(value, tuple) else value for value in values]
    found = FUNCTIONS[name.casefold()].apply(*given)
    return np.array(found.values) if hasattr(found, "values") else found


def rotation(quaternion):
    w, x, y, z = np.asarray(quaternion).T
    return Rotation.from_quat(np.stack([x, y, z, w], axis=-1))


def random_orientations(seed):
    quaternions = np.random.default_rng(seed).normal(size=(CASES, 4))
    # Some that are nearly, and exactly, no turn and half a turn.
    quaternions[:50, 1:] *= 1e-9
    quaternions[50:100, 0] *= 1e-9
    quaternions[100:104] = np.eye(4)
    return [orientation(tuple(row)) for row in quaternions.tolist()]


def random_angles(seed):
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-360, 360, (CASES, 3))
    edges = rng.choice([-180, -90, 0, 90, 180], CASES // 2)
    offsets = rng.choice([0, 1e-13, 1e-9, 1e-6, 1e-3], CASES // 2) * rng.choice([-1, 1], CASES // 2)
    angles[: CASES // 2, 1] = edges + offsets
    angles[:500] = np.round(angles[:500] / 90) * 90
    return angles


def assert_same(found, expected):
    assert np.max((rotation(found).inv() * expected).magnitude()) < SMALL


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_angles_make_the_turn(convention):
    angles = random_angles(1)
    found = [apply(f"ORI{convention}", *row) for row in angles.tolist()]
    assert_same(found, Rotation.from_euler(CONVENTIONS[convention], angles, degrees=True))


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_angles_taken_apart_make_it_again(convention):
    order = CONVENTIONS[convention]
    made = Rotation.from_euler(order, random_angles(2), degrees=True)
    x, y, z, w = made.as_quat().T
    values = [orientation(tuple(row)) for row in np.stack([w, x, y, z], axis=-1).tolist()]
    names = [f"ANGLE{axis}" for axis in (order if len(set(order)) == 3 else "ZYX")]
    angles = [[apply(name, convention, value) for name in names] for value in values]
    assert_same([apply(f"ORI{convention}", *row) for row in angles], made)
    assert np.all(np.abs(np.array(angles)[:, [0, 2]]) <= 180)
    middle = np.array(angles)[:, 1]
    assert np.all((middle >= 0) & (middle <= 180)) if convention == "ZYZ2" else np.all(np.abs(middle) <= 90)


def test_where_only_a_sum_counts_the_last_angle_is_0():
    value = FUNCTIONS["orizyx"].apply(30.0, 90.0, 10.0)
    assert apply("ANGLEX", "ZYX", value) == 0.0
    assert apply("ANGLEZ", "zyx", value) == pytest.approx(20.0)


def test_axis_and_angle():
    for value in random_orientations(3):
        angle, axis = apply("ROTANGLE", value), apply("ROTAXIS", value)
        expected = rotation(quaternion_of(value))
        assert abs(np.radians(angle) - expected.magnitude()) < SMALL
        assert abs(np.linalg.norm(axis) - 1.0) < SMALL
        assert_same(apply("ORIVANG", tuple(axis.tolist()), angle), expected)


def test_no_turn_is_about_z():
    assert apply("ROTANGLE", orientation((1.0, 0.0, 0.0, 0.0))) == 0.0
    assert tuple(apply("ROTAXIS", orientation((-1.0, 0.0, 0.0, 0.0)))) == (0.0, 0.0, 1.0)


def test_turns_about_an_axis():
    rng = np.random.default_rng(4)
    axes, angles = rng.normal(size=(CASES, 3)), rng.uniform(-720, 720, CASES)
    angles[:100] = np.round(angles[:100] / 180) * 180
    found = [
        apply("ORIVANG", tuple(axis), angle)
        for axis, angle in zip(axes.tolist(), angles.tolist(), strict=True)
    ]
    units = axes / np.linalg.norm(axes, axis=1)[:, None]
    assert_same(found, Rotation.from_rotvec(units * np.radians(angles)[:, None]))


def test_columns():
    values = random_orientations(5)
    columns = [[apply(f"VECTOR{name}", value) for name in "NOA"] for value in values]
    expected = rotation([quaternion_of(value) for value in values])
    assert np.max(np.abs(np.swapaxes(np.array(columns), 1, 2) - expected.as_matrix())) < SMALL
    assert_same([apply("ORIMAT", *(tuple(c.tolist()) for c in row)) for row in columns], expected)


def test_quaternion_components():
    for value in random_orientations(6):
        found = [apply(f"QUAT{letter}", value) for letter in "ABCD"]
        assert tuple(found) == quaternion_of(value)
        assert_same(apply("ORIQUAT", *found), rotation(quaternion_of(value)))


def test_reference_systems_of_three_points():
    rng = np.random.default_rng(7)
    for origin, matrix in zip(
        rng.uniform(-1000, 1000, (CASES, 3)), Rotation.random(CASES, random_state=7).as_matrix(), strict=True
    ):
        on_x = origin + matrix[:, 0] * rng.uniform(1, 500)
        in_xy = origin + matrix[:, 0] * rng.uniform(-500, 500) + matrix[:, 1] * rng.uniform(1, 500)
        found = apply("ORIRS", *(tuple(point.tolist()) for point in (origin, on_x, in_xy)))
        # Differences of coordinates of a metre have 13 digits.
        assert (rotation(found).inv() * Rotation.from_matrix(matrix)).magnitude() < 1e-9


NO_VALUE = [
    "ORIMAT((1, 0, 0), (0, 1, 0), (0, 0, -1))",
    "ORIMAT((2, 0, 0), (0, 1, 0), (0, 0, 2))",
    "ORIMAT((1, 0, 0), (1, 0, 0), (0, 0, 1))",
    "ORIRS((0, 0, 0), (0, 0, 0), (0, 1, 0))",
    "ORIRS((0, 0, 0), (1, 0, 0), (2, 0, 0))",
    "ORIVANG((0, 0, 0), 30)",
    "ANGLEX('XZX', ORIXYZ(1, 2, 3))",
]


@pytest.mark.parametrize("expression", NO_VALUE)
def test_what_is_no_orientation(value_error, expression):
    code, message, text = value_error(expression)
    assert (code, text) == ("IRL506", expression)
    assert message.startswith(f"{expression.split('(')[0]} has no value at ")


def test_in_programs(value):
    assert value("ANGLEZ('ZYX', ORIZYX(10, 20, 30))") == pytest.approx(10.0)
    assert value("ROTANGLE(ORIVANG((0, 0, 1), 270))") == pytest.approx(90.0)
    assert value("VECTORN(ORIZYX(90, 0, 0))").reals() == pytest.approx((0.0, 1.0, 0.0))
    assert value("QUATA(ORIVANG((0, 0, 1), 60))") == pytest.approx(math.cos(math.radians(30)))
