"""Nodes of statements other than motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from irlx.language.tree.expressions import Argument, Designator, Expression, Range
from irlx.language.tree.motion import (
    CriterionEnd,
    CriterionStart,
    CyclicEnd,
    CyclicStart,
    FreezeEnd,
    FreezeStart,
    LimitSwitch,
    LimitSwitchEnd,
    Move,
    ObstacleEnd,
    ObstacleStart,
    Reconfiguration,
)
from irlx.language.tree.nodes import Name, Node


@dataclass(frozen=True, slots=True)
class Assignment(Node):
    """``target := value``; setting an output is one too."""

    target: Designator
    value: Expression


@dataclass(frozen=True, slots=True)
class Call(Node):
    """Call of a procedure, declared or built in."""

    name: Name
    arguments: tuple[Argument, ...]


@dataclass(frozen=True, slots=True)
class Return(Node):
    """RETURN, with the value of a function or without."""

    value: Expression | None


@dataclass(frozen=True, slots=True)
class Goto(Node):
    """GOTO label."""

    label: Name


@dataclass(frozen=True, slots=True)
class Label(Node):
    """A place that GOTO names, a statement of its own before the one it marks."""

    name: Name


@dataclass(frozen=True, slots=True)
class IfBranch(Node):
    """IF or ELSIF with its condition and what it guards."""

    condition: Expression
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class If(Node):
    """IF: branches in order; `otherwise` is None without ELSE."""

    branches: tuple[IfBranch, ...]
    otherwise: tuple[Statement, ...] | None


@dataclass(frozen=True, slots=True)
class CaseBranch(Node):
    """WHEN with its values and ranges."""

    labels: tuple[Expression | Range, ...]
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class Case(Node):
    """CASE; `default` is None without DEFAULT."""

    selector: Expression
    branches: tuple[CaseBranch, ...]
    default: tuple[Statement, ...] | None


@dataclass(frozen=True, slots=True)
class For(Node):
    """FOR, upwards or with `down` downwards; `step` is None where the program gives none."""

    variable: Designator
    start: Expression
    stop: Expression
    down: bool
    step: Expression | None
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class While(Node):
    """WHILE condition DO."""

    condition: Expression
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class Repeat(Node):
    """REPEAT .. UNTIL condition."""

    body: tuple[Statement, ...]
    condition: Expression


@dataclass(frozen=True, slots=True)
class Exit(Node):
    """EXIT: leaves the innermost loop."""


@dataclass(frozen=True, slots=True)
class Halt(Node):
    """HALT: comes to rest and ends the run."""


@dataclass(frozen=True, slots=True)
class Pause(Node):
    """PAUSE: comes to rest and waits to be continued."""


@dataclass(frozen=True, slots=True)
class WaitTime(Node):
    """WAIT duration SEC; duration in s."""

    duration: Expression


@dataclass(frozen=True, slots=True)
class WaitFor(Node):
    """WAIT FOR condition, for at most `timeout` s where one is given."""

    condition: Expression
    timeout: Expression | None


Statement: TypeAlias = (
    "Assignment | Call | Return | Goto | Label | If | Case | For | While | Repeat | Exit | Halt | Pause"
    " | WaitTime | WaitFor | Move | LimitSwitch | LimitSwitchEnd | FreezeStart | FreezeEnd | CyclicStart"
    " | CyclicEnd | ObstacleStart | ObstacleEnd | Reconfiguration | CriterionStart | CriterionEnd"
)
