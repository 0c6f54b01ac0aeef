"""Scripted inputs in a file of their own: CSV with a line for each change."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from irlx.cell.errors import CellError
from irlx.cell.load import read_bytes
from irlx.diagnostics import Diagnostic, Place, report

HEADER = ["time", "input", "value"]
_ENTRY = "a time in s, an input, and TRUE, FALSE or a number"
_WORDS = {"true": 1.0, "false": 0.0}


@dataclass(frozen=True)
class InputFile:
    """Traces by casefolded name, and the place of the first line of each, by its name as spelt."""

    traces: dict[str, tuple[tuple[float, float], ...]]
    places: dict[str, Place]


def read_input_file(path: Path) -> InputFile:
    """Traces of a CSV with the columns time (s), input, value (TRUE, FALSE or a number).

    The times of each input rise. Raises CellError with every fault, IRL618 at its line; IRL001, IRL002 or
    IRL007 where the file cannot be read.
    """
    try:
        text = read_bytes(path).decode("utf-8-sig")
    except UnicodeDecodeError as cause:
        raise CellError(_fault(path, 1, "UTF-8", f"byte {cause.start}")) from cause
    lines = _lines(text, path)
    head = [cell.strip().casefold() for cell in lines[0]] if lines else []
    if head != HEADER:
        raise CellError(_fault(path, 1, f"the header {','.join(HEADER)}", ",".join(head) or "nothing"))
    traces: dict[str, list[tuple[float, float]]] = {}
    places: dict[str, Place] = {}
    faults = []
    for number, line in enumerate(lines[1:], 2):
        if not line:
            continue
        found = _entry(line)
        if found is None:
            faults.append(_fault(path, number, _ENTRY, ",".join(line)))
            continue
        name, at, value = found
        if name.casefold() not in traces:
            places[name] = _place(path, number)
        trace = traces.setdefault(name.casefold(), [])
        if trace and at <= trace[-1][0]:
            faults.append(_fault(path, number, f"a time after {trace[-1][0]:g} s for {name}", f"{at:g}"))
            continue
        trace.append((at, value))
    if faults:
        raise CellError(faults)
    return InputFile({name: tuple(trace) for name, trace in traces.items()}, places)


def _lines(text: str, path: Path) -> list[list[str]]:
    """Fields of all lines, whichever way these end. Raises CellError for what no CSV holds."""
    reader = csv.reader(io.StringIO(text, newline=""))
    try:
        return list(reader)
    except csv.Error as cause:
        raise CellError(_fault(path, reader.line_num, _ENTRY, str(cause))) from cause


def _entry(line: list[str]) -> tuple[str, float, float] | None:
    """Input, time and value of a line, None where it is no change of an input."""
    if len(line) != len(HEADER) or not line[1].strip():
        return None
    word = line[2].strip()
    try:
        at, value = float(line[0]), _WORDS.get(word.casefold())
        value = float(word) if value is None else value
    except ValueError:
        return None
    return (line[1].strip(), at, value) if isfinite(at) and at >= 0.0 and isfinite(value) else None


def _fault(path: Path, line: int, expected: str, found: str) -> Diagnostic:
    return report("IRL618", _place(path, line), line=line, expected=expected, found=found)


def _place(path: Path, line: int) -> Place:
    return Place(str(path), key=f"line {line}")
