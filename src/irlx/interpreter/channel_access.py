"""Which file or channel a call means, and whether it is at its end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from irlx.diagnostics import Place, SourceText, report
from irlx.interpreter.channels.fault import ChannelFault
from irlx.interpreter.channels.open_file import OpenFile
from irlx.interpreter.code import Frame
from irlx.interpreter.compiled import Compiled
from irlx.interpreter.errors import InterpreterError, fail
from irlx.interpreter.types import BOOL, FILE
from irlx.language import tree

if TYPE_CHECKING:
    from irlx.interpreter.expressions import Expressions

_T = TypeVar("_T")

Channel = Callable[[Frame], "OpenFile | None"]
"""Gives the file that is meant, None for a standard channel; raises InterpreterError, IRL542."""


def at(node: tree.Node, source: SourceText, action: Callable[[], _T]) -> _T:
    """What an action gives. Raises InterpreterError at a node for what goes wrong with a file or channel."""
    try:
        return action()
    except ChannelFault as fault:
        place = Place.in_text(source, node.span)
        raise InterpreterError(report(fault.code, place, related=fault.related, **fault.data)) from None


def text_of(node: tree.Node, source: SourceText) -> str:
    """What the program writes for a node."""
    return source.text[node.span.start : node.span.end]


def leading_file(expressions: Expressions, arguments: Sequence[tree.Argument]) -> tree.Designator | None:
    """The variable of type FILE that stands first in a call, or None."""
    first = arguments[0] if arguments else None
    if not isinstance(first, tree.Designator):
        return None
    mark = expressions.context.mark()
    try:
        type = expressions.designators.cell(first, "").type
    except InterpreterError:
        type = None
    expressions.context.undo(mark)
    return first if type == FILE else None


def file_variable(expressions: Expressions, node: tree.Argument, where: str) -> Compiled:
    """The cell of a variable of type FILE. Raises InterpreterError: IRL249, IRL222 for another one."""
    if isinstance(node, tree.FormattedValue):
        raise fail("IRL249", expressions.source, node.span, where=where, found="a value with a layout")
    found = expressions.designators.cell(node, where)
    if found.type != FILE:
        name = found.type.name if found.type else ""
        raise fail("IRL222", expressions.source, node.span, expected="a variable of FILE", found=name)
    return found


def open_file(expressions: Expressions, node: tree.Argument, where: str) -> Channel:
    """Gives the open file of a variable."""
    run, source = file_variable(expressions, node, where).run, expressions.source

    def channel(frame: Frame) -> OpenFile:
        file = run(frame).value
        if not isinstance(file, OpenFile):
            raise fail("IRL542", source, node.span, name=text_of(node, source))
        return file

    return channel


def standard(expressions: Expressions, direction: Literal["IN", "OUT"], node: tree.Node) -> Channel:
    """Gives the file that stands for a standard channel, None where no variable does."""
    bound, source = expressions.context.channels.bound, expressions.source

    def channel(_: Frame) -> OpenFile | None:
        variable = bound.get(direction)
        if variable is None:
            return None
        if not isinstance(variable.value, OpenFile):
            raise fail("IRL542", source, node.span, name=variable.name)
        return variable.value

    return channel


def end_of_file(expressions: Expressions, given: Sequence[tree.Expression], node: tree.Node) -> Compiled:
    """EOF of a file, or of the standard channel. Raises InterpreterError: IRL228, IRL590 in constants."""
    context = expressions.context
    if context.assembler is None:
        raise fail("IRL590", context.source, node.span, what="the function EOF in a constant")
    if len(given) > 1:
        data: dict[str, Any] = {"function": "EOF", "expected": "0 or 1 values", "found": len(given)}
        raise fail("IRL228", context.source, node.span, **data)
    channel = open_file(expressions, given[0], "EOF") if given else standard(expressions, "IN", node)
    channels, source = context.channels, context.source

    def run(frame: Frame) -> bool:
        file = channel(frame)
        return at(node, source, lambda: channels.reader(file).at_end())

    return Compiled(BOOL, run)
