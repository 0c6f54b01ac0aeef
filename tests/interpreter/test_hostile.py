"""Programs without end or measure: a coded error at the place, within bounded time and memory."""

import tracemalloc

import pytest

from irlx.diagnostics import Span
from irlx.interpreter.code import Code
from irlx.interpreter.errors import InterpreterError
from irlx.interpreter.interpret import interpret
from irlx.interpreter.machine import Machine
from irlx.language.analysis import analyse
from irlx.language.source import source_text

pytestmark = pytest.mark.req("QA-08")


@pytest.fixture
def ended(setting):
    """Code and marked text of the error that ends a program, and the number of blocks before it."""

    def run(declarations, body, max_steps=20_000):
        text = f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM"
        analysis = analyse(source_text("t.irl", text))
        found = []
        with pytest.raises(InterpreterError) as caught:
            found.extend(interpret(analysis.tree, analysis.source, setting(), max_steps=max_steps))
        place = caught.value.reason.place
        return caught.value.reason.code, text[place.span.start : place.span.end], len(found)

    return run


LOOPS = [
    ("WHILE TRUE DO ENDWHILE;", "TRUE"),
    ("REPEAT UNTIL FALSE;", "FALSE"),
    ("again: GOTO again;", "GOTO again"),
    ("FOR i := 1 TO 9223372036854775807 DO ENDFOR;", "i"),
    ("FOR x := 0 TO 1E300 STEP 1E-300 DO ENDFOR;", "x"),
    ("WHILE TRUE DO p; ENDWHILE;", None),
    ("one: GOTO two; two: GOTO one;", None),
]


@pytest.mark.parametrize(("body", "marked"), LOOPS)
def test_loops_without_end(ended, body, marked):
    code, text, _ = ended("VAR INT: i; REAL: x; PROCEDURE p; BEGIN ENDPROC;", body)
    assert code == "IRL510"
    assert marked in (None, text)


def test_a_loop_that_moves_without_end(ended):
    code, _, blocks = ended("", "WHILE TRUE DO CYCLICSTART; CYCLICEND; ENDWHILE;", max_steps=3000)
    assert code == "IRL510"
    assert 1900 < blocks < 2001


RECURSION = [
    "PROCEDURE p; BEGIN p; ENDPROC;",
    "PROCEDURE p; BEGIN q; ENDPROC; PROCEDURE q; BEGIN p; ENDPROC;",
    "FUNCTION f(INT: n): INT; BEGIN RETURN 1 + f(n + 1); ENDFCT; PROCEDURE p; BEGIN f(1); ENDPROC;",
    "PROCEDURE r(VAR INT: n); BEGIN r(n); ENDPROC; PROCEDURE p; VAR INT: i; BEGIN r(i); ENDPROC;",
]


@pytest.mark.parametrize("declarations", RECURSION)
def test_recursion_without_end(ended, declarations):
    assert ended(declarations, "p;", max_steps=100_000)[0] == "IRL511"


def test_ten_thousand_calls_may_wait(ended, final):
    declarations = """VAR INT: i;
    FUNCTION f(INT: n): INT; BEGIN IF n = 1 THEN RETURN 1; ENDIF; RETURN f(n - 1) + 1; ENDFCT;"""
    assert final(declarations, "i := f(10000);")["i"] == 10_000
    assert ended(declarations, "i := f(10001);", max_steps=100_000)[0] == "IRL511"


def test_references_handed_on_a_thousand_times(final):
    declarations = """VAR INT: i := 0; ARRAY [1..2] OF INT: a := (1, 2);
    PROCEDURE r(VAR INT: n; INT: depth); BEGIN
      IF depth > 0 THEN r(n, depth - 1); ELSE n := n + 1; ENDIF; ENDPROC;"""
    assert final(declarations, "r(a[2], 9000);")["a"] == (1, 3)


def test_parts_of_parts_handed_on_are_bounded(ended):
    """Each call hands on a part of what it got, so that the way to it grows with the depth."""
    declarations = """TYPE ARRAY [1..1] OF INT = one; VAR one: a := (1);
    PROCEDURE r(VAR one: list; INT: depth); BEGIN list[1] := depth; r(list, depth + 1); ENDPROC;"""
    assert ended(declarations, "r(a, 1);", max_steps=100_000)[0] == "IRL511"


