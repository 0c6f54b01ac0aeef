"""Values of data lists: variables of the program, evaluated by its types, wrong at their own place."""

import pytest

from irlx.blocks import Question
from irlx.blocks.text import block_text
from irlx.interpreter.errors import InterpreterError
from irlx.interpreter.interpret import declared_scope, interpret
from irlx.interpreter.support import unsupported
from irlx.interpreter.values import RecordValue
from irlx.language.analysis import analyse
from irlx.language.source import source_text

pytestmark = pytest.mark.req("LANG-13")


def analysed(declarations, body, values):
    text = f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM"
    points = source_text("points.dat", f"DATALIST points;\n{values}\nENDDATALIST\n")
    return analyse(source_text("t.irl", text), data_lists=lambda *_: points)


@pytest.fixture
def variables(setting):
    """Variables of a program that imports a list of values, by name."""

    def run(values, declarations="", joints=3):
        found = analysed(f"IMPORT DATALIST points; {declarations}", "", values)
        assert found.diagnostics == ()
        return declared_scope(found.tree, found.source, setting(joints), found.data_lists).variables

    return run


@pytest.fixture
def lines(setting):
    """Text lines of the blocks of such a program."""

    def run(values, body, declarations="", joints=3):
        found = analysed(f"{declarations} IMPORT DATALIST points;", body, values)
        assert found.diagnostics == ()
        source = interpret(found.tree, found.source, setting(joints), found.data_lists)
        blocks = [block for block in source if not isinstance(block, Question)]
        return [block_text(block, ["rad"] * joints) for block in blocks]

    return run


@pytest.fixture
def wrong(setting):
    """Place, code and message of what is wrong with a list; what a check finds is what a run finds."""

    def run(values, declarations="", joints=3):
        found = analysed(f"{declarations} IMPORT DATALIST points;", "", values)
        with pytest.raises(InterpreterError) as caught:
            declared_scope(found.tree, found.source, setting(joints), found.data_lists)
        reason = caught.value.reason
        assert {str(finding) for finding in found.diagnostics} <= {str(reason)}
        return f"{reason.place} {reason.code} {reason.message}"

    return run


def reals(value):
    """A value with its records opened into tuples."""
    return tuple(reals(part) for part in value.values) if hasattr(value, "values") else value


def test_values_by_type(variables):
    found = variables(
        """POSE: p0 := ((600, 0, 400), ORIQUAT(1, 0, 0, 0)), p1 := p0 + POSITION(0, 0, 10);
        MAIN_JOINT: j := (0, -30, 1.5); REAL: lift := 120; INT: n := 2; STRING: s := 'a';
        ARRAY [1..n] OF POSITION: rack := ((1, 2, 3), (4, 5, 6)); MAIN_JOINT_SPEED_MAX: v := (1, 2, 3);
        POSITION: later;"""
    )
    assert reals(found["p1"].value) == ((600.0, 0.0, 410.0), (1.0, 0.0, 0.0, 0.0))
    assert reals(found["j"].value) == (0.0, -30.0, 1.5)
    assert found["lift"].value == 120.0
    assert isinstance(found["lift"].value, float)
    assert reals(found["rack"].value) == ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0))
    assert (found["s"].value, found["v"].type.name) == ("a", "MAIN_JOINT_SPEED_MAX")
    assert isinstance(found["later"].value, RecordValue)
    assert not any(found[name].constant for name in ("p0", "p1", "j", "lift", "rack", "later"))


def test_types_of_the_program_count(variables):
    types = """TYPE RECORD REAL: left, mid, right; ENDRECORD = MAIN_JOINT;
    TYPE RECORD REAL: width; MAIN_JOINT: rest; ENDRECORD = gripper;"""
    found = variables("gripper: g := (5, (1, 2, 3)); MAIN_JOINT: j := g.rest; REAL: r := j.mid;", types)
    assert found["r"].value == 2.0
    assert reals(found["g"].value) == (5.0, (1.0, 2.0, 3.0))


