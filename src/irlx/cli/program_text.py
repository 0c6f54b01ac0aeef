"""What a program writes to STANDARD_OUT, on stdout while it runs."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable

from irlx.cli.output import encodable


class ProgramText:
    """Passes texts on to stdout at once; `first` is called before the first one.

    A reader that went away is no reason to end the run: the rest is dropped.
    """

    def __init__(self) -> None:
        # This very stream: who shows progress may put another one in its place for a while.
        self._stream = sys.stdout
        self._gone = False
        self._line_begun = False
        self.first: Callable[[], None] | None = None

    def write(self, text: str) -> int:
        """Pass a text on. Raises OSError where stdout cannot be written."""
        if self.first is not None:
            self.first()
            self.first = None
        if text and not self._gone:
            self._line_begun = not text.endswith("\n")
            try:
                self._stream.write(encodable(text, self._stream))
                self._stream.flush()
            except BrokenPipeError:
                self._gone = True
            except OSError:
                self._gone = True
                self._drop()
                raise
        return len(text)

    def _drop(self) -> None:
        """Let what cannot be written go: else Python tries again at its end, and speaks of it."""
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, self._stream.fileno())
        os.close(nowhere)

    def end_line(self) -> None:
        """Begin a new line, unless stdout is at the beginning of one."""
        if self._line_begun:
            self.write("\n")
