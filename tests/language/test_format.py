"""The formatter: what it makes of texts."""

from pathlib import Path

import pytest

import irlx
from irlx.language import format as formatter
from irlx.language.format import format_source, ports, reading
from irlx.language.parser import parse
from irlx.language.source import source_text

PROGRAMS = Path(__file__).parents[2] / "programs"


def body(text):
    """The formatted statements of a program, without their indentation."""
    lines = format_source(f"PROGRAM t; BEGIN\n{text}\nENDPROGRAM").splitlines()
    assert (lines[:2], lines[-1]) == (["PROGRAM t;", "BEGIN"], "ENDPROGRAM")
    return [line.removeprefix("  ") for line in lines[2:-1]]


def declared(text):
    """The formatted declarations of a program."""
    lines = format_source(f"PROGRAM t; {text} BEGIN ENDPROGRAM").splitlines()
    return lines[1:-2]


@pytest.mark.req("LANG-74")
def test_python_interface():
    assert irlx.format_source("program p;begin end_1:=2 endprogram") == (
        "PROGRAM p;\nBEGIN\n  end_1 := 2;\nENDPROGRAM\n"
    )


@pytest.mark.req("LANG-74")
@pytest.mark.parametrize(
    "path", sorted(PROGRAMS.rglob("*.irl")) + sorted(PROGRAMS.rglob("*.dat")), ids=lambda path: path.name
)
def test_the_programs_of_the_repository_have_the_form(path):
    text = path.read_text(encoding="utf-8")
    assert format_source(text) == text


@pytest.mark.req("LANG-74")
@pytest.mark.parametrize(
    ("written", "formatted"),
    [
        ("X:=y+  2*z ;", ["X := y + 2 * z;"]),
        ("x:=-y; z:=not(- -y)", ["x := -y;", "z := NOT (- -y);"]),
        ("a [ 1 ,2 ] . b:=f ( ) + g(x,y);", ["a[1, 2].b := f() + g(x, y);"]),
        ("x := 'it''s' ; y := \"A\" ; z := 1.E5;", ["x := 'it''s';", 'y := "A";', "z := 1.E5;"]),
        ("move lin p1,p2 Speed:=5 acc:=7", ["MOVE LIN p1, p2 Speed := 5, acc := 7;"]),
        ("MOVE LIN p1, SPEED := 5;", ["MOVE LIN p1 SPEED := 5;"]),
        ("criterion c , weight:=2 gain:=1;", ["CRITERION c weight := 2, gain := 1;"]),
        (
            "Move_Inc spline path (a,b) with reconfiguration(c,d);",
            ["MOVE_INC SPLINE PATH (a, b) WITH RECONFIGURATION (c, d);"],
        ),
        ("wait for a timeout 5 sec; wait 2 Sec;", ["WAIT FOR a TIMEOUT 5 SEC;", "WAIT 2 SEC;"]),
        ("step := sec; to := at + timeout;", ["step := sec;", "to := at + timeout;"]),
        ("for i:=1 to 3 do endfor;", ["FOR i := 1 TO 3 DO", "ENDFOR;"]),
        ("repeat x until y;", ["REPEAT", "  x;", "UNTIL y;"]),
        ("again: goto again;", ["again:", "GOTO again;"]),
        (";;x;;", ["x;"]),
        ("write(x:5:2, y :3);", ["write(x:5:2, y:3);"]),
        (
            "case n of when 1,3 ..5:x; when 1. .. .5: default:y endcase",
            *[
                [
                    "CASE n OF",
                    "  WHEN 1, 3..5:",
                    "    x;",
                    "  WHEN 1. .. .5:",
                    "  DEFAULT:",
                    "    y;",
                    "ENDCASE;",
                ]
            ],
        ),
        (
            "if a then x; elsif b then y; else z; endif;",
            ["IF a THEN", "  x;", "ELSIF b THEN", "  y;", "ELSE", "  z;", "ENDIF;"],
        ),
    ],
)
def test_statements(written, formatted):
    assert body(written) == formatted


