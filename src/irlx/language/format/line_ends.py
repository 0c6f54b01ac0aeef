"""Rows to text: comments behind lines stay aligned where the text had them aligned."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from irlx.language.format.document import Remark
from irlx.language.format.render import WIDTH, Row, shifted

__all__ = ["text_of"]

_GAP = 2
_NEAR = 5
"""Rows further apart than this are not aligned with each other, whatever the text does."""


def text_of(rows: Sequence[Row]) -> str:
    """The text of all rows, with one line end behind each."""
    lines: list[str] = []
    for paragraph in _paragraphs(rows):
        columns = _columns(paragraph)
        for index, row in enumerate(paragraph):
            lines.append(_line(row, columns.get(index, 0)))
    return "\n".join(lines).strip("\n") + "\n"


def _paragraphs(rows: Sequence[Row]) -> Iterator[list[Row]]:
    """Rows up to and with each empty one."""
    paragraph: list[Row] = []
    for row in rows:
        paragraph.append(row)
        if not row.code and not row.remarks:
            yield paragraph
            paragraph = []
    yield paragraph


def _columns(paragraph: Sequence[Row]) -> dict[int, int]:
    """Column of the comments behind each row that has some."""
    columns: dict[int, int] = {}
    for together in _aligned(paragraph):
        widths = {index: len(paragraph[index].code) for index in together}
        columns.update({index: width + _GAP for index, width in widths.items()})
        while widths:
            column = max(widths.values()) + _GAP
            if not any(_is_pushed_out(paragraph[index], column) for index in widths):
                columns.update(dict.fromkeys(widths, column))
                break
            # The longest line pushes comments beyond the margin: it stands apart.
            widths = {index: width for index, width in widths.items() if width + _GAP < column}
    return columns


def _aligned(paragraph: Sequence[Row]) -> list[list[int]]:
    """Rows near each other whose comments begin at one column of the text."""
    runs: dict[int, list[list[int]]] = {}
    for index, row in enumerate(paragraph):
        if row.remarks:
            of_column = runs.setdefault(row.remarks[0].column, [])
            if of_column and index - of_column[-1][-1] <= _NEAR:
                of_column[-1].append(index)
            else:
                of_column.append([index])
    return [run for of_column in runs.values() for run in of_column]


def _is_pushed_out(row: Row, column: int) -> bool:
    width = len(_joined(row.remarks).split("\n")[0])
    return column + width > WIDTH >= len(row.code) + _GAP + width


def _joined(remarks: Sequence[Remark]) -> str:
    return " ".join(remark.text for remark in remarks)


def _line(row: Row, column: int) -> str:
    if not row.remarks:
        return row.code
    remark = Remark(_joined(row.remarks), row.remarks[0].column, "end")
    return f"{row.code:<{column}}{shifted(remark, column)}"
