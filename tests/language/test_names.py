"""Names, symbols, motion and switches beyond the programs of the diagnostics pages."""

import pytest

from irlx.language.analysis import analyse
from irlx.language.builtins import MOVE_PARAMETERS
from irlx.language.source import source_text


def codes(text):
    return [(d.code, d.data.get("name")) for d in analyse(source_text("t.irl", text)).diagnostics]


@pytest.mark.req("LANG-10")
def test_symbols_by_kind(analysed):
    analysis = analysed(
        "PROGRAM t; FROM m IMPORT i; CONST INT: c := 1; TYPE ARRAY [1..2] OF INT = T2;"
        " VAR T2: v; INPUT BOOL: in AT 1; BEGIN ENDPROGRAM"
    )
    assert [d.code for d in analysis.diagnostics] == ["IRL106"]
    analysis = analysed(
        "PROGRAM t; FROM m IMPORT i; CONST INT: c := 1; TYPE ARRAY [1..2] OF INT = T2; ROBOT r := arm;"
        " VAR T2: v; INPUT BOOL: part AT 1; OUTPUT BOOL: lamp AT 1;"
        " PROCEDURE p; BEGIN ENDPROC; FUNCTION f: INT; BEGIN RETURN 1; ENDFCT; BEGIN ENDPROGRAM"
    )
    assert not analysis.diagnostics
    assert {key: symbol.kind for key, symbol in analysis.symbols.items()} == {
        "i": "import",
        "c": "constant",
        "r": "robot",
        "v": "variable",
        "part": "input",
        "lamp": "output",
        "p": "procedure",
        "f": "function",
    }
    assert set(analysis.types) == {"t2"}


@pytest.mark.req("LANG-13")
def test_a_data_list_that_is_not_looked_at_may_hold_any_name():
    assert codes("PROGRAM t; IMPORT DATALIST points; BEGIN MOVE LIN p1; ENDPROGRAM") == []


@pytest.mark.req("LANG-12")
def test_imported_names_may_be_anything():
    text = "PROGRAM t; FROM m IMPORT T1, go, f; VAR T1: x; BEGIN go(x); x := f(1); ENDPROGRAM"
    assert codes(text) == []


def test_unknown_names_are_reported_once():
    assert codes("PROGRAM t; BEGIN a := b; a := b; ENDPROGRAM") == [("IRL201", "a"), ("IRL201", "b")]


@pytest.mark.req("LANG-11")
def test_routines_see_the_program_and_themselves():
    text = """PROGRAM t; VAR INT: n;
    FUNCTION fac(INT: k): INT; BEGIN IF k < 2 THEN RETURN 1; ENDIF; RETURN k * fac(k - 1) + n; ENDFCT;
    PROCEDURE later; BEGIN earlier; ENDPROC; PROCEDURE earlier; VAR INT: m; BEGIN m := n; later(); ENDPROC;
    BEGIN n := fac(3); ENDPROGRAM"""
    assert codes(text) == []


@pytest.mark.req("LANG-11")
def test_local_names_stay_local():
    text = "PROGRAM t; PROCEDURE p; VAR INT: m; BEGIN m := 1; ENDPROC; BEGIN m := 2; ENDPROGRAM"
    assert codes(text) == [("IRL201", "m")]


def test_loop_variables_are_declared():
    assert codes("PROGRAM t; BEGIN FOR i := 1 TO 3 DO ENDFOR; ENDPROGRAM") == [("IRL201", "i")]


@pytest.mark.req("LANG-20")
@pytest.mark.req("LANG-22")
@pytest.mark.req("LANG-23")
@pytest.mark.req("LANG-34")
@pytest.mark.req("LANG-52")
def test_built_in_names_are_known():
    text = """PROGRAM t; VAR REAL: x; INTEGER: i; CHARACTER: c; BOOLEAN: b; FILE: f; SEMAPHORE: s := 1;
    MAIN_JOINT_ACCEL_MIN: m; ROBTARGET: g; POSE: pose; BEGIN
    x := r_speed + R_MOVE_TIME + atan2(1., 2.); pose := R_TOOL @ FK(R_JOINT_ACT);
    R_BASE := POSE((0,0,0), ORIXYZ(0,0,0));
    OPEN(f, 'a', 'READ'); WRITELN; ENDPROGRAM"""
    assert codes(text) == []


def test_labels_of_loops_and_exit():
    text = """PROGRAM t; VAR INT: i; BEGIN
    again: i := 1;
    FOR i := 1 TO 3 DO IF i = 2 THEN GOTO again; ENDIF; EXIT; ENDFOR;
    ENDPROGRAM"""
    assert codes(text) == []


def test_type_and_variable_of_one_name_do_not_clash():
    assert codes("PROGRAM t; VAR POSE: pose; BEGIN MOVE LIN pose; ENDPROGRAM") == []


