"""A program file, read and analysed: what `irlx.load` returns."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from irlx.cell.find import find_cell, is_file
from irlx.cell.frame_names import frame_names
from irlx.diagnostics import Diagnostic, IrlxError, Place, SourceText, report
from irlx.diagnostics.near_files import near_files
from irlx.language import tree
from irlx.language.analysis import Analysis, analyse
from irlx.language.data_lists import ImportedList
from irlx.language.source import decode_source
from irlx.language.tree.nodes import Name

PathLike = str | os.PathLike[str]


class ProgramError(IrlxError):
    """A program that cannot be used; `diagnostics` holds all findings, warnings included."""


@dataclass(frozen=True)
class DataListFile(ImportedList):
    """A data list that a program imports: its file, text, tree, and the SHA-256 of the file's bytes."""

    path: Path
    sha256: str


@dataclass(frozen=True)
class Program:
    """A program without errors: its file, text, tree, the warnings of its analysis, and its data lists.

    `sha256` is that of the file's bytes; with data lists it covers them as well, see `digest_of_all`.
    """

    path: Path
    source: SourceText
    tree: tree.Program
    diagnostics: tuple[Diagnostic, ...]
    sha256: str
    data_lists: tuple[DataListFile, ...] = ()

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
    content, files = _content(file), _ListFiles(file)
    analysis = _analysis(file, content, cell, files)
    if analysis.has_errors or not isinstance(analysis.tree, tree.Program):
        raise ProgramError(_why_no_program(analysis))
    lists = tuple(files.file_of(found) for found in analysis.data_lists)
    digest = digest_of_all(hashlib.sha256(content).hexdigest(), lists)
    return Program(file, analysis.source, analysis.tree, analysis.diagnostics, digest, lists)


def digest_of_all(program: str, lists: Sequence[DataListFile]) -> str:
    """SHA-256 of a program and its data lists, in order, from that of the program's file.

    Without lists it is that of the file; else that of the text with one digest a line, each line with its
    end: what ``sha256sum p.irl points.dat | cut -c-64 | sha256sum`` prints.
    """
    if not lists:
        return program
    lines = "".join(f"{digest}\n" for digest in (program, *(found.sha256 for found in lists)))
    return hashlib.sha256(lines.encode("ascii")).hexdigest()


def analyse_file(path: PathLike, cell: PathLike | None = None, joints: tuple[str, ...] = ()) -> Analysis:
    """Analysis of a program, module or data list file, with lints; `joints` are those of its robot, if known.

    Raises ProgramError where the file cannot be read.
    """
    file = Path(path)
    return _analysis(file, _content(file), cell, _ListFiles(file), joints, lints=True)


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


class _ListFiles:
    """Reads the data lists beside a program, and keeps what there is to know of their files."""

    def __init__(self, program: Path) -> None:
        self._program = program
        self._read: dict[str, tuple[Path, str]] = {}

    def __call__(self, name: str, place: Place) -> SourceText:
        """Text of the data list of a name. Raises IrlxError: IRL240, IRL241 at `place`, IRL130, IRL131."""
        path = self._program.with_name(f"{name}.dat")
        try:
            content = path.read_bytes()
        except FileNotFoundError:
            raise IrlxError(report("IRL240", place, name=name, path=path, near=near_files(path))) from None
        except (OSError, ValueError) as cause:
            words = "it is a folder" if isinstance(cause, IsADirectoryError) else _words(cause)
            raise IrlxError(report("IRL241", place, name=name, path=path, cause=words)) from None
        self._read[str(path)] = path, hashlib.sha256(content).hexdigest()
        return decode_source(str(path), content)

    def file_of(self, found: ImportedList) -> DataListFile:
        """A data list with its file."""
        return DataListFile(found.source, found.tree, *self._read[found.source.name])


def _analysis(
    path: Path,
    content: bytes,
    cell: PathLike | None,
    files: _ListFiles,
    joints: tuple[str, ...] = (),
    *,
    lints: bool = False,
) -> Analysis:
    """Analysis of the bytes of a file. Raises ProgramError for bytes that are no text."""

    def cell_names(root: tree.Program) -> tuple[str, ...]:
        if cell is not None:
            return frame_names(Path(cell))
        found = (candidate for candidate in _candidates(path, _specification(root)) if is_file(candidate))
        return next((frame_names(candidate) for candidate in found), ())

    try:
        text = decode_source(str(path), content)
        return analyse(text, cell_names=cell_names, data_lists=files, joints=joints, lints=lints)
    except IrlxError as error:
        raise ProgramError(error.diagnostics) from error


def _why_no_program(analysis: Analysis) -> tuple[Diagnostic, ...]:
    """Findings of a file that is no usable program; a module or data list without errors gets one."""
    if analysis.has_errors or analysis.tree is None:
        return analysis.diagnostics
    place = Place.in_text(analysis.source, analysis.tree.name.span)
    kind = type(analysis.tree).__name__.upper()
    return (*analysis.diagnostics, report("IRL008", place, name=analysis.tree.name.name, kind=kind))


def _content(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise ProgramError(report("IRL001", path=path, near=near_files(path))) from None
    except IsADirectoryError:
        raise ProgramError(report("IRL007", path=path)) from None
    except (OSError, ValueError) as cause:
        raise ProgramError(report("IRL002", path=path, cause=_words(cause))) from None


def _words(cause: OSError | ValueError) -> str:
    return cause.strerror if isinstance(cause, OSError) and cause.strerror else str(cause)
