"""Where expressions and statements stand: their text, what names mean there, and what their steps go to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from irlx.diagnostics import SourceText
from irlx.interpreter.channels.channels import Channels
from irlx.interpreter.code import Assembler
from irlx.interpreter.machine import Machine
from irlx.interpreter.scope import Scope
from irlx.interpreter.setting import Setting
from irlx.interpreter.values import Value


@dataclass(frozen=True)
class Context:
    """One body that is being compiled; without an `assembler` a constant or a bound.

    `rest` gives, by the name of a record type, values of the last fields that its constructor may leave out.
    """

    source: SourceText
    scope: Scope
    setting: Setting
    machine: Machine
    assembler: Assembler | None = None
    rest: Mapping[str, tuple[Value, ...]] = field(default_factory=dict)
    channels: Channels = field(default_factory=Channels)

    def mark(self) -> tuple[int, int]:
        """What `undo` needs to forget the steps that are added from here on."""
        return (0, 0) if self.assembler is None else self.assembler.mark

    def undo(self, mark: tuple[int, int]) -> None:
        """Forget the steps added since `mark`."""
        if self.assembler is not None:
            self.assembler.undo(mark)
