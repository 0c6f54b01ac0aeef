"""A stream made again from what its file says: what `irlx run --reproduce` and `irlx.reproduce` do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

from irlx.cell.find import is_file
from irlx.diagnostics import Diagnostic, IrlxError, Place, report
from irlx.interpreter.channels.pieces import InputGiven
from irlx.job import Job, PathLike, prepare
from irlx.pipeline import Execution
from irlx.report.run import RunError
from irlx.running import execute_to_files
from irlx.streams.formats import scan_stream
from irlx.streams.header_plain import header_to_plain
from irlx.streams.joint_stream import BlockRecord, StreamHeader
from irlx.streams.making import Making
from irlx.streams.scan import RowBatch, ScanItem
from irlx.streams.temporary_folder import temporary_folder

_SOFTWARE = ("irlx_version", "making.software")


@dataclass(frozen=True)
class Reproduction:
    """What came of making a stream again.

    `same_bytes`: the file is the same byte by byte. `differences` of the stream, in words: none where header,
    blocks and samples are the same bit by bit, the versions of software aside, which `software` tells where
    they differ.
    """

    path: Path
    same_bytes: bool
    differences: tuple[str, ...]
    software: str = ""

    @property
    def reproduced(self) -> bool:
        """Whether it is the same stream."""
        return not self.differences

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """IRL732 with the first difference, where there is one."""
        if self.reproduced:
            return ()
        software = self.software or "they are the same"
        return (report("IRL732", Place(str(self.path)), difference=self.differences[0], software=software),)


def reproduce(
    path: PathLike,
    program: PathLike | None = None,
    cell: PathLike | None = None,
    inputs: PathLike | None = None,
    files: PathLike | None = None,
    input: InputGiven = None,
) -> Reproduction:
    """Make a stream file again, and compare.

    `program`, `cell` and `inputs` are looked for beside the file and in the working folder, by the recorded
    names, where they are not given; each must be what it was. `files` and `input` as in `run`. Raises
    StreamError for a file that cannot be read, IrlxError: IRL730 where something is not as it was, IRL731
    where the file does not say all; what `run` raises where nothing can be run.
    """
    out = Path(path)
    header = next(scan_stream(out))
    assert isinstance(header, StreamHeader)
    making = header.making
    _check_known(out, header, {"files": files is not None, "input": isinstance(input, str)})
    source = _found(out, program, _source_name(out, header))
    job = prepare(
        source,
        None if cell is None and not header.cell_name else _found(out, cell, header.cell_name),
        header.tick_ns / 1e6,
        making.max_slow,
        making.max_steps,
        _found(out, inputs, making.inputs) if making.inputs else None,
        files,
        input,
        pause_s=making.pause,
    )
    _check_same(out, header, job)
    job = replace(job, making=replace(job.making, given=making.given))
    with temporary_folder() as folder:
        again = folder / out.name
        try:
            execute_to_files(Execution(job), [again])
        except RunError as error:
            if not error.run.files:
                raise
            again = error.run.files[0]
        return _compared(out, again)


def _check_known(path: Path, header: StreamHeader, given: Mapping[str, bool]) -> None:
    """Raises IrlxError, IRL731, for what the file does not say and is not `given` again, by its name."""
    missing = [GIVEN[name] for name in header.making.given if not given.get(name)]
    if header.making == Making():
        missing.append("all that files of version 2 say")
    if missing:
        raise IrlxError(report("IRL731", Place(str(path)), missing=", ".join(missing)))


GIVEN = {
    "inputs": "inputs that Python gave",
    "input": "the text for STANDARD_IN that Python gave",
    "files": "the folder of --files",
    "on_pause": "a function that answered each PAUSE",
    "cell": "a cell that is no file as it stands",
}
"""What a run may be given that no file can hold: its name in the file, and words for it."""


def _source_name(path: Path, header: StreamHeader) -> str:
    """Name of the file that was run: the program, or the stream that was replayed."""
    if not header.making.replay_of:
        return header.program_name
    return f"{path.name.removesuffix(path.suffix).removesuffix('.replay')}{path.suffix}"


def _found(beside: Path, given: PathLike | None, name: str) -> Path:
    """A file that is given, or of this name beside another or in the working folder."""
    if given is not None:
        return Path(given)
    if not name or Path(name).name != name:
        return beside.parent / "missing"
    return next(filter(is_file, (beside.with_name(name), Path(name))), beside.with_name(name))


def _check_same(path: Path, header: StreamHeader, job: Job) -> None:
    """Raises IrlxError, IRL730, for everything that is not as it was."""
    making = header.making
    pairs = [
        (job.program.path, job.program.sha256, header.program_sha256),
        (Path(job.cell.file), job.making.cell_sha256, making.cell_sha256),
    ]
    if making.inputs:
        pairs.append((Path(making.inputs), job.making.inputs_sha256, making.inputs_sha256))
    if making.replay_of:
        pairs[0] = job.program.path, job.making.replay_of, making.replay_of
    changed = [
        report("IRL730", Place(str(path)), name=name, found=found[:12] or "none", recorded=recorded[:12])
        for name, found, recorded in pairs
        if found != recorded
    ]
    if changed:
        raise IrlxError(changed)


def _compared(first: Path, second: Path) -> Reproduction:
    same_bytes = first.is_file() and first.read_bytes() == second.read_bytes()
    if same_bytes:
        return Reproduction(first, True, ())
    software, differences = "", []
    headers = [header_to_plain(_header(path)) for path in (first, second)]
    for key in sorted({*_flat(headers[0]), *_flat(headers[1])}):
        one, other = (_flat(plain).get(key) for plain in headers)
        if one != other and key in _SOFTWARE:
            software += f"{'; ' if software else ''}{_text(one)} (here {_text(other)})"
        elif one != other:
            differences.append(f"{key} of the header is {other!r}, recorded {one!r}")
    differences += _first_difference(first, second, headers[0]["joint_names"])
    return Reproduction(first, False, tuple(differences), software)


def _header(path: Path) -> StreamHeader:
    header = next(scan_stream(path))
    assert isinstance(header, StreamHeader)
    return header


def _flat(plain: dict[str, Any]) -> dict[str, Any]:
    parts = {f"making.{name}": value for name, value in plain.get("making", {}).items()}
    return {**{name: value for name, value in plain.items() if name != "making"}, **parts}


def _text(value: object) -> str:
    return ", ".join(value) if isinstance(value, list) else str(value)


def _first_difference(first: Path, second: Path, names: list[str]) -> list[str]:
    """The first place at which blocks or samples of two files differ, none where they do not."""
    for one, other in zip_longest(*(_pieces(path) for path in (first, second))):
        if one is None or other is None:
            return ["one ends before the other"]
        if isinstance(one, RowBatch) and isinstance(other, RowBatch):
            words = _rows_differ(one, other, names)
            if words:
                return [words]
        elif one != other:
            return [f"{_title(other)} is in the place of {_title(one)}"]
    return []


def _title(item: object) -> str:
    if isinstance(item, BlockRecord):
        return f"block {item.block.id}"
    return "a sample" if isinstance(item, RowBatch) else "the end"


def _pieces(path: Path) -> Iterator[ScanItem]:
    """What a file holds behind its header, rows one portion a time, cut alike in two files of one format."""
    items = scan_stream(path)
    next(items)
    yield from items


def _rows_differ(one: RowBatch, other: RowBatch, names: list[str]) -> str:
    rows = min(len(one.ticks), len(other.ticks))
    for name in ("ticks", "q", "block", "tool"):
        first, second = (np.ascontiguousarray(getattr(batch, name)[:rows]) for batch in (one, other))
        if first.tobytes() == second.tobytes():
            continue
        differs = (first.view(np.int64) != second.view(np.int64)).reshape(rows, -1)
        row, column = np.unravel_index(int(np.argmax(differs)), differs.shape)
        if name == "q":
            way = abs(float(first[row, column] - second[row, column]))
            return f"joint {names[int(column)]} at tick {one.ticks[row]} by {way:.2g}"
        return f"{name} at tick {one.ticks[row]}"
    return "" if len(one.ticks) == len(other.ticks) else f"one ends at tick {one.ticks[rows - 1]}"
