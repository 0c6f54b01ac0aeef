"""How moves run and end: profile, jerk, override, and passing their target; parameters and their defaults."""

import pytest

from irlx.blocks import Blend, Profile

PLACES = "VAR POSITION: p := (1, 2, 3), q := (4, 5, 6), r := (7, 8, 9); BOOL: b := TRUE; REAL: x := 3;"


def blends(blocks, body):
    return [block.blend for block in blocks(PLACES, body)]


@pytest.mark.req("LANG-51")
@pytest.mark.parametrize(
    ("params", "expected"),
    [
        ("", None),
        ("C_CP := 20", Blend(distance=0.02)),
        ("C_CP := 0", None),
        ("C_PASS := TRUE", Blend()),
        ("C_PASS := FALSE", None),
        ("C_CP := 20, C_PASS := TRUE", Blend(distance=0.02)),
        ("C_CP := 20, C_PASS := FALSE", None),
        ("C_CP := 0 C_PASS := TRUE", Blend()),
        ("C_CP := x * 2 C_PASS := NOT b", None),
        ("C_CP := x * 2", Blend(distance=0.006)),
        ("C_PTP := 50", None),
        ("C_PTP := 50 C_PASS := TRUE", Blend()),
    ],
)
@pytest.mark.parametrize("kind", ["LIN p", "CIRCLE p, q", "LIN PATH (p, q)", "SPLINE PATH (p, q)"])
def test_moves_of_the_tool(blocks, kind, params, expected):
    assert blends(blocks, f"MOVE {kind} {params};") == [expected]


@pytest.mark.req("LANG-51")
@pytest.mark.parametrize(
    ("params", "expected"),
    [
        ("", None),
        ("C_PTP := 100", Blend(share=1.0)),
        ("C_PTP := 25", Blend(share=0.25)),
        ("C_PTP := 0", None),
        ("C_PASS := TRUE", Blend()),
        ("C_PTP := 25 C_PASS := FALSE", None),
        ("C_PTP := 0 C_PASS := TRUE", Blend()),
        ("C_CP := 20", None),
    ],
)
def test_a_ptp(blocks, params, expected):
    assert blends(blocks, f"MOVE PTP p {params};") == [expected]


@pytest.mark.req("LANG-51")
def test_defaults_are_variables(blocks):
    body = """MOVE LIN p; R_C_CP := 5; MOVE LIN p; MOVE LIN p C_CP := 0; MOVE LIN p C_PASS := FALSE;
    MOVE PTP p; R_C_PTP := 10; MOVE PTP p; R_C_CP := 0; R_C_PASS := TRUE; MOVE LIN p;
    MOVE LIN p C_PASS := FALSE;
    MOVE LIN p C_CP := 1; R_C_PASS := b AND x < 3; MOVE LIN p;"""
    assert blends(blocks, body) == [
        None,
        Blend(distance=0.005),
        None,
        None,
        None,
        Blend(share=0.1),
        Blend(),
        None,
        Blend(distance=0.001),
        None,
    ]


@pytest.mark.req("LANG-51")
def test_all_moves_of_a_statement_pass(blocks):
    assert blends(blocks, "MOVE LIN p, q, r C_CP := 20;") == [Blend(distance=0.02)] * 3


@pytest.mark.req("LANG-51")
def test_profile_jerk_and_override(blocks):
    body = """MOVE LIN p; MOVE LIN p PROFILE := 's_Curve' JERK := 4000 OVERRIDE := 25; R_JERK := 100;
    R_PROFILE := 'S_CURVE'; R_OVERRIDE := 12.5; MOVE PTP p; MOVE LIN p PROFILE := 'trapezoid', JERK := 0;
    RECONFIGURATION (1, 2, 3, 4, 5, 6, 7);"""
    laws = [block.law for block in blocks(PLACES, body)]
    found = [(law.profile, law.jerk, law.override) for law in laws]
    assert found == [
        (Profile.TRAPEZOID, None, 1.0),
        (Profile.S_CURVE, 4.0, 0.25),
        (Profile.S_CURVE, 0.1, 0.125),
        (Profile.TRAPEZOID, None, 0.125),
        (Profile.S_CURVE, 0.1, 0.125),
    ]


@pytest.mark.req("LANG-51")
def test_values_are_latched_when_the_statement_runs(blocks):
    body = (
        """FUNCTION place(REAL: z): POSITION; BEGIN R_C_CP := R_C_CP + z; RETURN POSITION(0, 0, z); ENDFCT;"""
    )
    (first, second) = blocks(body, "MOVE LIN place(3); MOVE LIN place(4);")
    # Targets are evaluated before the defaults are looked at.
    assert (first.blend, second.blend) == (Blend(distance=0.003), Blend(distance=0.007))


@pytest.mark.req("LANG-51")
@pytest.mark.parametrize(
    ("move", "expected", "marked"),
    [
        ("MOVE LIN p C_CP := -1", "C_CP must be 0 or more, found -1", "-1"),
        ("MOVE PTP p C_PTP := -0.5", "C_PTP must be 0 or more, found -0.5", "-0.5"),
        ("MOVE PTP p C_PTP := 100.5", "C_PTP must be at most 100 %, found 100.5", "100.5"),
        ("MOVE LIN p JERK := -1", "JERK must be 0 or more, found -1", "-1"),
        ("MOVE LIN p OVERRIDE := 0", "OVERRIDE must be greater than 0, found 0", "0"),
        ("MOVE LIN p OVERRIDE := 101", "OVERRIDE must be at most 100 %, found 101", "101"),
        (
            "MOVE LIN p PROFILE := 'sine'",
            "PROFILE must be 'TRAPEZOID' or 'S_CURVE', found 'sine'",
            "'sine'",
        ),
        ("R_C_CP := -2; MOVE LIN p", "R_C_CP must be 0 or more, found -2", "MOVE LIN p"),
        ("R_C_PTP := 200; MOVE LIN p", "R_C_PTP must be at most 100 %, found 200", "MOVE LIN p"),
        ("R_OVERRIDE := 0; MOVE PTP p", "R_OVERRIDE must be greater than 0, found 0", "MOVE PTP p"),
        ("R_JERK := -3; MOVE PTP p", "R_JERK must be 0 or more, found -3", "MOVE PTP p"),
        (
            "R_PROFILE := ''; MOVE PTP p",
            "R_PROFILE must be 'TRAPEZOID' or 'S_CURVE', found ''",
            "MOVE PTP p",
        ),
    ],
)
def test_out_of_range(run_error, move, expected, marked):
    assert run_error(PLACES, f"{move};") == ("IRL505", expected, marked)
