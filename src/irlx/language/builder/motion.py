"""Reductions of motion statements and of the switches of the redundancy extension."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from irlx.language import tree
from irlx.language.builder.children import Children, nodes_of, span_of
from irlx.language.token import Token

_CLAUSES = (tree.WithLimit, tree.WithReconfiguration, tree.WithCriterion, tree.WithTolerance)
_LIMIT_KINDS: dict[str, tree.LimitKind] = {
    "JOINTLIMIT": "POSITION",
    "JOINTSPEEDLIMIT": "SPEED",
    "JOINTACCELLIMIT": "ACCELERATION",
}


def _opened(targets: tuple[tree.Expression, ...]) -> tuple[tree.Expression, ...]:
    """The items of a PATH's parenthesised list."""
    if len(targets) == 1:
        match targets[0]:
            case tree.Aggregate(items=items):
                return items
            case tree.Paren(value=value):
                return (value,)
    return targets


class _Tail:
    """Sorts the flat tail of a MOVE: what follows a clause may belong to it."""

    def __init__(self) -> None:
        self.targets: list[tree.Expression] = []
        self.frames: list[tree.InFrame] = []
        self.params: list[tree.MoveParam] = []
        self.clauses: list[tree.WithClause] = []

    def add(self, item: tree.Expression | tree.InFrame | tree.MoveParam | tree.WithClause) -> None:
        """Take the next item of the tail."""
        last = self.clauses[-1] if self.clauses else None
        if isinstance(item, _CLAUSES):
            self.clauses.append(item)
        elif isinstance(item, tree.InFrame):
            self.frames.append(item)
        elif isinstance(item, tree.MoveParam):
            if isinstance(last, tree.WithCriterion):
                span = last.span.to(item.span)
                self.clauses[-1] = replace(last, span=span, params=(*last.params, item))
            else:
                self.params.append(item)
        elif isinstance(last, tree.WithReconfiguration):
            span = last.span.to(item.span)
            self.clauses[-1] = replace(last, span=span, targets=(*last.targets, item))
        else:
            self.targets.append(item)

    def opened_clauses(self) -> Iterable[tree.WithClause]:
        """The clauses with the lists of a PATH opened."""
        for clause in self.clauses:
            if isinstance(clause, tree.WithReconfiguration):
                yield replace(clause, targets=_opened(clause.targets))
            else:
                yield clause


class MotionBuilder:
    """Methods for the rules of motion and switches."""

    def move(self, children: Children) -> tree.Move:
        """Reduce MOVE or MOVE_INC with its flat tail."""
        tail = _Tail()
        for child in children[2:]:
            if not isinstance(child, Token):
                tail.add(child)
        path = isinstance(children[2], Token)
        targets = tuple(tail.targets)
        return tree.Move(
            span_of(children),
            children[1].type,
            path,
            children[0].type == "MOVE_INC",
            _opened(targets) if path else targets,
            tuple(tail.frames),
            tuple(tail.params),
            tuple(tail.opened_clauses() if path else tail.clauses),
        )

    def in_frame(self, children: Children) -> tree.InFrame:
        """Reduce IN FRAME."""
        return tree.InFrame(span_of(children), children[2])

    def param(self, children: Children) -> tree.MoveParam:
        """Reduce ``name := value``."""
        return tree.MoveParam(span_of(children), children[0], children[2])

    def with_limit(self, children: Children) -> tree.WithLimit:
        """Reduce WITH JOINTLIMIT and its kin."""
        return tree.WithLimit(span_of(children), _LIMIT_KINDS[children[1].type], children[2], children[4])

    def with_reconfiguration(self, children: Children) -> tree.WithReconfiguration:
        """Reduce WITH RECONFIGURATION; further targets come with the tail."""
        return tree.WithReconfiguration(span_of(children), (children[2],))

    def with_criterion(self, children: Children) -> tree.WithCriterion:
        """Reduce WITH CRITERION; its parameters come with the tail."""
        return tree.WithCriterion(span_of(children), children[2], ())

    def with_tolerance(self, children: Children) -> tree.WithTolerance:
        """Reduce WITH TOLERANCE."""
        return tree.WithTolerance(span_of(children), children[2])

    def limit_switch(self, children: Children) -> tree.LimitSwitch:
        """Reduce JOINTLIMIT and its kin."""
        return tree.LimitSwitch(span_of(children), _LIMIT_KINDS[children[0].type], children[1], children[3])

    def limit_switch_end(self, children: Children) -> tree.LimitSwitchEnd:
        """Reduce JOINTLIMITEND and its kin."""
        return tree.LimitSwitchEnd(span_of(children), _LIMIT_KINDS[children[0].type.removesuffix("END")])

    def freeze_start(self, children: Children) -> tree.FreezeStart:
        """Reduce FREEZESTART."""
        return tree.FreezeStart(span_of(children), nodes_of(children))

    def freeze_end(self, children: Children) -> tree.FreezeEnd:
        """Reduce FREEZEEND."""
        return tree.FreezeEnd(span_of(children))

    def cyclic_start(self, children: Children) -> tree.CyclicStart:
        """Reduce CYCLICSTART."""
        return tree.CyclicStart(span_of(children))

    def cyclic_end(self, children: Children) -> tree.CyclicEnd:
        """Reduce CYCLICEND."""
        return tree.CyclicEnd(span_of(children))

    def obstacle_start(self, children: Children) -> tree.ObstacleStart:
        """Reduce OBSTACLE."""
        return tree.ObstacleStart(span_of(children), children[1])

    def obstacle_end(self, children: Children) -> tree.ObstacleEnd:
        """Reduce OBSTACLEEND."""
        return tree.ObstacleEnd(span_of(children), children[1])

    def reconfiguration(self, children: Children) -> tree.Reconfiguration:
        """Reduce RECONFIGURATION as a statement."""
        return tree.Reconfiguration(span_of(children), children[1], *children[2:])

    def criterion_start(self, children: Children) -> tree.CriterionStart:
        """Reduce CRITERION."""
        return tree.CriterionStart(span_of(children), children[1], nodes_of(children[2:]))

    def criterion_end(self, children: Children) -> tree.CriterionEnd:
        """Reduce CRITERIONEND."""
        return tree.CriterionEnd(span_of(children), children[1])
