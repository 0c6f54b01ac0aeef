"""The pages of the codes: every code has one, and its programs show what it says."""

import re
from pathlib import Path

import pytest

from irlx.diagnostics import CATALOGUE
from irlx.diagnostics.codes.lints import LINTS
from irlx.language.analysis import analyse
from irlx.language.source import source_text

PAGES = Path(__file__).parents[2] / "docs" / "diagnostics"

# Line, column and message that the bad program of the page gives, and nothing else.
MESSAGES = {
    "IRL101": (4, 12, "expected a value, found ';'"),
    "IRL102": (4, 14, "missing ';' after the MOVE"),
    "IRL103": (4, 14, "missing ';' after the CYCLICSTART"),
    "IRL104": (4, 11, "missing THEN after the condition of IF"),
    "IRL105": (4, 5, "'=' taken for ':='"),
    "IRL106": (2, 11, "PATH is a keyword and cannot be a name"),
    "IRL107": (6, 1, "missing ENDIF for the IF of line 4, found the keyword ENDPROGRAM"),
    "IRL108": (5, 3, "ENDIF without IF"),
    "IRL109": (6, 1, "nothing may follow the end of the program, found the name 'x'"),
    "IRL110": (4, 11, "comment without end"),
    "IRL111": (3, 11, "text without closing '"),
    "IRL112": (4, 10, "'–' (U+2013) has no meaning outside texts and comments"),
    "IRL113": (4, 8, "number outside the range of INT"),
    "IRL114": (4, 30, "this target stands after WITH or out of order in the MOVE"),
    "IRL115": (4, 18, "comparisons cannot be chained"),
    "IRL116": (1, 1, "expected PROGRAM, MODULE or DATALIST at the start, found the keyword BEGIN"),
    "IRL117": (1, 1, "the file holds no program"),
    "IRL118": (4, 108, "parentheses nested deeper than 100 levels"),
    "IRL120": (2, 9, "missing ':' before the name 'x'"),
    "IRL121": (4, 3, "'CYCLICSTRAT' is no word of the language; did you mean CYCLICSTART?"),
    "IRL122": (4, 9, "',' found where ';' has to end the assignment"),
    "IRL123": (4, 8, "'==' is not known here"),
    "IRL124": (4, 9, "',' inside a number"),
    "IRL125": (6, 3, "ELSE IF begins a second IF, and there is no ENDIF for it"),
    "IRL126": (4, 3, "this comment holds the beginning of another one, in line 6"),
    "IRL140": (4, 34, "nothing on this line gives IRL205: the comment ignores nothing"),
    "IRL141": (4, 46, "IRL203 is an error and cannot be ignored"),
    "IRL142": (3, 18, "no message has the code IRL2O5; did you mean 'IRL725' or 'IRL425' or 'IRL285'?"),
    "IRL143": (3, 3, "this comment to irlx is not understood: expected irlx: ignore, then codes"),
    "IRL201": (4, 3, "unknown name 'lenght'; did you mean 'length'?"),
    "IRL202": (3, 11, "'Count' is declared twice"),
    "IRL203": (4, 15, "MOVE has no parameter 'SPED'; did you mean 'SPEED' or 'SPEED_PTP' or 'SPEED_ORI'?"),
    "IRL204": (2, 5, "unknown type 'PSE'; did you mean 'POSE'?"),
    "IRL205": (3, 3, "port 'OUT_3' is not declared"),
    "IRL206": (4, 8, "unknown function 'SQR'; did you mean 'SQRT'?"),
    "IRL207": (6, 3, "unknown procedure 'pck'; did you mean 'pick'?"),
    "IRL208": (4, 8, "GOTO 'inside' jumps into a structured statement"),
    "IRL209": (4, 8, "'list' is no function"),
    "IRL210": (4, 3, "no GOTO uses the label 'again'"),
    "IRL211": (4, 3, "'limit' is a constant and cannot be set"),
    "IRL212": (4, 29, "MOVE parameter 'SPEED' is given twice"),
    "IRL213": (3, 21, "'count' hides a name of the program"),
    "IRL214": (2, 22, "the record has two fields 'A'"),
    "IRL215": (4, 8, "unknown label 'finish'; did you mean 'finsh'?"),
    "IRL216": (2, 11, "'r_speed' is a system variable: assign to it instead of declaring it"),
    "IRL217": (3, 3, "EXIT outside of a loop"),
    "IRL246": (3, 47, "type MAIN_JOINT_MAX is defined with 2 fields, but MAIN_JOINT with 3"),
    "IRL247": (5, 3, "RETURN of the function half needs a value of type REAL"),
    "IRL248": (5, 10, "RETURN gives a value, but the procedure half has no result"),
    "IRL249": (9, 12, "the VAR parameter 'count' of increase needs a variable, found an expression"),
    "IRL250": (8, 8, "'half' is a procedure, not a function"),
    "IRL251": (2, 13, "the constant 'lift' has no value"),
    "IRL252": (6, 10, "5 is chosen by an earlier label of this CASE"),
    "IRL266": (
        2,
        16,
        "STANDARD_OUT cannot be 'logg': there is no such variable; did you mean 'log'?",
    ),
    "IRL267": (3, 16, "a FILE cannot be a parameter by value"),
    "IRL268": (4, 11, "the file 'log' is used but never opened"),
    "IRL269": (4, 8, "the file 'log' is opened but never closed"),
    "IRL280": (
        4,
        11,
        "this means (first = TRUE) AND (second = TRUE); Pascal would read (first = (TRUE AND second)) = TRUE",
    ),
    "IRL281": (2, 24, "the variable 'left' is never used"),
    "IRL282": (4, 35, "'lift' is read but never set"),
    "IRL283": (6, 3, "this statement is never reached"),
    "IRL284": (4, 3, "this WHILE never ends"),
    "IRL285": (4, 3, "this WAIT FOR may wait for ever"),
    "IRL286": (4, 12, "= compares REAL numbers digit for digit"),
    "IRL287": (3, 10, "the function sign can end without a RETURN"),
    "IRL288": (4, 14, "the blend of this move is lost: WAIT in line 5 needs the robot at rest"),
    "IRL289": (6, 3, "gripper is set while the robot passes the corner, not once it has stopped there"),
    "IRL310": (4, 14, "the lower bound 60 of joint 2 is above its upper bound -60"),
    "IRL311": (
        5,
        3,
        "the path that begins here at (600, 0, 400) does not come back: it ends at (500, 0, 400)",
    ),
    "IRL312": (2, 75, "STATUS 5 of a ROBTARGET is carried and not compared: it chooses no posture"),
    "IRL313": (5, 12, "a ROBTARGET does not fix the posture of a robot with 7 joints"),
    "IRL301": (4, 3, "CYCLICSTART is still on at the end of the program"),
    "IRL302": (5, 3, "FREEZEEND although FREEZESTART is not on"),
    "IRL303": (5, 3, "FREEZESTART is switched on while it is on; the new values replace the old"),
    "IRL304": (3, 18, "joint 1 is listed twice"),
    "IRL305": (3, 15, "there is no joint 0"),
    "IRL306": (4, 69, "parameter 'Gain' of the criterion joint_centring is given twice"),
    "IRL407": (
        4,
        15,
        "WITH CRITERION manipulability does nothing on a PTP, which goes straight in joint space",
    ),
    "IRL401": (4, 3, "PATH does not go with PTP"),
    "IRL402": (4, 3, "SPLINE needs PATH"),
    "IRL403": (4, 3, "CIRCLE needs pairs of via point and end point, found 1 target(s)"),
    "IRL404": (4, 15, "ANGLE does not go with LIN"),
    "IRL405": (5, 23, "3 target(s), but 2 posture(s) after RECONFIGURATION"),
    "IRL406": (4, 49, "WITH TOLERANCE is given twice"),
}
LINTED = {code.id for code in LINTS}
MODULE = "MODULE grippers; EXPORT close; PROCEDURE close; BEGIN ENDPROC; ENDMODULE"
IMPORT_MESSAGES = {
    "IRL218": (2, 6, "no module 'gripers'"),
    "IRL219": (2, 22, "grippers.irl does not export 'shut'"),
}


