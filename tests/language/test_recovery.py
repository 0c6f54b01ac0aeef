"""Mistakes: what is reported, where, and that one mistake gives one report."""

import pytest

from irlx.language import tree


def told(analysis):
    return [f"{d.place.line}:{d.place.line_and_column[1]} {d.code} {d.message}" for d in analysis.diagnostics]


def in_body(text):
    names = "VAR REAL: x, y, z; POSE: p, q; ARRAY [1..9] OF REAL: r; BOOL: a, b; MAIN_JOINT: j; INT: n;"
    return f"PROGRAM t; {names}\nBEGIN\n{text}\nENDPROGRAM\n"


MOVE_SEMICOLON = "IRL102 missing ';' after the MOVE"
CASES = {
    "MOVE LIN p\nx := 5;": ["3:11 " + MOVE_SEMICOLON],
    "MOVE LIN p SPEED := 5\nx := 5;": ["3:22 " + MOVE_SEMICOLON],
    "MOVE LIN p\nr[1] := 5;": ["3:11 " + MOVE_SEMICOLON],
    "MOVE LIN p\nWRITELN(x);": ["3:11 " + MOVE_SEMICOLON],
    "MOVE LIN p\nMOVE LIN q;": ["3:11 " + MOVE_SEMICOLON],
    "MOVE LIN p,\n  q\n  SPEED := 5;": [],
    "MOVE LIN p WITH CRITERION c\n  depth := 5;": [],
    "MOVE LIN p SPEED := 5,\nx := 5;": ["3:22 IRL122 ',' found where ';' has to end the MOVE"],
    "MOVE LIN p,\nMOVE LIN q;": ["3:11 IRL122 ',' found where ';' has to end the MOVE"],
    "MOVE LIN p SPEED := 0,5;": ["3:22 IRL124 ',' inside a number"],
    "MOVE LIN p SPED := 5;": [
        "3:12 IRL203 MOVE has no parameter 'SPED'; did you mean 'SPEED' or 'SPEED_PTP' or 'SPEED_ORI'?"
    ],
    "CYCLICSTRAT;\nCYCLICEND;": [
        "3:1 IRL121 'CYCLICSTRAT' is no word of the language; did you mean CYCLICSTART?"
    ],
    "FREEZSTART 1, 2;\nFREEZEEND;": [
        "3:1 IRL121 'FREEZSTART' is no word of the language; did you mean FREEZESTART?"
    ],
    "OBSTACEL box;\nOBSTACLEEND box;": [
        "3:1 IRL121 'OBSTACEL' is no word of the language; did you mean OBSTACLE?"
    ],
    "MOVE LIN p WITH JOINTLMIT p, q;": [
        "3:17 IRL121 'JOINTLMIT' is no word of the language; did you mean JOINTLIMIT?"
    ],
    "x := 5; // don't\ny := 6;": ["3:9 IRL123 '//' is not known here"],
    "x := 5; /* first\nsecond */ y := 6;": ["3:9 IRL123 '/*' is not known here"],
    "a := x => y;": ["3:8 IRL123 '=>' is not known here"],
    "IF x = 1 && a THEN\n  y := 1;\nENDIF;": ["3:10 IRL123 '&&' is not known here"],
    "WRITELN(„text“);": ["3:9 IRL123 the quote „ is not known here"],
    "IF a THEN\n  x := 1;\nELSE IF b THEN\n  y := 1;\nELSE IF a THEN\n  x := 2;\nELSE\n  y := 2;\nENDIF;": [
        "5:1 IRL125 ELSE IF begins a second IF, and there is no ENDIF for it",
        "7:1 IRL125 ELSE IF begins a second IF, and there is no ENDIF for it",
    ],
    "IF a THEN\n  x := 1;\nELSE IF b THEN\n  y := 1;\nENDIF;\nENDIF;": [],
    "CASE n OF\n  WHEN 1:\n    IF a THEN\n      y := 1;\n  WHEN 2:\n    y := 2;\nENDCASE;": [
        "7:3 IRL107 missing ENDIF for the IF of line 5, found the keyword WHEN"
    ],
    "WHILE a DO\n  x := 1;\nEND WHILE;": [
        "5:1 IRL121 'END' is no word of the language; did you mean ENDWHILE?"
    ],
    "{ one\n  line more\nx := 1;": ["3:1 IRL110 comment without end"],
    "{ one\nx := 1;\ny = 2;\nz := 3;\n{ two }\ny := 4;\n\nWRITELN('a);": [
        "3:1 IRL110 comment without end",
        "5:3 IRL105 '=' taken for ':='",
        "10:9 IRL111 text without closing '",
    ],
    "{ one\nx := 1;\n{ two }\ny := 2;": [
        "3:1 IRL126 this comment holds the beginning of another one, in line 5"
    ],
    "{ one\nx := ;\ny := 3;\n{ two }\ny := ;": [
        "3:1 IRL110 comment without end",
        "4:6 IRL101 expected a value, found ';'",
        "7:6 IRL101 expected a value, found ';'",
    ],
    "RETURN\nx := 5;": ["3:7 IRL102 missing ';' after the RETURN"],
    "RETURN\nr[2] := 5;": ["3:7 IRL102 missing ';' after the RETURN"],
    "x := 5\ny := 6;": ["3:7 IRL102 missing ';' after the assignment"],
    "x := 5 y := 6;": ["3:7 IRL102 missing ';' after the assignment"],
    "WRITELN(x)\ny := 6;": ["3:11 IRL102 missing ';' after the call of 'WRITELN'"],
    "IF a THEN x := 1; ENDIF\ny := 6;": ["3:24 IRL102 missing ';' after the ENDIF"],
    "x := 5": ["3:7 IRL103 missing ';' after the assignment"],
    "REPEAT x := 5 UNTIL a;": ["3:14 IRL103 missing ';' after the assignment"],
    "CYCLICSTART\nCYCLICEND;": ["3:12 IRL103 missing ';' after the CYCLICSTART"],
    "IF a\n  x := 1;\nENDIF;": ["3:5 IRL104 missing THEN after the condition of IF"],
    "WHILE a\n  x := 1;\nENDWHILE;": ["3:8 IRL104 missing DO after the condition of WHILE"],
    "x = 5;": ["3:3 IRL105 '=' taken for ':='"],
    "MOVE LIN p SPEED = 5;": ["3:18 IRL105 '=' taken for ':='"],
    "x := ENDIF;": ["3:6 IRL106 ENDIF is a keyword and cannot be a name"],
    "MOVE LIN LIN;": ["3:10 IRL106 LIN is a keyword and cannot be a name"],
    "x := a < b < 3;": ["3:12 IRL115 comparisons cannot be chained"],
    "x := y +;\ny := 1;": ["3:9 IRL101 expected a value, found ';'"],
    "x := 1 2;": ["3:8 IRL101 expected ';', found the number 2"],
    "x y;": ["3:2 IRL102 missing ';' after the call of 'x'"],
    "MOVE p;": ["3:6 IRL101 expected CIRCLE, LIN, PTP or SPLINE, found the name 'p'"],
    "MOVE LIN;": ["3:9 IRL101 expected a value, found ';'"],
    "WAIT 5;": ["3:7 IRL120 missing SEC before ';'"],
    "x := (1;\ny := 2;": ["3:8 IRL120 missing ')' before ';'"],
    "x := r[1;": ["3:9 IRL120 missing ']' before ';'"],
    "x := 1);": ["3:7 IRL108 ')' without '('"],
    "a < b;": ["3:3 IRL101 expected ':=', '(' or ';', found '<'"],
    "FOR x 1 TO 3 DO\n  y := 1;\nENDFOR;\ny := 2;": ["3:6 IRL120 missing ':=' before the number 1"],
    "FOR x := 1 TO DO\n  y := 1;\nENDFOR;": ["3:15 IRL101 expected a value, found the keyword DO"],
    "IF a b THEN\n  y := 1;\nELSE\n  y := 2;\nENDIF;": ["3:6 IRL101 expected THEN, found the name 'b'"],
    "CASE x OF\nWHEN 1 2: y := 1;\nWHEN 3: y := 2;\nENDCASE;": [
        "4:8 IRL101 expected ':', ',' or '..', found the number 2"
    ],
    "WHILE a DO\n  x := 1;\nENDIF;\ny := 2;": [
        "5:1 IRL107 missing ENDWHILE for the WHILE of line 3, found the keyword ENDIF"
    ],
    "WHILE a DO\n  IF b THEN\n    x := 1;\nENDWHILE;\ny := 2;": [
        "6:1 IRL107 missing ENDIF for the IF of line 4, found the keyword ENDWHILE"
    ],
    "WHILE a DO\n  x := 1;\n  ENDIF;\nENDWHILE;": ["5:3 IRL108 ENDIF without IF"],
    "ENDIF;\nx := 1;": ["3:1 IRL108 ENDIF without IF"],
    "x := 'abc;\ny := 2;": ["3:6 IRL111 text without closing '"],
    "x := 5 § 3;\ny := 2;": ["3:8 IRL112 '§' (U+00A7) has no meaning outside texts and comments"],
    "x := 1E999;": ["3:6 IRL113 number outside the range of REAL"],
    "MOVE LIN p WITH RECONFIGURATION j SPEED := 5;": [
        "3:35 IRL114 'SPEED' stands after WITH or out of order in the MOVE"
    ],
}


