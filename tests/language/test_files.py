"""What a check says of files and channels before anything runs."""

import pytest

from irlx.language.analysis import analyse
from irlx.language.format import format_source
from irlx.language.source import source_text

DECLARATIONS = """VAR FILE: f, g; INT: i; REAL: x; STRING: s; ARRAY [1..2] OF FILE: fs;
TYPE RECORD FILE: f; INT: n; ENDRECORD = book; VAR book: one, other; ARRAY [1..2] OF book: shelf;
PROCEDURE note(VAR FILE: t); BEGIN WRITELN(t, 1); ENDPROC; PROCEDURE plain(INT: n); BEGIN ENDPROC;"""


def found(body, declarations=DECLARATIONS, lints=False):
    text = f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM"
    diagnostics = analyse(source_text("t.irl", text), lints=lints).diagnostics
    return [(d.code, d.message, text[d.place.span.start : d.place.span.end]) for d in diagnostics]


COPIED = "a FILE cannot be copied"


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize(
    ("body", "wanted"),
    [
        ("OPEN(f, 'a', 'READ'); CLOSE(f);", []),
        ("OPEN(fs[i], s + '.txt', 'append'); WRITE(fs[1], i, x:3:1); CLOSE(fs[2]);", []),
        ("OPEN(one.f, 'a', 'WRITE'); one.n := shelf[2].n; CLOSE(shelf[i].f); note(one.f);", []),
        ("READ(f, i, x, s); READ(fs[1], i); i := 1; IF EOF(f) OR EOF(one.f) OR EOF() THEN HALT; ENDIF;", []),
        ("g := f;", [("IRL267", COPIED, "f")]),
        ("one := other;", [("IRL267", COPIED, "other")]),
        ("shelf[1] := one;", [("IRL267", COPIED, "one")]),
        ("fs[1] := f;", [("IRL267", COPIED, "f")]),
        ("f := 'a';", [("IRL222", "expected FILE, found STRING", "'a'")]),
        ("IF f = g THEN HALT; ENDIF;", [("IRL267", COPIED, "f"), ("IRL267", COPIED, "g")]),
        ("plain(f);", [("IRL267", COPIED, "f")]),
        ("note(f); note(fs[1]); note(one.f);", []),
        ("note(i);", [("IRL222", "expected a variable of FILE, found INT", "i")]),
        ("WRITE(i, f);", [("IRL267", COPIED, "f")]),
        ("READ(i, f);", [("IRL222", "expected INT, REAL, CHAR, STRING or BOOL, found FILE", "f")]),
        ("WRITE(one);", [("IRL267", COPIED, "one")]),
        ("WRITE(f:3);", [("IRL267", COPIED, "f")]),
        ("IF EOF(f, g) THEN HALT; ENDIF;", [("IRL228", "EOF takes 0 or 1 values, found 2", "EOF(f, g)")]),
        ("IF EOF(i) THEN HALT; ENDIF;", [("IRL222", "expected a variable of FILE, found INT", "i")]),
        ("IF EOF(3) THEN HALT; ENDIF;", [("IRL249", "EOF needs a variable, found a number", "3")]),
        ("IF EOF OR NOT EOF THEN HALT; ENDIF;", []),
        ("i := EOF;", [("IRL222", "expected INT, found BOOL", "EOF")]),
        ("EOF := TRUE;", [("IRL211", "'EOF' is a function and cannot be set", "EOF")]),
        ("READ(EOF);", [("IRL249", "READ needs a variable, found a function", "EOF")]),
        ("i := EOF.n;", [("IRL201", "unknown name 'EOF'", "EOF")]),
        ("i := EOF();", [("IRL222", "expected INT, found BOOL", "EOF()")]),
        ("WRITE(1:1000:100, 1:0:0);", []),
        ("WRITE(1:1001);", [("IRL505", "the width of WRITE must be 0 to 1,000, found 1001", "1001")]),
        ("WRITE(1:-1);", [("IRL505", "the width of WRITE must be 0 to 1,000, found -1", "-1")]),
        ("WRITE(f, 1:9:101);", [("IRL505", "the precision of WRITE must be 0 to 100, found 101", "101")]),
        ("WRITE(1:2.5);", [("IRL222", "expected INT, found REAL", "2.5")]),
        ("CLOSE(unknown);", [("IRL201", "unknown name 'unknown'", "unknown")]),
    ],
)
def test_statements(body, wanted):
    assert found(body) == wanted


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize(
    ("declarations", "wanted"),
    [
        ("CONST FILE: f;", [("a constant", "FILE"), None]),
        ("VAR FILE: f; FILE: g := f;", [("copied", "f")]),
        ("PROCEDURE p(IN FILE: f); BEGIN ENDPROC;", [("a parameter by value", "IN FILE: f")]),
        (
            "PROCEDURE p(ARRAY [1..2] OF FILE: f); BEGIN ENDPROC;",
            [("a parameter by value", "ARRAY [1..2] OF FILE: f")],
        ),
        ("PROCEDURE p(VAR ARRAY [1..2] OF FILE: f); BEGIN ENDPROC;", []),
        (
            "VAR FILE: g; FUNCTION p: FILE; BEGIN RETURN g; ENDFCT;",
            [("the result of a function", "FILE"), ("copied", "g")],
        ),
    ],
)
def test_declarations(declarations, wanted):
    given = [(m, t) for c, m, t in found("", declarations) if c == "IRL267"]
    assert given == [(f"a FILE cannot be {what}", text) for what, text in filter(None, wanted)]