OF_CELLS = {"IRL290", "IRL291"}
"""Names of a cell, whose pages show one beside the program."""
OF_FILES = {"IRL260", "IRL261", "IRL262", "IRL263", "IRL264", "IRL265"}
"""Modules and lists as files, which have tests of their own: their pages show several."""


def section(code, title):
    page = (PAGES / f"{code}.md").read_text(encoding="utf-8")
    found = re.search(rf"^## {title}\n+```irl\n(.*?)```", page, re.MULTILINE | re.DOTALL)
    assert found, f"{code} has no program under {title}"
    return found[1]


def told(text, resolver=None, *, lints=False):
    diagnostics = analyse(source_text("p.irl", text), resolver, lints=lints).diagnostics
    return [(d.code, *d.place.line_and_column, d.message) for d in diagnostics]


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize("code", sorted(CATALOGUE))
def test_every_code_has_a_page(code):
    path = PAGES / f"{code}.md"
    assert path.is_file()
    page = path.read_text(encoding="utf-8")
    assert page.startswith(f"# {code}: ")
    assert ("## Bad\n" in page and "## Repaired\n" in page) or "## Example\n" in page


@pytest.mark.req("LANG-70")
def test_every_page_has_a_code():
    assert {path.stem for path in PAGES.glob("IRL*.md")} <= set(CATALOGUE)


@pytest.mark.req("LANG-70")
@pytest.mark.req("LANG-71")
@pytest.mark.parametrize("code", MESSAGES)
def test_bad_program_gives_the_message(code):
    assert told(section(code, "Bad"), lints=code in LINTED) == [(code, *MESSAGES[code])]


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize("code", MESSAGES)
def test_repaired_program_is_clean(code):
    assert told(section(code, "Repaired"), lints=code in LINTED) == []


def grippers(name):
    return analyse(source_text("grippers.irl", MODULE)) if name == "grippers" else None


@pytest.mark.req("LANG-12")
@pytest.mark.parametrize("code", IMPORT_MESSAGES)
def test_imports(code):
    assert told(section(code, "Bad"), grippers) == [(code, *IMPORT_MESSAGES[code])]
    assert told(section(code, "Repaired"), grippers) == []


def test_language_codes_are_all_covered():
    ours = {code for code in CATALOGUE if re.match(r"IRL(1\d\d|2([015-9]\d|4[6-9])|3[0-3]\d|4[01]\d)", code)}
    assert (
        ours
        == MESSAGES.keys() | IMPORT_MESSAGES.keys() | {"IRL144", "IRL130", "IRL131"} | OF_FILES | OF_CELLS
    )
