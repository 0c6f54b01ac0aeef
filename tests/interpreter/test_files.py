"""OPEN, CLOSE, READ, WRITE and EOF in programs, with files in memory."""

import random

import pytest

from irlx.interpreter.channels.channels import Channels
from irlx.interpreter.channels.memory_files import MemoryFiles
from irlx.interpreter.channels.pieces import once, pieces_of
from irlx.interpreter.errors import InterpreterError
from irlx.interpreter.interpret import Interpretation
from irlx.language.analysis import analyse
from irlx.language.source import source_text
from long_run import first

DECLARATIONS = """VAR FILE: f, g; INT: i, j; REAL: x; BOOL: b; CHAR: c; STRING: s;
ARRAY [1..3] OF INT: a; ARRAY [1..70] OF FILE: fs;"""


@pytest.fixture
def run(setting):
    """Output, files, and final values of a program; `given` are files and `typed` the standard input."""

    def make(body, declarations=DECLARATIONS, given=(), typed="", checked=True):
        text = f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM"
        analysis = analyse(source_text("t.irl", text))
        if checked:
            assert not [d for d in analysis.diagnostics if d.is_error], analysis.diagnostics
        files = MemoryFiles()
        for name, content in dict(given).items():
            sink = files.open(name, "WRITE", lambda _: None).sink
            sink.write(content.encode())
        channels = Channels(files, once(typed))
        ready = Interpretation(analysis.tree, analysis.source, setting(), channels=channels)
        list(ready.run())
        values = {name: variable.value for name, variable in ready.scope.variables.items()}
        written = {name: bytes(content).decode() for name, content in files.written.items()}
        return channels.output, written, values

    return make


@pytest.fixture
def wrong(run):
    """Code, message and marked text of a program that ends in an error."""

    def make(body, **more):
        with pytest.raises(InterpreterError) as caught:
            run(body, **more)
        place = caught.value.reason.place
        marked = place.text.text[place.span.start : place.span.end]
        return caught.value.reason.code, caught.value.reason.message, marked

    return make


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize(
    ("body", "text"),
    [
        ("WRITE;", ""),
        ("WRITELN; WRITELN();", "\n\n"),
        ("WRITE(1, 2); WRITE('a'); WRITELN('b');", "12ab\n"),
        ("WRITE(1:3, 'a':2, 1.5:5:2, TRUE:5);", "  1 a 1.50 TRUE"),
        ("i := 4; WRITE(i:i + 2:i - 3);", "   4.0"),
        ("s := 'x'; WRITE(s[1], s + 'y', CHR(65));", "xxyA"),
        ("WRITE((1 + 2):4);", "   3"),
        ("WRITE(1:0, 12:1);", "112"),
        ("WRITE(1.0 / 3.0);", "0.3333333333333333"),
        ("WRITE(1:1000);", " " * 999 + "1"),
    ],
)
def test_writing(run, body, text):
    assert run(body)[0] == text


@pytest.mark.req("LANG-42")
def test_a_variable_is_open_from_open_to_close(run, wrong):
    assert run("OPEN(f, 'a', 'WRITE'); CLOSE(f); OPEN(f, 'a', 'append'); WRITE(f, 1); CLOSE(f);")[1] == {
        "a": "1"
    }
    for body in ("WRITE(f, 1);", "WRITELN(f);", "READ(f, i);", "CLOSE(f);", "b := EOF(f);"):
        assert wrong(body) == ("IRL542", "the file 'f' is not open", "f"), body
        assert wrong(f"OPEN(f, 'a', 'WRITE'); CLOSE(f); {body}")[0] == "IRL542", body
    assert wrong("OPEN(f, 'a', 'WRITE'); OPEN(f, 'b', 'WRITE');") == (
        "IRL543",
        "'f' is open already, on 'a'",
        "f",
    )
    assert wrong("WRITE(fs[2 + 1], 1);")[1] == "the file 'fs[2 + 1]' is not open"