@pytest.mark.req("LANG-05")
@pytest.mark.req("LANG-44")
@pytest.mark.parametrize("text", CASES)
def test_mistake_in_a_body(analysed, text):
    assert sorted(told(analysed(in_body(text)))) == sorted(CASES[text])


BESIDE = [
    "WAIT 0,5 SEC;",
    "x := y +;",
    "MOVE LIN p WITH JOINTLIMIT (1, 2, 3);",
    "IF a THEN x := 1; END_IF;",
    "x := (1;",
    "x := 1);",
    "MOVE LIN p",
    "x := 5,",
    "x := 5",
]


@pytest.mark.req("LANG-05")
@pytest.mark.parametrize("mistake", BESIDE)
def test_statements_beside_a_mistake_are_looked_at(analysed, mistake):
    """A wrong type is told although a statement next to it has a mistake; what was guessed is not judged."""
    wrong = "IRL222 expected INT, found REAL"
    alone = told(analysed(in_body(f"{mistake}\nn := 7;")))
    assert len(alone) == 1
    assert told(analysed(in_body(f"{mistake}\nn := 7 / 2;"))) == [*alone, f"4:6 {wrong}"]
    before = told(analysed(in_body(f"n := 7 / 2;\n{mistake}\nn := 7;")))
    assert before == [f"3:6 {wrong}", alone[0].replace("3:", "4:", 1)]


