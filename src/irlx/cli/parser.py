"""The argument parser of `irlx`: a word or option that it does not know gets an answer that helps."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from irlx.diagnostics import IrlxError

__all__ = ["CommandParser"]


class CommandParser(argparse.ArgumentParser):
    """Parser of the whole line, and of each command.

    Parsing raises IrlxError, beside what argparse itself does: IRL016 for an unknown command, IRL017 for an
    unknown option. Both are looked for before anything else: a slip is not told as what follows of it. IRL006
    is a value that an argument cannot have.
    """

    commands: argparse._SubParsersAction[Any] | None = None
    """Where commands are added; None for the parser of one."""

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse arguments; raises IrlxError for an unknown command or option."""
        given = [str(argument) for argument in (sys.argv[1:] if args is None else args)]
        if self.commands is not None:
            self._look_at_command(given)
        else:
            self._look_at_options(given)
        options, rest = super().parse_known_args(args, namespace)
        if rest and rest[0].startswith("-"):
            raise self._unknown(rest[0])
        return options, rest

    def _look_at_command(self, given: Sequence[str]) -> None:
        """Raise IrlxError where the first word is no command, or an option before it is none of irlx."""
        known = {} if self.commands is None else self.commands.choices
        for place, argument in enumerate(given):
            if argument in known:
                self._look_at_options(given[:place])
                return
            if not argument.startswith("-"):
                self._look_at_options(given[:place])
                raise _unknown_command(argument, list(known))
        self._look_at_options(given)

    def _look_at_options(self, given: Sequence[str]) -> None:
        """Raise IrlxError for the first long option that there is none of, also not by a beginning of it."""
        for argument in given:
            if argument == "--":
                return
            name = argument.partition("=")[0]
            if name.startswith("--") and not any(known.startswith(name) for known in self._long()):
                raise self._unknown(name)

    def _print_message(self, message: str, file: Any = None) -> None:
        """Write a help; raises OSError where it cannot be, which argparse would keep to itself."""
        if message:
            (file or sys.stderr).write(message)

    def _get_value(self, action: argparse.Action, arg_string: str) -> Any:
        """The value of an argument; raises IrlxError, IRL006, for one of another kind."""
        try:
            return super()._get_value(action, arg_string)
        except argparse.ArgumentError as cause:
            expected = {int: "a whole number is expected", float: "a number is expected"}
            words = next((words for kind, words in expected.items() if action.type is kind), str(cause))
            raise self._unfit(action, arg_string, words) from None

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Raises IrlxError, IRL006, for a value that is not among those that can be chosen."""
        commands = isinstance(action, argparse._SubParsersAction)
        if commands or action.choices is None or value in action.choices:
            super()._check_value(action, value)
            return
        from irlx.diagnostics.diagnostic import near_matches

        known = [str(choice) for choice in action.choices]
        raise self._unfit(action, value, f"not one of {', '.join(known)}{near_matches(str(value), known)}")

    def _unfit(self, action: argparse.Action, value: object, cause: str) -> IrlxError:
        from irlx.diagnostics import IrlxError, report

        option = action.option_strings[-1] if action.option_strings else action.dest
        helps = f"{self.prog} --help has examples"
        return IrlxError(report("IRL006", help=helps, option=option, value=str(value) or "''", cause=cause))

    def _long(self) -> list[str]:
        return [name for name in self._option_string_actions if name.startswith("--")]

    def _unknown(self, option: str) -> IrlxError:
        from irlx.diagnostics import IrlxError, report
        from irlx.diagnostics.diagnostic import near_matches

        near = near_matches(option, self._long()) if option.startswith("--") else ""
        return IrlxError(report("IRL017", command=self.prog, option=option, near=near))


def _unknown_command(word: str, commands: list[str]) -> IrlxError:
    # Imported here, as above: only a slip needs messages, and they take as long to load as all the rest.
    from irlx.diagnostics import IrlxError, report

    return IrlxError(report("IRL016", name=word, near=_meant(word, commands)))


def _meant(word: str, commands: list[str]) -> str:
    """Clause with what may be meant by a word that is no command."""
    if Path(word).suffix.lower() == ".irl":
        return f"; did you mean 'irlx run {word}'?"
    from irlx.diagnostics.diagnostic import near_matches

    return near_matches(word, commands)
