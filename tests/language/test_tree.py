"""Every construct of the language gives the node that stands for it."""

from dataclasses import fields

import pytest

from compiled_grammar import build_grammar
from irlx.diagnostics import Span
from irlx.language import tree as t

AT = Span(0, 0)


def name(text):
    return t.Name(AT, text, text.casefold())


def var(text, *selectors):
    return t.Designator(AT, name(text), selectors)


def num(value):
    return t.IntLiteral(AT, value) if isinstance(value, int) else t.RealLiteral(AT, value)


def field(text):
    return t.Field(AT, text, text.casefold())


def index(*values):
    return t.Index(AT, tuple(num(v) for v in values))


def text(value):
    return t.StringLiteral(AT, value)


def param(word, value):
    return t.MoveParam(AT, name(word), value)


def assign(word, value):
    return t.Assignment(AT, var(word), num(value))


def move(kind, *targets, path=False, incremental=False, frames=(), params=(), clauses=()):
    return t.Move(AT, kind, path, incremental, targets, frames, params, clauses)


def in_frame(word):
    return t.InFrame(AT, name(word))


TRUE, FALSE = t.BoolLiteral(AT, True), t.BoolLiteral(AT, False)
P, Q = var("p"), var("q")

STATEMENTS = {
    "x := 1;": assign("x", 1),
    "X := 1;": assign("x", 1),
    "; x := 1;;": assign("x", 1),
    "p.pos.x := r[1, 2].a1.max;": t.Assignment(
        AT, var("p", field("pos"), field("x")), var("r", index(1, 2), field("a1"), field("max"))
    ),
    "pick;": t.Call(AT, name("pick"), ()),
    "pick();": t.Call(AT, name("pick"), ()),
    "pick(p, 2.5);": t.Call(AT, name("pick"), (P, num(2.5))),
    "WRITE(f, x:8, x:8:3, 'a');": t.Call(
        AT,
        name("write"),
        (
            var("f"),
            t.FormattedValue(AT, var("x"), num(8), None),
            t.FormattedValue(AT, var("x"), num(8), num(3)),
            text("a"),
        ),
    ),
    "RETURN;": t.Return(AT, None),
    "RETURN 5;": t.Return(AT, num(5)),
    "GOTO again;": t.Goto(AT, name("again")),
    "again:": t.Label(AT, name("again")),
    "EXIT;": t.Exit(AT),
    "HALT;": t.Halt(AT),
    "PAUSE;": t.Pause(AT),
    "WAIT 1.5 SEC;": t.WaitTime(AT, num(1.5)),
    "WAIT FOR x;": t.WaitFor(AT, var("x"), None),
    "WAIT FOR x TIMEOUT 5 SEC;": t.WaitFor(AT, var("x"), num(5)),
    "WAIT sec SEC;": t.WaitTime(AT, var("sec")),
    "IF x THEN ENDIF;": t.If(AT, (t.IfBranch(AT, var("x"), ()),), None),
    "IF x THEN a := 1; ELSIF y THEN b := 2; ELSE c := 3; ENDIF;": t.If(
        AT,
        (t.IfBranch(AT, var("x"), (assign("a", 1),)), t.IfBranch(AT, var("y"), (assign("b", 2),))),
        (assign("c", 3),),
    ),
    "IF x THEN ELSE ENDIF;": t.If(AT, (t.IfBranch(AT, var("x"), ()),), ()),
    "CASE x OF WHEN 1, 3..5: a := 1; DEFAULT: b := 2; ENDCASE;": t.Case(
        AT,
        var("x"),
        (t.CaseBranch(AT, (num(1), t.Range(AT, num(3), num(5))), (assign("a", 1),)),),
        (assign("b", 2),),
    ),
    "CASE x OF WHEN 1: ENDCASE;": t.Case(AT, var("x"), (t.CaseBranch(AT, (num(1),), ()),), None),
    "FOR i := 1 TO 3 DO a := 1; ENDFOR;": t.For(AT, var("i"), num(1), num(3), False, None, (assign("a", 1),)),
    "FOR i := 3 DOWNTO 1 STEP 2 DO ENDFOR;": t.For(AT, var("i"), num(3), num(1), True, num(2), ()),
    "FOR step := to TO at STEP step DO ENDFOR;": t.For(
        AT, var("step"), var("to"), var("at"), False, var("step"), ()
    ),
    "WHILE x DO a := 1; ENDWHILE;": t.While(AT, var("x"), (assign("a", 1),)),
    "REPEAT a := 1; UNTIL x;": t.Repeat(AT, (assign("a", 1),), var("x")),
    "MOVE PTP p;": move("PTP", P),
    "move lin p, q;": move("LIN", P, Q),
    "MOVE LIN p SPEED := 5 ACC := 7;": move("LIN", P, params=(param("speed", num(5)), param("acc", num(7)))),
    "MOVE LIN p, q, SPEED := 5, ACC := 7;": move(
        "LIN", P, Q, params=(param("speed", num(5)), param("acc", num(7)))
    ),
    "MOVE LIN (1., 2., 3.);": move("LIN", t.Aggregate(AT, (num(1.0), num(2.0), num(3.0)))),
    "MOVE CIRCLE p, q ANGLE := 360;": move("CIRCLE", P, Q, params=(param("angle", num(360)),)),
    "MOVE LIN PATH (p, q);": move("LIN", P, Q, path=True),
    "MOVE SPLINE PATH (p);": move("SPLINE", P, path=True),
    "MOVE SPLINE PATH rack;": move("SPLINE", var("rack"), path=True),
    "MOVE_INC LIN p;": move("LIN", P, incremental=True),
    "MOVE LIN p WITH JOINTLIMIT a, b;": move(
        "LIN", P, clauses=(t.WithLimit(AT, "POSITION", var("a"), var("b")),)
    ),
    "MOVE LIN p WITH JOINTSPEEDLIMIT a, b WITH JOINTACCELLIMIT c, d;": move(
        "LIN",
        P,
        clauses=(
            t.WithLimit(AT, "SPEED", var("a"), var("b")),
            t.WithLimit(AT, "ACCELERATION", var("c"), var("d")),
        ),
    ),
    "MOVE LIN p, q SPEED := 5 WITH RECONFIGURATION a, b WITH TOLERANCE w;": move(
        "LIN",
        P,
        Q,
        params=(param("speed", num(5)),),
        clauses=(t.WithReconfiguration(AT, (var("a"), var("b"))), t.WithTolerance(AT, var("w"))),
    ),
    "MOVE LIN PATH (p, q) WITH RECONFIGURATION (a, b);": move(
        "LIN", P, Q, path=True, clauses=(t.WithReconfiguration(AT, (var("a"), var("b"))),)
    ),
    "MOVE LIN p WITH RECONFIGURATION (1., 2.);": move(
        "LIN", P, clauses=(t.WithReconfiguration(AT, (t.Aggregate(AT, (num(1.0), num(2.0))),)),)
    ),
    "MOVE LIN p WITH CRITERION damping WEIGHT := 2 depth := 3;": move(
        "LIN",
        P,
        clauses=(t.WithCriterion(AT, name("damping"), (param("weight", num(2)), param("depth", num(3)))),),
    ),
    "JOINTLIMIT a, b;": t.LimitSwitch(AT, "POSITION", var("a"), var("b")),
    "JOINTLIMITEND;": t.LimitSwitchEnd(AT, "POSITION"),
    "JOINTSPEEDLIMIT a, b;": t.LimitSwitch(AT, "SPEED", var("a"), var("b")),
    "JOINTSPEEDLIMITEND;": t.LimitSwitchEnd(AT, "SPEED"),
    "JOINTACCELLIMIT a, b;": t.LimitSwitch(AT, "ACCELERATION", var("a"), var("b")),
    "JOINTACCELLIMITEND;": t.LimitSwitchEnd(AT, "ACCELERATION"),
    "FREEZESTART 1, 2;": t.FreezeStart(AT, (num(1), num(2))),
    "FREEZEEND;": t.FreezeEnd(AT),
    "CYCLICSTART;": t.CyclicStart(AT),
    "CYCLICEND;": t.CyclicEnd(AT),
    "OBSTACLE ściana_1;": t.ObstacleStart(AT, name("ściana_1")),
    "OBSTACLEEND wall;": t.ObstacleEnd(AT, name("wall")),
    "MOVE LIN p, q IN FRAME pipe SPEED := 5;": move(
        "LIN", P, Q, frames=(in_frame("pipe"),), params=(param("speed", num(5)),)
    ),
    "MOVE_INC LIN PATH (p, q) IN FRAME Frame WITH TOLERANCE w;": move(
        "LIN",
        P,
        Q,
        path=True,
        incremental=True,
        frames=(in_frame("Frame"),),
        clauses=(t.WithTolerance(AT, var("w")),),
    ),
    "frame := 1;": assign("frame", 1),
    "RECONFIGURATION konf IN FRAME pipe;": t.Reconfiguration(AT, var("konf"), in_frame("pipe")),
    "RECONFIGURATION konf;": t.Reconfiguration(AT, var("konf")),
    "CRITERION c;": t.CriterionStart(AT, name("c"), ()),
    "CRITERION c WEIGHT := 2, x := 1;": t.CriterionStart(
        AT, name("c"), (param("weight", num(2)), param("x", num(1)))
    ),
    "CRITERIONEND c;": t.CriterionEnd(AT, name("c")),
}


