"""A program in the making: its declarations, its files, and what the writer knows of it."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from drawn.body import Body, Pose

SIDES = ("MIN", "MAX")
LIMIT_WORDS = {"position": "JOINTLIMIT", "speed": "JOINTSPEEDLIMIT", "acceleration": "JOINTACCELLIMIT"}
LIMIT_TYPES = {"position": "MAIN_JOINT", "speed": "MAIN_JOINT_SPEED", "acceleration": "MAIN_JOINT_ACCEL"}


@dataclass
class Script:
    """Declarations by part, and the state of the program where the next statement stands.

    `at` is where the tool will be, None where nobody knows; `base` and `tool` are R_BASE and R_TOOL.
    `inside` how deep in loops, branches and routines; `local` whether in a routine, which no value of this
    place may go to. `noted` counts what was written.
    """

    rng: np.random.Generator
    body: Body
    noted: Counter[str] = field(default_factory=Counter)
    constants: list[str] = field(default_factory=list)
    types: list[str] = field(default_factory=list)
    variables: list[str] = field(default_factory=list)
    routines: list[str] = field(default_factory=list)
    data: list[str] = field(default_factory=list)
    module: list[str] = field(default_factory=list)
    exported: list[str] = field(default_factory=list)
    files: dict[str, str] = field(default_factory=dict)
    routine_names: list[str] = field(default_factory=list)
    count: int = 0
    at: Pose | None = None
    base: Pose = field(default_factory=lambda: (np.zeros(3), Rotation.identity()))
    tool: Pose = field(default_factory=lambda: (np.zeros(3), Rotation.identity()))
    frozen: tuple[int, ...] = ()
    cyclic: bool = False
    narrowed: set[str] = field(default_factory=set)
    watched: set[str] = field(default_factory=set)
    criteria: set[str] = field(default_factory=set)
    inside: int = 0
    moves_left: int = 0
    needs: set[str] = field(default_factory=set)
    """Routines of a fixed text that are called."""
    reads: list[str] = field(default_factory=list)
    """Values that STANDARD_IN holds, in order."""

    def note(self, *words: str) -> None:
        self.noted.update(words)

    def chance(self, share: float) -> bool:
        return bool(self.rng.random() < share)

    def pick(self, items):
        return items[int(self.rng.integers(len(items)))]

    def name(self, letter: str = "v") -> str:
        self.count += 1
        return f"{letter}{self.count}"

    def holds(self, type_: str, value: str, exact: bool = True) -> str:
        """A place that holds a value: variable, constant, part of an array or record, datum."""
        kind = self.pick(
            ["variable"] * 5 + ["constant", "array", "record", "data", "module", "group", "dotted"]
        )
        name = self.name()
        simple = type_ in {"INT", "REAL", "BOOL", "STRING", "CHAR", "POSITION", "ORIENTATION", "POSE"}
        if kind == "constant" and exact:
            self.note("constant")
            self.constants.append(f"{type_}: {name} := {value};")
        elif kind == "array" and simple:
            self.note("array")
            place = int(self.rng.integers(3))
            self.variables.append(f"ARRAY [{place}..{place + 1}] OF {type_}: {name} := ({value}, {value});")
            return f"{name}[{place + int(self.rng.integers(2))}]"
        elif kind == "record" and simple:
            self.note("record")
            record = self.name("t")
            field_name = "what.now" if self.chance(0.5) else "what"
            self.types.append(f"RECORD INT: tag; {type_}: {field_name}; ENDRECORD = {record};")
            self.variables.append(f"{record}: {name} := (7, {value});")
            return f"{name}.{field_name}"
        elif kind == "data" and exact:
            self.note("data list")
            self.data.append(f"{type_}: {name} := {value};")
        elif kind == "module" and exact and simple:
            self.note("module")
            part = self.pick(["CONST", "VAR"])
            self.module.append(f"{part} {type_}: {name} := {value};")
            self.exported.append(name)
        elif kind == "group" and simple:
            self.note("array of two dimensions")
            self.variables.append(
                f"ARRAY [1..2, -1..0] OF {type_}: {name} := ({value}, {value}, {value}, {value});"
            )
            return f"{name}[{self.pick(['1', '2'])}, {self.pick(['-1', '0'])}]"
        else:
            self.note("variable")
            other = f", {self.name()}" if self.chance(0.2) else ""
            self.variables.append(f"{type_}: {name} := {value}{other};")
        return name

    def limits_in_force(self) -> tuple[np.ndarray, np.ndarray]:
        return self.body.cell.limits.pair("position")

    def statement_state(self) -> tuple:
        return self.at, self.base, self.tool
