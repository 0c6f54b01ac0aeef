"""Files and channels: OPEN, CLOSE, READ, WRITE, WRITELN."""

from __future__ import annotations

from irlx.language import tree
from irlx.language.checking.expressions import Expressions
from irlx.language.checking.words import count
from irlx.language.types import BOOL, CHAR, FILE, INT, REAL, STRING, UNKNOWN, Type

_MODES = ("READ", "WRITE", "APPEND")
_WRITTEN: tuple[Type, ...] = (INT, REAL, CHAR, STRING, BOOL)
_SIMPLE_VALUE = "INT, REAL, CHAR, STRING or BOOL"


class Channels(Expressions):
    """Types in calls of the procedures that every program knows."""

    def built_in_procedure(self, call: tree.Call) -> None:
        """Arguments of a built-in procedure."""
        match call.name.key:
            case "open":
                self._open(call)
            case "close":
                if self._number(call, 1):
                    self.variable_argument(call.arguments[0], "CLOSE", FILE)
            case "read":
                self._read(call)
            case _:
                for argument in self._behind_file(call.arguments):
                    self._written(argument)

    def _number(self, call: tree.Call, wanted: int) -> bool:
        found = len(call.arguments)
        if found == wanted:
            return True
        self.unknown_arguments(call.arguments)
        expected = count(wanted, "value")
        self.add("IRL228", call, function=call.name.key.upper(), expected=expected, found=found)
        return False

    def _open(self, call: tree.Call) -> None:
        if not self._number(call, 3):
            return
        file, name, mode = call.arguments
        self.variable_argument(file, "OPEN", FILE)
        self.fitted(name, STRING)
        value = self.fitted(mode, STRING).value
        if isinstance(value, str) and value.upper() not in _MODES:
            expected = "'READ', 'WRITE' or 'APPEND'"
            self.add("IRL505", mode, param="the mode of OPEN", expected=expected, value=f"'{value}'")

    def _behind_file(self, arguments: tuple[tree.Argument, ...]) -> tuple[tree.Argument, ...]:
        """Arguments behind the file that may stand first."""
        if arguments and isinstance(arguments[0], tree.Designator):
            file = arguments[0]
            trial = self.trial(lambda: self.typed(file))
            if trial.typed.type is FILE:
                self.keep(trial)
                return arguments[1:]
        return arguments

    def _read(self, call: tree.Call) -> None:
        variables = self._behind_file(call.arguments)
        if not variables:
            self.add("IRL228", call, function="READ", expected="a variable", found="none")
        for argument in variables:
            self.variable_argument(argument, "READ", None)
            trial = self.trial(lambda argument=argument: self.typed(argument))  # type: ignore[misc]
            self._simple(argument, trial.typed.type)

    def _written(self, argument: tree.Argument) -> None:
        value = argument.value if isinstance(argument, tree.FormattedValue) else argument
        self._simple(value, self.typed(argument).type)

    def _simple(self, node: tree.Argument, type: Type) -> None:
        if type is not UNKNOWN and type not in _WRITTEN:
            self.mismatch(node, _SIMPLE_VALUE, type.name)