@pytest.mark.req("LANG-40")
@pytest.mark.req("LANG-41")
@pytest.mark.req("LANG-50")
@pytest.mark.req("LANG-60")
@pytest.mark.parametrize("source", STATEMENTS)
def test_statement(statement_of, source):
    assert statement_of(source) == STATEMENTS[source]


REAL, POSE = t.NamedType(AT, name("REAL")), t.NamedType(AT, name("POSE"))


def variable(word, initial=None):
    return t.Variable(AT, name(word), initial)


DECLARATIONS = {
    "SYSTEM SPECIFICATION cell;": t.SystemSpecification(AT, name("cell")),
    "FROM m IMPORT a, b;": t.ImportFrom(AT, name("m"), (name("a"), name("b"))),
    "IMPORT DATALIST points;": t.ImportDatalist(AT, name("points")),
    "EXPORT a;": t.Export(AT, (name("a"),), None),
    "EXPORT a, b TO m;": t.Export(AT, (name("a"), name("b")), name("m")),
    "ROBOT r := arm;": t.RobotBinding(AT, name("r"), name("arm")),
    "STANDARD_IN = ch;": t.StandardChannel(AT, "IN", name("ch")),
    "STANDARD_OUT = ch;": t.StandardChannel(AT, "OUT", name("ch")),
    "CONST REAL: a := 1.5;": t.ConstDeclaration(AT, REAL, (variable("a", num(1.5)),)),
    "VAR REAL: a, b := 2;": t.VarDeclaration(AT, REAL, (variable("a"), variable("b", num(2)))),
    "VAR ARRAY [1..5, 0..2] OF POSE: rack;": t.VarDeclaration(
        AT,
        t.ArrayType(AT, (t.Range(AT, num(1), num(5)), t.Range(AT, num(0), num(2))), POSE),
        (variable("rack"),),
    ),
    "VAR INPUT REAL: a AT 3;": t.SignalDeclaration(
        AT, "INPUT", None, REAL, (t.SignalPort(AT, name("a"), num(3)),)
    ),
    "VAR DIGITAL OUTPUT: a AT 3, b AT 4;": t.SignalDeclaration(
        AT,
        "OUTPUT",
        "DIGITAL",
        None,
        (t.SignalPort(AT, name("a"), num(3)), t.SignalPort(AT, name("b"), num(4))),
    ),
    "VAR ANALOG INPUT: a AT 1;": t.SignalDeclaration(
        AT, "INPUT", "ANALOG", None, (t.SignalPort(AT, name("a"), num(1)),)
    ),
    "TYPE RECORD REAL: a1.max, a2; POSE: p; ENDRECORD = R;": t.TypeDefinition(
        AT,
        t.RecordType(
            AT,
            (
                t.FieldGroup(AT, REAL, (name("a1.max"), name("a2"))),
                t.FieldGroup(AT, POSE, (name("p"),)),
            ),
        ),
        name("R"),
    ),
    "TYPE ARRAY [1..2] OF REAL = PAIR;": t.TypeDefinition(
        AT, t.ArrayType(AT, (t.Range(AT, num(1), num(2)),), REAL), name("PAIR")
    ),
    "PROCEDURE work; BEGIN ENDPROC;": t.ProcedureDeclaration(AT, name("work"), (), (), ()),
    "PROCEDURE work(IN POSE: p; REAL: h, k; VAR REAL: n);"
    " VAR REAL: a; BEGIN a := 1; ENDPROC;": t.ProcedureDeclaration(
        AT,
        name("work"),
        (
            t.Parameter(AT, "IN", POSE, (name("p"),)),
            t.Parameter(AT, "IN", REAL, (name("h"), name("k"))),
            t.Parameter(AT, "VAR", REAL, (name("n"),)),
        ),
        (t.VarDeclaration(AT, REAL, (variable("a"),)),),
        (assign("a", 1),),
    ),
    "FUNCTION one(REAL: x): REAL; BEGIN RETURN 1; ENDFCT;": t.FunctionDeclaration(
        AT, name("one"), (t.Parameter(AT, "IN", REAL, (name("x"),)),), REAL, (), (t.Return(AT, num(1)),)
    ),
}


