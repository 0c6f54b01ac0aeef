"""What a check says of ROBTARGETs: a STATUS that counts for nothing, a posture that is left open."""

import pytest

from irlx.language.analysis import analyse
from irlx.language.source import source_text

pytestmark = pytest.mark.req("LANG-53")

SEVEN = tuple(f"j{number}" for number in range(1, 8))
POSE = "POSE((600, 0, 400), ORIZYX(0, 180, 0))"
AT = f"ROBTARGET({POSE})"


def told(declarations, body="", joints=(), data_lists=None, lints=True):
    text = f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM"
    found = analyse(source_text("t.irl", text), data_lists=data_lists, joints=joints, lints=lints).diagnostics
    assert not [one for one in found if one.is_error], found
    wanted = [one for one in found if one.code in ("IRL312", "IRL313")]
    return [(one.code, one.place.text.text[one.place.span.start : one.place.span.end]) for one in wanted]


STATUS = {
    f"VAR ROBTARGET: t := ROBTARGET({POSE}, 5);": ["5"],
    f"VAR ROBTARGET: t := ROBTARGET({POSE}, 0);": [],
    f"VAR ROBTARGET: t := ROBTARGET({POSE});": [],
    f"VAR ROBTARGET: t := ROBTARGET({POSE}, -1);": ["-1"],
    f"VAR INT: s := 5; ROBTARGET: t := ROBTARGET({POSE}, s);": [],
    f"CONST INT: s := 5; VAR ROBTARGET: t := ROBTARGET({POSE}, s);": ["s"],
    f"CONST ROBTARGET: t := ROBTARGET({POSE}, 2); u := ROBTARGET({POSE}, 3);".replace("; u", ", u"): ["2"],
    f"VAR ROBTARGET: t := ({POSE}, 4, (0, 0, 0, 0, 0, 0, 0), ADD_JOINT());": ["4"],
    "TYPE RECORD INT: a, status; ENDRECORD = pair; VAR pair: p := (1, 2);": [],
}


@pytest.mark.parametrize("declarations", STATUS)
def test_a_status_where_it_is_written(declarations):
    assert told(declarations, joints=SEVEN) == [("IRL312", marked) for marked in STATUS[declarations]]
    assert told(declarations, joints=SEVEN, lints=False) == []


ASSIGNED = {
    "t.STATUS := 3;": ["3"],
    "t.status := 0;": [],
    "t.STATUS := t.STATUS + 1;": [],
    "a[2].STATUS := 1 + 1;": ["1 + 1"],
    "p.status := 3;": [],
}


@pytest.mark.parametrize("body", ASSIGNED)
def test_a_status_that_is_assigned(body):
    declarations = f"""TYPE RECORD INT: a, status; ENDRECORD = pair;
    VAR pair: p; ROBTARGET: t := {AT}; ARRAY [1..2] OF ROBTARGET: a;"""
    assert told(declarations, body) == [("IRL312", marked) for marked in ASSIGNED[body]]


def test_a_taught_status_is_told_once():
    points = "".join(f"ROBTARGET: t{n} := ROBTARGET({POSE}, {n});\n" for n in range(5))
    lists = lambda name, place: source_text("d.dat", f"DATALIST d;\n{points}ENDDATALIST")  # noqa: E731
    assert told("IMPORT DATALIST d;", "MOVE PTP t1; MOVE PTP t2;", data_lists=lists) == [("IRL312", "1")]


OPEN = {
    "MOVE PTP t;": ["t"],
    "MOVE LIN t, p; MOVE LIN t;": ["t"],
    "MOVE LIN p, a[1];": ["a[1]"],
    "MOVE CIRCLE p, t;": ["t"],
    f"MOVE PTP {AT};": [AT],
    "MOVE PTP t WITH RECONFIGURATION j;": [],
    "MOVE LIN t WITH JOINTLIMIT low, high;": ["t"],
    "MOVE PTP p; MOVE LIN j; MOVE PTP t.PSE;": [],
    "PROCEDURE_CALL": ["inner"],
}


@pytest.mark.parametrize("body", OPEN)
def test_a_posture_that_is_left_open(body):
    declarations = f"""VAR ROBTARGET: t := {AT}; ARRAY [1..2] OF ROBTARGET: a; POSE: p := {POSE};
    MAIN_JOINT: j; MAIN_JOINT_MIN: low; MAIN_JOINT_MAX: high;"""
    if body == "PROCEDURE_CALL":
        declarations += " PROCEDURE go(ROBTARGET: inner); BEGIN MOVE PTP inner; ENDPROC;"
        body, wanted = "go(t);", ["inner"]
    else:
        wanted = OPEN[body]
    assert told(declarations, body, joints=SEVEN) == [("IRL313", marked) for marked in wanted]
    assert told(declarations, body, joints=SEVEN[:6]) == []
    assert told(declarations, body) == []


def test_the_program_may_tell_the_number_of_joints():
    shape = "TYPE RECORD REAL: a1, a2, a3, a4, a5, a6, a7; ENDRECORD = MAIN_JOINT;"
    assert told(f"{shape} VAR ROBTARGET: t := {AT};", "MOVE PTP t;") == [("IRL313", "t")]


def test_a_comment_ignores_either():
    declarations = f"VAR ROBTARGET: t := ROBTARGET({POSE}, 5); {{ irlx: ignore IRL312 }}"
    assert told(declarations, "MOVE PTP t; { irlx: ignore IRL313 }", joints=SEVEN) == []
