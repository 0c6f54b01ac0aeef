"""How a run comes on, for people at a terminal: one line on stderr that is gone in the end."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType

from rich.console import Console
from rich.live import Live
from rich.spinner import Spinner
from rich.text import Text

from irlx.blocks import Block, MoveBlock, Origin, ReconfigureBlock
from irlx.diagnostics import Place

_REFRESHES = 8
"""Refreshes of the line a second: planning goes on for seconds in which nothing is told."""

_PATIENCE = 1.0
"""Planning (s) from which on it is told how long it has taken."""

_PAUSE = 5.0
"""Time (s) between two lines where a terminal can only add lines."""


@dataclass(frozen=True)
class Course:
    """What progress is measured by: ticks of `dt` s, the `moves` to come, None where nobody knows their
    number; `locate` tells where in the text a block comes from."""

    dt: float
    moves: int | None
    locate: Callable[[Origin], Place]


class Progress:
    """What is being done, as words; a `Watch` of the pacer, and called with each block that is done.

    A context manager; here it shows nothing, see `LiveProgress` and `LineProgress`.
    """

    def __init__(self, course: Course) -> None:
        self._course = course
        self._began = time.monotonic()
        self._current = self._done = self._last = 0
        self._simulated = 0.0
        self._planning: float | None = None
        self._where = self._says = ""

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.silence()

    def silence(self) -> None:
        """Show nothing from now on: the program itself speaks, or all is done."""

    def says(self, words: str) -> None:
        """Something else than the program is being worked on now."""
        self._says = words
        self._changed()

    def begins(self, block: Block, tick: int) -> None:
        """A motion begins."""
        self._where, self._planning, self._says = self._line_of(block), None, ""
        self._simulated, self._current = tick * self._course.dt, self._done + 1
        self._changed()

    def ticked(self, tick: int) -> None:
        """A tick is being solved."""
        self._simulated, self._planning = tick * self._course.dt, None

    def plans(self) -> None:
        """The motion is being planned."""
        self._planning = time.monotonic()
        self._changed()

    def __call__(self, block: Block, simulated: float) -> None:
        """A block is done, or a part of it."""
        self._simulated, self._planning = simulated, None
        if isinstance(block, MoveBlock | ReconfigureBlock) and block.id != self._last:
            self._last = block.id
            self._done += 1

    @property
    def state(self) -> tuple[str, str, str]:
        """What is done and how fast; that it is being planned, or ''; the line of the program."""
        if self._says or not self._where:
            return self._says or "starting", "", ""
        moves = self._course.moves
        counted = f"move {self._current}" if moves is None else f"move {self._current} of {moves}"
        pace = self._simulated / max(time.monotonic() - self._began, 1e-9)
        done = f"{counted}  {self._simulated:.2f} s  {pace:.1f} x real time"
        return done, self._planned, self._where

    @property
    def _planned(self) -> str:
        if self._planning is None:
            return ""
        since = time.monotonic() - self._planning
        return f"planning {since:.0f} s" if since >= _PATIENCE else "planning"

    def _line_of(self, block: Block) -> str:
        place = self._course.locate(block.origin)
        if place.text is None or place.line is None:
            return f"line {block.origin.line}"
        words = " ".join(place.text.line_text(place.line).split())
        return f"line {place.line}: {''.join(filter(str.isprintable, words))}"

    def _changed(self) -> None:
        """Called where something new is to be told."""


class LiveProgress(Progress):
    """One line that is renewed in place, no wider than the terminal."""

    def __init__(self, course: Course) -> None:
        super().__init__(course)
        self._console = Console(stderr=True, highlight=False)
        narrow = self._console.options.ascii_only
        self._spinner = Spinner("line" if narrow else "dots")
        self._more = "..." if narrow else "\N{HORIZONTAL ELLIPSIS}"
        # What goes to stdout is not this line's business: it may go to a file.
        self._live = Live(
            get_renderable=self._line,
            console=self._console,
            refresh_per_second=_REFRESHES,
            transient=True,
            redirect_stdout=False,
        )

    def __enter__(self) -> LiveProgress:
        self._live.start()
        return self

    def silence(self) -> None:
        """Show nothing from now on."""
        self._live.stop()

    def _line(self) -> Text:
        done, planning, where = (self._shown(words) for words in self.state)
        frames = self._spinner.frames
        mark = frames[int(1e3 * time.monotonic() / self._spinner.interval) % len(frames)]
        parts: list[str | tuple[str, str]] = [(f"{mark} ", "green"), done]
        if planning:
            parts += ["  ", (planning, "yellow")]
        if where:
            parts += ["  ", (where, "dim")]
        line = Text.assemble(*parts, no_wrap=True)
        width = max(self._console.width - 1, 8)
        if line.cell_len > width:
            line.truncate(width - len(self._more))
            line.append(self._more)
        return line

    def _shown(self, words: str) -> str:
        encoding = self._console.encoding
        return words.encode(encoding, "replace").decode(encoding)


class LineProgress(Progress):
    """A line now and then, for terminals that can do no more (TERM=dumb)."""

    def __init__(self, course: Course) -> None:
        super().__init__(course)
        self._told = self._began
        self._silent = False

    def silence(self) -> None:
        """Show nothing from now on."""
        self._silent = True

    def ticked(self, tick: int) -> None:
        """A tick is being solved."""
        super().ticked(tick)
        self._changed()

    def _changed(self) -> None:
        if self._silent or time.monotonic() - self._told < _PAUSE:
            return
        self._told = time.monotonic()
        encoding = sys.stderr.encoding or "utf-8"
        words = "  ".join(filter(None, self.state))
        print(words.encode(encoding, "replace").decode(encoding), file=sys.stderr, flush=True)