def test_large_local_arrays_in_recursion(ended):
    declarations = """PROCEDURE p; VAR ARRAY [1..1000000] OF INT: a; BEGIN a[1] := 1; p; ENDPROC;"""
    tracemalloc.start()
    try:
        assert ended(declarations, "p;")[0] == "IRL511"
        assert tracemalloc.get_traced_memory()[1] < 400e6
    finally:
        tracemalloc.stop()


def test_arrays_of_arrays_are_bounded(ended):
    assert ended("VAR ARRAY [1..10000] OF ARRAY [1..10000] OF REAL: v;", "")[0] == "IRL507"
    record = "TYPE RECORD ARRAY [1..1000000] OF REAL: a; ENDRECORD = r; VAR ARRAY [1..1000] OF r: v;"
    assert ended(record, "")[0] == "IRL507"


def test_texts_are_bounded(ended):
    code, text, _ = ended("VAR STRING: s := 'abc';", "WHILE TRUE DO s := s + s; ENDWHILE;")
    assert (code, text) == ("IRL512", "s + s")


def test_numbers_are_bounded(ended):
    assert ended("VAR INT: i := 2;", "WHILE TRUE DO i := i * i; ENDWHILE;")[0] == "IRL503"
    assert ended("VAR REAL: x := 2;", "WHILE TRUE DO x := x * x; ENDWHILE;")[0] == "IRL503"


def test_nested_as_deeply_as_the_parser_takes(final):
    depth = 20
    expression = "1" + " + (i * -(1" * (depth // 2) + "))" * (depth // 2)
    loops = "IF TRUE THEN " * 60 + f"i := {expression};" + " ENDIF;" * 60
    assert isinstance(final("VAR INT: i := 1;", loops)["i"], int)


DEEP = [
    ("REAL", "SQRT(" * 98 + "1" + ")" * 98),
    ("REAL", "DISTANCE((" * 45 + "1" + ", 0, 0), (0, 0, 0))" * 45),
    ("INT", "-(" * 70 + "1" + ")" * 70),
    ("BOOL", "NOT (TRUE AND " * 45 + "FALSE" + ")" * 45),
    ("INT", "v[" * 70 + "1" + "]" * 70),
    ("INT", "f(" * 98 + "1" + ")" * 98),
]


@pytest.mark.parametrize(("type", "expression"), DEEP)
def test_deep_expressions_have_values(final, type, expression):
    declarations = f"""VAR ARRAY [1..1] OF INT: v := (1); FUNCTION f(INT: n): INT; BEGIN RETURN n; ENDFCT;
    VAR {type}: x; VAR {type}: y := {expression};"""
    found = final(declarations, f"x := {expression};")
    assert found["x"] == found["y"]


def test_a_stack_of_python_that_runs_out_is_told_at_the_statement():
    """Whatever the depth of the caller's own stack: there is no RecursionError."""

    def endless(frame):
        return endless(frame)

    source = source_text("t.irl", "x := 1;")
    with pytest.raises(InterpreterError) as caught:
        list(Machine().run(Code(source, [endless], [Span(0, 6)])))
    assert (caught.value.reason.code, caught.value.reason.place.span) == ("IRL513", Span(0, 6))


def test_memory_of_a_long_loop_does_not_grow(generator):
    text = """PROGRAM t; VAR INT: i; POSITION: p := (0, 0, 0); STRING: s;
    FUNCTION f(POSITION: p): POSITION; BEGIN RETURN p + POSITION(1, 0, 0); ENDFCT;
    BEGIN FOR i := 1 TO 1000000 DO p := f(p); s := 'a' + 'b'; MOVE LIN p; ENDFOR; ENDPROGRAM"""
    source = generator(text)
    for _ in range(2000):
        next(source)
    tracemalloc.start()
    try:
        for _ in range(1500):
            next(source)
        assert tracemalloc.get_traced_memory()[0] < 15_000
    finally:
        tracemalloc.stop()