@pytest.mark.req("LANG-42")
def test_one_file_has_one_writer(run, wrong):
    given = {"a": "1\n2\n"}
    body = "OPEN(f, 'a', 'READ'); OPEN(g, './a', 'READ'); READ(f, i); READ(f, i); READ(g, j);"
    values = run(body, given=given)[2]
    assert (values["i"], values["j"]) == (2, 1)
    for one, other in [("READ", "WRITE"), ("WRITE", "READ"), ("WRITE", "APPEND"), ("APPEND", "APPEND")]:
        code, message, marked = wrong(f"OPEN(f, 'a', '{one}'); OPEN(g, 'b/../a', '{other}');", given=given)
        assert (code, marked) == ("IRL544", "'b/../a'")
        assert f"by f to {one}" in message
    # A refused OPEN changes nothing.
    with pytest.raises(InterpreterError):
        run("OPEN(f, 'a', 'READ'); OPEN(g, 'a', 'WRITE');", given=given)


@pytest.mark.req("LANG-42")
def test_modes(wrong):
    assert wrong("OPEN(f, 'a', 'READ'); WRITE(f, 1);", given={"a": "1"})[:2] == (
        "IRL545",
        "the file 'a' is open to READ and cannot be written",
    )
    assert wrong("OPEN(f, 'a', 'APPEND'); READ(f, i);")[0] == "IRL545"
    assert wrong("OPEN(f, 'a', 'WRITE'); b := EOF(f);")[0] == "IRL545"
    assert wrong("s := 'RAED'; OPEN(f, 'a', s);") == (
        "IRL505",
        "the mode of OPEN must be 'READ', 'WRITE' or 'APPEND', found 'RAED'",
        "s",
    )


@pytest.mark.req("LANG-42")
def test_what_is_read_goes_to_variables_of_all_kinds(run):
    declarations = DECLARATIONS + "TYPE RECORD INT: n; CHAR: c; ENDRECORD = part; VAR part: p;"
    body = "READ(i, a[i], p.n, p.c, s); j := a[2]; WRITE(p.n, p.c, s, j);"
    assert run(body, declarations, typed="2 7 -1 zrest\n")[0] == "-1zrest7"


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize(
    ("body", "code", "message", "marked"),
    [
        (
            "READ(i);",
            "IRL546",
            "STANDARD_IN, line 1, column 1: expected a whole number, but this is the end",
            "i",
        ),
        ("READ(x, i);", "IRL547", "STANDARD_IN, line 2, column 2: expected a whole number, found 'b'", "i"),
        ("i := 4; READ(a[i]);", "IRL504", "index 4 of 'a' is outside 1..3", "i"),
        ("i := 1001; WRITE(1:i);", "IRL505", "the width of WRITE must be 0 to 1,000, found 1001", "i"),
        ("i := -1; WRITE(x:3:i);", "IRL501", "'x' has no value yet", "x"),
        ("i := -1; WRITE(1:3:i);", "IRL505", "the precision of WRITE must be 0 to 100, found -1", "i"),
        ("WRITE(i);", "IRL501", "'i' has no value yet", "i"),
    ],
)
def test_what_goes_wrong_has_a_place(wrong, body, code, message, marked):
    typed = "1.5\n b" if "x, i" in body else ""
    assert wrong(body, typed=typed) == (code, message, marked)


def test_what_was_read_before_stays(run):
    """The first variable is set, although the second one cannot be."""
    assert run("READ(i); WHILE NOT EOF() DO READ(j); ENDWHILE;", typed="5")[2]["i"] == 5


@pytest.mark.req("LANG-42")
def test_too_many_files(run, wrong):
    body = "FOR i := 1 TO {} DO OPEN(fs[i], 'f' + CHR(192 + i), 'WRITE'); ENDFOR;"
    assert len(run(body.format(64))[1]) == 64
    code, message, _ = wrong(body.format(65))
    assert (code, "64 files" in message) == ("IRL552", True)