@pytest.mark.req("LANG-05")
@pytest.mark.parametrize(
    "text",
    [
        "n := 1 2;",
        "n := r[1 + p;",
        "b := n ; 0;",
        "b := n and\n  r[ + 1;",
        "x := 5 n := 7 / 2;",
    ],
)
def test_what_stands_in_a_statement_with_a_mistake_is_not_judged(analysed, text):
    assert len(analysed(in_body(text)).diagnostics) == 1


WHOLE = {
    "": ["1:1 IRL117 the file holds no program"],
    "x": ["1:1 IRL116 expected PROGRAM, MODULE or DATALIST at the start, found the name 'x'"],
    "PROGRAM t\nBEGIN ENDPROGRAM": ["1:10 IRL102 missing ';' after the PROGRAM"],
    "PROGRAM t; VAR REAL: begin; BEGIN ENDPROGRAM": ["1:22 IRL106 BEGIN is a keyword and cannot be a name"],
    "PROGRAM t;\nVAR REAL a;\n  INT: b;\nBEGIN b := 1; ENDPROGRAM": [
        "2:9 IRL120 missing ':' before the name 'a'"
    ],
    "PROGRAM t;\nTYPE RECORD REAL a; ENDRECORD = X;\nVAR X: b;\nBEGIN ENDPROGRAM": [
        "2:17 IRL120 missing ':' before the name 'a'"
    ],
    "PROGRAM t;\nTYPE RECORD REAL: a; ENDRECORD X;\nVAR X: b;\nBEGIN ENDPROGRAM": [
        "2:31 IRL120 missing '=' before the name 'X'"
    ],
    "PROGRAM t;\nPROCEDURE p(INT x; INT: y);\nBEGIN\nENDPROC;\nBEGIN p(1, 2); ENDPROGRAM": [
        "2:16 IRL120 missing ':' before the name 'x'"
    ],
    "PROGRAM t;\nBEGIN\n  HALT;\n": [
        "4:1 IRL107 missing ENDPROGRAM for the PROGRAM of line 1, found the end of the file"
    ],
    "PROGRAM t;\nPROCEDURE p;\nBEGIN\n  HALT;\nBEGIN\nENDPROGRAM": [
        "5:1 IRL107 missing ENDPROC for the PROCEDURE of line 2, found the keyword BEGIN",
    ],
    "PROGRAM t; BEGIN ENDPROGRAM; x := 1;": [
        "1:30 IRL109 nothing may follow the end of the program, found the name 'x'"
    ],
    "PROGRAM t; BEGIN { ENDPROGRAM": ["1:18 IRL110 comment without end"],
    "PROGRAM t; BEGIN (*) ENDPROGRAM": ["1:18 IRL110 comment without end"],
}


