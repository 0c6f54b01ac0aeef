"""The formatter declares ports that a program uses by their own names, and does nothing else to it."""

import random

import pytest

import irlx
from irlx.cli.main import main
from irlx.language import format as formatter
from irlx.language.analysis import analyse
from irlx.language.format import format_source
from irlx.language.source import source_text

pytestmark = [pytest.mark.req("LANG-44"), pytest.mark.req("LANG-74")]


def declared(text):
    """Lines of a formatted text, its findings gone; formatted once more it stays."""
    formatted = format_source(text)
    assert format_source(formatted) == formatted
    assert "IRL205" not in codes(formatted)
    return formatted.splitlines()


def codes(text):
    return [found.code for found in analyse(source_text("p.irl", text)).diagnostics]


def test_ports_of_each_kind_in_the_order_of_their_numbers():
    body = "OUT_10 := IN_3; OUT_2 := in_1 AND IN_12; AOUT_1 := AIN_2 * 2; OUT_2 := FALSE;"
    assert declared(f"PROGRAM p; BEGIN {body} ENDPROGRAM")[1:6] == [
        "VAR",
        "  INPUT BOOL: in_1 AT 1, IN_3 AT 3, IN_12 AT 12;",
        "  INPUT REAL: AIN_2 AT 2;",
        "  OUTPUT BOOL: OUT_2 AT 2, OUT_10 AT 10;",
        "  OUTPUT REAL: AOUT_1 AT 1;",
    ]


PLACES = {
    "PROGRAM p;\nBEGIN\n@": ["PROGRAM p;", "VAR", "  OUTPUT BOOL: OUT_1 AT 1;", "BEGIN"],
    "PROGRAM p;\nVAR INT: a; { how many }\n{ first }\nBEGIN\n@": [
        "PROGRAM p;",
        "VAR",
        "  INT: a;  { how many }",
        "  OUTPUT BOOL: OUT_1 AT 1;",
        "{ first }",
        "BEGIN",
    ],
    "PROGRAM p; VAR INPUT BOOL: b AT 2;\nINT: a;\nBEGIN @": [
        "PROGRAM p;",
        "VAR",
        "  INPUT BOOL: b AT 2;",
        "  OUTPUT BOOL: OUT_1 AT 1;",
        "  INT: a;",
        "BEGIN",
    ],
    "PROGRAM p; CONST INT: c := 1; { one }\nPROCEDURE q;\nVAR INT: a;\nBEGIN @ ENDPROC;\nBEGIN q;": [
        "PROGRAM p;",
        "CONST",
        "  INT: c := 1;  { one }",
        "",
        "VAR",
        "  OUTPUT BOOL: OUT_1 AT 1;",
        "PROCEDURE q;",
        "VAR",
        "  INT: a;",
        "BEGIN",
    ],
    "PROGRAM p;  { short }\n{ What it does }\n\n{ of q }\nPROCEDURE q; BEGIN @ ENDPROC;\nBEGIN q;": [
        "PROGRAM p;  { short }",
        "{ What it does }",
        "VAR",
        "  OUTPUT BOOL: OUT_1 AT 1;",
        "",
        "{ of q }",
        "PROCEDURE q;",
        "BEGIN",
    ],
    "PROGRAM p;\n{ What it does }\nBEGIN\n@": [
        "PROGRAM p;",
        "{ What it does }",
        "VAR",
        "  OUTPUT BOOL: OUT_1 AT 1;",
        "BEGIN",
    ],
    "PROGRAM p; PROCEDURE q; BEGIN @ ENDPROC; VAR INT: n; BEGIN q;": [
        "PROGRAM p;",
        "VAR",
        "  OUTPUT BOOL: OUT_1 AT 1;",
        "PROCEDURE q;",
        "BEGIN",
    ],
}


@pytest.mark.parametrize("text", PLACES)
def test_where_declarations_go(text):
    lines = declared(f"{text.replace('@', 'OUT_1 := TRUE;')} ENDPROGRAM")
    assert lines[: len(PLACES[text])] == PLACES[text]


def test_a_module_declares_its_own():
    text = "MODULE m; EXPORT q; PROCEDURE q; BEGIN OUT_7 := TRUE; ENDPROC; ENDMODULE"
    assert "  OUTPUT BOOL: OUT_7 AT 7;" in declared(text)


def test_a_variable_that_reads_a_port_comes_behind_it():
    lines = declared("PROGRAM p; VAR INT: a; BOOL: b := IN_3; REAL: c; BEGIN ENDPROGRAM")
    assert lines[1:6] == ["VAR", "  INT: a;", "  INPUT BOOL: IN_3 AT 3;", "  BOOL: b := IN_3;", "  REAL: c;"]