@pytest.mark.req("LANG-42")
def test_bounds_of_what_is_written(wrong, monkeypatch):
    monkeypatch.setattr("irlx.interpreter.channels.channels.MOST_WRITTEN", 1000)
    monkeypatch.setattr("irlx.interpreter.channels.channels.MOST_SHOWN", 500)
    loop = "WHILE TRUE DO WRITELN({} 'abc'); ENDWHILE;"
    assert wrong("OPEN(f, 'a', 'WRITE'); " + loop.format("f,"))[:2] == (
        "IRL553",
        "the program has written too much to files: at most 1,000 bytes a run",
    )
    assert wrong(loop.format(""))[1].endswith("to STANDARD_OUT: at most 500 characters a run")


@pytest.mark.req("LANG-42")
def test_calls_in_arguments_come_in_the_order_of_the_text(run):
    """A function that reads and writes is called once, where it stands."""
    declarations = (
        DECLARATIONS
        + """
    FUNCTION next: INT; VAR INT: n; BEGIN READ(n); WRITE('<', n, '>'); RETURN n; ENDFCT;"""
    )
    body = "i := 0; WRITELN(i, next, i, next:next); WRITE(EOF(), ' ', next, EOF()); a[1] := next + 10 * next;"
    body += "WRITE(a[1]); READ(a[next], j); WRITE(a[2], j);"
    output, _, _ = run(body, declarations, typed="1 2 5 3 4 6 2 8 9")
    # 1 and 2 at width 5; the first EOF is asked before `next`, the second behind it.
    assert output == "<1><2><5>010    2\n<3>FALSE 3FALSE<4><6>64<2>89"


@pytest.mark.req("LANG-42")
def test_eof_in_conditions(run):
    body = "i := 0; WHILE NOT EOF() AND i < 2 DO READ(j); i := i + 1; ENDWHILE; WRITE(i, j);"
    assert run(body, typed="7 8 9")[0] == "28"
    assert run(body.replace("j);", "j);", 1), typed="7\n")[0] == "17"
    assert run("b := EOF() OR FALSE; WRITE(b);")[0] == "TRUE"
    assert run("WHILE NOT EOF DO READ(j); ENDWHILE; WRITE(j, EOF);", typed="4 5")[0] == "5TRUE"
    assert run("eof := TRUE; WRITE(eof);", DECLARATIONS + "VAR BOOL: eof;")[0] == "TRUE"


@pytest.mark.req("LANG-10")
def test_standard_channels_of_the_program(run, wrong):
    channels = "STANDARD_OUT = f; STANDARD_IN = g;"
    body = "OPEN(f, 'o', 'WRITE'); OPEN(g, 'i', 'READ'); READ(i); WRITE(i + 1, EOF()); CLOSE(f); CLOSE(g);"
    output, written, _ = run(body, channels + DECLARATIONS, given={"i": "41"})
    assert (output, written["o"]) == ("", "42TRUE")
    assert run("WRITE(1);", "STANDARD_OUT = screen; STANDARD_IN = keyboard;")[0] == "1"
    for body in ("WRITE(1);", "READ(i);", "b := EOF();"):
        assert wrong(body, declarations=channels + DECLARATIONS)[0] == "IRL542"


def test_initial_values_may_read(run):
    """They are read when the run begins, one after the other."""
    declarations = """FUNCTION next: INT; VAR INT: n; BEGIN READ(n); RETURN n; ENDFCT;
    VAR INT: i := next, j := next; BOOL: b := EOF();"""
    assert run("WRITE(i, ' ', j, ' ', b);", declarations, typed="3 4")[0] == "3 4 TRUE"


def test_an_open_file_is_no_value_of_a_local_variable_only(run):
    """A file that a procedure leaves open stays open until the end."""
    declarations = (
        DECLARATIONS + "PROCEDURE p; VAR FILE: l; BEGIN OPEN(l, 'a', 'WRITE'); WRITE(l, 1); ENDPROC;"
    )
    assert run("p;", declarations)[1] == {"a": "1"}
    with pytest.raises(InterpreterError, match="IRL544"):
        run("p; p;", declarations)


