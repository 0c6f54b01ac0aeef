"""Layout of motion statements and of the switches of the redundancy extension."""

from __future__ import annotations

from collections.abc import Sequence

from irlx.language import tree
from irlx.language.builtins import LIMIT_WORDS, MOVE_PARAMETERS
from irlx.language.format.document import Doc, Fill, Group, Here, Indent, Line
from irlx.language.format.expressions import ExpressionLayout

__all__ = ["MotionLayout"]

_LIMITS = tuple(LIMIT_WORDS.values())
_LIMIT_ENDS = tuple(f"{word}END" for word in _LIMITS)


class MotionLayout(ExpressionLayout):
    """A MOVE on one line, or its parameters and each WITH on lines of their own."""

    def motion(self, node: tree.Statement) -> Doc:
        """A statement of motion or a switch, without its ``;``."""
        word = self.tokens.word
        match node:
            case tree.Move():
                return self._move(node)
            case tree.LimitSwitch():
                return (word(*_LIMITS), " ", self._limits(node))
            case tree.LimitSwitchEnd():
                return word(*_LIMIT_ENDS)
            case tree.FreezeStart():
                return (word("FREEZESTART"), " ", self.listed(node.joints, self.expression, fill=True))
            case tree.FreezeEnd() | tree.CyclicStart() | tree.CyclicEnd():
                return word("FREEZEEND", "CYCLICSTART", "CYCLICEND")
            case tree.Reconfiguration():
                posture = (word("RECONFIGURATION"), " ", self.expression(node.target))
                return posture if node.frame is None else (*posture, " ", self._in_frame(node.frame))
            case tree.CriterionStart():
                head = (word("CRITERION"), " ", self.name(node.name))
                return (head, *self._params_behind(node))
            case tree.ObstacleStart() | tree.ObstacleEnd() | tree.CriterionEnd():
                return (word("OBSTACLE", "OBSTACLEEND", "CRITERIONEND"), " ", self.name(node.name))
            case _:
                raise TypeError(f"no layout of {type(node).__name__}")

    def _move(self, node: tree.Move) -> Doc:
        word = self.tokens.word
        head: list[Doc] = [word("MOVE", "MOVE_INC"), " ", word("PTP", "LIN", "CIRCLE", "SPLINE"), " "]
        if node.path:
            head += [word("PATH"), " "]
        head.append(self._targets(node.targets))
        parts: list[Doc] = []
        broken = False
        for frame in node.frames:
            broken = broken or self.tokens.on_new_line
            parts += [Line(), self._in_frame(frame)]
        if node.params:
            broken = self._at_params() or broken
            # At the start of a line, any other name begins the next statement.
            may_begin_line = node.params[0].name.key in MOVE_PARAMETERS
            parts += [Line() if may_begin_line else " ", self._params(node.params)]
        for clause in node.clauses:
            broken = broken or self.tokens.on_new_line
            word_with = word("WITH")
            # The monograph breaks its lines behind WITH.
            broken = broken or self.tokens.on_new_line
            parts += [Line(), word_with, " ", self._clause(clause)]
        return Group((*head, Indent(tuple(parts))), broken)

    def _in_frame(self, node: tree.InFrame) -> Doc:
        return (self.tokens.word("IN"), " ", self.tokens.word("FRAME"), " ", self.name(node.name))

    def _targets(self, targets: Sequence[tree.Expression]) -> Doc:
        """Targets with commas; the parentheses of a PATH are none of the tree's."""
        if self.tokens.kind != "LEFT_PAREN" or self.tokens.start >= targets[0].span.start:
            return self.listed(targets, self.expression, fill=True)
        opening = self.tokens.word("LEFT_PAREN")
        inner = self.listed(targets, self.expression, fill=True)
        return (opening, inner, self.tokens.word("RIGHT_PAREN"))

    def _at_params(self) -> bool:
        """Leave out a comma before the first parameter; whether the parameter stands on a new line."""
        if self.tokens.kind == "COMMA":
            self.tokens.drop()
        return self.tokens.on_new_line

    def _params_behind(self, node: tree.WithCriterion | tree.CriterionStart) -> Sequence[Doc]:
        """Parameters behind the name of a criterion."""
        if not node.params:
            return ()
        self._at_params()
        return (" ", self._params(node.params))

    def _params(self, params: Sequence[tree.MoveParam]) -> Doc:
        """Parameters with commas between, also where the text has none."""
        docs: list[Doc] = []
        for index, param in enumerate(params):
            name = self.name(param.name)
            doc: Doc = (name, " ", self.tokens.word("ASSIGN"), " ", self.expression(param.value))
            if index + 1 < len(params):
                doc = (doc, self.tokens.word("COMMA") if self.tokens.kind == "COMMA" else ",")
            docs.append(doc)
        return Here(Fill(tuple(docs)))

    def _clause(self, node: tree.WithClause) -> Doc:
        match node:
            case tree.WithLimit():
                return (self.tokens.word(*_LIMITS), " ", self._limits(node))
            case tree.WithReconfiguration():
                return (self.tokens.word("RECONFIGURATION"), " ", self._targets(node.targets))
            case tree.WithTolerance():
                return (self.tokens.word("TOLERANCE"), " ", self.expression(node.bands))
            case tree.WithCriterion():
                head: list[Doc] = [self.tokens.word("CRITERION"), " ", self.name(node.name)]
                return (*head, *self._params_behind(node))

    def _limits(self, node: tree.WithLimit | tree.LimitSwitch) -> Doc:
        return self.listed((node.lower, node.upper), self.expression, fill=False)
