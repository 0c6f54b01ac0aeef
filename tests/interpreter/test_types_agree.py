"""What the check says of the type of an expression is what its value turns out to be: random expressions."""

import random
import re

import pytest

from irlx.interpreter.context import Context
from irlx.interpreter.errors import InterpreterError
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.interpret import declared_scope
from irlx.interpreter.machine import Machine
from irlx.interpreter.values import RecordValue, is_set
from irlx.interpreter.world import World
from irlx.language.analysis import analyse
from irlx.language.checking.check import type_check
from irlx.language.checking.type_forms import Joints, joints_of
from irlx.language.source import source_text
from long_run import first_rows

DECLARATIONS = """TYPE RECORD REAL: a; ENDRECORD = one; RECORD INT: n; POSITION: p; ENDRECORD = two;
RECORD REAL: a1.max, a2.max; ENDRECORD = dotted; RECORD one: a1; REAL: a1.s.max; ENDRECORD = mixed;
CONST INT: four := 4; REAL: half := 0.5; BOOL: yes := TRUE;
VAR INT: i := 3, j := -2; REAL: x := 1.5, y := 0.25; BOOL: b := TRUE, c := FALSE; STRING: s := 'a', t := 'bc';
CHAR: k := 'q', l := 'b'; ARRAY [1..2] OF STRING: texts := ('up', 'it');
POSITION: v := (1, 2, 3), w := (4, 5, 6); ORIENTATION: o := (1, 0, 0, 0); POSE: p := ((1, 2, 3), o);
MAIN_JOINT: m := (1, 2, 3, 4); one: e1 := (7); two: e2 := (5, (1, 2, 3)); dotted: d := (1, 2);
mixed: e3 := ((1), 2); ARRAY [1..3] OF REAL: tr := (1, 2, 3); ARRAY [0..1, 1..2] OF INT: g := (1, 2, 3, 4);
ARRAY [1..2] OF POSITION: vs := ((1, 2, 3), (4, 5, 6)); ARRAY [1..1] OF INT: lone := (9);
"""
words = re.compile(r"\S+").findall
NAMES = words("i j x y b c s t k l texts v w o p m e1 e2 d e3 tr g vs lone four half yes")
FIELDS = words("x y z q1 q4 pos ori a n p a1 a1.max a2.max a1.s.max max a4 m_joint zz")
LITERALS = words("0 1 2 7 1.5 .25 2E3 TRUE FALSE 'a' 'it''s' 9223372036854775807")
BINARY = words("+ - * / DIV MOD = <> < > <= >= AND OR EXOR @")
UNARY = ["-", "+", "NOT "]
FUNCTIONS = words(
    "ORIQUAT ORIVANG ORIXYZ ORIYXZ ORIZYX POSITION POSE INV NORM SQRT SIN COS TAN ASIN ACOS ATAN ATAN2"
    " EXP LN ABS"
    " ROUND TRUNC FLOAT ORD CHR LEN DISTANCE DOT CROSS ORIRS ORIZYZ2 ROTANGLE ROTAXIS ANGLEX VECTORN"
)
EXPECTED = words("int real bool string char position orientation pose main_joint one two dotted mixed")

TYPE_CODES = {"IRL222", "IRL223", "IRL225", "IRL227", "IRL228", "IRL229"}
COUNTS = {"IRL223", "IRL228"}
"""A wrong number of values is told by the check before what is wrong with one of them."""
VALUE_CODES = {"IRL230", "IRL502", "IRL503", "IRL504", "IRL506"}


class Written:
    """Random expressions; `sane` is how often a part is made to fit what stands around it."""

    def __init__(self, seed, sane):
        self.chance = random.Random(seed)
        self.sane = sane

    def any(self, depth):
        chance = self.chance
        kind = chance.random()
        if depth <= 0 or kind < 0.2:
            return chance.choice(LITERALS)
        if kind < 0.4:
            return chance.choice(NAMES) + self.selectors(depth)
        if kind < 0.45:
            return f"({self.any(depth - 1)})"
        if kind < 0.5:
            return f"{chance.choice(UNARY)}{self.operand(depth - 1)}"
        if kind < 0.75:
            return f"{self.operand(depth - 1)} {chance.choice(BINARY)} {self.operand(depth - 1)}"
        if kind < 0.9:
            arguments = [self.any(depth - 1) for _ in range(chance.choice([0, 1, 1, 1, 2, 2, 3, 3, 4]))]
            return f"{chance.choice(FUNCTIONS)}({', '.join(arguments)})"
        items = [self.any(depth - 1) for _ in range(chance.choice([2, 2, 3, 3, 4]))]
        return f"({', '.join(items)})"

    def operand(self, depth):
        return f"({self.any(depth)})" if depth > 0 and self.chance.random() < 0.7 else self.any(0)

    def selectors(self, depth):
        chance = self.chance
        if chance.random() < 0.6:
            return ""
        if chance.random() < 0.6:
            return f".{chance.choice(FIELDS)}"
        return f"[{', '.join(self.any(depth - 2) for _ in range(chance.choice([1, 1, 2])))}]"

    def of(self, type, depth):
        """An expression of a type, by the tables of the language and not by the check."""
        if self.chance.random() > self.sane:
            return self.any(depth)
        ways = [way.strip() for way in WAYS[type].split("|")]
        way = self.chance.choice(ways if depth > 0 else [way for way in ways if "{" not in way])
        return re.sub(r"\{(\w+)\}", lambda found: self.of(found[1], depth - 1), way)