@pytest.mark.req("LANG-10")
@pytest.mark.req("LANG-21")
@pytest.mark.parametrize("source", DECLARATIONS)
def test_declaration(declarations_of, source):
    assert declarations_of(source) == (DECLARATIONS[source],)


@pytest.mark.req("LANG-10")
def test_parts_come_in_any_order_and_repeat(declarations_of):
    found = declarations_of("VAR INT: a; CONST INT: b := 1; VAR INT: c; REAL: d; SYSTEM SPECIFICATION x;")
    assert [type(d).__name__ for d in found] == [
        "VarDeclaration",
        "ConstDeclaration",
        "VarDeclaration",
        "VarDeclaration",
        "SystemSpecification",
    ]


@pytest.mark.req("LANG-12")
def test_module(analysed):
    analysis = analysed("MODULE m; EXPORT a; VAR INT: a; ENDMODULE;")
    assert isinstance(analysis.tree, t.Module)
    assert analysis.tree.name == name("m")
    assert len(analysis.tree.declarations) == 2
    assert not analysis.diagnostics
    assert analysis.symbols["a"].kind == "variable"


LITERALS = {
    "42": num(42),
    "180.": num(180.0),
    ".5": num(0.5),
    "1.5E-3": num(0.0015),
    "2e3": num(2000.0),
    "'it''s'": text("it's"),
    '"a ""b"" \'c\'"': text("a \"b\" 'c'"),
    "''": text(""),
    "TRUE": TRUE,
    "false": FALSE,
    "(1)": t.Paren(AT, num(1)),
    "((1, 2), 3)": t.Aggregate(AT, (t.Aggregate(AT, (num(1), num(2))), num(3))),
    "ORIZYX(0, 180, 0)": t.FunctionCall(AT, name("orizyx"), (num(0), num(180), num(0))),
    "now()": t.FunctionCall(AT, name("now"), ()),
}