def test_variables_of_the_program_may_begin_with_values_of_a_list(variables):
    """Wherever the IMPORT stands: variables come last."""
    found = variables("REAL: lift := 120;", "VAR REAL: high := 2 * lift;")
    assert found["high"].value == 240.0


def test_they_can_be_set_and_moved_to(lines):
    body = """MOVE LIN p;
    p.x := p.x + 1; lift := lift * 2; rack[2] := p;
    MOVE LIN p SPEED := lift;
    MOVE LIN rack[2];"""
    found = lines("POSITION: p := (1, 2, 3); REAL: lift := 50; ARRAY [1..2] OF POSITION: rack;", body)
    assert [line.split(" kept")[0] for line in found] == [
        "1 MOVE LIN to (1 2 3)",
        "2 MOVE LIN to (2 2 3)",
        "3 MOVE LIN to (2 2 3)",
    ]
    assert "speed 100 mm/s" in found[1]
    # Blocks come from the program's text, wherever their values stand.
    assert [line.rsplit(" ", 1)[1] for line in found] == ["4", "6", "7"]


WRONG = {
    "POSITION: p := (1, 2);": "2:16 IRL223 POSITION takes 3 values, found 2",
    "MAIN_JOINT: j := (1, 2, 3, 4);": "2:18 IRL223 MAIN_JOINT takes 3 values, found 4",
    "ARRAY [1..3] OF INT: a := (1, 2);": "2:27 IRL223 ARRAY [1..3] OF INT takes 3 values, found 2",
    "INT: n := 1.5;": "2:11 IRL222 expected INT, found REAL",
    "ORIENTATION: o := (1, 1, 0, 0);": "2:19 IRL230 an orientation needs a quaternion of length 1, "
    "found length 1.41421356",
    "REAL: a := 1 / 0;": "2:12 IRL502 division by zero",
    "REAL: a := SQRT(-1);": "2:12 IRL506 SQRT has no value at -1",
    "REAL: a;\nREAL: b := a;": "3:12 IRL501 'a' has no value yet",
    "ARRAY [3..1] OF INT: a;": "2:8 IRL508 the range 3..1 is empty",
    "SEMAPHORE: s;": "2:1 IRL590 this version of irlx reads the type SEMAPHORE but does not execute it yet",
}


@pytest.mark.req("LANG-24")
@pytest.mark.parametrize("values", WRONG)
def test_faults_are_told_in_the_list(wrong, values):
    assert wrong(values) == f"points.dat:{WRONG[values]}"


@pytest.mark.req("LANG-23")
def test_joint_types_must_fit_the_robot(wrong):
    defined = "TYPE RECORD REAL: a1, a2; ENDRECORD = MAIN_JOINT;"
    assert wrong("MAIN_JOINT: j := (1, 2);", defined).startswith("t.irl:2:39 IRL221 type MAIN_JOINT")


def test_constants_know_no_variables(wrong):
    assert wrong("REAL: lift := 1;", "CONST REAL: high := 2 * lift;") == (
        "t.irl:2:25 IRL201 unknown name 'lift'; it comes from a data list and is a variable, of which "
        "constants know nothing"
    )


def test_a_value_without_one_is_told_where_it_is_used(setting):
    found = analysed("IMPORT DATALIST points;", "MOVE LIN later;", "POSITION: later;")
    with pytest.raises(InterpreterError) as caught:
        list(interpret(found.tree, found.source, setting(3), found.data_lists))
    assert str(caught.value).startswith("t.irl:4:10: error IRL501: 'later' has no value yet")


def test_a_check_names_what_a_run_would_stop_at():
    found = analysed("IMPORT DATALIST points;", "out_3 := 1;", "SEMAPHORE: r;\nREAL: out_3 := 1; SIGNAL: s;")
    told = [str(d) for d in unsupported(found.tree, found.source, found.data_lists)]
    assert [line.split(" but")[0] for line in told] == [
        "points.dat:2:1: warning IRL591: this version of irlx reads the type SEMAPHORE",
        "points.dat:3:19: warning IRL591: this version of irlx reads the type SIGNAL",
    ]
