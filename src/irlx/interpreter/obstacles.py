"""Names of obstacles in a program -> those of the cell."""

from __future__ import annotations

from irlx.diagnostics import Place
from irlx.interpreter.context import Context
from irlx.interpreter.errors import InterpreterError
from irlx.language import tree
from irlx.language.obstacles import unknown_obstacle


def obstacle_of_cell(name: tree.Name, context: Context) -> str:
    """An obstacle or group as the cell writes it; as the program does where nobody knows the cell.

    Raises InterpreterError, IRL573, for a name that the cell does not have.
    """
    known = context.setting.obstacles
    if known is None:
        return name.name
    found = known.get(name.key)
    if found is None:
        place = Place.in_text(context.source, name.span)
        raise InterpreterError(unknown_obstacle(name.name, known.values(), place))
    return found
