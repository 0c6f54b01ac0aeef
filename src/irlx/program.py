"""A program file, read and analysed: what `irlx.load` returns."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path

from irlx.cell.find import find_cell, is_file
from irlx.cell.frame_names import frame_names
from irlx.diagnostics import Diagnostic, IrlxError, Place, SourceText, report
from irlx.diagnostics.near_files import near_files
from irlx.language import tree
from irlx.language.analysis import Analysis, analyse
from irlx.language.source import decode_source
from irlx.language.tree.nodes import Name

PathLike = str | os.PathLike[str]


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
        return _specification(self.tree)


def load(path: PathLike, cell: PathLike | None = None) -> Program:
    """Read and analyse a program file; the frames of its cell are names it may use.

    `cell` None: found as `cell_path` finds it. Raises ProgramError that holds all diagnostics; what is
    wrong with the cell is not told here.
    """
    file = Path(path)
    content = _content(file)
    analysis = _analysis(file, content, cell)
    if analysis.has_errors or not isinstance(analysis.tree, tree.Program):
        raise ProgramError(_with_module(analysis))
    digest = hashlib.sha256(content).hexdigest()
    return Program(file, analysis.source, analysis.tree, analysis.diagnostics, digest)


def analyse_file(path: PathLike, cell: PathLike | None = None) -> Analysis:
    """Analysis of a program or module file. Raises ProgramError where the file cannot be read."""
    return _analysis(Path(path), _content(Path(path)), cell)


def cell_path(program: Program, given: PathLike | None) -> Path:
    """Path of the cell file of a program. Raises CellError, IRL609, that lists what was tried."""
    if given is not None:
        return Path(given)
    name = program.specification
    place = Place.in_text(program.source, name.span) if name is not None else Place(str(program.path))
    return find_cell(_candidates(program.path, name), place)


def _candidates(path: Path, specification: Name | None) -> list[Path]:
    """Where the cell of a program may be, the first one that exists counts."""
    named = [] if specification is None else [path.with_name(f"{specification.name}.toml")]
    return [*named, path.with_suffix(".toml")]


def _specification(root: tree.Program) -> Name | None:
    for part in root.declarations:
        if isinstance(part, tree.SystemSpecification):
            return part.name
    return None


def _analysis(path: Path, content: bytes, cell: PathLike | None) -> Analysis:
    """Analysis of the bytes of a file. Raises ProgramError for bytes that are no text."""

    def cell_names(root: tree.Program) -> tuple[str, ...]:
        if cell is not None:
            return frame_names(Path(cell))
        found = (candidate for candidate in _candidates(path, _specification(root)) if is_file(candidate))
        return next((frame_names(candidate) for candidate in found), ())

    try:
        return analyse(decode_source(str(path), content), cell_names=cell_names)
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
        raise ProgramError(report("IRL001", path=path, near=near_files(path))) from None
    except IsADirectoryError:
        raise ProgramError(report("IRL007", path=path)) from None
    except (OSError, ValueError) as cause:
        words = cause.strerror if isinstance(cause, OSError) and cause.strerror else str(cause)
        raise ProgramError(report("IRL002", path=path, cause=words)) from None
