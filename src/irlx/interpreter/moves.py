"""MOVE and MOVE_INC: program tree -> steps that yield one block for each move."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from math import radians
from typing import Any, NamedTuple

from irlx.blocks import (
    ArcCourse,
    Block,
    CriterionClause,
    JointTarget,
    LimitClause,
    LimitKind,
    MoveBlock,
    MoveKind,
    Origin,
    PathCourse,
    Target,
    ToleranceClause,
)
from irlx.interpreter.base import Base
from irlx.interpreter.compiled import Compiled, failing
from irlx.interpreter.errors import fail
from irlx.interpreter.frames import base_of, link_frame_of, told_in
from irlx.interpreter.law import Law, Passing
from irlx.interpreter.motion_parts import MotionParts, NextId, Wanted
from irlx.interpreter.parameters import Latched, choice_of, criterion_params, not_negative, word
from irlx.interpreter.targets import increment_of, target_of
from irlx.interpreter.types import INT, POSE, POSITION, REAL, STRING, TOLERANCE, Array, Type
from irlx.interpreter.values import ArrayValue, RecordValue
from irlx.language import tree


class Stop(NamedTuple):
    """One move of a statement: where its text is, where it goes and how, and the posture asked for there."""

    origin: Origin
    target: Target
    course: ArcCourse | PathCourse | None
    posture: JointTarget | None


class Moves(MotionParts):
    """Compiles moves of one body."""

    def add(self, node: tree.Move) -> None:
        """Add the steps of a move. Raises InterpreterError: IRL405 for postures that are not one a point."""
        law, passing = Law(node, self._expressions), Passing(node, self._expressions)
        wanted, slices = _in_order({"law": law.parts, "passing": passing.parts, **self._further(node)})
        parts = self._expressions.operands(wanted)
        self._count_postures(node, parts[slices["targets"]], parts[slices["postures"]])
        base = base_of(node.frame, self._context, node)
        frame = link_frame_of(base)

        def make(values: list[Any], next_id: NextId) -> list[Block]:
            at = {name: values[part] for name, part in slices.items()}
            common: dict[str, Any] = {
                "law": law.latched(at["law"]),
                "blend": passing.latched(at["passing"]),
                "limits": tuple(self._limits(node, at["limits"])),
                "criteria": tuple(self._criteria(node, at["criteria"])),
                "frame": frame,
                "tolerance": self._bands(node, at["tolerance"]),
            }
            return [
                MoveBlock(
                    id=next_id(),
                    origin=stop.origin,
                    kind=_kind(node, stop.course),
                    target=stop.target,
                    course=stop.course,
                    reconfiguration=stop.posture,
                    **common,
                )
                for stop in self._stops(node, at, base)
            ]

        self._emit(node, parts, make)

    def _further(self, node: tree.Move) -> dict[str, Wanted]:
        """Expressions of a MOVE beside those of its law, by kind and in the order of their evaluation."""
        given = {param.name.key: param.value for param in node.params}
        posture = self._listed if node.path else self._expressions.one_of
        return {
            "limits": [p for c in node.clauses if isinstance(c, tree.WithLimit) for p in self._range(c)],
            "criteria": [
                part
                for clause in node.clauses
                if isinstance(clause, tree.WithCriterion)
                for part in criterion_params(clause, self._expressions)
            ],
            "tolerance": [
                (clause.bands, partial(self._of_bands, clause.bands))
                for clause in node.clauses
                if isinstance(clause, tree.WithTolerance)
            ],
            "postures": [
                (target, partial(posture, target, self._postures()))
                for clause in node.clauses
                if isinstance(clause, tree.WithReconfiguration)
                for target in clause.targets
            ],
            "targets": [(target, partial(self._of_target, node, target)) for target in node.targets],
            "course": [
                (given[key], partial(self._expressions.value, given[key], type))
                for key, type in (("angle", REAL), ("circ_ori", STRING))
                if key in given
            ],
        }

    # ---- targets

    def _of_target(self, move: tree.Move, node: tree.Expression) -> Compiled:
        """A target, or on a PATH an array of them; values in parentheses are never taken for a ROBTARGET."""
        types: tuple[Type, ...] = (POSE, POSITION, *self._postures())
        if move.incremental:
            types = types[:2] if move.path else types
        elif not isinstance(node, tree.Aggregate):
            types = (*types, self._type("robtarget"))
        return self._listed(node, types) if move.path else self._one_of(node, types)

    def _one_of(self, node: tree.Expression, types: tuple[Type, ...]) -> Compiled:
        """One of several types; that ROBTARGET is among them, messages do not tell."""
        robtarget = self._type("robtarget")
        if robtarget in types:
            mark = self._context.mark()
            found = self._expressions.value(node)
            if found.type == robtarget:
                return found
            self._context.undo(mark)
        return self._expressions.one_of(node, tuple(type for type in types if type != robtarget))

    def _listed(self, node: tree.Expression, types: tuple[Type, ...]) -> Compiled:
        """One of several types, or a variable that is an array of one of them."""
        if isinstance(node, tree.Designator):
            mark = self._context.mark()
            found = self._expressions.value(node)
            if isinstance(found.type, Array) and found.type.element in types:
                return found
            self._context.undo(mark)
        return self._one_of(node, types)

    def _count_postures(
        self, node: tree.Move, targets: Sequence[Compiled], postures: Sequence[Compiled]
    ) -> None:
        """A PATH has a posture for each of its points; that of others is told by their text."""
        if not node.path or not postures:
            return
        points, found = _count(targets), _count(postures)
        if points is not None and found is not None and points != found:
            clause = next(c for c in node.clauses if isinstance(c, tree.WithReconfiguration))
            data = {"targets": points, "postures": found}
            raise fail("IRL405", self._context.source, clause.span, **data)

    def _warn_of_status(self, node: tree.Move, values: Sequence[Any]) -> None:
        """A STATUS is carried, and counts for nothing."""
        robtarget = self._type("robtarget")
        for target, value in zip(node.targets, values, strict=True):
            for item in _opened([value]):
                status = item.values[1] if item.type == robtarget else 0
                if isinstance(status, int) and status != 0:
                    machine, source = self._context.machine, self._context.source
                    machine.warn_once("IRL312", source, target.span, status=status)

    # ---- moves

    def _stops(self, node: tree.Move, at: dict[str, list[Any]], base: Base) -> Iterator[Stop]:
        """The moves of a statement by the values of its parts."""
        self._warn_of_status(node, at["targets"])
        turned = increment_of if node.incremental else target_of
        setting = self._context.setting
        frame = link_frame_of(base)
        targets = [told_in(turned(value, base, setting), frame) for value in _opened(at["targets"])]
        postures = [self._posture(value) for value in _opened(at["postures"])]
        if node.path:
            course = PathCourse(tuple(targets[:-1]), tuple(postures[:-1])) if len(targets) > 1 else None
            yield Stop(self._origin(node), targets[-1], course, postures[-1] if postures else None)
            return
        ends = _ends(node)
        pairs = _posture_pairs(postures, len(ends))
        for number, ((via, end), (posture_at_via, posture)) in enumerate(zip(ends, pairs, strict=True)):
            origin = self._origin(via or end, end) if len(ends) > 1 else self._origin(node)
            if via is None:
                yield Stop(origin, targets[number], None, posture)
            else:
                arc = self._arc(node, targets[2 * number], at["course"], posture_at_via)
                yield Stop(origin, targets[2 * number + 1], arc, posture)

    def _arc(self, node: tree.Move, via: Target, travel: list[Any], posture: JointTarget | None) -> ArcCourse:
        """Via point of a CIRCLE, its posture where it has one, with what ANGLE and CIRC_ORI say."""
        given = {param.name.key: param.value for param in node.params}
        values, source = iter(travel), self._context.source
        angle, turning = None, "END"
        if "angle" in given:
            angle = radians(next(values))
            if angle == 0.0:
                data = {"param": "ANGLE", "expected": "other than 0", "value": "0"}
                raise fail("IRL505", source, given["angle"].span, **data)
        if "circ_ori" in given:
            found = Latched(next(values), "CIRC_ORI", given["circ_ori"])
            turning = word(found, ("VIA", "END"), source)
        return ArcCourse(via, angle, turning == "VIA", posture)

    # ---- clauses

    def _limits(self, node: tree.Move, values: list[Any]) -> list[LimitClause]:
        clauses = [clause for clause in node.clauses if isinstance(clause, tree.WithLimit)]
        pairs = zip(clauses, values[::2], values[1::2], strict=True)
        return [
            LimitClause(LimitKind(clause.kind), self._joint_range(bounds), self._origin(clause))
            for clause, *bounds in pairs
        ]

    def _of_bands(self, node: tree.Expression) -> Compiled:
        """The bands of TOLERANCE: six values in parentheses, or an array of six numbers."""
        if isinstance(node, tree.Aggregate):
            return self._expressions.value(node, TOLERANCE)
        found = self._expressions.value(node)
        six = isinstance(found.type, Array) and found.type.size == len(TOLERANCE.fields)
        if found.type is None or (
            six and isinstance(found.type, Array) and found.type.element in (REAL, INT)
        ):
            return found
        data = {"expected": "6 values for TOLERANCE", "found": found.type.name}
        return failing(fail("IRL222", self._context.source, node.span, **data), (found,))

    def _bands(self, node: tree.Move, values: list[Any]) -> ToleranceClause | None:
        """The clause of the values of its bands, mm and degrees. Raises InterpreterError, IRL505."""
        clause = next((c for c in node.clauses if isinstance(c, tree.WithTolerance)), None)
        if clause is None:
            return None
        found = []
        for number, ((name, _), value) in enumerate(zip(TOLERANCE.fields, values[0].values, strict=True)):
            items = clause.bands.items if isinstance(clause.bands, tree.Aggregate) else ()
            told = Latched(value, name, items[number] if items else clause.bands)
            band = not_negative(told, self._context.source)
            found.append(band * 1e-3 if number < 3 else radians(band))
        dx, dy, dz, da, db, dc = found
        return ToleranceClause((dx, dy, dz, da, db, dc), self._origin(clause))

    def _criteria(self, node: tree.Move, values: list[Any]) -> list[CriterionClause]:
        found, rest = [], list(values)
        for clause in node.clauses:
            if isinstance(clause, tree.WithCriterion):
                own, rest = rest[: len(clause.params)], rest[len(clause.params) :]
                choice = choice_of(clause, own, self._context.source)
                found.append(CriterionClause(choice, self._origin(clause)))
        return found


def _in_order(groups: dict[str, Wanted]) -> tuple[Wanted, dict[str, slice]]:
    """Expressions of all groups one after the other, and where those of each group are."""
    slices, start = {}, 0
    for name, group in groups.items():
        slices[name] = slice(start, start + len(group))
        start += len(group)
    return [part for group in groups.values() for part in group], slices


def _kind(node: tree.Move, course: ArcCourse | PathCourse | None) -> MoveKind:
    """Kind of a move; a SPLINE through one point alone is a line."""
    return MoveKind.LIN if node.kind == "SPLINE" and course is None else MoveKind(node.kind)


def _count(parts: Sequence[Compiled]) -> int | None:
    """How many values parts have together that may be arrays, or None where one of them is wrong."""
    if any(part.type is None for part in parts):
        return None
    return sum(part.type.size if isinstance(part.type, Array) else 1 for part in parts)


def _opened(values: Sequence[RecordValue | ArrayValue]) -> Iterator[RecordValue]:
    """Values one by one, those of arrays in their order."""
    for value in values:
        for one in value.values if isinstance(value, ArrayValue) else (value,):
            if not isinstance(one, RecordValue):
                raise TypeError("targets and postures are records")
            yield one


def _posture_pairs(
    postures: Sequence[JointTarget], moves: int
) -> list[tuple[JointTarget | None, JointTarget | None]]:
    """Postures of WITH RECONFIGURATION, at the via point and at the end of each move of a MOVE.

    A CIRCLE has one for each target, or one for each end point.
    """
    if not postures:
        return [(None, None)] * moves
    if len(postures) == moves:
        return [(None, posture) for posture in postures]
    return list(zip(postures[::2], postures[1::2], strict=True))


def _ends(statement: tree.Move) -> list[tuple[tree.Expression | None, tree.Expression]]:
    """Where the moves of a MOVE end, each with its via point: CIRCLE takes its targets in pairs."""
    targets = statement.targets
    if statement.kind != "CIRCLE":
        return [(None, target) for target in targets]
    return list(zip(targets[::2], targets[1::2], strict=True))
