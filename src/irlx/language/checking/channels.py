"""Files and channels: OPEN, CLOSE, READ, WRITE, WRITELN."""

from __future__ import annotations

from irlx.diagnostics.diagnostic import near_matches
from irlx.language import tree
from irlx.language.builtins import OPEN_MODES, SIMPLE_VALUE, STANDARD_CHANNELS
from irlx.language.checking.context import Typed
from irlx.language.checking.expressions import Expressions
from irlx.language.types import BOOL, CHAR, FILE, INT, REAL, STRING, UNKNOWN, Type, holds_files
from irlx.language.words import count

_WRITTEN: tuple[Type, ...] = (INT, REAL, CHAR, STRING, BOOL)


class Channels(Expressions):
    """Types in calls of the procedures that every program knows."""

    def built_in_procedure(self, call: tree.Call) -> None:
        """Arguments of a built-in procedure."""
        match call.name.key:
            case "open":
                self._open(call)
            case "close":
                if self._number(call, 1):
                    self._file(call.arguments[0], "CLOSE")
            case "read":
                self._read(call)
            case _:
                for argument in self._behind_file(call):
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
        self._file(file, "OPEN")
        self.fitted(name, STRING)
        value = self.fitted(mode, STRING).value
        if isinstance(value, str) and value.upper() not in OPEN_MODES:
            expected = "'READ', 'WRITE' or 'APPEND'"
            self.add("IRL505", mode, param="the mode of OPEN", expected=expected, value=f"'{value}'")

    def _file(self, node: tree.Argument, word: str) -> None:
        """A variable of type FILE, and what is done with it."""
        self.file_use(node, word)
        self.variable_argument(node, word, FILE)

    def file_use(self, node: tree.Argument, what: str) -> None:
        """Remember that a variable of type FILE may be used; `what` is '' where a routine has it."""
        if isinstance(node, tree.Designator):
            entry = self.names.value(node.base.key)
            if entry is not None and holds_files(entry.type):
                self.facts.files.append((what, entry, node.base))

    def _behind_file(self, call: tree.Call) -> tuple[tree.Argument, ...]:
        """Arguments behind the file that may stand first."""
        arguments = call.arguments
        if arguments and isinstance(arguments[0], tree.Designator):
            file = arguments[0]
            entry = self.names.value(file.base.key)
            if entry is not None and holds_files(entry.type):
                type = self.trial(lambda: Typed(self.part(entry.type, file))).typed.type
                if type is FILE:
                    self._file(file, call.name.key.upper())
                    return arguments[1:]
        self.facts.standard.add("IN" if call.name.key == "read" else "OUT")
        return arguments

    def _read(self, call: tree.Call) -> None:
        variables = self._behind_file(call)
        if not variables:
            self.add("IRL228", call, function="READ", expected="a variable", found="none")
        for argument in variables:
            self.variable_argument(argument, "READ", None)
            if isinstance(argument, tree.Designator):
                trial = self.trial(lambda node=argument: Typed(self.set_target(node)[0]))  # type: ignore[misc]
                self._simple(argument, trial.typed.type)

    def _written(self, argument: tree.Argument) -> None:
        value = argument.value if isinstance(argument, tree.FormattedValue) else argument
        self._simple(value, self.typed(argument).type)

    def _simple(self, node: tree.Argument, type: Type) -> None:
        if type is not UNKNOWN and type not in _WRITTEN:
            self.mismatch(node, SIMPLE_VALUE, type.name)

    def standard_channel(self, part: tree.StandardChannel, *, in_program: bool) -> None:
        """A FILE variable, or the standard channel itself, that STANDARD_IN or STANDARD_OUT is set to."""
        channel, name, own = f"STANDARD_{part.direction}", part.channel, STANDARD_CHANNELS[part.direction]
        if not in_program:
            self._not_standard(part, channel, "only the program itself says what its standard channels are")
            return
        entry = self.names.value(name.key)
        if entry is None:
            if name.key and name.key != own.casefold():
                files = [
                    e.symbol.name.name for e in self.names.values.values() if e.symbol and e.type is FILE
                ]
                near = near_matches(name.name, [*files, own]) or f"; it may be a FILE variable or {own}"
                self._not_standard(part, channel, f"there is no such variable{near}")
        elif entry.type is not FILE or entry.kind not in ("variable", "import"):
            if entry.type is not UNKNOWN:
                self.mismatch(name, "a variable of FILE", entry.type.name)
        else:
            self.facts.files.append((channel, entry, name))

    def _not_standard(self, part: tree.StandardChannel, channel: str, cause: str) -> None:
        self.add("IRL266", part.channel, channel=channel, name=part.channel.name, cause=cause)
