"""Types in MOVE with its parameters and clauses, and in the switches of the redundancy extension."""

from __future__ import annotations

from functools import partial

from irlx.diagnostics import told_apart
from irlx.language import tree
from irlx.language.builtins import LIMIT_TYPES, MOVE_PARAMETERS
from irlx.language.checking.context import Settled, Typed
from irlx.language.checking.type_forms import TypeForms
from irlx.language.frames import unknown_frame
from irlx.language.types import (
    BOOL,
    INT,
    POSE,
    POSITION,
    REAL,
    STRING,
    TOLERANCE,
    UNKNOWN,
    Array,
    Type,
    same_type,
)

_PARAMETER_TYPES: dict[str, Type] = {"c_pass": BOOL, "profile": STRING, "circ_ori": STRING}
"""Types of the parameters of MOVE that are no REAL."""

_WORDS = {"profile": ("TRAPEZOID", "S_CURVE"), "circ_ori": ("VIA", "END")}
_POSITIVE = frozenset(
    {"speed", "acc", "time", "speed_ori", "acc_ori", "speed_ptp", "acc_ptp", "override", "weight"}
)
_NOT_NEGATIVE = frozenset({"jerk", "c_cp", "c_ptp"})
_SHARES = frozenset({"speed_ptp", "acc_ptp", "override", "c_ptp"})

_FIXED_JOINTS = 6
"""A robot with more joints has many postures near each other for one pose."""


