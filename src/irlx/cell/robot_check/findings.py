"""Where findings on a URDF go."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import sqrt
from typing import Any

from irlx.diagnostics import Diagnostic, Place, report
from irlx.solids.placement import Vector3


@dataclass(frozen=True)
class ModelFindings:
    """Findings on the URDF `file`, in the order in which they are told."""

    file: str
    found: list[Diagnostic] = field(default_factory=list)

    def tell(self, code: str, key: str = "", **data: Any) -> None:
        """Add a finding at a key such as ``joint 'elbow'``, at the file as a whole without one."""
        self.found.append(report(code, Place(self.file, key=key), **data))


def length_of(vector: Vector3) -> float:
    """Length of a vector, m."""
    return sqrt(sum(part * part for part in vector))


def joint_key(name: str) -> str:
    """How places name a joint."""
    return f"joint '{name}'"


def link_key(name: str) -> str:
    """How places name a link."""
    return f"link '{name}'"