def test_finish_warns_of_open_files():
    channels = Channels()
    from irlx.diagnostics import Place

    channels.open("a", "WRITE", "f", Place("t.irl"))
    closed = channels.open("b", "WRITE", "g", Place("t.irl"))
    channels.close(closed)
    assert [(d.code, d.data["name"]) for d in channels.finish()] == [("IRL549", "a")]
    assert channels.finish() == []


# ---- values written and read back


def literal(text):
    return "'" + text.replace("'", "''") + "'"


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize("seed", first(3, range(6)))
def test_what_is_written_reads_back(run, seed):
    """Values of every type, extremes and duplicates among them, each on a line; compared in the program."""
    chance = random.Random(seed)
    reals = [0.0, 5e-324, 1.7976931348623157e308, 0.1, 1 / 3, 1e16, 1e22, 2.0**53 + 2]
    reals += [chance.uniform(0, 1) * 10.0 ** chance.randint(-307, 307) for _ in range(30)]
    ints = [0, 0, 1, 2**63 - 1, *(chance.randint(0, 2**63 - 1) for _ in range(10))]
    signs = "aż ś€𝄞'\"{};:,()\t\x01\u00a0"
    texts = [
        "",
        "'",
        '"',
        " ",
        "''",
        *("".join(chance.choices(signs, k=chance.randint(1, 9))) for _ in range(30)),
    ]
    reals, ints = reals + [-x for x in reals], ints + [-i for i in ints]
    pairs = [
        *(("x", repr(x)) for x in reals),
        *(("i", str(i)) for i in ints),
        *(("s", literal(s)) for s in texts),
    ]
    pairs += [("b", "TRUE"), ("b", "FALSE"), ("c", literal("'")), ("c", literal("ż"))]
    chance.shuffle(pairs)
    before, after = ["OPEN(f, 'v.txt', 'WRITE');"], ["OPEN(f, 'v.txt', 'READ');"]
    for at, (name, text) in enumerate(pairs):
        layout = ":30" if name in "xi" and chance.random() < 0.3 else ""
        before.append(f"{name} := {text}; WRITELN(f, {name}{layout});")
        ends = ", ends" if name == "c" else ""
        after.append(f"READ(f, {name}{ends}); IF {name} <> {text} THEN WRITE({at}, ' '); ENDIF;")
    body = "\n".join([*before, "CLOSE(f);", *after, "WRITE(EOF(f)); CLOSE(f);"])
    output, written, _ = run(body, DECLARATIONS + "VAR CHAR: ends;")
    assert output == "TRUE"
    # And Python agrees with what stands in the file.
    lines = written["v.txt"].split("\n")
    for (name, text), line in zip(pairs, lines, strict=False):
        if name == "x":
            assert float(line) == float(text)
        elif name == "i":
            assert int(line) == int(text)
        elif name == "s":
            assert literal(line) == text


class Bytes:
    """A file of bytes in short pieces."""

    def __init__(self, content, size):
        self.content, self.size = content, size

    def readline(self, most):
        piece, self.content = self.content[: self.size], self.content[self.size :]
        return piece


@pytest.mark.parametrize("size", [1, 2, 3, 1000])
def test_bytes_of_an_input(size):
    pull = pieces_of(Bytes("\ufeffża\r\nb\rc\r".encode(), size), "STANDARD_IN")
    assert "".join(iter(pull, "")) == "ża\nb\rc\r"


@pytest.mark.parametrize("size", [1, 2, 1000])
def test_an_input_that_is_no_text(size):
    from irlx.interpreter.channels.fault import ChannelFault

    pull = pieces_of(Bytes(b"ab\xc5\xbcd\xffe", size), "STANDARD_IN")
    with pytest.raises(ChannelFault) as caught:
        list(iter(pull, ""))
    assert (caught.value.code, caught.value.data["offset"]) == ("IRL550", 5)
