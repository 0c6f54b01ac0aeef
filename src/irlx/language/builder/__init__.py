"""Turns the parser's reductions into the typed tree, bottom up, without an intermediate tree."""

from irlx.language.builder.expressions import ExpressionBuilder
from irlx.language.builder.motion import MotionBuilder
from irlx.language.builder.parts import PartBuilder
from irlx.language.builder.statements import StatementBuilder

__all__ = ["TreeBuilder"]


class TreeBuilder(ExpressionBuilder, StatementBuilder, MotionBuilder, PartBuilder):
    """One method for each rule of the grammar; holds no state, so one serves any number of parsers."""