WAYS = {
    "int": """1 | 2 | i | j | four | e2.n | g[0, 1] | lone[1] | ({int} + {int})
    | ({int} - {int}) | ({int} * {int}) | ({int} DIV {int}) | ({int} MOD {int}) | -{int} | ({int})
    | ABS({int}) | ROUND({real}) | ORD({char}) | LEN({string})""",
    "real": """1.5 | x | half | v.x | p.pos.z | o.q1 | d.a1.max | e3.a1.s.max | e3.a1.a | m.a3 | tr[2]
    | ({real} + {int}) | ({int} - {real}) | ({real} * {real}) | ({int} / {int}) | -{real} | ({real})
    | SIN({real}) | ATAN2({int}, {real}) | NORM({position}) | ABS({real}) | SQRT({int})""",
    "bool": """TRUE | b | yes | ({bool} AND {bool}) | ({bool} OR {bool}) | ({bool} EXOR {bool}) | NOT {bool}
    | ({int} < {real}) | ({real} = {int}) | ({string} <> {string}) | ({bool} = {bool})
    | (k < {char}) | ({char} >= s[1]) | ({char} = {string})""",
    "string": """'a' | s | t | k | texts[1] | ({string} + {string}) | ({char} + {string}) | ({char} + 'x')
    | {char}""",
    "char": "'a' | k | l | s[1] | t[{int}] | texts[2][1] | CHR(70 + {int}) | ({char})",
    "position": """v | p.pos | e2.p | vs[1] | ({position} + {position}) | ({position} - {position})
    | ({position} * {real}) | ({int} * {position}) | ({position} / {real}) | ({pose} @ {position})
    | ({orientation} * {position}) | POSITION({real}, {int}, {real}) | ({position} + ({real}, {int}, 1.5))
    | (({int}, {real}, 2) - {position}) | ({orientation} * (1, {real}, 2)) | ((1, 2, {real}) / {real})
    | ({real} * ({int}, 5, 6)) | ({pose} @ (1, {int}, {real}))""",
    "orientation": """o | p.ori | ORIZYX({real}, {int}, 0) | ({orientation} @ {orientation})
    | INV({orientation}) | ORIVANG({position}, {real})""",
    "pose": """p | POSE({position}, {orientation}) | ({pose} @ {pose}) | ({pose} + {position}) | INV({pose})
    | ({pose} - ({real}, 2, 3)) | (({position}, o) @ {pose}) | ({pose} @ ({position}, {orientation}))
    | (({position}, {orientation}) + {position})""",
    "main_joint": "m",
    "one": "e1 | e3.a1",
    "two": "e2",
    "dotted": "d",
    "mixed": "e3",
}
"""Ways to write a value of a type, as the reference tells them."""
AGGREGATES = {
    "position": "({real}, {int}, {real})",
    "pose": "({position}, {orientation})",
    "orientation": "(1, 0, 0, 0)",
    "main_joint": "({real}, {int}, {int}, {real})",
    "one": "({real})",
    "two": "({int}, {position})",
    "dotted": "({int}, {real})",
    "mixed": "({one}, {real})",
}
for _type, _way in AGGREGATES.items():
    WAYS[f"{_type} value"] = f"{WAYS[_type]} | {_way} | {_way}"