@pytest.mark.req("LANG-74")
@pytest.mark.parametrize(
    ("written", "formatted"),
    [
        ("var real:x,y:=2;", ["VAR", "  real: x, y := 2;"]),
        ("const REAL:a:=1; int:b:=2; var", ["CONST", "  REAL: a := 1;", "  int: b := 2;", "VAR"]),
        ("var array[1..5,0..2]of POSE:r;", ["VAR", "  ARRAY [1..5, 0..2] OF POSE: r;"]),
        (
            "type record real:a.max,b;endrecord=both;",
            ["TYPE", "  RECORD", "    real: a.max, b;", "  ENDRECORD = both;"],
        ),
        (
            "var input BOOL:a at 1,b at 2; analog output:c at 3;",
            ["VAR", "  INPUT BOOL: a AT 1, b AT 2;", "  ANALOG OUTPUT: c AT 3;"],
        ),
        (
            "from m import a,b;export a,b to c;robot r:=s;standard_in=c;import datalist d;",
            *[
                [
                    "FROM m IMPORT a, b;",
                    "EXPORT a, b TO c;",
                    "ROBOT r := s;",
                    "STANDARD_IN = c;",
                    "IMPORT DATALIST d;",
                ]
            ],
        ),
        (
            "procedure p(in REAL:a,b;var INT:c); var INT:i; begin i:=1 endproc;",
            ["PROCEDURE p(IN REAL: a, b; VAR INT: c);", "VAR", "  INT: i;", "BEGIN", "  i := 1;", "ENDPROC;"],
        ),
        (
            "function f:REAL; begin return 1; endfct;",
            ["FUNCTION f: REAL;", "BEGIN", "  RETURN 1;", "ENDFCT;"],
        ),
    ],
)
def test_declarations(written, formatted):
    assert declared(written) == formatted


@pytest.mark.req("LANG-74")
def test_long_lines_are_broken():
    targets = ", ".join(f"target_number_{n}" for n in range(9))
    assert body(f"MOVE LIN {targets} SPEED := 100 WITH JOINTLIMIT lower, upper;") == [
        "MOVE LIN target_number_0, target_number_1, target_number_2, target_number_3, target_number_4,",
        "         target_number_5, target_number_6, target_number_7, target_number_8",
        "  SPEED := 100",
        "  WITH JOINTLIMIT lower, upper;",
    ]
    assert body(f"x := ({', '.join(['-123.456'] * 14)});") == [
        f"x := ({', '.join(['-123.456'] * 10)},",
        f"      {', '.join(['-123.456'] * 4)});",
    ]
    summands = [f"summand_{n} * 12.5" for n in range(7)]
    assert body(f"x := {' + '.join(summands)};") == [
        f"x := {summands[0]}",
        *[f"     + {summand}" for summand in summands[1:-1]],
        f"     + {summands[-1]};",
    ]


@pytest.mark.req("LANG-74")
def test_lists_that_the_text_breaks_stay_broken():
    assert declared("VAR POSE: a := (1, 2),\nb := (3, 4);") == [
        "VAR",
        "  POSE: a := (1, 2),",
        "        b := (3, 4);",
    ]
    assert declared("VAR POSE: a := (1, 2), b := (3, 4);") == ["VAR", "  POSE: a := (1, 2), b := (3, 4);"]
    assert body("x := ((1, 0),\n(0, 1));") == ["x := ((1, 0),", "      (0, 1));"]
    assert body("x := (1,\n0);") == ["x := (1, 0);"]
    assert body("MOVE LIN a WITH\nRECONFIGURATION b;") == ["MOVE LIN a", "  WITH RECONFIGURATION b;"]


@pytest.mark.req("LANG-74")
def test_a_parameter_that_a_move_does_not_know_never_begins_a_line():
    assert body("MOVE LIN p1 SPED := 5,\nSPEED := 3;") == ["MOVE LIN p1 SPED := 5, SPEED := 3;"]


@pytest.mark.req("LANG-74")
def test_blank_lines():
    assert body("\n\nx;\ny;\n\n\n\n{ c }\n\nz;\n\n") == ["x;", "y;", "", "{ c }", "", "z;"]
    text = "{ a }\n\n\nPROGRAM t;\n\nCONST\n\nINT: a := 1;\n\n\nVAR\nBEGIN\nENDPROGRAM\n\n{ z }\n\n"
    assert format_source(text).splitlines() == [
        *[
            "{ a }",
            "",
            "PROGRAM t;",
            "",
            "CONST",
            "  INT: a := 1;",
            "",
            "VAR",
            "BEGIN",
            "ENDPROGRAM",
            "",
            "{ z }",
        ],
    ]