@pytest.mark.req("LANG-03")
@pytest.mark.req("LANG-24")
@pytest.mark.req("LANG-32")
@pytest.mark.parametrize("source", LITERALS)
def test_literal(statement_of, source):
    assert statement_of(f"x := {source};").value == LITERALS[source]


def shown(node):
    """An expression with all its parentheses."""
    match node:
        case t.Binary(op=op, left=left, right=right):
            return f"({shown(left)} {op} {shown(right)})"
        case t.Unary(op=op, operand=operand):
            return f"({op} {shown(operand)})"
        case t.Paren(value=value):
            return shown(value)
        case t.Designator(base=base):
            return base.name
        case t.BoolLiteral(value=value):
            return str(value).upper()
        case t.IntLiteral(value=value):
            return str(value)
    raise AssertionError(node)


@pytest.mark.req("LANG-30")
@pytest.mark.req("LANG-31")
@pytest.mark.parametrize(
    ("source", "reading"),
    [
        ("IN_1 = TRUE AND IN_2 = TRUE", "((IN_1 = TRUE) AND (IN_2 = TRUE))"),
        ("a OR b AND c", "(a OR (b AND c))"),
        ("a OR b EXOR c AND d", "(a OR (b EXOR (c AND d)))"),
        ("a - b - c", "((a - b) - c)"),
        ("a + b * c @ d", "(a + (b * (c @ d)))"),
        ("a @ b @ c", "((a @ b) @ c)"),
        ("- a @ b", "((- a) @ b)"),
        ("- a * b", "((- a) * b)"),
        ("a * - b", "(a * (- b))"),
        ("NOT a = b", "((NOT a) = b)"),
        ("NOT NOT a", "(NOT (NOT a))"),
        ("a div b mod c", "((a DIV b) MOD c)"),
        ("a + 1 < b - 1 AND c", "(((a + 1) < (b - 1)) AND c)"),
        ("(a OR b) AND c", "((a OR b) AND c)"),
        ("a <> b OR a >= b OR a <= b", "(((a <> b) OR (a >= b)) OR (a <= b))"),
    ],
)
def test_precedence(statement_of, source, reading):
    assert shown(statement_of(f"x := {source};").value) == reading


