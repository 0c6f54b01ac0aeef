"""A program file, read and analysed: what `irlx.load` returns."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, TypeAlias

from irlx.blocks import Origin
from irlx.cell.find import find_cell, is_file
from irlx.cell.frame_names import frame_names
from irlx.cell.known import KnownCell, known_of, known_of_file, unreadable
from irlx.diagnostics import Diagnostic, IrlxError, Place, SourceText, Span, report
from irlx.diagnostics.near_files import near_files, near_names
from irlx.diagnostics.whole_file import whole_file
from irlx.language import tree
from irlx.language.analysis import Analysis, CellNames, DataListResolver, analyse
from irlx.language.data_lists import ImportedList
from irlx.language.modules import ImportedModule, ModuleProblem
from irlx.language.move_count import move_count
from irlx.language.source import decode_source
from irlx.language.suppression import Ignore
from irlx.language.tree.nodes import Name

if TYPE_CHECKING:
    from irlx.cell.cell import Cell

PathLike = str | os.PathLike[str]


class ProgramError(IrlxError):
    """A program that cannot be used; `diagnostics` holds all findings, warnings included."""


@dataclass(frozen=True)
class DataListFile(ImportedList):
    """A data list that a program imports: its file, text, tree, and the SHA-256 of the file's bytes."""

    path: Path
    sha256: str

    def is_as_read(self) -> bool:
        """Whether the file still holds the very bytes that were read."""
        try:
            return hashlib.sha256(whole_file(self.path)).hexdigest() == self.sha256
        except OSError:
            return False


@dataclass(frozen=True)
class ModuleFile(ImportedModule):
    """A module that a program needs: its file, text, tree, and the SHA-256 of the file's bytes."""

    path: Path = Path()
    sha256: str = ""


@dataclass(frozen=True)
class Program:
    """A program without errors: its file, text, tree, the warnings of its analysis, its data lists, modules.

    `data_lists` are those of the program itself, `modules` all that it needs, each behind those that it
    imports. `sha256` is that of the file's bytes; it covers lists and modules as well, see `digest_of_all`.
    `ignores` are what comments ask to ignore and only a run or a look at what can be executed finds. `known`
    is what was known of its cell when it was analysed.
    """

    path: Path
    source: SourceText
    tree: tree.Program
    diagnostics: tuple[Diagnostic, ...]
    sha256: str
    data_lists: tuple[DataListFile, ...] = ()
    modules: tuple[ModuleFile, ...] = ()
    ignores: tuple[Ignore, ...] = ()
    known: KnownCell = field(default_factory=KnownCell)

    @property
    def file_name(self) -> str:
        """Name of its file, without folder."""
        return self.path.name

    def place(self, origin: Origin) -> Place:
        """Where a block comes from, in the text of the program or of one of its modules."""
        texts = (module.source for module in self.modules)
        text = next((text for text in texts if PurePath(text.name).name == origin.file), self.source)
        return Place.in_text(text, Span(origin.start, origin.end))

    @property
    def name(self) -> str:
        """Name after PROGRAM, as spelt."""
        return self.tree.name.name

    @property
    def has_tolerances(self) -> bool:
        """Whether any move in it, or in its modules, is WITH TOLERANCE."""
        roots = (self.tree, *(module.tree for module in self.modules))
        return any(isinstance(node, tree.WithTolerance) for root in roots for node in tree.walk(root))

    @property
    def move_count(self) -> int | None:
        """Number of moves that it makes, None where only a run tells."""
        return move_count(self.tree, (module.tree for module in self.modules))

    @property
    def all_lists(self) -> tuple[DataListFile, ...]:
        """Data lists of the program and its modules, each file once."""
        of_modules = (found for module in self.modules for found in module.data_lists)
        lists = (found for found in (*self.data_lists, *of_modules) if isinstance(found, DataListFile))
        return tuple({found.path: found for found in lists}.values())

    @property
    def specification(self) -> Name | None:
        """Name of the cell that SYSTEM SPECIFICATION gives, or None."""
        return _specification(self.tree)


def load(path: PathLike, cell: PathLike | Cell | None = None) -> Program:
    """Read and analyse a program file, with what its cell tells: names that it may use, joints of the robot.

    `cell` None: found as `cell_path` finds it. Raises ProgramError that holds all diagnostics; what is
    wrong with the cell is not told here.
    """
    file = Path(path)
    return _loaded(file, read_file(file), cell)


def load_text(text: str, path: PathLike, cell: PathLike | Cell | None = None) -> Program:
    """The program of a text, as if it stood in a file at `path`, which need not be there.

    Data lists, modules and the cell are looked for beside it; a Cell that has been loaded says its names
    itself. Raises ProgramError as `load` does.
    """
    return _loaded(Path(path), text.encode("utf-8"), cell)


