"""Poses and orientations against SciPy's rotations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

SINGULAR = [
    (0, 0, 0),
    (10, 90, 20),
    (10, -90, 20),
    (180, 90, -180),
    (0, 180, 0),
    (360, 720, -360),
    (1e-9, 90, 1e-9),
    (33, 89.999999, -77),
]
RANDOM = [tuple(row) for row in np.random.default_rng(1).uniform(-360.0, 360.0, (6, 3)).round(4)]


def rotation_of(value):
    w, x, y, z = value.reals()
    return Rotation.from_quat([x, y, z, w])


def assert_same_rotation(found, expected):
    assert (found.inv() * expected).magnitude() < 1e-13


def as_pose(value):
    """4x4 matrix of a POSE value."""
    matrix = np.eye(4)
    matrix[:3, 3] = value.values[0].reals()
    matrix[:3, :3] = rotation_of(value.values[1]).as_matrix()
    return matrix


def pose_text(rng):
    x, y, z = rng.uniform(-2000.0, 2000.0, 3)
    a, b, c = rng.uniform(-180.0, 180.0, 3)
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler("ZYX", [a, b, c], degrees=True).as_matrix()
    matrix[:3, 3] = (x, y, z)
    return f"POSE(POSITION({x}, {y}, {z}), ORIZYX({a}, {b}, {c}))", matrix


@pytest.mark.req("LANG-32")
@pytest.mark.req("LANG-35")
@pytest.mark.parametrize("angles", SINGULAR + RANDOM)
@pytest.mark.parametrize("order", ["XYZ", "YXZ", "ZYX"])
def test_angles_are_intrinsic(value, order, angles):
    found = value(f"ORI{order}({', '.join(f'{float(a):.17g}' for a in angles)})")
    assert np.linalg.norm(found.reals()) == pytest.approx(1.0, abs=1e-15)
    assert_same_rotation(rotation_of(found), Rotation.from_euler(order, angles, degrees=True))


@pytest.mark.req("LANG-32")
@pytest.mark.req("LANG-35")
@pytest.mark.parametrize("angle", [0.0, 30.0, -90.0, 180.0, 540.0, 1e-8])
@pytest.mark.parametrize("axis", [(0, 0, 2), (1, 1, 1), (-3, 0, 0.5)])
def test_orivang_turns_about_the_axis(value, axis, angle):
    found = value(f"ORIVANG({axis}, {angle:.17g})")
    unit = np.array(axis) / np.linalg.norm(axis)
    assert_same_rotation(rotation_of(found), Rotation.from_rotvec(np.radians(angle) * unit))


@pytest.mark.req("LANG-32")
def test_oriquat_is_scalar_first(value):
    assert rotation_of(value("ORIQUAT(0.5, 0.5, 0.5, 0.5)")).apply([1, 0, 0]) == pytest.approx([0, 1, 0])
    assert value("ORIQUAT(0.6, 0, 0, 0.8)").reals() == (0.6, 0.0, 0.0, 0.8)


@pytest.mark.req("LANG-22")
def test_a_quaternion_typed_with_six_digits_is_made_unit(value):
    found = value("(0.707107, 0.707107, 0, 0)", expected="orientation")
    assert found.reals() == pytest.approx((0.5**0.5, 0.5**0.5, 0.0, 0.0), abs=1e-15)


@pytest.mark.req("LANG-22")
@pytest.mark.parametrize(
    ("expression", "length"),
    [("ORIQUAT(1, 1, 0, 0)", "1.41421356"), ("ORIQUAT(0, 0, 0, 0)", "0"), ("ORIQUAT(0, 0, 0, 2)", "2")],
)
def test_a_quaternion_that_is_not_unit(value_error, expression, length):
    message = f"an orientation needs a quaternion of length 1, found length {length}"
    assert value_error(expression) == ("IRL230", message, expression)


def test_an_axis_without_direction(value_error):
    code, message, text = value_error("ORIVANG((0, 0, 0), 30)")
    assert code == "IRL506"
    assert message.startswith("ORIVANG has no value at")
    assert text == "ORIVANG((0, 0, 0), 30)"


@pytest.mark.req("LANG-31")
@pytest.mark.parametrize("seed", range(4))
def test_poses_compose_like_matrices(value, seed):
    rng = np.random.default_rng(seed)
    (a, a_matrix), (b, b_matrix) = pose_text(rng), pose_text(rng)
    declared = f"VAR POSE: a := {a}, b := {b};"
    assert as_pose(value("a @ b", declared)) == pytest.approx(a_matrix @ b_matrix, abs=1e-9)
    assert as_pose(value("INV(a)", declared)) == pytest.approx(np.linalg.inv(a_matrix), abs=1e-9)
    assert as_pose(value("INV(a) @ a @ b", declared)) == pytest.approx(b_matrix, abs=1e-9)
    point = (a_matrix @ [10.0, -20.0, 30.0, 1.0])[:3]
    assert value("a @ POSITION(10, -20, 30)", declared).reals() == pytest.approx(point, abs=1e-9)


@pytest.mark.req("LANG-31")
@pytest.mark.parametrize("seed", range(3))
def test_orientations_compose_and_turn_points(value, seed):
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-180.0, 180.0, (2, 3))
    first, second = (Rotation.from_euler("ZYX", row, degrees=True) for row in angles)
    texts = [f"ORIZYX({', '.join(map(repr, row))})" for row in angles.tolist()]
    declared = f"VAR ORIENTATION: a := {texts[0]}, b := {texts[1]};"
    assert_same_rotation(rotation_of(value("a @ b", declared)), first * second)
    assert value("a * POSITION(1, 2, 3)", declared).reals() == pytest.approx(first.apply([1, 2, 3]))


DECLARED = """VAR POSE: q := ((1, 2, 3), ORIZYX(90, 0, 0)); POSITION: v := (1, 0, 0), w := (10, 20, 30);
ORIENTATION: o := ORIZYX(90, 0, 0);"""


@pytest.mark.req("LANG-31")
@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("v + w", (11, 20, 30)),
        ("v - w", (-9, -20, -30)),
        ("w * 2", (20, 40, 60)),
        ("2 * w", (20, 40, 60)),
        ("w * 0.5 + v", (6, 10, 15)),
        ("w / 10", (1, 2, 3)),
        ("q @ v * 2", (2, 6, 6)),
        ("v + w / 10 - v * 2", (0, 2, 3)),
    ],
)
def test_positions(value, expression, expected):
    assert value(expression, DECLARED).reals() == pytest.approx(expected, abs=1e-12)


@pytest.mark.req("LANG-31")
@pytest.mark.parametrize(("sign", "at"), [("+", (11, 22, 33)), ("-", (-9, -18, -27))])
def test_a_position_shifts_a_pose_in_the_base_frame(value, sign, at):
    found = value(f"q {sign} w", DECLARED)
    assert found.values[0].reals() == at
    assert found.values[1].reals() == pytest.approx(value("o", DECLARED).reals(), abs=1e-15)


@pytest.mark.req("LANG-31")
@pytest.mark.parametrize(
    ("expression", "left", "right"),
    [
        ("v + q", "POSITION", "POSE"),
        ("q + q", "POSE", "POSE"),
        ("q * 2", "POSE", "INT"),
        ("v * w", "POSITION", "POSITION"),
        ("v / w", "POSITION", "POSITION"),
        ("o + v", "ORIENTATION", "POSITION"),
        ("v @ q", "POSITION", "POSE"),
        ("2 / v", "INT", "POSITION"),
        ("q = q", "POSE", "POSE"),
    ],
)
def test_what_has_no_meaning(value_error, expression, left, right):
    op = expression.split()[1]
    assert value_error(expression, DECLARED) == (
        "IRL227",
        f"{op} is not defined for {left} and {right}",
        expression,
    )


@pytest.mark.req("LANG-31")
def test_inverse_of_an_orientation(value):
    assert_same_rotation(rotation_of(value("INV(o)", DECLARED)), Rotation.from_euler("z", -90, degrees=True))