@pytest.mark.req("LANG-05")
@pytest.mark.parametrize("text", WHOLE)
def test_mistake_in_a_file(analysed, text):
    assert told(analysed(text)) == WHOLE[text]


@pytest.mark.req("LANG-05")
def test_tree_of_the_rest_is_kept(analysed):
    analysis = analysed(in_body("x := 1;\ny := );\nz := 3;\nIF a THEN z := ; x := 2; ENDIF;\nx := 4;"))
    assert len([d for d in analysis.diagnostics if d.is_error]) == 2
    kept = analysis.tree.body
    assert [type(s) for s in kept] == [tree.Assignment, tree.Assignment, tree.If, tree.Assignment]
    assert len(kept[2].branches[0].body) == 1


@pytest.mark.req("LANG-05")
def test_reports_stop_at_twenty(analysed):
    assert len(analysed(in_body("x := ;\n" * 100)).diagnostics) == 20


@pytest.mark.req("LANG-05")
def test_mistakes_far_apart_are_each_reported_once(analysed):
    mistakes = ["x := ;", "MOVE LIN p", "IF a b THEN x := 1; ENDIF;", "y := (1;", "ENDFOR;", "z := r[;"]
    filler = "y := 1;\n" * 20
    analysis = analysed(in_body("".join(filler + mistake + "\n" for mistake in mistakes) + filler))
    assert [d.place.line for d in analysis.diagnostics] == [23 + 21 * k for k in range(len(mistakes))]


@pytest.mark.req("LANG-05")
@pytest.mark.parametrize(
    "text",
    [
        "x := " + "(" * 10_000 + "1" + ")" * 10_000 + ";",
        "x := " + "NOT " * 10_000 + "a;",
        "x := 1" + " + 1" * 10_000 + ";",
        "x := " + "r[" * 10_000 + "1" + "]" * 10_000 + ";",
        "IF a THEN " * 10_000 + "ENDIF; " * 10_000,
    ],
)
def test_deep_nesting_is_a_coded_error(analysed, text):
    assert [d.code for d in analysed(in_body(text)).diagnostics] == ["IRL118"]


@pytest.mark.req("LANG-44")
def test_lenient_forms_give_the_same_tree(analysed):
    strict = in_body("IF a THEN x := 1; ENDIF; WHILE a DO x := 1; ENDWHILE; MOVE LIN p, SPEED := 5; x := 2;")
    lenient = in_body("IF a x := 1; ENDIF; WHILE a x := 1; ENDWHILE; MOVE LIN p SPEED:=5; x = 2;")
    assert analysed(strict).tree == analysed(lenient).tree
    assert not analysed(strict).diagnostics
    assert not analysed(lenient).has_errors
