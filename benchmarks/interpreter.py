"""How many simple statements a second the interpreter executes, by kind: python benchmarks/interpreter.py."""

from __future__ import annotations

import argparse
import json
from time import perf_counter

from irlx.interpreter.interpret import interpret
from irlx.interpreter.setting import SYSTEM_REALS, Setting
from irlx.language.analysis import analyse
from irlx.language.source import source_text

LOOPS = {
    "INT assignments": ("INT: i, a, b;", "a := i + 1; b := a * 2; a := b - i; b := a;", 4),
    "REAL assignments": (
        "INT: i; REAL: x := 1, y := 2;",
        "x := y * 0.5 + 1; y := x - y; x := x / 2; y := 3;",
        4,
    ),
    "IF and comparison": ("INT: i, a := 0;", "IF i MOD 3 = 0 THEN a := a + 1; ELSE a := a - 1; ENDIF;", 2),
    "array elements": (
        "INT: i; ARRAY [0..999] OF INT: v;",
        "v[i MOD 1000] := i; v[(i + 1) MOD 1000] := v[i MOD 1000];",
        2,
    ),
    "WHILE": ("INT: i, a;", "a := 0; WHILE a < 10 DO a := a + 1; ENDWHILE;", 22),
    "CASE": ("INT: i, a;", "CASE i MOD 4 OF WHEN 0, 1: a := 1; WHEN 2..3: a := 2; ENDCASE;", 2),
    "procedure calls": ("INT: i, a := 0;", "add(a, i);", 3),
    "function calls": ("INT: i, a := 0;", "a := sum(a, i) MOD 7;", 3),
    "poses": (
        "INT: i; POSE: p := ((1, 2, 3), (1, 0, 0, 0)), q := ((3, 2, 1), (0, 1, 0, 0));",
        "p := p @ q;",
        1,
    ),
}
ROUTINES = """
PROCEDURE add(VAR INT: sum; INT: b); BEGIN sum := (sum + b) MOD 1000; ENDPROC;
FUNCTION sum(INT: a, b): INT; BEGIN RETURN a + b; ENDFCT;
"""


def rate(declarations: str, body: str, statements: int, rounds: int) -> float:
    """Statements a second of a loop: those of its body, and one for the loop itself a round."""
    text = (
        f"PROGRAM t; {ROUTINES} VAR {declarations} BEGIN FOR i := 1 TO {rounds} DO {body} ENDFOR; ENDPROGRAM"
    )
    analysis = analyse(source_text("t.irl", text))
    setting = Setting(("j1",), (False,), dict.fromkeys(SYSTEM_REALS, 100.0))
    run = interpret(analysis.tree, analysis.source, setting, max_steps=10**9)
    start = perf_counter()
    for _ in run:
        pass
    return rounds * (statements + 1) / (perf_counter() - start)


def main() -> None:
    """Print the best of several runs for each kind of statement."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=50_000)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    rates = {
        name: max(rate(*loop, options.rounds) for _ in range(options.runs)) for name, loop in LOOPS.items()
    }
    if options.json:
        print(json.dumps(rates, indent=2))
        return
    for name, found in rates.items():
        print(f"{name:<20}{found:>12,.0f} statements/s")


if __name__ == "__main__":
    main()