KEPT = {
    "what is declared": "PROGRAM p;\nVAR\n  OUTPUT BOOL: out_1 AT 1;\nBEGIN\n  OUT_1 := TRUE;\nENDPROGRAM\n",
    "a local variable": (
        "PROGRAM p;\nPROCEDURE q;\nVAR\n  INT: IN_1;\nBEGIN\n  IN_1 := 2;\nENDPROC;\nBEGIN\nENDPROGRAM\n"
    ),
    "what a comment ignores": "PROGRAM p;\nBEGIN\n  OUT_1 := TRUE;  { irlx: ignore IRL205 }\nENDPROGRAM\n",
    "a data list that nobody reads": "PROGRAM p;\nIMPORT DATALIST d;\nBEGIN\n  OUT_1 := TRUE;\nENDPROGRAM\n",
    "what a module gives": "PROGRAM p;\nFROM m IMPORT OUT_1;\nBEGIN\n  OUT_1 := TRUE;\nENDPROGRAM\n",
    "a number of no port": "PROGRAM p;\nBEGIN\n  OUT_9223372036854775808 := TRUE;\nENDPROGRAM\n",
    "a comment and a text": "PROGRAM p;\n{ OUT_1 := TRUE; }\nBEGIN\n  write('IN_3');\nENDPROGRAM\n",
}


@pytest.mark.parametrize("name", KEPT)
def test_what_is_left_alone(name):
    assert format_source(KEPT[name]) == KEPT[name]


def test_the_command_looks_at_data_lists_and_cells(tmp_path, capsys):
    body = "BEGIN OUT_1 := TRUE; OUT_2 := TRUE; MOVE LIN IN_4; ENDPROGRAM"
    (tmp_path / "p.irl").write_text(f"PROGRAM p; IMPORT DATALIST d; {body}")
    (tmp_path / "d.dat").write_text("DATALIST d;\nBOOL: OUT_1 := FALSE;\nENDDATALIST\n")
    (tmp_path / "p.toml").write_text("[frames.IN_4]\nposition = [1, 2, 3]\n")
    assert main(["fmt", str(tmp_path / "p.irl")]) == 0
    text = (tmp_path / "p.irl").read_text()
    assert "  OUTPUT BOOL: OUT_2 AT 2;\n" in text
    assert "OUT_1 AT" not in text
    assert "IN_4 AT" not in text
    assert main(["fmt", "--check", str(tmp_path / "p.irl")]) == 0
    capsys.readouterr()


def test_carriage_returns_stay():
    text = "PROGRAM p;\r\nVAR INT: a;\r\nBEGIN\r\nOUT_1 = TRUE\r\nENDPROGRAM\r\n"
    formatted = format_source(text)
    assert "  OUTPUT BOOL: OUT_1 AT 1;\r\n" in formatted
    assert formatted.count("\n") == formatted.count("\r\n")


@pytest.mark.parametrize("spoiled", ["OUT_1 AT 2", "OUT_1 AT 1; INT: k", "OUT_1 AT 1; { new }"])
def test_nothing_else_may_be_added(monkeypatch, spoiled):
    """The check behind the formatter: a declaration of another port, a variable, a comment."""
    from irlx.language.format import ports

    honest = ports.declared_ports

    def wrong(reading, *around):
        made = honest(reading, *around)
        return ports.DeclaredPorts(made.text.replace("OUT_1 AT 1", spoiled), made.written, made.nodes)

    monkeypatch.setattr(formatter, "declared_ports", wrong)
    with pytest.raises(irlx.IrlxError) as caught:
        format_source("PROGRAM p; BEGIN OUT_1 := TRUE; ENDPROGRAM")
    assert caught.value.reason.code == "IRL144"


STATEMENTS = (
    "OUT_1 := IN_1;",
    "OUT_2 := TRUE;  { lamp }",
    "x := AIN_3 + 1;",
    "AOUT_1 := x;",
    "IF in_07 THEN OUT_1 := FALSE; ENDIF;",
    "{ IN_99 }",
    "q;",
    "WAIT FOR IN_2 TIMEOUT 1 SEC;",
)
PARTS = (
    "VAR REAL: x;",
    "VAR REAL: x; { x }\nINPUT BOOL: IN_2 AT 2;",
    "CONST INT: c := 3; VAR REAL: x := AIN_3;",
    "{ above }\nVAR\n\n REAL: x;\n\n{ below }\n",
)


@pytest.mark.parametrize("seed", range(40))
def test_random_programs_keep_what_they_mean(seed):
    print(f"seed {seed}")
    chance = random.Random(seed)
    some = "\n".join(chance.choices(STATEMENTS, k=chance.randrange(6)))
    inner = chance.choice(["OUT_1 := TRUE;", "", "OUT_5 := IN_5; { five }"])
    local = chance.choice(["", "VAR BOOL: OUT_1;"])
    routine = f"PROCEDURE q; {local} BEGIN {inner} ENDPROC;"
    parts = [chance.choice(PARTS), routine]
    chance.shuffle(parts)
    title = chance.choice(["", "  { title }", "\n"])
    text = f"PROGRAM p;{title}\n{' '.join(parts)}\nBEGIN\n{some}\nENDPROGRAM"
    assert not [code for code in codes(text) if code not in ("IRL205", "IRL213")]
    formatted = "\n".join(declared(text))
    assert not [code for code in codes(formatted) if code != "IRL213"]