@pytest.mark.req("LANG-10")
@pytest.mark.parametrize(
    ("declarations", "wanted"),
    [
        ("STANDARD_OUT = f; STANDARD_IN = g; VAR FILE: f, g;", []),
        ("STANDARD_OUT = SCREEN; STANDARD_IN = keyboard;", []),
        ("VAR FILE: screen; STANDARD_IN = screen;", []),
        ("STANDARD_OUT = keyboard;", [("IRL266", "keyboard")]),
        ("STANDARD_IN = screen;", [("IRL266", "screen")]),
        ("STANDARD_IN = kebyoard;", [("IRL266", "kebyoard")]),
        ("STANDARD_IN = i; VAR INT: i;", [("IRL222", "i")]),
        ("STANDARD_IN = fs; VAR ARRAY [1..2] OF FILE: fs;", [("IRL222", "fs")]),
        ("STANDARD_IN = f; STANDARD_IN = g; VAR FILE: f, g;", [("IRL202", "STANDARD_IN = g")]),
        ("STANDARD_IN = p; PROCEDURE p; BEGIN ENDPROC;", []),
    ],
)
def test_standard_channels(declarations, wanted):
    assert [(code, text) for code, _, text in found("", declarations)] == wanted


def test_channels_belong_to_the_program():
    text = "MODULE m; STANDARD_OUT = f; VAR FILE: f; EXPORT f; ENDMODULE"
    (diagnostic,) = analyse(source_text("m.irl", text)).diagnostics
    assert diagnostic.code == "IRL266"
    assert "only the program itself" in diagnostic.message


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize(
    ("declarations", "body", "wanted"),
    [
        ("VAR FILE: f;", "OPEN(f, 'a', 'READ'); CLOSE(f);", []),
        ("VAR FILE: f;", "OPEN(f, 'a', 'READ');", [("IRL269", "f")]),
        ("VAR FILE: f;", "CLOSE(f); WRITE(f, 1); OPEN(f, 'a', 'WRITE');", []),
        ("VAR FILE: f;", "WRITE(f, 1); WRITELN(f);", [("IRL268", "f")]),
        ("VAR FILE: f;", "IF EOF(f) THEN HALT; ENDIF;", [("IRL268", "f")]),
        ("VAR FILE: f; PROCEDURE p(VAR FILE: g); BEGIN WRITE(g, 1); ENDPROC;", "p(f);", []),
        ("VAR FILE: f; EXPORT f;", "OPEN(f, 'a', 'READ');", []),
        ("FROM m IMPORT f;", "WRITELN(f, 1);", []),
        ("STANDARD_OUT = f; VAR FILE: f;", "WRITE(1);", [("IRL268", "f")]),
        ("STANDARD_OUT = f; VAR FILE: f;", "", []),
        ("STANDARD_IN = f; VAR FILE: f;", "IF EOF() THEN HALT; ENDIF;", [("IRL268", "f")]),
        ("VAR ARRAY [1..2] OF FILE: f;", "OPEN(f[1], 'a', 'READ'); CLOSE(f[2]);", []),
        ("PROCEDURE p; VAR FILE: f; BEGIN OPEN(f, 'a', 'READ'); ENDPROC;", "p;", [("IRL269", "f")]),
    ],
)
def test_lints(declarations, body, wanted):
    assert [(code, text) for code, _, text in found(body, declarations, lints=True)] == wanted


@pytest.mark.req("LANG-74")
def test_the_form_keeps_layouts():
    text = "PROGRAM t; VAR FILE: f; REAL: x; BEGIN\nWRITELN(f,x : 6 :2,' ',x:8);WRITE(x:6+1:2); ENDPROGRAM;\n"
    once = format_source(text)
    assert "  WRITELN(f, x:6:2, ' ', x:8);\n  WRITE(x:6 + 1:2);\n" in once
    assert format_source(once) == once
