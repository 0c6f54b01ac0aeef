"""Random expressions with functions that change what others read, against Python's order of evaluation."""

import random

import pytest

from long_run import first

DECLARATIONS = """VAR INT: n := 1, log := 0, i := 0; BOOL: b := FALSE;
FUNCTION small(INT: x): INT; BEGIN x := x MOD 7; IF x < 0 THEN RETURN x + 7; ENDIF; RETURN x; ENDFCT;
FUNCTION f(INT: x): INT; BEGIN n := small(n + 1); log := (log * 3 + 1) MOD 1000003; RETURN x + n; ENDFCT;
FUNCTION g(BOOL: x): BOOL; BEGIN n := small(n + 2); log := (log * 5 + 2) MOD 1000003; RETURN NOT x; ENDFCT;
FUNCTION h(VAR INT: v; INT: x): INT;
BEGIN v := small(v + x); log := (log * 7 + 3) MOD 1000003; RETURN n; ENDFCT;
"""
COMPARISONS = {"<": "<", ">": ">", "=": "==", "<>": "!=", "<=": "<=", ">=": ">="}


class Twin:
    """What the functions above do, in Python."""

    def __init__(self):
        self.n, self.log = 1, 0

    def f(self, x):
        self.n, self.log = (self.n + 1) % 7, (self.log * 3 + 1) % 1000003
        return x + self.n

    def g(self, x):
        self.n, self.log = (self.n + 2) % 7, (self.log * 5 + 2) % 1000003
        return not x

    def h(self, x):
        self.n, self.log = (self.n + x) % 7, (self.log * 7 + 3) % 1000003
        return self.n


def whole(rng, depth):
    """A random INT expression as the language and as Python write it."""
    kind = rng.randrange(6) if depth else rng.randrange(2)
    if kind == 0:
        digit = str(rng.randrange(9))
        return digit, digit
    if kind == 1:
        return "n", "t.n"
    left = whole(rng, depth - 1)
    if kind == 2:
        return f"f({left[0]})", f"t.f({left[1]})"
    if kind == 3:
        return f"h(n, {left[0]})", f"t.h({left[1]})"
    right, op = whole(rng, depth - 1), rng.choice("+-*")
    return f"({left[0]} {op} {right[0]})", f"({left[1]} {op} {right[1]})"


def truth(rng, depth):
    """A random BOOL expression as the language and as Python write it."""
    kind = rng.randrange(5) if depth else 0
    if kind == 0:
        value = str(rng.random() < 0.5)
        return value.upper(), value
    if kind == 1:
        left, right, op = whole(rng, depth - 1), whole(rng, depth - 1), rng.choice(list(COMPARISONS))
        return f"({left[0]} {op} {right[0]})", f"({left[1]} {COMPARISONS[op]} {right[1]})"
    left = truth(rng, depth - 1)
    if kind == 2:
        return f"(NOT {left[0]})", f"(not {left[1]})"
    if kind == 3:
        return f"g({left[0]})", f"t.g({left[1]})"
    right, op = truth(rng, depth - 1), rng.choice(["AND", "OR"])
    return f"({left[0]} {op} {right[0]})", f"({left[1]} {op.lower()} {right[1]})"


@pytest.mark.req("LANG-11")
@pytest.mark.req("LANG-30")
@pytest.mark.parametrize("seed", first(2, range(10)))
def test_everything_happens_once_and_in_order(final, seed):
    rng = random.Random(seed)
    for _ in range(40):
        make, name = rng.choice([(whole, "i"), (truth, "b")])
        text, python = make(rng, 5)
        twin = Twin()
        expected = eval(python, {"t": twin})
        found = final(DECLARATIONS, f"{name} := {text};")
        assert (found[name], found["n"], found["log"]) == (expected, twin.n, twin.log), text
