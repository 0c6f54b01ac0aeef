"""What colours a program says the same of it as the lexer and the tree of irlx."""

from itertools import accumulate
from unicodedata import normalize

import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from compiled_grammar import build_grammar
from irlx.language import tree
from irlx.language.analysis import analyse
from irlx.language.builtins import (
    BARE_FUNCTIONS,
    FUNCTIONS,
    PROCEDURES,
    SYSTEM_VARIABLES,
    TYPES,
    is_port_name,
)
from irlx.language.highlight import Kind, pieces
from irlx.language.highlight.words import keyword_kinds, sign_kinds
from irlx.language.keywords import NAMES_TOO, keyword_table
from irlx.language.lexing import lex
from irlx.language.source import source_text
from random_programs import PROGRAMS

RELAXED = settings(
    suppress_health_check=list(HealthCheck), deadline=None, derandomize=True, phases=[Phase.generate]
)
KEYWORDS = {
    Kind.DECLARATION,
    Kind.CONTROL,
    Kind.MOTION,
    Kind.REDUNDANCY,
    Kind.WORD_OPERATOR,
    Kind.CONSTANT,
}
UNSEEN = {Kind.SPACE, Kind.COMMENT, Kind.INSTRUCTION}
TERMINALS = {"INT": Kind.INT, "REAL": Kind.REAL, "STRING": Kind.STRING}


def spans(text):
    """Kind of each piece that is not between lexemes, by its span."""
    found = list(pieces(text))
    ends = list(accumulate(len(piece.text) for piece in found))
    return {
        (end - len(piece.text), end): piece.kind
        for piece, end in zip(found, ends, strict=True)
        if piece.kind not in UNSEEN
    }


def expected_of(node):
    """What the tree says of names: each with the kind that it should have."""
    match node:
        case tree.NamedType(name=name):
            yield name, Kind.TYPE if name.key in TYPES else Kind.OWN_TYPE
        case tree.TypeDefinition(name=name):
            yield name, Kind.TYPE if name.key in TYPES else Kind.OWN_TYPE
        case tree.FunctionCall(name=name):
            kind = Kind.TYPE if name.key in TYPES else Kind.ROUTINE
            yield name, Kind.FUNCTION if name.key in FUNCTIONS and name.key not in TYPES else kind
        case tree.Call(name=name):
            yield name, Kind.PROCEDURE if name.key in PROCEDURES else Kind.ROUTINE
        case tree.ProcedureDeclaration(name=name) | tree.FunctionDeclaration(name=name):
            yield name, Kind.ROUTINE
        case tree.Program(name=name) | tree.Module(name=name) | tree.DataList(name=name):
            yield name, Kind.PART
        case tree.ImportFrom(module=name) | tree.ImportDatalist(name=name):
            yield name, Kind.PART
        case tree.Label(name=name) | tree.Goto(label=name):
            yield name, Kind.LABEL
        case tree.MoveParam(name=name):
            yield name, Kind.PARAMETER
        case tree.Designator(base=name):
            yield name, used(name.key)


def used(key):
    if key in SYSTEM_VARIABLES:
        return Kind.SYSTEM_VARIABLE
    if key in BARE_FUNCTIONS:
        return Kind.FUNCTION
    return Kind.PORT if is_port_name(key) else Kind.NAME


def agrees_with_the_tree(text):
    """Compare a text with its tokens and its tree; False where it has mistakes, or what irlx forgives."""
    source = source_text("t.irl", text)
    analysis = analyse(source)
    if any(one.code.startswith("IRL1") for one in analysis.diagnostics):
        return False
    found, lexed, root = spans(source.text), lex(source), analysis.tree
    assert list(found) == [(token.start_pos, token.end_pos) for token in lexed.tokens]
    inside, wanted = set(), {}
    for node in tree.walk(root):
        if isinstance(node, tree.Name | tree.Field):
            # Names of fields may hold dots, and blanks beside them.
            inside.update(range(node.span.start, node.span.end))
        wanted |= {(name.span.start, name.span.end): kind for name, kind in expected_of(node)}
    before = None
    for token in lexed.tokens:
        span = token.start_pos, token.end_pos
        kind = found[span]
        if token.type in set(keyword_table().values()) and token.start_pos not in inside:
            assert kind is keyword_kinds()[token.type], token
        elif token.type == "NAME" or token.type in NAMES_TOO:
            assert kind not in KEYWORDS, token
            assert (kind is Kind.FIELD) is (before == "."), token
            assert kind is wanted.get(span, kind), token
        else:
            assert kind is (TERMINALS.get(token.type) or sign_kinds()[str(token)]), token
        before = token
    assert Kind.WRONG not in found.values()
    return True


@pytest.mark.req("LANG-04")
def test_every_program_is_coloured_as_it_is_read(sources):
    assert sum(agrees_with_the_tree(text) for text in sources.values()) > 200


@settings(RELAXED, max_examples=40)
@given(PROGRAMS)
def test_every_form_of_the_grammar_is_coloured_as_it_is_read(text):
    assume(agrees_with_the_tree(text))