def check_fits(program: Program, cell: Cell) -> None:
    """Refuse a program that has errors in a cell, though it had none with what was known of its cell before.

    It is analysed anew where the cell tells other things, with its lists and modules as they were read.
    Raises ProgramError that holds all diagnostics.
    """
    if program.known.tells_the_same(known_of(cell)):
        return
    read: list[Program | DataListFile | ModuleFile] = [program, *program.all_lists, *program.modules]
    contents = {part.path: part.source.text.encode("utf-8") for part in read}
    analysis = _analysis(
        program.path, contents[program.path], _Beside(program.path, cell, contents.__getitem__)
    )
    if analysis.has_errors:
        raise ProgramError(analysis.diagnostics)


def _loaded(file: Path, content: bytes, cell: PathLike | Cell | None) -> Program:
    files = _Beside(file, cell)
    analysis = _analysis(file, content, files)
    if analysis.has_errors or not isinstance(analysis.tree, tree.Program):
        raise ProgramError(_why_no_program(analysis))
    return _program(file, content, analysis.tree, analysis, files)


def _program(file: Path, content: bytes, root: tree.Program, analysis: Analysis, files: _Beside) -> Program:
    lists = tuple(files.lists.file_of(found) for found in analysis.data_lists)
    modules = tuple(files.modules)
    digest = digest_of_all(hashlib.sha256(content).hexdigest(), lists, modules)
    return Program(
        file,
        analysis.source,
        root,
        analysis.diagnostics,
        digest,
        lists,
        modules,
        analysis.ignores,
        files.known,
    )


def digest_of_all(program: str, lists: Sequence[DataListFile], modules: Sequence[ModuleFile] = ()) -> str:
    """SHA-256 of a program, its data lists in order, and its modules, each with its own data lists.

    Without lists and modules it is that of the program's file; else that of the text with one digest a line,
    each line with its end: what ``sha256sum p.irl points.dat tools.irl | cut -c-64 | sha256sum`` prints.
    """
    digests = [program, *(found.sha256 for found in lists)]
    for module in modules:
        of_lists = (found.sha256 for found in module.data_lists if isinstance(found, DataListFile))
        digests += [module.sha256, *of_lists]
    if len(digests) == 1:
        return program
    lines = "".join(f"{digest}\n" for digest in digests)
    return hashlib.sha256(lines.encode("ascii")).hexdigest()


def names_around(path: PathLike) -> tuple[DataListResolver, CellNames]:
    """What gives the data lists beside a file, and the names that the cell a run would find adds to it."""
    file = Path(path)
    return _ListFiles(file), lambda root: _found_names(file, root)


def analyse_text(text: str, path: PathLike, cell: PathLike | Cell | None = None) -> Analysis:
    """Analysis, with lints, of a text as if it stood in a file at `path`, as `load_text` takes it."""
    file = Path(path)
    return _analysis(file, text.encode("utf-8"), _Beside(file, cell), lints=True)


def analyse_with_program(path: PathLike, cell: PathLike | None = None) -> tuple[Analysis, Program | None]:
    """Analysis, with lints, of a file, and the program that `load` would give where it is one without errors.

    The file is a program, a module or a data list. Raises ProgramError where the file cannot be read.
    """
    file = Path(path)
    content, files = read_file(file), _Beside(file, cell)
    analysis = _analysis(file, content, files, lints=True)
    if analysis.has_errors or not isinstance(analysis.tree, tree.Program):
        return analysis, None
    return analysis, _program(file, content, analysis.tree, analysis, files)


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


def _specification(root: tree.Program | tree.Module) -> Name | None:
    for part in root.declarations:
        if isinstance(part, tree.SystemSpecification):
            return part.name
    return None


Read: TypeAlias = "Callable[[Path], bytes]"
"""Gives the content of a file. Raises OSError or ValueError."""


def _given(cell: PathLike | Cell | None) -> KnownCell | None:
    """What a cell that is given tells, None where none is."""
    if cell is None:
        return None
    return known_of_file(Path(cell)) if isinstance(cell, str | os.PathLike) else known_of(cell)


class _ListFiles:
    """Reads the data lists beside a program, and keeps what there is to know of their files."""

    def __init__(self, program: Path, read: Read = whole_file) -> None:
        self._program, self._content = program, read
        self._read: dict[str, tuple[Path, str]] = {}

    def __call__(self, name: str, place: Place) -> SourceText:
        """Text of the data list of a name. Raises IrlxError: IRL240, IRL241 at `place`, IRL130, IRL131."""
        path = self._program.with_name(f"{name}.dat")
        try:
            content = self._content(path)
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


