"""The model of types: which are the same, which fit, and what fields there are."""

import pytest

from irlx.language import builtins
from irlx.language import types as t
from irlx.language.checking.operators import binary_type

PAIR = t.Record("pair", (("a", t.INT), ("b", t.REAL)))
OPEN = t.known_types(None)
SEVEN = t.known_types(7)


@pytest.mark.req("LANG-20")
@pytest.mark.parametrize(
    ("found", "expected", "wanted"),
    [
        (t.INT, t.REAL, True),
        (t.REAL, t.INT, False),
        (t.INT, t.INT, True),
        (t.BOOL, t.INT, False),
        (t.CHAR, t.STRING, True),
        (t.STRING, t.CHAR, False),
        (t.UNKNOWN, t.POSE, True),
        (t.POSE, t.UNKNOWN, True),
        (t.POSE, t.POSITION, False),
        (PAIR, t.Record("pair", (("a", t.INT), ("b", t.REAL))), True),
        (PAIR, t.Record("other", PAIR.fields), False),
        (PAIR, t.Record("pair", (("a", t.REAL), ("b", t.REAL))), False),
        (PAIR, t.Record("pair", (("a", t.INT),)), False),
        (PAIR, t.Record("pair", (("a", t.UNKNOWN), ("b", t.REAL))), True),
        (t.Array(((1, 3),), t.INT), t.Array(((1, 3),), t.INT), True),
        (t.Array(((1, 3),), t.INT), t.Array(((0, 2),), t.INT), False),
        (t.Array(((1, 3),), t.INT), t.Array(((1, 3),), t.REAL), False),
        (t.Array(((1, 3),), t.INT), t.Array(((1, 3), (1, 3)), t.INT), False),
        (t.Array((t.ANY_BOUNDS,), t.INT), t.Array(((1, 3),), t.INT), True),
        (OPEN["main_joint"], SEVEN["main_joint"], True),
        (OPEN["main_joint"], OPEN["main_joint_min"], False),
        (SEVEN["joint"], OPEN["joint"], True),
    ],
)
def test_what_fits(found, expected, wanted):
    assert t.fits(found, expected) is wanted
    if found not in (t.INT, t.CHAR):
        assert t.same_type(found, expected) is t.same_type(expected, found) is wanted


@pytest.mark.req("LANG-23")
@pytest.mark.parametrize(
    ("key", "path", "used"),
    [
        ("main_joint", ["a7"], 1),
        ("main_joint", ["a0"], None),
        ("main_joint", ["b1"], None),
        ("main_joint_min", ["a3", "min"], 2),
        ("main_joint_min", ["a3", "max"], None),
        ("main_joint_speed_max", ["a3", "s", "max"], 3),
        ("main_joint_accel_min", ["a3", "a", "min"], 3),
        ("main_joint_accel_min", ["a3"], None),
    ],
)
def test_fields_of_joint_types_with_and_without_a_robot(key, path, used):
    wanted = None if used is None else (t.REAL, used)
    assert t.longest_field(OPEN[key], path) == t.longest_field(SEVEN[key], path) == wanted


def test_the_robot_bounds_the_fields():
    assert t.longest_field(OPEN["main_joint"], ["a12"]) == (t.REAL, 1)
    assert t.longest_field(SEVEN["main_joint"], ["a12"]) is None


def test_every_predefined_type_and_function_is_known():
    """SIGNAL has no values; constructors are called like their types."""
    assert set(builtins.TYPES) - set(OPEN) == {"signal"}
    assert set(builtins.FUNCTIONS) <= set(t.built_in_functions(OPEN)) | set(OPEN)


def test_a_running_program_knows_the_same_types():
    assert t.predefined_types(7).items() <= SEVEN.items()


@pytest.mark.req("LANG-30")
@pytest.mark.req("LANG-31")
def test_operators_are_defined_for_few_of_all_pairs():
    """A count by hand from the reference: comparisons, arithmetic, logic, texts, geometry."""
    kinds = [t.INT, t.REAL, t.BOOL, t.CHAR, t.STRING, t.POSITION, t.ORIENTATION, t.POSE, PAIR]
    wanted = {
        "+": 4 + 4 + 2,
        "-": 4 + 2,
        "*": 4 + 4 + 1,
        "/": 4 + 2,
        "DIV": 1,
        "MOD": 1,
        "=": 4 + 1 + 4,
        "<>": 4 + 1 + 4,
        "<": 4 + 1,
        "AND": 1,
        "EXOR": 1,
        "@": 3,
    }
    pairs = [(left, right) for left in kinds for right in kinds]
    for op, count in wanted.items():
        assert sum(binary_type(op, left, right) is not None for left, right in pairs) == count, op
