"""OPEN, CLOSE, READ, WRITE and WRITELN: the world is asked or told when the program gets there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

from irlx.blocks import AskStandstill
from irlx.diagnostics import Place
from irlx.interpreter.channel_access import at, file_variable, leading_file, open_file, standard, text_of
from irlx.interpreter.channels.layout import laid_out, plain
from irlx.interpreter.channels.open_file import OpenFile
from irlx.interpreter.channels.text_reader import TextReader
from irlx.interpreter.code import Frame, Step
from irlx.interpreter.compiled import Compiled, Run, first_failing
from irlx.interpreter.errors import fail
from irlx.interpreter.targets import origin_of
from irlx.interpreter.types import BOOL, CHAR, INT, REAL, STRING, Type
from irlx.interpreter.values import UNSET
from irlx.language import tree
from irlx.language.builtins import LAYOUT_BOUNDS, OPEN_MODES, SIMPLE_VALUE
from irlx.language.words import count

if TYPE_CHECKING:
    from irlx.interpreter.expressions import Expressions
    from irlx.interpreter.statements import Statements

_READERS: dict[Type, Callable[[TextReader], Any]] = {
    INT: TextReader.whole,
    REAL: TextReader.real,
    BOOL: TextReader.truth,
    CHAR: TextReader.character,
    STRING: TextReader.rest_of_line,
}


def add_channel_call(statements: Statements, node: tree.Call) -> None:
    """Add the steps of a call of one of these procedures. Raises InterpreterError for wrong arguments.

    What is read and written belongs to its place in time: the robot comes to rest first.
    """
    _add_standstill(statements, node)
    match node.name.key:
        case "open":
            _add_open(statements, node)
        case "close":
            _add_close(statements, node)
        case "read":
            _add_read(statements, node)
        case _:
            _add_write(statements, node)


def _add_standstill(statements: Statements, node: tree.Call) -> None:
    machine, asked = statements.context.machine, AskStandstill(origin_of(statements.context.source, node))

    def make(following: int) -> Step:
        return lambda _: machine.ask(asked, _nothing, following)

    statements.assembler.add(node, make)


def _nothing(_: tuple[float, ...]) -> None:
    """What the answer says."""


def _number(statements: Statements, node: tree.Call, wanted: int) -> None:
    if len(node.arguments) != wanted:
        data = {"expected": count(wanted, "value"), "found": len(node.arguments)}
        raise fail("IRL228", statements.context.source, node.span, function=node.name.key.upper(), **data)


def _add_open(statements: Statements, node: tree.Call) -> None:
    _number(statements, node, 3)
    expressions, context = statements.expressions, statements.context
    channels, source = context.channels, context.source
    file, name, mode = node.arguments
    parts = expressions.operands(
        [
            (file, partial(file_variable, expressions, file, "OPEN")),
            (name, partial(expressions.value, name, STRING)),
            (mode, partial(expressions.value, mode, STRING)),
        ]
    )
    wrong = first_failing(parts)
    if wrong is not None:
        statements.run(node, wrong.run)
        return
    cell, given, way = (part.run for part in parts)
    variable, place = text_of(file, source), Place.in_text(source, node.span)

    def run(frame: Frame) -> None:
        target, path, word = cell(frame), given(frame), way(frame)
        if word.upper() not in OPEN_MODES:
            data = {"param": "the mode of OPEN", "expected": "'READ', 'WRITE' or 'APPEND'"}
            raise fail("IRL505", source, mode.span, value=f"'{word}'", **data)
        if isinstance(target.value, OpenFile):
            raise fail("IRL543", source, file.span, variable=variable, name=target.value.name)
        opened = at(name, source, lambda: channels.open(path, word.upper(), variable, place))
        target.value = opened

    statements.run(node, run)


def _add_close(statements: Statements, node: tree.Call) -> None:
    _number(statements, node, 1)
    channels, source = statements.context.channels, statements.context.source
    (file,) = node.arguments
    cell = file_variable(statements.expressions, file, "CLOSE").run

    def run(frame: Frame) -> None:
        target = cell(frame)
        opened = target.value
        if not isinstance(opened, OpenFile):
            raise fail("IRL542", source, file.span, name=text_of(file, source))
        target.value = UNSET
        at(node, source, lambda: channels.close(opened))

    statements.run(node, run)


# ---- READ


def _add_read(statements: Statements, node: tree.Call) -> None:
    """One step finds what to read from, and one more each variable: an index may use what was read before."""
    expressions, source = statements.expressions, statements.context.source
    channels, slot = statements.context.channels, statements.assembler.slot()
    file = leading_file(expressions, node.arguments)
    variables = node.arguments[1:] if file is not None else node.arguments
    if not variables:
        raise fail("IRL228", source, node.span, function="READ", expected="a variable", found="none")
    channel = standard(expressions, "IN", node) if file is None else open_file(expressions, file, "READ")

    def find(frame: Frame) -> None:
        found = channel(frame)
        frame[slot] = at(file or node, source, lambda: channels.reader(found))

    statements.run(node, find)
    for variable in variables:
        _add_variable(statements, variable, slot)


def _add_variable(statements: Statements, node: tree.Argument, slot: int) -> None:
    source = statements.context.source
    if isinstance(node, tree.FormattedValue):
        raise fail("IRL249", source, node.span, where="READ", found="a value with a layout")
    found = statements.expressions.designators.cell(node, "READ")
    read = _READERS.get(found.type) if found.type is not None else None
    if read is None:
        name = found.type.name if found.type else ""
        raise fail("IRL222", source, node.span, expected=SIMPLE_VALUE, found=name)
    cell, take = found.run, read

    def run(frame: Frame) -> None:
        target = cell(frame)
        target.value = at(node, source, lambda: take(frame[slot]))

    statements.run(node, run)


# ---- WRITE


def _add_write(statements: Statements, node: tree.Call) -> None:
    expressions, context = statements.expressions, statements.context
    channels, source = context.channels, context.source
    file = leading_file(expressions, node.arguments)
    values = node.arguments[1:] if file is not None else node.arguments
    word, end = node.name.key.upper(), "\n" if node.name.key == "writeln" else ""
    channel = standard(expressions, "OUT", node) if file is None else open_file(expressions, file, word)
    wanted = [part for value in values for part in _parts(expressions, value)]
    parts = expressions.operands(wanted)
    wrong = first_failing(parts)
    if wrong is not None:
        statements.run(node, wrong.run)
        return
    pieces, rest = [], iter(parts)
    for value in values:
        pieces.append(_piece(expressions, value, next(rest), rest))

    origin = origin_of(source, node)

    def run(frame: Frame) -> None:
        target = channel(frame)
        text = "".join([piece(frame) for piece in pieces]) + end
        at(node, source, lambda: channels.write(target, text, origin))

    statements.run(node, run)


def _parts(
    expressions: Expressions, node: tree.Argument
) -> Iterator[tuple[tree.Node, Callable[[], Compiled]]]:
    """A value, and its width and precision where it has them."""
    if not isinstance(node, tree.FormattedValue):
        yield node, partial(expressions.value, node)
        return
    yield node.value, partial(expressions.value, node.value)
    for number in (node.width, node.precision):
        if number is not None:
            yield number, partial(expressions.value, number, INT)


def _piece(
    expressions: Expressions, node: tree.Argument, found: Compiled, rest: Iterator[Compiled]
) -> Callable[[Frame], str]:
    """Gives the text of a value; `rest` are the numbers of its layout. Raises InterpreterError, IRL222."""
    value = node.value if isinstance(node, tree.FormattedValue) else node
    source, type = expressions.source, found.type
    if type not in _READERS:
        name = type.name if type is not None else ""
        raise fail("IRL222", source, value.span, expected=SIMPLE_VALUE, found=name)
    run = found.run
    if not isinstance(node, tree.FormattedValue):
        return lambda frame: plain(run(frame))
    width = _bounded(expressions, node.width, "width", next(rest).run)
    if node.precision is None:
        return lambda frame: laid_out(run(frame), width(frame), None)
    if type not in (INT, REAL):
        words = "a number before :width:precision"
        raise fail("IRL222", source, value.span, expected=words, found=type.name if type else "")
    precision = _bounded(expressions, node.precision, "precision", next(rest).run)
    return lambda frame: laid_out(run(frame), width(frame), precision(frame))


def _bounded(expressions: Expressions, node: tree.Expression, what: str, run: Run) -> Callable[[Frame], int]:
    """A number of a layout. When run, IRL505 beyond its bounds."""
    source, most = expressions.source, LAYOUT_BOUNDS[what]

    def number(frame: Frame) -> int:
        value: int = run(frame)
        if not 0 <= value <= most:
            data = {"param": f"the {what} of WRITE", "expected": f"0 to {most:,}", "value": str(value)}
            raise fail("IRL505", source, node.span, **data)
        return value

    return number