class Judge:
    """Evaluates and checks an expression among the declarations."""

    def __init__(self, setting, joints):
        source = source_text("t.irl", f"PROGRAM t;\n{DECLARATIONS}BEGIN ENDPROGRAM")
        analysis = analyse(source, joints=joints)
        assert not analysis.has_errors, analysis.diagnostics
        self.declarations = analysis.tree.declarations
        self.setting = setting(4)
        self.scope = declared_scope(analysis.tree, source, self.setting)
        self.world = World(self.setting, Machine())
        self.source = source
        self.joints = joints

    def node(self, expression):
        """Tree and text of an expression, or None where it is none."""
        source = source_text("t.irl", f"PROGRAM t; BEGIN x := {expression}; ENDPROGRAM")
        tree = analyse(source).tree
        if any(finding.code.startswith("IRL1") for finding in analyse(source).diagnostics) or not tree:
            return None, source
        return tree.body[0].value, source

    def checked(self, node, source, expected):
        """Type and findings of the check."""
        joints = joints_of(self.declarations, self.joints) if self.joints else Joints()
        check = type_check(self.source, joints)
        check.declare(self.declarations)
        assert check.findings == []
        check.source = source
        found = check.typed(node) if expected is None else check.fitted(node, check.names.types[expected])
        return found, check.findings

    def evaluated(self, node, source, expected):
        """Type and value, or what is wrong."""
        wanted = self.scope.types[expected] if expected else None
        context = Context(source, self.scope, self.setting, self.world.machine, rest=self.world.rest)
        found = Expressions(context).value(node, wanted)
        try:
            return found.type, found.run([]), None
        except InterpreterError as error:
            return found.type, None, error.reason


@pytest.fixture(params=["known", "unknown"])
def judge(setting, request):
    """The robot is known to the check, or not."""
    return Judge(setting, ("j1", "j2", "j3", "j4") if request.param == "known" else ())


def is_of(value, type):
    """Whether a value is one of a type, inside and out."""
    simple = {"INT": int, "REAL": float, "BOOL": bool, "STRING": str, "CHAR": str}.get(type.name)
    if simple is not None:
        return value.__class__ is simple and (type.name != "CHAR" or len(value) == 1)
    if not is_set(value) or value.type != type:
        return False
    fields = isinstance(value, RecordValue)
    types = [part for _, part in type.fields] if fields else [type.element] * type.size
    return all(map(is_of, value.values, types)) and len(value.values) == len(types)


def compared(judge, expression, expected):
    """Check against run; True where the two could be compared."""
    node, source = judge.node(expression)
    if node is None:
        return False
    found, findings = judge.checked(node, source, expected)
    type, value, reason = judge.evaluated(node, source, expected)
    errors = [finding for finding in findings if finding.is_error]
    context = (expression, expected, [str(e) for e in errors], value, str(reason))
    if not errors:
        # The check has found nothing: a run may only lack a value, never meet a type.
        uncounted = reason is not None and not judge.joints and "MAIN_JOINT" in reason.message
        assert reason is None or reason.code in VALUE_CODES or uncounted, context
        if reason is None:
            wanted = judge.scope.types[expected] if expected else None
            assert is_of(value, type), context
            assert type == wanted if wanted is not None else type.name == found.type.name, context
            if isinstance(found.value, int | float | str) and wanted is None:
                assert found.value == value, context
    elif reason is None:
        # A run meets no mistake only where it does not get to it.
        assert " AND " in expression or " OR " in expression, context
    elif reason.code in TYPE_CODES and len(errors) == 1 and errors[0].code in TYPE_CODES - COUNTS:
        # Which names are near depends on the number of joints.
        assert errors[0].message.split(";")[0] == reason.message.split(";")[0], context
        assert errors[0].place == reason.place, context
    return True


@pytest.mark.req("LANG-20")
@pytest.mark.req("LANG-24")
@pytest.mark.req("LANG-30")
@pytest.mark.parametrize(("seed", "sane"), first_rows(2, [(2, 0.5), (4, 1.0), (1, 0.0), (3, 0.9)]))
def test_random_expressions(judge, seed, sane):
    expressions = Written(seed, sane)
    count = 0
    for _ in range(2000):
        expected = expressions.chance.choice([None, *EXPECTED])
        type = expected if expected is None or expressions.chance.random() < 0.8 else None
        if type is None:
            expression = expressions.any(3)
        else:
            expression = expressions.of(f"{type} value" if type in AGGREGATES else type, 3)
        count += compared(judge, expression, expected)
        if count == 60:
            break
    assert count > 50


@pytest.mark.parametrize("type", list(WAYS))
@pytest.mark.parametrize("count", [8, pytest.param(250, marks=pytest.mark.slow)])
def test_what_is_well_typed_by_the_tables_is_for_the_check(judge, type, count):
    """The tables above are a second account of the language: nothing they build is called wrong."""
    expressions = Written(type, 1.0)
    for _ in range(count):
        expression = expressions.of(type, 3)
        node, source = judge.node(expression)
        _, findings = judge.checked(node, source, type.removesuffix(" value"))
        assert not [f for f in findings if f.is_error and f.code not in VALUE_CODES], expression
