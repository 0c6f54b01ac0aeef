"""`irlx completion`: a script by which a shell completes the command line of irlx."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

_EXAMPLE = """\
examples:
  irlx completion bash
  irlx completion zsh
"""
_SHELLS = ("bash", "zsh", "fish", "tcsh")
_PROGRAMS = ("*.irl",)
_LISTS = ("*.irl", "*.dat")
_STREAMS = "streams"
"""Stands for the patterns of all stream formats."""
_FILES: Mapping[str, tuple[str, ...]] = {
    "P": (*_PROGRAMS, _STREAMS),
    "OUT": (_STREAMS,),
    "OUT2": (_STREAMS,),
    "plot F": ("*.svg", "*.png", "*.pdf"),
    "convert OUT": (_STREAMS, "*.script", "*.src", "*.mod"),
    "IN": (_STREAMS,),
    "STREAM": (_STREAMS,),
    "FILE": _LISTS,
    "check P.irl": _LISTS,
    "CSV": ("*.csv",),
    "M": ("*.py",),
}
"""Patterns of files by what the help calls an argument, of one command or of all."""
_FOLDERS = frozenset({"DIR"})


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "completion",
        help="print a script that lets a shell complete commands, options and files",
        description="Print a script by which a shell completes commands, options, files by their endings, "
        "robots and codes. docs/reference/editors.md tells where each shell wants it.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    shells = f"{{{','.join(_SHELLS)}}}"
    # What argparse says is missing: the choices, not the word 'shell'.
    parser.add_argument("shell", choices=_SHELLS, metavar=shells, help="which shell")
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Print the script on stdout."""
    import shtab

    from irlx.cli.main import build_parser

    parser = build_parser()
    for name, action in _arguments(parser):
        _complete(name, action)
    print(shtab.complete(parser, options.shell))
    return 0


def _arguments(parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.Action]]:
    """Every argument that takes a value, by the command and what the help calls it."""
    (commands,) = [one for one in parser._actions if isinstance(one, argparse._SubParsersAction)]
    for name, command in commands.choices.items():
        for action in command._actions:
            if action.nargs != 0 and action.choices is None:
                yield f"{name} {action.metavar or action.dest}", action


def _complete(name: str, action: argparse.Action) -> None:
    """Say how an argument is completed; what the help calls it decides, and where it has an ending that."""
    import shtab

    called = name.partition(" ")[2]
    words = _WORDS.get(name) or _WORDS.get(called)
    ending = called.rpartition(".")[2] if "." in called else ""
    patterns = _FILES.get(name) or _FILES.get(called) or ((f"*.{ending}",) if ending else ())
    if words is not None:
        action.choices = words()
    elif called in _FOLDERS:
        action.complete = shtab.DIRECTORY  # type: ignore[attr-defined]
    elif patterns:
        files = shtab.glob(*_expanded(patterns))
        if len(patterns) == 1 and _STREAMS not in patterns:
            # zsh takes one pattern in parentheses, which is what shtab writes, for a qualifier.
            files = {**files, "zsh": f"_files -g '{patterns[0]}'"}
        action.complete = files  # type: ignore[attr-defined]


def _expanded(patterns: Sequence[str]) -> Iterator[str]:
    from irlx.streams.formats import KNOWN_ENDINGS

    for pattern in patterns:
        yield from (f"*{ending}" for ending in KNOWN_ENDINGS) if pattern == _STREAMS else (pattern,)


def _codes() -> list[str]:
    from irlx.diagnostics import CATALOGUE

    return sorted(CATALOGUE)


def _robots() -> list[str]:
    from irlx.cell.overview import robot_names

    return [name for group in robot_names() for name in group]


_WORDS: Mapping[str, Callable[[], list[str]]] = {"CODE": _codes, "ROBOT": _robots, "robots NAME": _robots}
"""Words by what the help calls an argument, of one command or of all."""