@pytest.mark.req("LANG-74")
def test_comments_stay_where_they_belong():
    assert body("x; { x }\ny; { y } z; { z }\n{ lead } a;\n{ own }\nb;") == [
        *["x;  { x }", "y;  { y }", "z;  { z }", "{ lead } a;", "{ own }", "b;"],
    ]
    assert body("MOVE LIN { in } p1,  { first }\np2;  { second }") == [
        *["MOVE LIN { in } p1,  { first }", "         p2;  { second }"],
    ]
    assert body("x := f({1}a{2},{3}b{4}){5};") == ["x := f({1} a {2}, {3} b {4}) {5};"]
    inside = "IF a THEN { why }\nx;\n  { of x }\nELSE\n  y;\n{ of ENDIF }\nENDIF;"
    assert body(inside) == [
        "IF a THEN  { why }",
        "  x;",
        "  { of x }",
        "ELSE",
        "  y;",
        "{ of ENDIF }",
        "ENDIF;",
    ]


@pytest.mark.req("LANG-74")
def test_comments_of_several_lines_move_as_a_whole():
    assert body("      { one\n          two\n        three }\n    x;") == [
        "{ one",
        "    two",
        "  three }",
        "x;",
    ]
    assert body("x;\n{ one\ntwo }\ny;") == ["x;", "{ one", "two }", "y;"]


@pytest.mark.req("LANG-74")
def test_what_is_aligned_stays_aligned():
    aligned = ["a;            { one }", "a_long_call;  { two }", "b;", "c;            { three }"]
    assert (
        body("a;               { one }\na_long_call;     { two }\nb;\nc;               { three }") == aligned
    )
    assert body("a;     { one }\na_long_call; { two }") == ["a;  { one }", "a_long_call;  { two }"]
    text = "CONST\nREAL: a    := 1;\nINT: bcd   := (2,\n3);\nINT: e := 4;"
    assert declared(text) == ["CONST", "  REAL: a  := 1;", "  INT: bcd := (2, 3);", "  INT: e := 4;"]
    assert declared("VAR\nINT: a   := 1,\n     bcd := 2;") == [
        "VAR",
        "  INT: a   := 1,",
        "       bcd := 2;",
    ]
    assert body("a[1, 2]  := 1;\nbcd      := 2;") == ["a[1, 2] := 1;", "bcd     := 2;"]
    assert body("a    := 1;\nbcd  := 2;\ne := 3;") == ["a   := 1;", "bcd := 2;", "e := 3;"]


@pytest.mark.req("LANG-74")
def test_a_line_that_pushes_comments_beyond_the_margin_stands_apart():
    call = f"call({', '.join(['argument'] * 7)});"
    remark = "{ " + "words " * 10 + "}"
    text = f"{call:<80}{remark}\n{'a;':<80}{remark}\n{'bc;':<80}{remark}"
    assert body(text) == [f"{call}  {remark}", f"a;   {remark}", f"bc;  {remark}"]


@pytest.mark.req("LANG-44")
@pytest.mark.parametrize(
    ("written", "formatted"),
    [
        ("IF a { why }\nx; ENDIF", ["IF a THEN  { why }", "  x;", "ENDIF;"]),
        ("WHILE a < b\nx; ENDWHILE;", ["WHILE a < b DO", "  x;", "ENDWHILE;"]),
        ("x = TRUE;", ["x := TRUE;"]),
        ("MOVE LIN p1 SPEED:=5 ACC:=2;", ["MOVE LIN p1 SPEED := 5, ACC := 2;"]),
        ("CYCLICSTART\nMOVE LIN p1;\nOBSTACLEEND w\nHALT { last }", None),
    ],
)
def test_what_irlx_forgives_is_mended(written, formatted):
    formatted = formatted or ["CYCLICSTART;", "MOVE LIN p1;", "OBSTACLEEND w;", "HALT;  { last }"]
    assert body(written) == formatted
    before = parse(source_text("t", f"PROGRAM t; BEGIN {written} ENDPROGRAM"))
    after = parse(source_text("t", "PROGRAM t; BEGIN " + "\n".join(formatted) + "\nENDPROGRAM"))
    assert after.tree == before.tree
    assert after.findings == ()