class Motion(TypeForms):
    """Types in motion statements."""

    in_main = False
    """Whether the main statements of a program are looked at, not those of a routine."""

    def _targets(self, move: tree.Move) -> tuple[Type, ...]:
        if move.incremental:
            # Along a path joint values would count from points whose postures nobody knows.
            return (POSE, POSITION) if move.path else (POSE, POSITION, *self._postures())
        return POSE, POSITION, self.names.types["robtarget"], *self._postures()

    def _postures(self) -> tuple[Type, ...]:
        return self.names.types["main_joint"], self.names.types["joint"]

    def move(self, move: tree.Move) -> None:
        """Targets, parameters and clauses of a MOVE."""
        candidates = self._targets(move)
        for frame in move.frames:
            self._frame(frame)
        types = []
        for target in move.targets:
            found = self._listed(target, candidates) if move.path else self._target(target, candidates)
            types.append(found.type)
            self._posture_left_open(move, target, found)
            if self.in_main:
                self.facts.targets[id(target)] = found.type, self._settled(target, found)
        for param in move.params:
            known = REAL if param.name.key in MOVE_PARAMETERS else UNKNOWN
            self._parameter(param, _PARAMETER_TYPES.get(param.name.key, known))
            if param.name.key == "angle" and move.kind == "CIRCLE":
                self._angle(param)
        for clause in move.clauses:
            match clause:
                case tree.WithLimit():
                    self.limits(clause)
                case tree.WithReconfiguration() if move.path:
                    self._postures_of_path(clause, types)
                case tree.WithReconfiguration(targets=targets):
                    for posture in targets:
                        self.one_of(posture, self._postures())
                case tree.WithCriterion():
                    self.criterion(clause)
                case tree.WithTolerance(bands=bands):
                    self._tolerance(bands)

    def _postures_of_path(self, clause: tree.WithReconfiguration, points: list[Type]) -> None:
        """One posture for each point, where both are written one by one or in arrays."""
        found = [self._listed(posture, self._postures()).type for posture in clause.targets]
        if UNKNOWN in (*points, *found):
            return
        targets, postures = ([_number(type) for type in types] for types in (points, found))
        # An array whose bounds only a run tells has 0 elements here.
        if 0 not in (*targets, *postures) and sum(postures) != sum(targets):
            self.add("IRL405", clause, targets=sum(targets), postures=sum(postures))

    def _posture_left_open(self, move: tree.Move, target: tree.Expression, found: Typed) -> None:
        """Tell of a ROBTARGET that is reached in any posture."""
        joints = self.joints.number
        if joints is None or joints <= _FIXED_JOINTS or found.type is not self.names.types["robtarget"]:
            return
        if not any(isinstance(clause, tree.WithReconfiguration) for clause in move.clauses):
            self.lint("IRL313", target, joints=joints)

    def _target(self, target: tree.Expression, candidates: tuple[Type, ...]) -> Typed:
        if isinstance(target, tree.Aggregate):
            # Bare values are a POSE, a POSITION or a MAIN_JOINT; the others need their constructor.
            bare = [type for type in candidates if type.name not in ("ROBTARGET", "JOINT")]
            return self.one_of(target, tuple(bare))
        return self.one_of(target, candidates)

    def _listed(self, target: tree.Expression, candidates: tuple[Type, ...]) -> Typed:
        """A target of a PATH, which may also be an array of them."""
        if isinstance(target, tree.Designator):
            trial = self.trial(lambda: self.typed(target))
            type = trial.typed.type
            if isinstance(type, Array) and any(same_type(type.element, one) for one in candidates):
                return self.keep(trial)
        return self._target(target, candidates)

    def _settled(self, node: tree.Expression, found: Typed) -> Settled:
        """Value of an expression, or the variable that it is."""
        if isinstance(node, tree.Designator) and not node.selectors and found.value is None:
            return self.names.value(node.base.key)
        return found.value

    # ---- parameters

    def _parameter(self, param: tree.MoveParam, type: Type) -> None:
        key, shown = param.name.key, param.name.name.upper()
        value = self.fitted(param.value, type).value
        words = _WORDS.get(key)
        if words is not None:
            if isinstance(value, str) and value.upper() not in words:
                expected = " or ".join(f"'{word}'" for word in words)
                self.add("IRL505", param.value, param=shown, expected=expected, value=f"'{value}'")
        elif isinstance(value, int | float) and not isinstance(value, bool):
            if key in _POSITIVE and not value > 0:
                self.add("IRL505", param.value, param=shown, expected="greater than 0", value=f"{value:g}")
            elif key in _NOT_NEGATIVE and not value >= 0:
                self.add("IRL505", param.value, param=shown, expected="0 or more", value=f"{value:g}")
            elif key in _SHARES and value > 100:
                found = told_apart(value, 100.0)[0]
                self.add("IRL505", param.value, param=shown, expected="at most 100 %", value=found)

    def _angle(self, param: tree.MoveParam) -> None:
        found = self.trial(lambda: self.typed(param.value)).typed
        if found.value == 0 and found.type in (INT, REAL):
            self.add("IRL505", param.value, param="ANGLE", expected="other than 0", value="0")

    def criterion(self, node: tree.CriterionStart | tree.WithCriterion) -> None:
        """Parameters of a criterion: numbers."""
        for param in node.params:
            self._parameter(param, REAL)

    def _tolerance(self, bands: tree.Expression) -> None:
        if isinstance(bands, tree.Aggregate):
            self.fitted(bands, TOLERANCE)
            for (name, _), item in zip(TOLERANCE.fields, bands.items, strict=False):
                value = self.trial(partial(self.typed, item)).typed.value
                if isinstance(value, int | float) and not value >= 0:
                    self.add("IRL505", item, param=name, expected="0 or more", value=f"{value:g}")
            return
        found = self.typed(bands).type
        six = isinstance(found, Array) and found.size in (0, 6)
        if found is not UNKNOWN and not six:
            self.mismatch(bands, "6 values for TOLERANCE", found.name)

    # ---- switches

    def limits(self, node: tree.LimitSwitch | tree.WithLimit) -> None:
        """The two bounds of a limit switch or clause."""
        types = self.names.types
        lowest, highest = LIMIT_TYPES[node.kind]
        lower, upper = self.fitted(node.lower, types[lowest]), self.fitted(node.upper, types[highest])
        settled = self._settled(node.lower, lower), self._settled(node.upper, upper)
        self.facts.limits.append((node, *settled))

    def freeze(self, node: tree.FreezeStart) -> None:
        """Numbers of joints."""
        most = self.joints.number
        for joint in node.joints:
            found = self.fitted(joint, INT)
            number = found.value
            if most is not None and isinstance(number, int) and found.type is INT and number > most:
                self.add("IRL346", joint, number=number, joints=most)

    def reconfiguration(self, node: tree.Reconfiguration) -> None:
        """The posture of RECONFIGURATION."""
        self.one_of(node.target, self._postures())
        if node.frame is not None:
            self._frame(node.frame)

    def _frame(self, node: tree.InFrame) -> None:
        """A name of a frame of the cell: IRL290 where the cell is known and has none like it."""
        known, name = self.names.frames, node.name
        if known is not None and name.key and name.key not in {one.casefold() for one in known}:
            self.findings.append(unknown_frame(name.name, known, self.place(name)))


def _number(type: Type) -> int:
    """How many targets or postures a value of a PATH is."""
    return type.size if isinstance(type, Array) else 1
