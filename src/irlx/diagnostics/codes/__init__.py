"""The catalogue of codes: severity, message and help of each; `docs/diagnostics/` has a page for each."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from irlx.diagnostics.codes.cell import CELL
from irlx.diagnostics.codes.clearance import CLEARANCE
from irlx.diagnostics.codes.code import Code, Severity
from irlx.diagnostics.codes.command import COMMAND
from irlx.diagnostics.codes.data_lists import DATA_LISTS
from irlx.diagnostics.codes.files import FILES
from irlx.diagnostics.codes.lints import LINTS
from irlx.diagnostics.codes.motion import MOTION
from irlx.diagnostics.codes.names import NAMES
from irlx.diagnostics.codes.pacing import PACING
from irlx.diagnostics.codes.redundancy import REDUNDANCY
from irlx.diagnostics.codes.robot_model import ROBOT_MODEL
from irlx.diagnostics.codes.run import RUN
from irlx.diagnostics.codes.static_types import STATIC_TYPES
from irlx.diagnostics.codes.stream import STREAM
from irlx.diagnostics.codes.syntax import SYNTAX
from irlx.diagnostics.codes.types import TYPES

CATALOGUE: Mapping[str, Code] = MappingProxyType(
    {
        code.id: code
        for group in (
            COMMAND,
            SYNTAX,
            NAMES,
            TYPES,
            STATIC_TYPES,
            LINTS,
            DATA_LISTS,
            REDUNDANCY,
            MOTION,
            PACING,
            CLEARANCE,
            RUN,
            FILES,
            CELL,
            ROBOT_MODEL,
            STREAM,
        )
        for code in group
    }
)

__all__ = ["CATALOGUE", "Code", "Severity"]
