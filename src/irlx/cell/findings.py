"""Where the findings on one table of a cell file go."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from irlx.diagnostics import Diagnostic, Place, report


@dataclass(frozen=True)
class Findings:
    """Findings on the table `table` of the cell `file`, such as ``obstacle[2]``, by the key they are at."""

    file: str
    table: str
    errors: list[Diagnostic]
    warnings: list[Diagnostic] = field(default_factory=list)

    def error(self, code: str, key: str = "", **data: object) -> None:
        """Add an error at a key of the table, at the table itself without one."""
        self.errors.append(self._report(code, key, data))

    def warning(self, code: str, key: str = "", **data: object) -> None:
        """Add a warning at a key of the table."""
        self.warnings.append(self._report(code, key, data))

    def _report(self, code: str, key: str, data: dict[str, Any]) -> Diagnostic:
        where = f"{self.table}.{key}" if key else self.table
        return report(code, Place(self.file, key=where), **({"key": where} | data))
