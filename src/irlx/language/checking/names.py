"""Names with types: what is in view at a place of a program."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from irlx.language.builtins import (
    ACTUAL_VARIABLES,
    FOLLOWED_VARIABLES,
    SYSTEM_VARIABLES,
    is_analog_port,
    is_input_port,
    is_port_name,
)
from irlx.language.symbols import Symbol, SymbolKind
from irlx.language.types import (
    BOOL,
    POSE,
    REAL,
    STRING,
    Signature,
    Type,
    built_in_functions,
    joint_bounds,
    joint_weights,
)

Constant: TypeAlias = "bool | int | float | str | tuple[Constant | None, ...]"
"""A value that the text tells; of a record or array a tuple, with None for what it does not tell."""

_SYSTEM_TYPES: dict[str, Type] = {
    "r_base": POSE,
    "r_tool": POSE,
    "r_c_pass": BOOL,
    "r_profile": STRING,
}
"""Types of the system variables that are no REAL, without those that depend on the robot."""


@dataclass(slots=True)
class Entry:
    """A name in view: its kind, type and, of a constant, its value.

    `settings` counts what sets a variable anywhere in the text, and `settled` is the value that it is set to:
    after the whole text, a variable that is set once has that value or none.
    """

    kind: SymbolKind | str
    type: Type
    symbol: Symbol | None = None
    value: Constant | None = None
    signature: Signature | None = None
    settings: int = 0
    settled: Constant | None = None

    def set(self, value: Constant | None, *, whole: bool = True) -> None:
        """Count what sets the variable, as a `whole` or in part."""
        self.settings += 1
        self.settled = value if whole and self.settings == 1 else None


class Names:
    """Values and types in view, by casefolded name; those of a routine hide the outer ones."""

    def __init__(self, types: dict[str, Type], outer: Names | None = None) -> None:
        self.outer = outer
        self.types = types
        self.values: dict[str, Entry] = {}
        self.type_symbols: dict[str, Symbol] = {}
        self.obstacles: Collection[str] | None = outer.obstacles if outer is not None else None
        """Names of obstacles and groups of the cell, None where no cell is known."""
        self.frames: Collection[str] | None = outer.frames if outer is not None else None
        """Names of frames of the cell, None where no cell is known."""
        self.functions: dict[str, Signature] = built_in_functions(types) if outer is None else outer.functions

    def inner(self) -> Names:
        """A view for a routine."""
        return Names(dict(self.types), self)

    def value(self, key: str) -> Entry | None:
        """What a name means that is no type."""
        names: Names | None = self
        while names is not None:
            found = names.values.get(key)
            if found is not None:
                return found
            names = names.outer
        return None

    def type_symbol(self, key: str) -> Symbol | None:
        """The declared type of a name."""
        found = self.type_symbols.get(key)
        return found or (self.outer.type_symbol(key) if self.outer else None)


def system_names(
    types: dict[str, Type],
    frames: Collection[str] | None,
    joints: int | None = None,
    obstacles: Collection[str] | None = None,
) -> Names:
    """The outermost names: system variables of a robot of a number of joints, what its cell has names for.

    Of `frames` a mapping says which move with a link of the robot, and are no poses.
    """
    names = Names(types)
    names.obstacles, names.frames = obstacles, frames
    of_robot = {
        "r_robtarget_act": types["robtarget"],
        "r_joint_act": types["joint"],
        "r_jbd": joint_bounds(types),
        "r_weights": joint_weights(joints),
    }
    for key in SYSTEM_VARIABLES:
        kind = (
            "system" if key in ACTUAL_VARIABLES else "followed" if key in FOLLOWED_VARIABLES else "variable"
        )
        names.values[key] = Entry(kind, of_robot.get(key) or _SYSTEM_TYPES.get(key, REAL))
    moving = {name for name, moves in frames.items() if moves} if isinstance(frames, Mapping) else ()
    for frame in frames or ():
        entry = Entry("moving frame" if frame in moving else "constant", POSE)
        names.values.setdefault(frame.casefold(), entry)
    return names


def port_entry(key: str) -> Entry | None:
    """What the name of a port means that is not declared."""
    if not is_port_name(key):
        return None
    return Entry("input" if is_input_port(key) else "output", REAL if is_analog_port(key) else BOOL)
