"""Conformance cases: small programs, each in a folder of its own with what has to come of it.

A case is a folder with `program.irl`, files that it needs (`*.dat`, `*.irl`, `cell.toml`, files
that it reads, `input.txt` for its standard input), and one of

- `blocks.txt`: the program runs, and these are its function blocks as `irlx blocks` prints them;
- `output.txt`: the program runs, and this is what it writes to its standard channel, and behind that each
  file that it writes: a line ``==> name <==``, then what is in it at the end;
- `error.txt`: the program must fail, with these errors, one a line: ``line:column: CODE message``;
- `check.txt`: the program is accepted, with these warnings in the same form, none where the file is
  empty; lints do not count.

The cell is the nearest `cell.toml`, in the folder of the case or above it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from difflib import unified_diff
from pathlib import Path
from typing import TYPE_CHECKING

from irlx.checking import check
from irlx.diagnostics import Diagnostic, IrlxError
from irlx.diagnostics.codes.lints import LINTS

if TYPE_CHECKING:
    from irlx.pipeline import Execution

__all__ = ["Case", "Outcome", "expectation_text", "find_cases", "run_case", "update_case"]

PROGRAM = "program.irl"
EXPECTATIONS = ("blocks.txt", "output.txt", "error.txt", "check.txt")
# What a version does not execute yet says nothing of the program, and lints are a matter of taste.
_UNEXECUTED = frozenset({"IRL590", "IRL591"})
_ASIDE = frozenset({*_UNEXECUTED, *(lint.id for lint in LINTS)})


@dataclass(frozen=True)
class Case:
    """A case: its folder, its name below the folder of all cases, and the name of its expectation.

    `fault` says why it is no case, '' where it is one.
    """

    folder: Path
    name: str
    cell: Path | None
    expectation: str
    fault: str = ""

    @property
    def must_fail(self) -> bool:
        """Whether the program has to be refused."""
        return self.expectation == "error.txt"


@dataclass(frozen=True)
class Outcome:
    """What came of a case; `reason` tells why it failed, with the difference where texts differ."""

    case: Case
    passed: bool
    reason: str = ""


def find_cases(root: Path) -> list[Case]:
    """All cases below a folder, in the order of their names."""
    folders = sorted(path.parent for path in root.rglob(PROGRAM))
    return [_case(root, folder) for folder in folders]


def _case(root: Path, folder: Path) -> Case:
    present = [name for name in EXPECTATIONS if (folder / name).is_file()]
    fault = "" if len(present) == 1 else f"needs one of {', '.join(EXPECTATIONS)}, has {len(present)}"
    # Also above the root, so that one area of a suite can be run by itself.
    cells = (place / "cell.toml" for place in (folder, *folder.parents))
    cell = next((path for path in cells if path.is_file()), None)
    name = folder.relative_to(root).as_posix()
    return Case(folder, name, cell, present[0] if present else "", fault)


def run_case(case: Case) -> Outcome:
    """Compare what the program of a case gives with what it has to give."""
    if case.fault:
        return Outcome(case, False, case.fault)
    expected = (case.folder / case.expectation).read_text(encoding="utf-8")
    try:
        found = expectation_text(case)
    except IrlxError as error:
        lines = "\n".join(str(diagnostic) for diagnostic in error.diagnostics)
        return Outcome(case, False, f"must be accepted, but fails:\n{lines}")
    if found is None:
        return Outcome(case, False, "must fail, but is accepted")
    if found == expected:
        return Outcome(case, True)
    names = (f"{case.expectation} (expected)", f"{case.expectation} (found)")
    difference = unified_diff(expected.splitlines(), found.splitlines(), *names, lineterm="")
    return Outcome(case, False, "\n".join(difference))


def update_case(case: Case) -> bool:
    """Write the expectation of a case anew; False where the program does not do what that kind is for."""
    if case.fault:
        return False
    try:
        found = expectation_text(case)
    except IrlxError:
        return False
    if found is not None:
        (case.folder / case.expectation).write_text(found, encoding="utf-8")
    return found is not None


def expectation_text(case: Case) -> str | None:
    """What the file of expectations would have to hold, None for a program that fails as little as it may.

    Raises IrlxError for a program that fails although it must not.
    """
    program = case.folder / PROGRAM
    findings = check(program, case.cell)
    errors = [finding for finding in findings if finding.is_error]
    if case.must_fail:
        failures = errors or _failures_of_a_run(case)
        return _text(_concise(case, failures)) if failures else None
    if errors:
        raise IrlxError(errors)
    if case.expectation == "check.txt":
        return _text(_concise(case, findings))
    return _text(_block_lines(case)) if case.expectation == "blocks.txt" else _output(case)


def _text(lines: list[str] | Iterator[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


def _concise(case: Case, findings: list[Diagnostic]) -> list[str]:
    """Findings as ``line:column: CODE message``; before them the file, where it is not the program."""
    lines = []
    for finding in findings:
        if finding.code in _ASIDE:
            continue
        place = str(finding.place or "").removeprefix(f"{case.folder / PROGRAM}:")
        place = place.replace(f"{case.folder.as_posix()}/", "")
        message = finding.message.replace(f"{case.folder.as_posix()}/", "")
        lines.append(f"{place}: {finding.code} {message}")
    return lines


def _failures_of_a_run(case: Case) -> list[Diagnostic]:
    """Errors of a program that is accepted but cannot run; what is not executed yet is no such error."""
    try:
        for _ in _block_lines(case):
            pass
    except IrlxError as error:
        return [found for found in error.diagnostics if found.is_error and found.code not in _UNEXECUTED]
    return []


def _block_lines(case: Case) -> Iterator[str]:
    # Imported here: cases that are only checked need no numeric library.
    from irlx.blocks.text import block_text
    from irlx.job import header_of

    execution = _execution(case)
    units = header_of(execution.job).joint_units
    for block in execution.blocks():
        yield block_text(block, units)


def _output(case: Case) -> str:
    """What a program writes, to files as well; none of them is made."""
    from irlx.interpreter.channels.memory_files import MemoryFiles

    execution = _execution(case)
    for _ in execution.blocks():
        pass
    text, files = execution.channels.output, execution.channels.files
    written = files.written if isinstance(files, MemoryFiles) else {}
    return text + "".join(
        f"==> {name} <==\n{content.decode('utf-8', 'replace')}" for name, content in written.items()
    )


def _execution(case: Case) -> Execution:
    from irlx.job import prepare
    from irlx.pipeline import Execution

    given = case.folder / "input.txt"
    text = given.read_text(encoding="utf-8") if given.is_file() else None
    return Execution(prepare(case.folder / PROGRAM, case.cell, input=text))