@pytest.mark.req("LANG-64")
@pytest.mark.req("LANG-67")
@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("OBSTACLE a; OBSTACLE b; OBSTACLEEND a; OBSTACLEEND B;", []),
        ("OBSTACLE ściana_1; OBSTACLE wall; OBSTACLEEND wall; OBSTACLEEND ŚCIANA_1;", []),
        ("OBSTACLE a; OBSTACLE b; OBSTACLE A; OBSTACLEEND b; OBSTACLEEND a;", ["IRL303"]),
        ("OBSTACLE a; OBSTACLEEND b;", ["IRL301", "IRL302"]),
        ("CYCLICSTART; IF TRUE THEN CYCLICEND; ENDIF;", []),
        ("off; CYCLICSTART; off;", []),
        ("CYCLICSTART; HALT;", []),
        ("CRITERION c; CRITERION d; CRITERIONEND c; CRITERIONEND d;", []),
        ("FREEZESTART 2, 1, 2; FREEZEEND;", ["IRL304"]),
        ("FREEZESTART -1; FREEZEEND;", ["IRL305"]),
    ],
)
def test_switches_on_the_straight_line(body, found):
    text = f"PROGRAM t; PROCEDURE off; BEGIN CYCLICEND; ENDPROC; BEGIN {body} ENDPROGRAM"
    left = [code for code, _ in codes(text)]
    assert left == found


@pytest.mark.req("LANG-67")
def test_a_switch_left_on_names_both_places(analysed):
    (found,) = analysed("PROGRAM t;\nBEGIN\nOBSTACLE a;\nENDPROGRAM\n").diagnostics
    assert found.place.line == 3
    assert [related.place.line for related in found.related] == [4]


@pytest.mark.req("LANG-51")
def test_every_parameter_of_move_is_known():
    values = {"profile": "'S_CURVE'", "circ_ori": "'VIA'", "c_pass": "TRUE"}
    given = " ".join(f"{word} := {values.get(word, '1')}" for word in MOVE_PARAMETERS)
    assert "speed_ori" in given
    assert "circ_ori" in given
    assert codes(f"PROGRAM t; VAR POSE: p, q; BEGIN MOVE CIRCLE p, q {given}; ENDPROGRAM") == []


@pytest.mark.parametrize(
    "declarations",
    [
        "VAR REAL: r_speed;",
        "CONST POSE: R_TOOL := ((0, 0, 0), (1, 0, 0, 0));",
        "VAR INPUT BOOL: R_Base AT 3;",
        "PROCEDURE pick(REAL: R_ACC); BEGIN ENDPROC;",
        "PROCEDURE pick; VAR REAL: R_ACC; BEGIN ENDPROC;",
    ],
)
def test_system_variables_are_not_declared(declarations):
    text = f"PROGRAM t; {declarations} BEGIN R_SPEED := 5; ENDPROGRAM"
    (found,) = analyse(source_text("t.irl", text)).diagnostics
    assert found.code == "IRL216"


def test_names_of_the_cell():
    text = """PROGRAM t; VAR POSE: p, own; PROCEDURE pick; BEGIN p := Fixture; ENDPROC;
    BEGIN p := FIXTURE; own := p; MOVE LIN fixtur; ENDPROGRAM"""
    found = analyse(
        source_text("t.irl", text), cell_names=lambda program: ["Fixture", "Own", program.name.name]
    )
    assert [d.message for d in found.diagnostics] == ["unknown name 'fixtur'; did you mean 'Fixture'?"]


@pytest.mark.parametrize(
    ("statement", "declaration", "settable"),
    [
        ("IN_2 := TRUE;", "VAR INPUT BOOL: IN_2 AT 2;", False),
        ("Ain_07 := 1.5;", "VAR INPUT REAL: Ain_07 AT 7;", False),
        ("OUT_0 := TRUE;", "VAR OUTPUT BOOL: OUT_0 AT 0;", True),
        ("AOUT_3 := 1.5;", "VAR OUTPUT REAL: AOUT_3 AT 3;", True),
    ],
)
@pytest.mark.req("LANG-44")
def test_a_port_without_a_declaration(statement, declaration, settable):
    """The help declares this very port, and with that declaration the same errors are found as without."""
    name = statement.split()[0]
    found = analyse(source_text("t.irl", f"PROGRAM t; BEGIN {statement} ENDPROGRAM")).diagnostics
    (warning,) = (one for one in found if one.code == "IRL205")
    assert warning.help == f"declare it: {declaration[:-1]}; irlx fmt does so"
    errors = [] if settable else [("IRL211", name)]
    assert codes(f"PROGRAM t; BEGIN {statement} ENDPROGRAM") == [*errors, ("IRL205", name)]
    assert codes(f"PROGRAM t; {declaration} BEGIN {statement} ENDPROGRAM") == errors


@pytest.mark.parametrize("declaration", ["VAR OUTPUT BOOL: IN_2 AT 7;", "VAR BOOL: IN_2;"])
def test_a_port_by_name_alone_may_be_something_else(declaration):
    assert codes(f"PROGRAM t; {declaration} BEGIN IN_2 := TRUE; ENDPROGRAM") == []
    # What a list that is not looked at declares is not known.
    imported = codes("PROGRAM t; IMPORT DATALIST ports; BEGIN IN_2 := TRUE; ENDPROGRAM")
    assert imported == [("IRL205", "IN_2")]
