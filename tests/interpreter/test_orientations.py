"""Orientations made and taken apart, against SciPy's rotations: thousands of cases, also singular ones."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.interpreter.functions import orientation, position, quaternion_of
from irlx.interpreter.rotations import CONVENTIONS, FUNCTIONS

pytestmark = [pytest.mark.req("LANG-32"), pytest.mark.req("LANG-33"), pytest.mark.req("LANG-35")]

CASES = 800
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
    angles[: CASES // 4] = np.round(angles[: CASES // 4] / 90) * 90
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
    values = random_orientations(3)
    angles = np.array([apply("ROTANGLE", value) for value in values])
    axes = np.array([apply("ROTAXIS", value) for value in values])
    expected = rotation([quaternion_of(value) for value in values])
    assert np.max(np.abs(np.radians(angles) - expected.magnitude())) < SMALL
    assert np.max(np.abs(np.linalg.norm(axes, axis=1) - 1.0)) < SMALL
    made = [
        apply("ORIVANG", tuple(axis), angle)
        for axis, angle in zip(axes.tolist(), angles.tolist(), strict=True)
    ]
    assert_same(made, expected)


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
    values = random_orientations(6)
    found = [tuple(apply(f"QUAT{letter}", value) for letter in "ABCD") for value in values]
    assert found == [quaternion_of(value) for value in values]
    assert_same([apply("ORIQUAT", *parts) for parts in found], rotation(found))


def test_reference_systems_of_three_points():
    rng = np.random.default_rng(7)
    turns = Rotation.random(CASES, random_state=7)
    along_x, along_y, _ = np.moveaxis(turns.as_matrix(), 2, 0)
    origins = rng.uniform(-1000, 1000, (CASES, 3))
    on_x = origins + along_x * rng.uniform(1, 500, (CASES, 1))
    in_xy = origins + along_x * rng.uniform(-500, 500, (CASES, 1)) + along_y * rng.uniform(1, 500, (CASES, 1))
    found = [
        apply("ORIRS", *map(tuple, points))
        for points in zip(origins.tolist(), on_x.tolist(), in_xy.tolist(), strict=True)
    ]
    # Differences of coordinates of a metre have 13 digits.
    assert np.max((rotation(found).inv() * turns).magnitude()) < 1e-9


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
