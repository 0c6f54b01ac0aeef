"""Random programs of the computing half of the language, for comparisons of what they come to.

Every program is written twice: with all parentheses, and with those alone that the precedence of operators
in the reference asks for.

REAL numbers are of two kinds, told apart by their names: those that come from exact or
correctly rounded operations alone decide what happens, and those from angles and rotations, which two correct
programs may have differently in the last digits, are only carried on.
"""

from __future__ import annotations

import random

from computing_tables import (
    AND,
    CLOSE,
    COMPARED,
    EDGES,
    LITERALS,
    NAMED,
    OPEN,
    PARTS,
    PRIMARY,
    RANKS,
    SETTABLE,
    SIGNED,
    STARTS,
    TIMES,
    TYPES,
    VALUES,
    WAYS,
    WRITTEN,
)


class Scope:
    """Variables that statements see: lists of (type, name); `written` are those that may be set."""

    def __init__(self, variables, written, routines, result=None, depth=None):
        self.variables, self.written, self.routines = variables, written, routines
        self.result, self.depth = result, depth
        self.counters = []
        self.loops = 0


class Author:
    """Writes one random program."""

    def __init__(self, seed):
        self.chance = random.Random(seed)
        self.labels = 0

    def program(self):
        pick = self.chance
        self.constants = [("int", "c1"), ("real", "c2"), ("string", "c3")]
        kinds = [pick.choice(SETTABLE) for _ in range(pick.randrange(4, 12))] + ["int", "int", "real", "bool"]
        variables = [(kind, f"{kind[:2]}{number % 5}{kind[2:4]}") for number, kind in enumerate(kinds)]
        variables = list(dict.fromkeys(variables))
        start = f"PROGRAM t;\nCONST\n  INT: c1 := {pick.choice(('2', '3', '-5'))};\n"
        start += "  REAL: c2 := c1 / 4;\n  STRING: c3 := 'ab' + 'c';\n" + TYPES
        known, declared = [*self.constants], []
        for kind, name in variables:
            declared.append(self.declared(kind, name, Scope(known, [], [])))
            known = [*known, (kind, name)]
        routines, texts = [], []
        for number in range(pick.choice((0, 1, 1, 2))):
            texts.append(self.routine(number, known, variables, routines))
        main = Scope(known, variables, routines)
        body = self.statements(main, pick.randrange(2, 7), pick.choice((2, 2, 3)))
        return (
            start
            + "VAR\n"
            + "".join(declared)
            + self.counters(main)
            + "".join(texts)
            + f"BEGIN\n{body}ENDPROGRAM\n"
        )

    def declared(self, kind, name, scope):
        pick = self.chance
        if pick.random() < 0.015:
            initial = ""
        elif kind in STARTS and (kind not in LITERALS or pick.random() < 0.6):
            initial = f" := {pick.choice(STARTS[kind])}"
        elif pick.random() < 0.4:
            initial = f" := {self.expected(scope, kind, 2)}"
        else:
            initial = f" := {pick.choice(LITERALS[kind])}"
        return f"  {WRITTEN.get(kind, kind.upper())}: {name}{initial};\n"

    def counters(self, scope):
        return "".join(f"  INT: {name} := 0;\n" for name in scope.counters)

    def routine(self, number, known, variables, routines):
        """One procedure or function; those above it may be called, and itself with a smaller depth."""
        pick = self.chance
        result = pick.choice((None, "int", "int", "real", "bool", "string", "position", "item", "near"))
        name, parameters = f"r{number}", [("IN", "int", "depth")]
        for place in range(pick.randrange(4)):
            kind = pick.choice(("int", "int", "real", "bool", "string", "position", "item", "triple", "pose"))
            # The same name as one of the program hides it.
            called = pick.choice([f"p{place}", pick.choice(variables)[1]])
            if called not in [p[2] for p in parameters]:
                parameters.append((pick.choice(("IN", "", "VAR")), kind, called))
        locals_ = [(k, f"v{i}") for i, k in enumerate(pick.choices(("int", "real", "string", "grid"), k=2))]
        own = [(kind, called) for _, kind, called in parameters] + locals_
        hidden = {called for _, called in own}
        outer = [v for v in known if v[1] not in hidden]
        routines.append((name, parameters, result))
        scope = Scope(outer + own, [v for v in variables if v[1] not in hidden] + own[1:], routines, result)
        scope.depth = name
        quiet = Scope(outer + own[:1], [], [])
        declared = "".join(self.declared(kind, called, quiet) for kind, called in locals_)
        body = self.statements(scope, pick.randrange(1, 4), pick.choice((1, 2)))
        written = "; ".join(f"{mode} {WRITTEN.get(k, k.upper())}: {n}".strip() for mode, k, n in parameters)
        ends = "ENDFCT" if result else "ENDPROC"
        head = f"FUNCTION {name}({written}): {WRITTEN.get(result, result.upper())}" if result else ""
        stop = "" if result is None else f"  RETURN {self.expected(scope, result, 1)};\n"
        if result and pick.random() < 0.05:
            stop = f"  IF {self.value(scope, 'bool', 1)} THEN\n  {stop}  ENDIF;\n"
        early = "" if result is None else self.literal(scope, result)
        return (
            (head or f"PROCEDURE {name}({written})")
            + f";\nVAR\n{declared}{self.counters(scope)}BEGIN\n  IF depth <= 0 THEN RETURN {early}; ENDIF;\n"
            + f"{body}{stop}{ends};\n"
        )

    # ---- expressions: text and the rank of its last operator

    def value(self, scope, kind, depth):
        return self.ranked(scope, kind, depth)[0]

    def literal(self, scope, kind):
        return self.chance.choice(LITERALS[kind])

    def ranked(self, scope, kind, depth):
        pick = self.chance
        if kind == "small":
            return pick.choice(("2", "3", "c1", "0.5", "4")) if depth >= 0 else "2", PRIMARY
        if kind == "divisor":
            return pick.choice(("3", "c1", "7", "10")), PRIMARY
        if kind == "digit":
            return str(pick.randrange(10)), PRIMARY
        chance = pick.random()
        if depth > 0 and chance < 0.1:
            called = self.called(scope, kind, depth)
            if called:
                return called, PRIMARY
        if depth > 0 and chance < 0.55 and (kind in WAYS or kind in NAMED):
            way = pick.choice(WAYS[kind].split("|")) if kind in WAYS else NAMED[kind]
            return self.filled(scope, kind, way, depth - 1)
        if chance < 0.9 or kind not in LITERALS:
            found = self.designator(scope, kind, scope.variables, depth)
            if found:
                return found, PRIMARY
        if kind == "int" and pick.random() < 0.15:
            return pick.choice(EDGES), PRIMARY
        text = pick.choice(LITERALS[kind]) if kind in LITERALS else NAMED[kind]
        return (
            (text, SIGNED if text[0] == "-" else PRIMARY)
            if "{" not in text
            else self.filled(scope, kind, text, 0)
        )

    def filled(self, scope, kind, way, depth):
        """A way to write a value with its parts; operands get the parentheses that they need."""
        words = way.replace("char name", "char_name").split(" ")
        words = [word.replace("_name", " name") for word in words]
        if len(words) == 3 and words[1] in RANKS:
            rank = RANKS[words[1]]
            left = self.operand(scope, words[0], depth, rank + (rank == COMPARED))
            return f"{left} {words[1]} {self.operand(scope, words[2], depth, rank + 1)}", rank
        if " / 1000" in way:
            return f"{self.parts(scope, kind, way[:-7], depth)} / 1000", TIMES
        for op in ("@", "+", "-", "*", "/"):
            left, found, right = way.partition(f" {op} ")
            if found and left.count("(") == left.count(")"):
                rank = RANKS[op]
                return (
                    f"{self.operand(scope, left, depth, rank)} {op} "
                    f"{self.operand(scope, right, depth, rank + 1)}",
                    rank,
                )
        for sign in ("-", "+", "NOT "):
            if way.startswith(sign + "{"):
                return sign + self.operand(scope, way[len(sign) :], depth, SIGNED), SIGNED
        return self.parts(scope, kind, way, depth), PRIMARY

    def operand(self, scope, way, depth, rank):
        if way.startswith("{") and way.endswith("}") and way.count("{") == 1 and " " not in way:
            text, own = self.ranked(scope, way[1:-1], depth)
        else:
            text, own = self.parts(scope, None, way, depth), PRIMARY
        if own < rank:
            return f"({text})"
        return text if own == PRIMARY else f"{OPEN}{text}{CLOSE}"

    def parts(self, scope, kind, way, depth):
        """A way with the values in its braces; all of `{same}` are one variable."""
        same = None
        while "{" in way:
            before, _, rest = way.partition("{")
            word, _, after = rest.partition("}")
            if word == "same":
                same = same or self.designator(scope, kind, scope.variables, 0) or LITERALS[kind][0]
                text = same
            elif word == "char name":
                text = self.designator(scope, "char", scope.variables, 0) or "c3[1]"
            elif word == "string letter":
                name = self.designator(scope, "string", scope.variables, 0, whole=True) or "c3"
                text = f"{name}[{self.chance.choice(('1', '2', self.value(scope, 'int', 0)))}]"
            elif word.endswith("="):
                text = self.expected(scope, word[:-1], depth - 1)
            else:
                text = self.value(scope, word, depth)
            way = f"{before}\x03{text}\x04{after}".replace("\x03", "").replace("\x04", "")
        return way

    def expected(self, scope, kind, depth):
        """A value where its type is expected: there a list of values may stand."""
        if kind in VALUES and (self.chance.random() < 0.4 or kind not in (*WAYS, *NAMED)):
            found = self.designator(scope, kind, scope.variables, 0) if self.chance.random() < 0.4 else None
            return found or self.parts(scope, kind, self.chance.choice(VALUES[kind].split("|")), depth)
        if kind == "real" and self.chance.random() < 0.2:
            kind = "int"
        return self.value(scope, kind, depth)

    def designator(self, scope, kind, variables, depth, whole=False):
        """A variable of a type or a part of one, None where there is none."""
        found = [name for own, name in variables if own == kind]
        for own, name in variables:
            found += [name + part for k, part in PARTS.get(own, ()) if k == kind and not whole]
        return self.indexed(scope, self.chance.choice(found), depth) if found else None

    def indexed(self, scope, text, depth):
        for mark, low, size in (("{0}", -1, 3), ("{1}", 1, 3), ("{2}", 0, 3), ("{p}", 1, 2)):
            while mark in text:
                number = self.value(scope, "int", depth - 1) if depth > 0 else "1"
                inside = str(self.chance.randrange(low, low + size))
                computed = f"{low} + ABS(({number}) MOD {size})"
                text = text.replace(mark, inside if depth <= 0 or self.chance.random() < 0.6 else computed, 1)
        if "{any}" in text:
            computed = self.designator(scope, "int", scope.written, depth - 1) if depth > 0 else None
            text = text.replace("{any}", computed or "2")
        return text

    def called(self, scope, kind, depth):
        fitting = [r for r in scope.routines if r[2] == kind]
        return self.call(scope, self.chance.choice(fitting), depth) if fitting else None

    def call(self, scope, routine, depth):
        """A call of a routine, None where there is no variable for a VAR parameter."""
        name, parameters, _ = routine
        arguments = ["depth - 1" if scope.depth else self.chance.choice(("0", "1", "2", "3"))]
        if scope.depth == name and self.chance.random() < 0.3:
            return None
        for mode, kind, _ in parameters[1:]:
            text = (
                self.designator(scope, kind, scope.written, depth - 1)
                if mode == "VAR"
                else self.expected(scope, kind, depth - 1)
            )
            if text is None:
                return None
            arguments.append(text)
        return f"{name}({', '.join(arguments)})"

    # ---- statements

    def statements(self, scope, count, depth):
        return "".join(self.statement(scope, depth) for _ in range(count))

    def statement(self, scope, depth):
        kinds = ["set"] * 6 + ["write"] * 2 + ["call", "leave"]
        kinds += ["if", "if", "case", "for", "for", "while", "repeat", "forward", "back"] * (depth > 0)
        return getattr(self, f"{self.chance.choice(kinds)}_")(scope, depth)

    def set_(self, scope, depth):
        kind = self.chance.choice(SETTABLE)
        target = self.designator(scope, kind, scope.written, 1)
        if target is None:
            return ""
        if kind == "int" and self.chance.random() < 0.5:
            text, rank = self.ranked(scope, "int", 3)
            inner = f"({text})" if rank < TIMES else f"{OPEN}{text}{CLOSE}"
            return f"  {target} := {inner} MOD 101;\n"
        return f"  {target} := {self.expected(scope, kind, 3)};\n"

    def write_(self, scope, depth):
        pick, items = self.chance, []
        for _ in range(pick.randrange(1, 4)):
            kind = pick.choice(("int", "real", "bool", "string", "char"))
            width = pick.choice(("1", "8", "12", "2 * 3"))
            layout = pick.choice(("", "", f":{width}", f":{width}:{pick.choice('0123')}"))
            items.append(self.value(scope, kind, 2) + (layout if kind in ("int", "real") else layout[:2]))
        return f"  {pick.choice(('WRITE', 'WRITELN'))}({', '.join(items)});\n"

    def call_(self, scope, depth):
        if not scope.routines:
            return self.set_(scope, depth)
        text = self.call(scope, self.chance.choice(scope.routines), 2)
        return f"  {text};\n" if text else ""

    def leave_(self, scope, depth):
        pick = self.chance
        ways = ["EXIT"] * (3 * (scope.loops > 0)) + ["HALT"] * (pick.random() < 0.2)
        if scope.result:
            ways.append(f"RETURN {self.expected(scope, scope.result, 1)}")
        elif pick.random() < 0.3 or scope.depth:
            ways.append("RETURN")
        return f"  IF {self.value(scope, 'bool', 2)} THEN {pick.choice(ways)}; ENDIF;\n" if ways else ""

    def block(self, scope, depth):
        return self.statements(scope, self.chance.choice((0, 1, 1, 2)), depth - 1)

    def if_(self, scope, depth):
        text = f"  IF {self.value(scope, 'bool', 3)} THEN\n{self.block(scope, depth)}"
        if self.chance.random() < 0.4:
            text += f"  ELSIF {self.value(scope, 'bool', 2)} THEN\n{self.block(scope, depth)}"
        if self.chance.random() < 0.5:
            text += f"  ELSE\n{self.block(scope, depth)}"
        return text + "  ENDIF;\n"

    def case_(self, scope, depth):
        pick = self.chance
        kind = pick.choice(("int", "int", "char", "string", "bool"))
        labels = {
            "int": ["0", "1..4", "-3..-1", "5", "7..100", "c1 + 200"],
            "char": ["'a'..'f'", "'q'", "'x'..'z'", "' '"],
            "string": ["'up'", "''", "'a'", "c3 + 'd'"],
            "bool": ["TRUE", "FALSE"],
        }[kind]
        pick.shuffle(labels)
        selector = self.value(scope, kind, 2) if kind != "char" else self.parts(scope, None, "{char name}", 1)
        text = f"  CASE {selector} OF\n"
        while labels and pick.random() < 0.8:
            taken = [labels.pop() for _ in range(min(len(labels), pick.choice((1, 1, 2))))]
            text += f"  WHEN {', '.join(taken)}:\n{self.block(scope, depth)}"
        if "WHEN" not in text:
            text += f"  WHEN {labels[0]}:\n{self.block(scope, depth)}"
        if pick.random() < 0.5:
            text += f"  DEFAULT:\n{self.block(scope, depth)}"
        return text + "  ENDCASE;\n"

    def loop(self, scope, depth):
        scope.loops += 1
        text = self.block(scope, depth)
        scope.loops -= 1
        return text

    def for_(self, scope, depth):
        pick = self.chance
        kind = pick.choice(("int", "int", "real"))
        variable = self.designator(scope, kind, scope.written, pick.randrange(2))
        if variable is None:
            return ""
        ends = [
            pick.choice((str(pick.randrange(-2, 5)), f"({self.value(scope, 'int', 1)}) MOD 5")) for _ in "ab"
        ]
        wild = self.designator(scope, "int", scope.written, 0) or "1"
        step = ("", "", " STEP 2", f" STEP {wild}", f" STEP ABS({wild}) + 1")
        if kind == "real":
            ends[1] = pick.choice((ends[1], "1", "0.3", f"{ends[0]} + 0.7"))
            if pick.random() < 0.03:
                ends = [f"-1.7E308 + {wild}", f"{wild} + 1.7E308"]
            step = (" STEP 0.1", " STEP 0.25", "", " STEP 0.7", f" STEP {wild}", f" STEP {wild} / 3")
            if "E308" in ends[0]:
                step = (" STEP 1E308", " STEP 4.E307", " STEP 1.7E308")
        way = pick.choice(("TO", "TO", "DOWNTO"))
        if way == "DOWNTO" and pick.random() < 0.7:
            ends.reverse()
        text = f"  FOR {variable} := {ends[0]} {way} {ends[1]}{pick.choice(step)} DO\n"
        return text + self.loop(scope, depth) + "  ENDFOR;\n"

    def counter(self, scope):
        scope.counters.append(f"k{len(scope.counters)}")
        return scope.counters[-1]

    def while_(self, scope, depth):
        count = self.counter(scope)
        bool_ = self.operand(scope, "{bool}", 2, AND)
        text = f"  {count} := 0;\n  WHILE {count} < {self.chance.randrange(1, 5)} AND {bool_} DO\n"
        return text + f"  {count} := {count} + 1;\n{self.loop(scope, depth)}  ENDWHILE;\n"

    def repeat_(self, scope, depth):
        count = self.counter(scope)
        bool_ = self.operand(scope, "{bool}", 2, AND)
        text = f"  {count} := 0;\n  REPEAT\n  {count} := {count} + 1;\n{self.loop(scope, depth)}"
        return text + f"  UNTIL {bool_} OR {count} >= {self.chance.randrange(1, 5)};\n"

    def forward_(self, scope, depth):
        self.labels += 1
        jump = f"  IF {self.value(scope, 'bool', 2)} THEN GOTO l{self.labels}; ENDIF;\n"
        label = f"  l{self.labels}:\n"
        between = self.block(scope, depth)
        return f"  IF {self.value(scope, 'bool', 1)} THEN\n{jump}  ENDIF;\n{between}{label}"

    def back_(self, scope, depth):
        self.labels += 1
        count, label = self.counter(scope), f"l{self.labels}"
        text = f"  {count} := 0;\n  {label}:\n  {count} := {count} + 1;\n{self.block(scope, depth)}"
        return text + f"  IF {count} < 3 AND {self.value(scope, 'bool', 0)} THEN GOTO {label}; ENDIF;\n"


def with_all_parentheses(text):
    return text.replace(OPEN, "(").replace(CLOSE, ")")


def with_few_parentheses(text):
    return text.replace(OPEN, "").replace(CLOSE, "")


def written(seed):
    """A random program, marked where parentheses may be left out."""
    return Author(seed).program()
