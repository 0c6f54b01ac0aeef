"""A whole case: program, cell, robot, module, data list and input files, all from one seed."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from drawn.cells import CellDrawing
from drawn.goals import Goals
from drawn.moves import Moves
from drawn.options import Options
from drawn.robots import drawn_robot
from drawn.script import Script
from drawn.statements import FREE, NUMBERS, Statements
from drawn.values import Values

LEAST_MOVES, MOST_MOVES = 10, 50

ROUTINES = {
    "visit": [
        "PROCEDURE visit(IN POSE: there; REAL: fast; VAR INT: count);",
        "BEGIN",
        "  MOVE LIN there SPEED := fast;",
        "  count := (count + 1) MOD 100;",
        "ENDPROC;",
    ],
    "same": [
        "FUNCTION same(POSE: p; INT: k): POSE;",
        "BEGIN",
        "  IF k > 100 THEN RETURN INV(p); ENDIF;",
        "  RETURN p @ POSE(POSITION(0, 0, 0), ORIENTATION(1, 0, 0, 0));",
        "ENDFCT;",
    ],
    "turns_of": [
        "FUNCTION turns_of(INT: k): INT;",
        "  TYPE ARRAY [1..2] OF INT = pair;",
        "  VAR pair: both := (1, k);",
        "BEGIN",
        "  IF k <= 1 THEN",
        "    RETURN both[1];",
        "  ENDIF;",
        "  RETURN both[2] * turns_of(k - 1);",
        "ENDFCT;",
    ],
}
CALLED = [
    "PROCEDURE called(POSE: there);",
    "BEGIN",
    "  MOVE LIN there;",
    "ENDPROC;",
]


@dataclass(frozen=True)
class Case:
    """Files of a case by name, and what they use."""

    seed: int
    files: dict[str, str]
    noted: Counter[str] = field(default_factory=Counter)
    tick: float = 0.0

    def write(self, folder: Path) -> None:
        for name, text in self.files.items():
            (folder / name).write_text(text, encoding="utf-8")


def drawn_case(seed: int, kind: str | None = None) -> Case:
    """The case of a seed, its robot of a kind or of any."""
    rng = np.random.default_rng(seed)
    robot = drawn_robot(rng, kind)
    body = CellDrawing(rng, robot).body()
    script = Script(rng, body)
    script.note(
        f"robot {robot.kind}",
        f"tick {body.tick} ms",
        f"{body.n} joints",
        *(f"cell: {s}" for s in body.special),
    )
    if robot.kind == "named":
        script.note(f"model {robot.model}")
    script.at = body.home
    values, goals = Values(script), Goals(script)
    options = Options(script, values, goals)
    statements = Statements(script, values, Moves(script, values, goals, options), options)
    count = int(rng.integers(LEAST_MOVES, MOST_MOVES + 1))
    script.moves_left = count
    lines = statements.block(count)
    if script.chance(0.1):
        script.note("HALT")
        lines += ["HALT;", *statements.block(1, True)]
    elif script.chance(0.05):
        script.note("RETURN of the program")
        lines += ["RETURN;"]
    files = {
        "program.irl": program_text(script, lines),
        "cell.toml": body.text,
        **robot.files,
        **beside(script),
    }
    return Case(seed, files, script.noted, body.tick)


def beside(script: Script) -> dict[str, str]:
    """Files beside the program."""
    files = {"numbers.txt": NUMBERS, "input.txt": " ".join([*script.reads, ""])}
    if script.data:
        files["points.dat"] = "\n".join(
            ["DATALIST points;", *(f"  {line}" for line in script.data), "ENDDATALIST", ""]
        )
    if script.module or "called" in script.needs:
        exported = [*script.exported, *(["called"] if "called" in script.needs else [])]
        body = [
            f"EXPORT {', '.join(exported)};",
            *script.module,
            *(CALLED if "called" in script.needs else []),
        ]
        files["parts.irl"] = "\n".join(["MODULE parts;", *body, "ENDMODULE", ""])
    return files


def program_text(script: Script, lines: list[str]) -> str:
    """The program with its parts in any order that the language allows."""
    rng = script.rng
    head = ["PROGRAM drawn;"]
    parts: list[list[str]] = [["SYSTEM SPECIFICATION cell;"]]
    imported = [*script.exported, *(["called"] if "called" in script.needs else [])]
    if imported:
        parts.append([f"FROM parts IMPORT {', '.join(imported)};"])
    if script.data:
        parts.append(["IMPORT DATALIST points;"])
    for share, word, part in (
        (0.2, "STANDARD_OUT", "STANDARD_OUT = SCREEN;"),
        (0.2, "STANDARD_IN", "STANDARD_IN = KEYBOARD;"),
        (0.2, "ROBOT", f"ROBOT arm := {script.body.cell.robot.name};"),
        (0.2, "EXPORT", "EXPORT n;"),
        (0.1, "EXPORT TO", "EXPORT m TO others;"),
    ):
        if script.chance(share):
            script.note(word)
            parts.append([part])
    if script.types:
        parts.append(["TYPE", *(f"  {line}" for line in script.types)])
    if script.constants:
        parts.append(["CONST", *(f"  {line}" for line in script.constants)])
    routines = [line for name in ROUTINES if name in script.needs for line in ROUTINES[name]]
    variables = ["VAR", *(f"  {one};" for one in FREE), *(f"  {line}" for line in script.variables)]
    late = [part for part in ([*routines, *script.routines], variables) if part]
    if script.chance(0.5):
        late.reverse()
    parts = [parts[int(k)] for k in rng.permutation(len(parts))] if not script.constants else parts
    body = [line for part in [*parts, *late] for line in part]
    return "\n".join([*head, *body, "BEGIN", *(f"  {line}" for line in lines), "ENDPROGRAM;", ""])
