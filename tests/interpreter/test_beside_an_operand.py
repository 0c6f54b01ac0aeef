"""Values in parentheses beside an operand take the type that goes with it; nested attempts stay cheap."""

import time

import pytest

from irlx.language.analysis import analyse
from irlx.language.source import source_text

DECLARATIONS = """VAR POSITION: v := (1, 2, 3), w; POSE: p := ((1, 2, 3), (1, 0, 0, 0)), q;
ORIENTATION: o := (1, 0, 0, 0);
REAL: h := 5; INT: n := 0; ROBTARGET: t;
FUNCTION up: REAL; BEGIN n := n + 1; RETURN n; ENDFCT;"""

VALUES = {
    "w := v + (0, 0, h);": {"w": (1.0, 2.0, 8.0)},
    "w := (0, 0, h) + v;": {"w": (1.0, 2.0, 8.0)},
    "w := v - ((0, 0, h));": {"w": (1.0, 2.0, -2.0)},
    "w := v + (0, 0, h) + (1, 1, 1);": {"w": (2.0, 3.0, 9.0)},
    "w := (1, 2, 3) + v - (1, 2, 3);": {"w": (1.0, 2.0, 3.0)},
    "w := 2 * (1, 2, 3);": {"w": (2.0, 4.0, 6.0)},
    "w := (1, 2, 3) / 2;": {"w": (0.5, 1.0, 1.5)},
    "w := o * (1, 2, 3);": {"w": (1.0, 2.0, 3.0)},
    "w := p @ (1, 2, 3);": {"w": (2.0, 4.0, 6.0)},
    "w := (v, o) @ v;": {"w": (2.0, 4.0, 6.0)},
    "q := p + (0, 0, h);": {"q": ((1.0, 2.0, 8.0), (1.0, 0.0, 0.0, 0.0))},
    "q := (v, o) + v;": {"q": ((2.0, 4.0, 6.0), (1.0, 0.0, 0.0, 0.0))},
    "q := p @ (v, o);": {"q": ((2.0, 4.0, 6.0), (1.0, 0.0, 0.0, 0.0))},
    "w := (up, 0, 0) + v * up;": {"w": (3.0, 4.0, 6.0), "n": 2},
    "w := v * up + (up, up, 0);": {"w": (3.0, 5.0, 3.0), "n": 3},
}


@pytest.mark.req("LANG-24")
@pytest.mark.req("LANG-31")
@pytest.mark.parametrize("body", VALUES)
def test_a_type_by_the_other_operand(final, body):
    """The values by hand; what is called is called once, in the order of the text."""
    found = final(DECLARATIONS, body)
    assert {name: found[name] for name in VALUES[body]} == VALUES[body]


WRONG = {
    "w := v + (1, 2);": ("IRL223", "POSITION takes 3 values, found 2", "(1, 2)"),
    "w := (1, 2, 3) / NORM(1);": ("IRL222", "expected POSITION, found INT", "1"),
    "w := (1, 2, 3) + v.k;": ("IRL225", "POSITION has no field 'k'", ".k"),
    "w := v + (1, 2, TRUE);": ("IRL222", "expected REAL, found BOOL", "TRUE"),
    "w := (1, 2, 3) + (4, 5, 6);": ("IRL222", "expected a single value, found 3 values", "(1, 2, 3)"),
    "n := n + (1, 2);": ("IRL222", "expected a single value, found 2 values", "(1, 2)"),
    "w := v * (1, 2);": ("IRL222", "expected a single value, found 2 values", "(1, 2)"),
    "q := p @ (1, 2, 3, 4);": ("IRL222", "expected a single value, found 4 values", "(1, 2, 3, 4)"),
    "o := o @ (2, 0, 0, 0);": ("IRL230", "the length of an ORIENTATION is 2; it must be 1", "(2, 0, 0, 0)"),
}


@pytest.mark.req("LANG-24")
@pytest.mark.parametrize("body", WRONG)
def test_what_fits_no_operand_is_told_alike(run_error, body):
    """What the check finds, and what a run would: code, message and place."""
    text = f"PROGRAM t;\n{DECLARATIONS}\nBEGIN\n{body}\nENDPROGRAM"
    found, *_ = [d for d in analyse(source_text("t.irl", text)).diagnostics if d.is_error]
    code, message, marked = WRONG[body]
    assert (found.code, text[found.place.span.start : found.place.span.end]) == (code, marked)
    assert code in ("IRL225", "IRL230") or found.message == message
    assert run_error(DECLARATIONS, body) == (code, found.message, marked)


@pytest.mark.req("LANG-20")
def test_the_smallest_whole_number(final, run_error):
    found = final("VAR INT: i, j;", "i := -9223372036854775808; j := i + 1;")
    assert (found["i"], found["j"]) == (-(2**63), 1 - 2**63)
    for body in ("i := 9223372036854775808;", "i := -(9223372036854775808);", "i := - -9223372036854775808;"):
        code, message, _ = run_error("VAR INT: i;", body)
        text = f"PROGRAM t; VAR INT: i; BEGIN {body} ENDPROGRAM"
        found, *_ = analyse(source_text("t.irl", text)).diagnostics
        assert (found.code, found.message) == (code, message)
        assert code == "IRL503"


@pytest.mark.req("LANG-22")
@pytest.mark.req("LANG-53")
@pytest.mark.parametrize(
    ("parts", "status", "turns"),
    [
        ("p", 0, (0, 0, 0)),
        ("p, 3", 3, (0, 0, 0)),
        ("p, 3, (1, -2, 0)", 3, (1, -2, 0)),
        ("p, 3, (1, -2, 0), t.A_JOINT", 3, (1, -2, 0)),
    ],
)
def test_a_robtarget_of_one_to_four_parts(final, parts, status, turns):
    declarations = DECLARATIONS.replace("ROBTARGET: t;", "ROBTARGET: t := ROBTARGET(p), u;")
    pose = ((1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0))
    assert final(declarations, f"u := ROBTARGET({parts});", joints=3)["u"] == (pose, status, turns, ())


NESTED = {
    "MANIPULABILITY(({inner}, 2))": 2,
    "MANIPULABILITY((2, {inner}))": 2,
    "DISTANCE(p, FK(({inner}, 2)))": 2,
    "NORM((MANIPULABILITY(R_JOINT_ACT), {inner}, 3) + v)": 3,
    "NORM(v + (1, 2, {inner}) + (MANIPULABILITY(R_JOINT_ACT), 1, 3))": 2,
}


@pytest.mark.req("LANG-34")
@pytest.mark.parametrize("way", NESTED)
def test_nested_attempts_take_no_time(final, way):
    """Thirty levels: with attempts inside attempts each one would double or triple the time."""
    inner = "1"
    for _ in range(30):
        inner = way.format(inner=inner)
    start = time.monotonic()
    text = f"PROGRAM t;\n{DECLARATIONS}\nBEGIN\nh := {inner};\nENDPROGRAM"
    assert not analyse(source_text("t.irl", text), joints=("a", "b", "c")[: NESTED[way]]).has_errors
    with pytest.raises(Exception, match="IRL"):
        final(DECLARATIONS, f"h := {inner}; n := 1 DIV 0;", joints=NESTED[way])
    assert time.monotonic() - start < 3.0
