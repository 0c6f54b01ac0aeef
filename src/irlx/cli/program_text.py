"""What a program writes to STANDARD_OUT, on stdout while it runs, and what it reads from STANDARD_IN."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import IO

from irlx.cli.output import encodable
from irlx.cli.standard_channels import drop_output


class ProgramText:
    """Passes texts on to stdout at once; `first` is called before the first one, and before anything is read.

    A reader that went away is no reason to end the run: the rest is dropped.
    """

    def __init__(self) -> None:
        # This very stream: who shows progress may put another one in its place for a while.
        self._stream = sys.stdout
        self._gone = False
        self._line_begun = False
        self.first: Callable[[], None] | None = None

    def begin(self) -> None:
        """The program itself wants the terminal now."""
        if self.first is not None:
            self.first()
            self.first = None

    def write(self, text: str) -> int:
        """Pass a text on. Raises OSError where stdout cannot be written."""
        self.begin()
        if text and not self._gone:
            self._line_begun = not text.endswith("\n")
            try:
                self._stream.write(encodable(text, self._stream))
                self._stream.flush()
            except BrokenPipeError:
                self._gone = True
            except OSError:
                self._gone = True
                # Else Python tries again at its end, and speaks of it.
                drop_output(self._stream.fileno())
                raise
        return len(text)

    def end_line(self) -> None:
        """Begin a new line, unless stdout is at the beginning of one."""
        if self._line_begun:
            self.write("\n")


class TypedInput:
    """Standard input, a line at a time; whoever types it sees nothing else come and go."""

    def __init__(self, source: IO[bytes], text: ProgramText) -> None:
        self._source, self._text = source, text

    def readline(self, limit: int = -1) -> bytes:
        """The next line, b'' at the end. Raises OSError."""
        self._text.begin()
        return self._source.readline(limit)