def test_texts_with_mistakes_fall_apart_where_the_lexer_says(sources):
    texts = [*sources.values(), "x := a == b && 'open\ny := “a”; // c\n/* d */ § { open", "(* { *) } 'a'"]
    grammar = build_grammar()
    for text in texts:
        normal = source_text("t.irl", text).text
        assert "".join(piece.text for piece in pieces(normal)) == normal
        whole = [token for token in grammar.lex(normal) if token.type != "COMMENT"]
        assert list(spans(normal)) == [(token.start_pos, token.end_pos) for token in whole]


WORDS = st.sampled_from(
    [
        *keyword_table(),
        "POSE",
        "x",
        "1.",
        "3",
        "..",
        ":=",
        "'",
        '"',
        "{",
        "}",
        "(*",
        "*)",
        "§",
        "é",
        "e\u0301",
        ";",
    ]
)
TEXTS = st.one_of(st.text(), st.lists(WORDS).map(" ".join), st.lists(WORDS).map("".join))


@settings(RELAXED, max_examples=200)
@given(TEXTS)
def test_any_text_comes_out_as_it_went_in(text):
    found = list(pieces(text))
    assert "".join(piece.text for piece in found) == text
    assert all(piece.text for piece in found)


@settings(RELAXED, max_examples=50)
@given(TEXTS)
def test_case_changes_nothing(text):
    upper, lower = text.upper(), text.upper().lower()
    if len(upper) == len(lower):
        assert [piece.kind for piece in pieces(upper)] == [piece.kind for piece in pieces(lower)]


def test_letters_of_two_signs_are_one_letter(sources):
    for text in [*sources.values(), "PROGRAM s\u0301ciana; { e\u0301 }"]:
        apart = normalize("NFD", text)
        found = list(pieces(apart))
        assert "".join(piece.text for piece in found) == apart
        kinds = [piece.kind for piece in pieces(normalize("NFC", text))]
        assert [piece.kind for piece in found] == kinds


def kinds_in(text):
    return {piece.text: piece.kind for piece in pieces(text)}


def test_comments():
    text = (
        "x := 1; { a { b } y := 2; (* c } *) { irlx: ignore IRL205, IRL206 } (*IRLX: ignore IRL205*) { open"
    )
    comments = [(piece.kind, piece.text) for piece in pieces(text) if piece.kind in UNSEEN - {Kind.SPACE}]
    assert comments == [
        (Kind.COMMENT, "{ a { b }"),
        (Kind.COMMENT, "(* c } *)"),
        (Kind.INSTRUCTION, "{ irlx: ignore IRL205, IRL206 }"),
        (Kind.INSTRUCTION, "(*IRLX: ignore IRL205*)"),
        (Kind.COMMENT, "{ open"),
    ]


def test_numbers_and_texts():
    text = '42 180. .5 1.5E-3 1..5 \'it\'\'s\' "say ""so""" \'open'
    assert [(piece.kind, piece.text) for piece in pieces(text) if piece.kind is not Kind.SPACE] == [
        (Kind.INT, "42"),
        (Kind.REAL, "180."),
        (Kind.REAL, ".5"),
        (Kind.REAL, "1.5E-3"),
        (Kind.INT, "1"),
        (Kind.OPERATOR, ".."),
        (Kind.INT, "5"),
        (Kind.STRING, "'it''s'"),
        (Kind.STRING, '"say ""so"""'),
        (Kind.WRONG, "'open"),
    ]


def test_a_part_of_a_program_is_coloured_like_the_whole():
    found = kinds_in(
        "again: MOVE LIN p2 SPEED := r_speed, C_CP := 3 WITH TOLERANCE (1, 2);\n speed := IN_3; pick;"
    )
    assert found["again"] is Kind.LABEL
    assert found["SPEED"] is found["C_CP"] is Kind.PARAMETER
    assert found["r_speed"] is Kind.SYSTEM_VARIABLE
    assert found["speed"] is found["p2"] is Kind.NAME
    assert found["TOLERANCE"] is Kind.MOTION
    assert found["IN_3"] is Kind.PORT
    assert found["pick"] is Kind.ROUTINE


def test_words_that_are_keywords_in_some_places_only():
    text = "FOR to := 1 TO 3 STEP step DO WAIT sec SEC; MOVE LIN frame IN FRAME at; ENDFOR;"
    kinds = [piece.kind in KEYWORDS for piece in pieces(text) if piece.kind not in UNSEEN]
    words = [piece.text for piece in pieces(text) if piece.kind not in UNSEEN]
    names = [word for word, is_keyword in zip(words, kinds, strict=True) if not is_keyword and word.isalpha()]
    assert names == ["to", "step", "sec", "frame", "at"]


def test_every_keyword_has_a_kind_and_every_sign():
    assert set(keyword_kinds()) == set(keyword_table().values())
    assert set(keyword_kinds().values()) == KEYWORDS
    signs = {
        one.pattern.value for one in build_grammar().terminals if type(one.pattern).__name__ == "PatternStr"
    }
    assert set(sign_kinds()) == signs


def test_standard_channels():
    found = kinds_in("PROGRAM p; STANDARD_OUT = SCREEN; BEGIN screen := 1; ENDPROGRAM")
    assert found["SCREEN"] is Kind.CHANNEL
    assert found["screen"] is Kind.NAME