class _Beside:
    """Reads the data lists and modules beside a program, each file once.

    `modules` are those that could be analysed, each behind those that it imports; `findings` those on them.
    The `cell` of the program is that of its modules, too; None: the one that a run would find.
    """

    def __init__(self, program: Path, cell: PathLike | Cell | None, read: Read = whole_file) -> None:
        self.lists = _ListFiles(program, read)
        self.modules: list[ModuleFile] = []
        self.findings: list[Diagnostic] = []
        self._program, self._known = program, _given(cell)
        self._open, self._content = [program], read
        self._done: dict[Path, Analysis] = {}

    def __call__(self, name: str) -> Analysis:
        """Analysis of the module of a name. Raises ModuleProblem: IRL218 without a file, IRL260, IRL261."""
        path = self._open[0].with_name(f"{name}.irl")
        if path in self._open:
            circle = " imports ".join(file.name for file in [*self._open[self._open.index(path) :], path])
            raise ModuleProblem("IRL260", module=name, files=circle)
        if path not in self._done:
            try:
                content = self._content(path)
            except FileNotFoundError:
                near = near_names(path, self._open)
                raise ModuleProblem("IRL218", module=name, near=near) from None
            except (OSError, ValueError) as cause:
                words = "it is a folder" if isinstance(cause, IsADirectoryError) else _words(cause)
                raise ModuleProblem("IRL261", module=name, path=path, cause=words) from None
            self._open.append(path)
            try:
                self._done[path] = self._analysed(name, path, content)
            finally:
                self._open.pop()
        return self._done[path]

    @property
    def known(self) -> KnownCell:
        """What is known of the cell, as soon as the program has been analysed."""
        return self._known or KnownCell()

    def analysed(self, text: SourceText, *, lints: bool = False) -> Analysis:
        """Analysis of the program, then of its modules, with all that its cell tells."""
        return analyse(
            text,
            self,
            lambda root: self._known_to(root).frames,
            self.lists,
            joints=(lambda root: self._known_to(root).joints) if self._known is None else self._known.joints,
            obstacles=lambda root: self._known_to(root).obstacles,
            lints=lints,
        )

    def _known_to(self, root: tree.Program | tree.Module) -> KnownCell:
        if self._known is None:
            found = _found_cell(self._program, root)
            self._known = KnownCell() if found is None else known_of_file(found)
        return self._known

    def _analysed(self, name: str, path: Path, content: bytes) -> Analysis:
        try:
            source = decode_source(str(path), content)
        except IrlxError as error:
            raise ModuleProblem("IRL261", module=name, path=path, cause=error.reason.message) from None
        analysis = self.analysed(source)
        self.findings += analysis.diagnostics
        if isinstance(analysis.tree, tree.Module):
            lists = tuple(self.lists.file_of(found) for found in analysis.data_lists)
            digest = hashlib.sha256(content).hexdigest()
            module = ModuleFile(name.casefold(), source, analysis.tree, lists, path, digest)
            self.modules.append(module)
        return analysis


def _analysis(file: Path, content: bytes, files: _Beside, *, lints: bool = False) -> Analysis:
    """Analysis of the bytes of a file. Raises ProgramError for bytes that are no text."""
    try:
        analysis = files.analysed(decode_source(str(file), content), lints=lints)
    except IrlxError as error:
        raise ProgramError(error.diagnostics) from error
    found = (*analysis.diagnostics, *files.findings)
    return replace(analysis, diagnostics=found, modules=tuple(files.modules))


def _found_names(path: Path, root: tree.Program | tree.Module) -> Mapping[str, bool] | None:
    """Names of the frames of the cell that a run of this file would find, None where there is none."""
    cell = _found_cell(path, root)
    return None if cell is None else frame_names(cell)


def faults_of_found_cell(path: PathLike, root: tree.Program | tree.Module) -> list[Diagnostic]:
    """Why the cell that a run of a file would find cannot be read; what it says is not looked at."""
    cell = _found_cell(Path(path), root)
    return [] if cell is None else unreadable(cell)


def _found_cell(path: Path, root: tree.Program | tree.Module) -> Path | None:
    return next(filter(is_file, _candidates(path, _specification(root))), None)


def _why_no_program(analysis: Analysis) -> tuple[Diagnostic, ...]:
    """Findings of a file that is no usable program; a module or data list without errors gets one."""
    if analysis.has_errors or analysis.tree is None:
        return analysis.diagnostics
    place = Place.in_text(analysis.source, analysis.tree.name.span)
    kind = type(analysis.tree).__name__.upper()
    return (*analysis.diagnostics, report("IRL008", place, name=analysis.tree.name.name, kind=kind))


def read_file(path: Path) -> bytes:
    """Content of a file. Raises ProgramError: IRL001 where there is none, IRL007 for a folder, IRL002."""
    try:
        return whole_file(path)
    except FileNotFoundError:
        raise ProgramError(report("IRL001", path=path, near=near_files(path))) from None
    except IsADirectoryError:
        raise ProgramError(report("IRL007", path=path)) from None
    except (OSError, ValueError) as cause:
        raise ProgramError(report("IRL002", path=path, cause=_words(cause))) from None


def _words(cause: OSError | ValueError) -> str:
    return cause.strerror if isinstance(cause, OSError) and cause.strerror else str(cause)
