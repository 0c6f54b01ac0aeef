"""Running the program again, beside the page."""

from __future__ import annotations

import threading
from collections.abc import Callable

from irlx.blocks import Block
from irlx.cell.cell import Cell
from irlx.diagnostics import Diagnostic, IrlxError, report
from irlx.viewer.shown import Shown

Progress = Callable[[Block, float], None]
Again = Callable[[Cell, Progress], Shown]
"""Runs the program in a cell; raises IrlxError with why it cannot."""


class _Given(BaseException):
    """Ends a run that nobody waits for; no Exception, which would be told as a fault of irlx."""


class Rerun:
    """At most one run at a time, in a thread of its own.

    `going` is called with line and time (s) as it goes on, at its end either
    `done` with what is to be shown or `failed` with the diagnostics.
    """

    def __init__(
        self,
        again: Again,
        going: Callable[[int, float], None],
        done: Callable[[Shown], None],
        failed: Callable[[tuple[Diagnostic, ...]], None],
    ) -> None:
        self._again, self._going, self._done, self._failed = again, going, done, failed
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._given_up = False

    @property
    def runs(self) -> bool:
        """Whether a run is going on."""
        return self._thread is not None and self._thread.is_alive()

    def start(self, cell: Callable[[], Cell]) -> bool:
        """Begin a run in a cell; False where one is going on."""
        with self._lock:
            if self.runs or self._given_up:
                return False
            self._thread = threading.Thread(
                target=self._run, args=(cell,), name="irlx view: run again", daemon=True
            )
            self._thread.start()
            return True

    def wait(self, timeout: float | None = None) -> None:
        """Wait until the run that goes on has ended, at most so long, s."""
        if self._thread is not None:
            self._thread.join(timeout)

    def stop(self, timeout: float = 5.0) -> None:
        """End a run that goes on at its next block."""
        self._given_up = True
        self.wait(timeout)

    def _run(self, cell: Callable[[], Cell]) -> None:
        try:
            self._done(self._again(cell(), self._progress))
        except IrlxError as error:
            self._failed(error.diagnostics)
        except _Given:
            pass
        except Exception as error:
            # A fault of irlx must not take the page with it.
            self._failed((report("IRL090", cause=f"{type(error).__name__}: {error}"),))

    def _progress(self, block: Block, seconds: float) -> None:
        if self._given_up:
            raise _Given
        self._going(block.origin.line, seconds)
