"""What an editor asks: uses of names, what they mean, and their types."""

import pytest

from irlx.language.analysis import analyse
from irlx.language.source import source_text

TEXT = """PROGRAM t;
TYPE RECORD INT: n; ENDRECORD = grip;
CONST INT: four := 4;
VAR ARRAY [1..four] OF grip: gs; INT: i; REAL: x;
PROCEDURE pick(VAR INT: count; REAL: i); VAR POSE: own;
BEGIN own.pos.x := i; count := count + four; ENDPROC;
FUNCTION half(REAL: a): REAL; BEGIN RETURN a / 2; ENDFCT;
BEGIN
  FOR i := 1 TO four DO gs[i].n := i; ENDFOR;
  pick(i, half(X)); x := grip(3).n;
ENDPROGRAM
"""
TEXT = TEXT.replace("x := grip(3).n;", "gs[1] := grip(3);")


def analysed(text):
    return analyse(source_text("t.irl", text))


def shown(analysis):
    """Line, text, access, and the line that declares it, of every use."""
    source = analysis.source
    return [
        (
            source.line_and_column(r.span.start)[0],
            source.text[r.span.start : r.span.end],
            r.access,
            source.line_and_column(r.symbol.name.span.start)[0],
        )
        for r in analysis.references
    ]


@pytest.mark.req("LANG-11")
def test_every_use_with_its_meaning():
    analysis = analysed(TEXT)
    assert [d.code for d in analysis.diagnostics] == ["IRL213"]
    assert shown(analysis) == [
        (4, "four", "read", 3),
        (4, "grip", "type", 2),
        (6, "own", "set", 5),
        (6, "i", "read", 5),
        (6, "count", "set", 5),
        (6, "count", "read", 5),
        (6, "four", "read", 3),
        (7, "a", "read", 7),
        (9, "i", "set", 4),
        (9, "four", "read", 3),
        (9, "gs", "set", 4),
        (9, "i", "read", 4),
        (9, "i", "read", 4),
        (10, "pick", "call", 5),
        (10, "i", "change", 4),
        (10, "half", "call", 7),
        (10, "X", "read", 4),
        (10, "gs", "set", 4),
        (10, "grip", "type", 2),
    ]


def test_symbols_have_types():
    analysis = analysed(TEXT)
    types = {key: symbol.type.name for key, symbol in analysis.symbols.items() if symbol.kind != "procedure"}
    assert types == {"four": "INT", "gs": "ARRAY [1..4] OF grip", "i": "INT", "x": "REAL", "half": "REAL"}
    assert analysis.types["grip"].type.fields[0][0] == "n"
    pick = analysis.symbols["pick"].signature
    assert [(p.name, p.types[0].name, p.by_reference) for p in pick.parameters] == [
        ("count", "INT", True),
        ("i", "REAL", False),
    ]
    assert pick.result is None
    assert analysis.symbols["half"].signature.result.name == "REAL"


def test_names_of_routines():
    analysis = analysed(TEXT)
    first, second = analysis.routines
    assert {key: symbol.kind for key, symbol in first.symbols.items()} == {
        "count": "parameter",
        "i": "parameter",
        "own": "variable",
    }
    assert analysis.source.text[first.span.start :].startswith("PROCEDURE pick")
    assert set(second.symbols) == {"a"}


def test_references_are_identical_to_the_symbols():
    analysis = analysed(TEXT)
    known = {id(symbol) for symbol in analysis.symbols.values()}
    known |= {id(symbol) for symbol in analysis.types.values()}
    known |= {id(symbol) for routine in analysis.routines for symbol in routine.symbols.values()}
    assert {id(reference.symbol) for reference in analysis.references} <= known


def test_names_of_data_lists_are_referred_to_in_their_own_text():
    points = source_text("points.dat", "DATALIST points; POSE: p; ENDDATALIST")
    text = "PROGRAM t; IMPORT DATALIST points; BEGIN MOVE LIN p; ENDPROGRAM"
    analysis = analyse(source_text("t.irl", text), data_lists=lambda *_: points)
    (reference,) = analysis.references
    assert reference.symbol.source is points
    assert reference.symbol.type.name == "POSE"


def test_partial_texts_have_what_could_be_understood():
    analysis = analysed("PROGRAM t; VAR INT: n; BEGIN n := 1; n := ; IF n > 1 THEN n := 2;")
    assert analysis.symbols["n"].type.name == "INT"
    assert [reference.symbol.name.name for reference in analysis.references][:1] == ["n"]
