"""A program file, read and analysed: what `irlx.load` returns."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

from irlx.diagnostics import Diagnostic, IrlxError, Place, SourceText, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.language import tree
from irlx.language.analysis import Analysis, analyse
from irlx.language.source import decode_source
from irlx.language.tree.nodes import Name


class ProgramError(IrlxError):
    """A program that cannot be used; `diagnostics` holds all findings, warnings included."""


@dataclass(frozen=True)
class Program:
    """A program without errors: its file, text, tree and the warnings of its analysis."""

    path: Path
    source: SourceText
    tree: tree.Program
    diagnostics: tuple[Diagnostic, ...]
    sha256: str

    @property
    def name(self) -> str:
        """Name after PROGRAM, as spelt."""
        return self.tree.name.name

    @property
    def specification(self) -> Name | None:
        """Name of the cell that SYSTEM SPECIFICATION gives, or None."""
        for part in self.tree.declarations:
            if isinstance(part, tree.SystemSpecification):
                return part.name
        return None


def load(path: str | os.PathLike[str]) -> Program:
    """Read and analyse a program file. Raises ProgramError that holds all diagnostics."""
    file = Path(path)
    content = _content(file)
    analysis = analyse_bytes(str(file), content)
    if analysis.has_errors or not isinstance(analysis.tree, tree.Program):
        raise ProgramError(_with_module(analysis))
    digest = hashlib.sha256(content).hexdigest()
    return Program(file, analysis.source, analysis.tree, analysis.diagnostics, digest)


def analyse_file(path: str | os.PathLike[str]) -> Analysis:
    """Analysis of a program or module file. Raises ProgramError where the file cannot be read."""
    return analyse_bytes(str(path), _content(Path(path)))


def analyse_bytes(name: str, content: bytes) -> Analysis:
    """Analysis of the bytes of a file. Raises ProgramError for bytes that are no text."""
    try:
        return analyse(decode_source(name, content))
    except IrlxError as error:
        raise ProgramError(error.diagnostics) from error


def _with_module(analysis: Analysis) -> tuple[Diagnostic, ...]:
    """Findings of a file that is no usable program; a module without errors gets one."""
    if analysis.has_errors or analysis.tree is None:
        return analysis.diagnostics
    place = Place.in_text(analysis.source, analysis.tree.name.span)
    return (*analysis.diagnostics, report("IRL008", place, name=analysis.tree.name.name))


def _content(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise ProgramError(report("IRL001", path=path, near=_near(path))) from None
    except IsADirectoryError:
        raise ProgramError(report("IRL007", path=path)) from None
    except (OSError, ValueError) as cause:
        words = cause.strerror if isinstance(cause, OSError) and cause.strerror else str(cause)
        raise ProgramError(report("IRL002", path=path, cause=words)) from None


def _near(path: Path) -> str:
    """Programs beside a missing file with a name like it."""
    try:
        names = sorted(entry.name for entry in path.parent.iterdir() if entry.suffix == path.suffix)
    except OSError:
        return ""
    return near_matches(path.name, names)
