"""Live progress of a run on stderr, for people at a terminal."""

from __future__ import annotations

import time
from types import TracebackType

from rich.console import Console
from rich.status import Status

from irlx.blocks import Block


class LiveProgress:
    """Context manager that gives a callable (block, simulated seconds) and shows what it is told."""

    def __init__(self) -> None:
        self._status = Status("starting", console=Console(stderr=True))
        self._began = time.monotonic()
        self._silent = False

    def __enter__(self) -> LiveProgress:
        self._status.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._status.stop()

    def silence(self) -> None:
        """Show nothing from now on: the program itself speaks."""
        self._status.stop()
        self._silent = True

    def __call__(self, block: Block, simulated: float) -> None:
        """Show block, program line, simulated time and its ratio to real time."""
        if self._silent:
            return
        factor = simulated / max(time.monotonic() - self._began, 1e-9)
        place = f"block {block.id}  line {block.origin.line}"
        self._status.update(f"{place}  {simulated:.2f} s simulated  {factor:.1f} x real time")