@pytest.mark.req("LANG-74")
@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("PROGRAM t; BEGIN x := ; ENDPROGRAM", ["IRL101"]),
        ("PROGRAM t; BEGIN x := 1 y := 2; ENDPROGRAM", ["IRL102"]),
        ("PROGRAM t; BEGIN x := { 1; ENDPROGRAM", ["IRL110"]),
        ("PROGRAM t; BEGIN MOVE LIN p1 SPEED := 5, p2; ENDPROGRAM", ["IRL114"]),
        ("", ["IRL117"]),
    ],
)
def test_texts_with_errors_are_refused(text, codes):
    with pytest.raises(irlx.IrlxError) as caught:
        format_source(text)
    assert [d.code for d in caught.value.diagnostics if d.is_error][:1] == codes


@pytest.mark.req("LANG-74")
def test_line_ends_and_byte_order_marks():
    assert format_source("PROGRAM t;\r\nBEGIN { a\r\n b }\r\nENDPROGRAM") == (
        "PROGRAM t;\r\nBEGIN  { a\r\n  b }\r\nENDPROGRAM\r\n"
    )
    assert format_source("\ufeffPROGRAM t; BEGIN ENDPROGRAM") == "PROGRAM t;\nBEGIN\nENDPROGRAM\n"


@pytest.mark.req("LANG-74")
@pytest.mark.parametrize(
    ("spoil", "what"),
    [
        (lambda text: text.replace("x", "y"), "the meaning of the program"),
        (lambda text: text.replace("x", "X"), "the spelling of a name or a literal"),
        (lambda text: text.replace("{ c }", ""), "every comment"),
        (lambda text: text + " ", "the form of a text that it has formatted"),
    ],
)
def test_a_formatter_that_spoils_something_gives_up(monkeypatch, spoil, what):
    text_of = formatter.text_of
    calls = []

    def spoiled(rows):
        calls.append(1)
        text = text_of(rows)
        return text + " " * len(calls) if "form" in what else spoil(text)

    monkeypatch.setattr(formatter, "text_of", spoiled)
    with pytest.raises(irlx.IrlxError) as caught:
        format_source("PROGRAM t; BEGIN x := 1; { c } ENDPROGRAM")
    assert caught.value.reason.code == "IRL144"
    assert what in caught.value.reason.message


@pytest.mark.req("LANG-74")
@pytest.mark.parametrize(
    ("text", "readings"),
    [
        ("PROGRAM p;\nBEGIN\nENDPROGRAM\n", 1),
        ("program p;begin x:=1; endprogram", 2),
        ("program p;begin x=1 endprogram", 3),
        ("program p;begin OUT_1=1 endprogram", 5),
    ],
)
def test_how_often_a_text_is_read(monkeypatch, text, readings):
    """Reading is most of the time: once as it is, once formatted, once mended, twice for declared ports."""
    read = []

    def counted(source):
        read.append(source.text)
        return parse(source)

    for module in (formatter, reading, ports):
        monkeypatch.setattr(module, "parse", counted)
    format_source(text)
    assert len(read) == readings
    assert len(set(read)) == readings


@pytest.mark.req("LANG-74", "TRF-23")
def test_in_frame():
    assert body("move lin a,b in frame Pipe,SPEED:=5;") == ["MOVE LIN a, b IN FRAME Pipe SPEED := 5;"]
    assert body("MOVE LIN a\nIN FRAME pipe\nSPEED := 5 WITH RECONFIGURATION k;") == [
        "MOVE LIN a",
        "  IN FRAME pipe",
        "  SPEED := 5",
        "  WITH RECONFIGURATION k;",
    ]
    assert body("reconfiguration k in { there } frame pipe;") == [
        "RECONFIGURATION k IN { there } FRAME pipe;"
    ]


@pytest.mark.req("LANG-74")
def test_a_comment_that_holds_the_beginning_of_another_one():
    """There is a warning of it, IRL126, before and after: no reason to leave the text as it is."""
    text = "PROGRAM p;\nBEGIN\n  { count\n  x := 1;\n  { on }\nENDPROGRAM\n"
    assert format_source(text) == text
    assert format_source(text.replace("\n  { on", "\n     { on")).count("{") == 2