@pytest.mark.req("LANG-01")
def test_keywords_and_names_ignore_case_and_keep_their_spelling(analysed):
    analysis = analysed("program T; Var int: Größe; begin GRÖSSE := 1; endprogram")
    assert not analysis.diagnostics
    assert analysis.symbols["grösse"].name.name == "Größe"


@pytest.mark.req("LANG-01")
def test_names_are_normalised(analysed):
    analysis = analysed("PROGRAM t; VAR INT: a\u0301; BEGIN \u00e1 := 1; ENDPROGRAM")
    assert not analysis.diagnostics
    assert "\u00e1" in analysis.source.text


@pytest.mark.req("LANG-02")
def test_comments_are_kept(analysed):
    analysis = analysed("PROGRAM t; { one (* } BEGIN (* two { \n *) ENDPROGRAM (**)")
    assert not analysis.diagnostics
    assert [analysis.source.text[s.start : s.end] for s in analysis.comments] == [
        "{ one (* }",
        "(* two { \n *)",
        "(**)",
    ]


@pytest.mark.req("LANG-04")
@pytest.mark.parametrize("word", ["at", "sec", "step", "timeout", "to", "datalist", "specification"])
def test_words_that_are_names_too(analysed, word):
    analysis = analysed(f"PROGRAM t; VAR INT: {word}; BEGIN {word} := {word} + 1; ENDPROGRAM")
    assert not analysis.diagnostics


@pytest.mark.req("LANG-72")
@pytest.mark.parametrize(
    ("statement", "spans"),
    [
        ("x := a + 1;", ["x := a + 1", "x", "a + 1", "a", "1"]),
        ("MOVE LIN p SPEED := 5 WITH RECONFIGURATION a, b;", ["SPEED := 5", "WITH RECONFIGURATION a, b"]),
        ("MOVE LIN p WITH CRITERION c WEIGHT := 1;", ["WITH CRITERION c WEIGHT := 1"]),
        (
            "IF x THEN a := 1; ELSE b := 1; ENDIF;",
            ["IF x THEN a := 1; ELSE b := 1; ENDIF", "IF x THEN a := 1"],
        ),
        ("p.pos[2] := (1);", [".pos", "[2]", "(1)"]),
    ],
)
def test_spans_point_at_their_text(analysed, statement, spans):
    analysis = analysed(f"PROGRAM t;\nBEGIN\n  {statement}\nENDPROGRAM")
    found = set()
    for node in t.walk(analysis.tree):
        assert 0 <= node.span.start < node.span.end <= len(analysis.source.text)
        found.add(analysis.source.text[node.span.start : node.span.end])
    assert set(spans) <= found


def test_walk_finds_every_node_in_order(analysed):
    root = analysed("PROGRAM t; VAR REAL: a := 1; BEGIN a := (a, 2); IF a THEN b; ENDIF; ENDPROGRAM").tree
    starts = [node.span.start for node in t.walk(root) if isinstance(node, t.Name)]
    assert starts == sorted(starts)
    assert len(starts) == 7


def test_every_node_has_a_span_first():
    kinds = [getattr(t, word) for word in t.__all__ if isinstance(getattr(t, word), type)]
    for kind in kinds:
        assert fields(kind)[0].name == "span", kind


@pytest.mark.req("LANG-04")
def test_every_rule_of_the_grammar_is_exercised():
    loaded = build_grammar()
    callbacks = loaded.parse_interactive().parser_state.parse_conf.callbacks
    used = set()

    def watched(rule, build):
        def run(children):
            used.add(rule.origin.name)
            return build(children)

        return run

    for rule, build in list(callbacks.items()):
        if not isinstance(rule, str):
            callbacks[rule] = watched(rule, build)
    for source in STATEMENTS:
        loaded.parse(f"PROGRAM t; BEGIN {source} ENDPROGRAM")
    for source in DECLARATIONS:
        loaded.parse(f"PROGRAM t; {source} BEGIN ENDPROGRAM")
    for source in LITERALS:
        loaded.parse(f"PROGRAM t; BEGIN x := -{source} * 2; ENDPROGRAM")
    loaded.parse("MODULE m; ENDMODULE")
    loaded.parse("DATALIST d; ENDDATALIST")
    rules = {rule.origin.name for rule in loaded.rules}
    assert rules - used - {rule for rule in rules if rule.startswith("__")} == set()
