"""What the text of a MOVE tells: order of its parts, number of targets, options that do not fit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from irlx.diagnostics import Diagnostic, Place, SourceText, Span, report
from irlx.language import tree
from irlx.language.builtins import LIMIT_WORDS

__all__ = ["check_move"]


def check_move(move: tree.Move, source: SourceText) -> list[Diagnostic]:
    """Findings on one MOVE."""
    found = [*_order(move), *_kind(move), *_clauses(move)]
    return [report(code, Place.in_text(source, span), **data) for code, span, data in found]


def _order(move: tree.Move) -> Iterator[tuple[str, Span, dict[str, Any]]]:
    """Targets come first, then IN FRAME, parameters, clauses; the first offender is enough."""
    if len(move.frames) > 1:
        yield "IRL114", move.frames[1].span, {"item": "a second IN FRAME"}
        return
    behind = [part[0].span.start for part in (move.params, move.clauses) if part]
    if any(frame.span.start > first for frame in move.frames for first in behind):
        yield "IRL114", move.frames[0].span, {"item": "IN FRAME"}
        return
    firsts = [part[0].span.start for part in (move.frames, move.params, move.clauses) if part]
    for target in move.targets:
        if any(target.span.start > first for first in firsts):
            yield "IRL114", target.span, {"item": "this target"}
            return
    clause_start = move.clauses[0].span.start if move.clauses else None
    for param in move.params:
        if clause_start is not None and param.span.start > clause_start:
            yield "IRL114", param.span, {"item": f"'{param.name.name}'"}
            return


def _kind(move: tree.Move) -> Iterator[tuple[str, Span, dict[str, Any]]]:
    if move.path and move.kind not in ("LIN", "SPLINE"):
        yield "IRL401", move.span, {"kind": move.kind}
    if move.kind == "SPLINE" and not move.path:
        yield "IRL402", move.span, {}
    if move.kind == "CIRCLE" and not move.path and len(move.targets) % 2:
        yield "IRL403", move.span, {"count": len(move.targets)}
    for param in move.params:
        if param.name.key in ("angle", "circ_ori") and move.kind != "CIRCLE":
            yield "IRL404", param.span, {"param": param.name.key.upper(), "kind": move.kind}


def _clauses(move: tree.Move) -> Iterator[tuple[str, Span, dict[str, Any]]]:
    seen: set[str] = set()
    for clause in move.clauses:
        kind = _clause_kind(clause)
        if kind.casefold() in seen:
            yield "IRL406", clause.span, {"clause": kind}
        elif isinstance(clause, tree.WithCriterion) and move.kind == "PTP":
            yield "IRL407", clause.span, {"clause": kind}
        seen.add(kind.casefold())
        if not isinstance(clause, tree.WithReconfiguration):
            continue
        # A PATH may take both lists from array variables, whose lengths their types tell.
        listed = not move.path
        counts = {len(move.targets), len(move.targets) // 2 if move.kind == "CIRCLE" else len(move.targets)}
        if listed and len(clause.targets) not in counts:
            data = {"targets": len(move.targets), "postures": len(clause.targets)}
            yield "IRL405", clause.span, data


def _clause_kind(clause: tree.WithClause) -> str:
    match clause:
        case tree.WithLimit(kind=kind):
            return LIMIT_WORDS[kind]
        case tree.WithReconfiguration():
            return "RECONFIGURATION"
        case tree.WithCriterion(name=name):
            return f"CRITERION {name.name}"
        case tree.WithTolerance():
            return "TOLERANCE"
