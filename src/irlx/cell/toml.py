"""Bytes of a cell file -> TOML."""

from __future__ import annotations

import sys
from typing import Any

from irlx.cell.errors import CellError
from irlx.diagnostics import Place, report

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

_BYTE_ORDER_MARK = b"\xef\xbb\xbf"


def cell_toml(content: bytes, file: str) -> dict[str, Any]:
    """The table of a cell file named `file`. Raises CellError, IRL601, for what is not TOML."""
    try:
        # Editors that put a byte-order mark before UTF-8 do so with cells as they do with programs.
        table: dict[str, Any] = tomllib.loads(content.removeprefix(_BYTE_ORDER_MARK).decode("utf-8"))
    except UnicodeDecodeError as cause:
        message = f"byte {cause.start} is no UTF-8"
        raise CellError(report("IRL601", Place(file), cause=message)) from cause
    except (ValueError, RecursionError) as cause:
        # Besides its own errors tomllib lets those of Python through: too many digits, too deep lists.
        raise CellError(report("IRL601", Place(file), cause=str(cause))) from cause
    return table
