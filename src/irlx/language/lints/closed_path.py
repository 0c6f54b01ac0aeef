"""Paths under CYCLICSTART that do not come back to where they began, where the text clearly tells."""

from __future__ import annotations

from collections.abc import Iterator
from math import dist
from typing import TypeAlias

from irlx.diagnostics import Diagnostic, Place, Related, SourceText, report
from irlx.language import tree
from irlx.language.checking.context import Facts
from irlx.language.checking.names import Constant
from irlx.language.lints.settled import value_of
from irlx.language.types import POSE, POSITION

_Point: TypeAlias = tuple[float, float, float]

_CLOSED_MM = 1e-3
_STAYS = (
    tree.LimitSwitch,
    tree.LimitSwitchEnd,
    tree.FreezeStart,
    tree.FreezeEnd,
    tree.ObstacleStart,
    tree.ObstacleEnd,
    tree.CriterionStart,
    tree.CriterionEnd,
    tree.Reconfiguration,
    tree.WaitTime,
    tree.WaitFor,
    tree.Pause,
)
"""Statements that leave the tool where it is."""
_FRAMES = frozenset({"r_base", "r_tool"})


def open_cycles(program: tree.Program, facts: Facts, source: SourceText) -> Iterator[Diagnostic]:
    """A warning at every such CYCLICSTART of the main statements."""
    at: _Point | None = None
    start: tuple[tree.CyclicStart, _Point | None] | None = None
    last: tree.Node | None = None
    for statement in program.body:
        match statement:
            case tree.Move():
                at, last = _end(statement, facts), statement.targets[-1] if statement.targets else None
            case tree.CyclicStart():
                start, last = (statement, at), None
            case tree.CyclicEnd():
                if start is not None and start[1] is not None and at is not None and last is not None:
                    yield from _compared(start[0], start[1], at, last, source)
                start = None
            case tree.Assignment(target=target):
                if target.base.key in _FRAMES:
                    return
            case _ if not isinstance(statement, _STAYS):
                at = None
                # Jumps and loops may pass here on other ways than from above.
                start = None


def _end(move: tree.Move, facts: Facts) -> _Point | None:
    """Where a MOVE ends, mm."""
    turned = any(param.name.key == "angle" for param in move.params)
    if move.incremental or turned or not move.targets or move.frame is not None:
        return None
    type, settled = facts.targets.get(id(move.targets[-1]), (None, None))
    value = value_of(settled)
    if type == POSE and isinstance(value, tuple) and value:
        return _point(value[0])
    return _point(value) if type == POSITION else None


def _point(value: Constant | None) -> _Point | None:
    if not isinstance(value, tuple) or len(value) != 3:
        return None
    x, y, z = value
    if isinstance(x, int | float) and isinstance(y, int | float) and isinstance(z, int | float):
        return float(x), float(y), float(z)
    return None


def _compared(
    start: tree.CyclicStart, begin: _Point, end: _Point, last: tree.Node, source: SourceText
) -> Iterator[Diagnostic]:
    if dist(begin, end) > _CLOSED_MM:
        related = (Related("the path ends here", Place.in_text(source, last.span)),)
        data = {"begin": _shown(begin), "end": _shown(end)}
        yield report("IRL311", Place.in_text(source, start.span), related=related, **data)


def _shown(point: _Point) -> str:
    return f"({', '.join(f'{part:g}' for part in point)})"
