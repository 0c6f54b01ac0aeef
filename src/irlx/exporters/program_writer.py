"""What all writers of programs are: they take a stream as it comes, and refuse what cannot be played."""

from __future__ import annotations

import os
from abc import abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from irlx.diagnostics import Diagnostic, Place, report
from irlx.exporters.axes import Axes, axes_of
from irlx.exporters.number_lines import number_lines
from irlx.exporters.profile import LARGEST_VALUE, Profile
from irlx.streams.error import StreamError
from irlx.streams.joint_stream import BlockRecord, Floats, Integers, StreamHeader
from irlx.streams.text_writer import TextWriter

_LONGEST_COMMENT = 160


class ProgramWriter(TextWriter):
    """Writes one stream as a program of a target, which appears only when it is closed.

    Blocks are passed over. `incomplete` allows a stream that did not come to its end. `notes` are what
    whoever plays the program should know. Raises StreamError, the file being given up: IRL710 for a number
    of joints, IRL711 for slides, IRL712 for a tick and IRL713 for a gap that the target does not take, IRL714
    for a value that is none, IRL715 where the stream ends while it moves, IRL716 where it is not
    complete, IRL717 for no points or too many; and what `StreamWriter` raises.
    """

    profile: ClassVar[Profile]
    _indent: ClassVar[str] = ""
    """In front of the lines of the program's body."""

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader, incomplete: bool = False) -> None:
        self.axes = self._axes(Path(path), header)
        _check_tick(self.profile, Path(path), header)
        super().__init__(path, header)
        self.notes: tuple[Diagnostic, ...] = ()
        self.name = self._program_name()
        self._incomplete = incomplete
        self._points = 0
        self._last_rows = np.zeros((0, header.joints))
        self._last_step = 0
        self._put_lines(self._head())

    def samples(self, ticks: Integers, q: Floats, block: Integers, tool: Floats) -> None:
        """Take a batch of rows, as in `StreamWriter`, and refuse what the target cannot play."""
        if q.shape == (len(ticks), self.header.joints) and len(ticks):
            self._check_values(ticks, q)
            self._check_gaps(ticks)
            self._keep_last(ticks, q)
        super().samples(ticks, q, block, tool)

    def refuse(self, code: str, **data: str | int) -> StreamError:
        """The refusal of a code, the file being given up."""
        self.abort()
        return _refusal(self.profile, self.path, code, **data)

    @abstractmethod
    def _head(self) -> list[str]:
        """Lines before the first posture."""

    @abstractmethod
    def _tail(self) -> None:
        """Write what is still to be written of the postures."""

    def _put_block(self, record: BlockRecord) -> None:
        """Programs of controllers have the postures only."""

    def _put_end(self, complete: bool) -> None:
        if not complete and not self._incomplete:
            raise self.refuse("IRL716")
        if not self.rows:
            raise self.refuse("IRL717", wanted=self.profile.points_wanted, found="none")
        self._check_rest()
        self._tail()
        if self.profile.comment:
            state = "complete" if complete else "not complete: the run did not come to its end"
            told = self._comment(f"end of the stream: {self.rows} samples, {state}")
            self._put_lines([self._indent + told])
        self._put_lines(self._foot())

    def _foot(self) -> list[str]:
        """Lines that close the program."""
        return []

    def _put_lines(self, lines: list[str]) -> None:
        end = self.profile.line_end
        self._write("".join(line + end for line in lines).encode("ascii"))

    def _comment(self, text: str) -> str:
        """A comment of one line of ASCII characters, whatever the text holds."""
        plain = text.encode("ascii", "backslashreplace").decode()
        plain = "".join(c if c.isprintable() else " " for c in plain)
        if len(plain) > _LONGEST_COMMENT:
            plain = plain[: _LONGEST_COMMENT - 2] + ".."
        return f"{self.profile.comment} {plain}"

    def _provenance(self) -> list[str]:
        """Comments that say where a program comes from."""
        header = self.header
        told = [
            f"{self.profile.title} by irlx {header.irlx_version}: a joint stream with a tick of "
            f"{_milliseconds(header.tick_ns)} ms",
            f"program {header.program_name}",
            f"sha256 {header.program_sha256}",
            f"robot {header.robot_name}, tip {header.tip}, cell {header.cell_name or 'none'}",
        ]
        return [self._comment(text) for text in told]

    def _put_values(self, fronts: Sequence[str], q: Floats, tails: Sequence[bytes]) -> None:
        """Write a line for each row of `q`: `fronts` stand before its values, one of `tails` behind."""
        self._write(number_lines(fronts, self.axes.values(q), self.profile.digits, tails))

    def _count(self, points: int) -> None:
        """Count points of the program; raises IRL717 beyond the most."""
        self._points += points
        most = self.profile.most_points
        if most is not None and self._points > most:
            raise self.refuse("IRL717", wanted=self.profile.points_wanted, found="more")

    def _program_name(self) -> str:
        rule = self.profile.names
        if rule is None:
            return ""
        asked = self.path.stem
        name = rule.name_from(asked)
        if name != asked:
            place = Place(str(self.path))
            found = report("IRL718", place, target=self.profile.title, asked=asked, name=name)
            self.notes = (*self.notes, found)
        return name

    def _axes(self, path: Path, header: StreamHeader) -> Axes:
        """Axes of the stream; raises IRL710 and IRL711."""
        profile = self.profile
        axes = axes_of(header, profile.angle)
        slides = header.joints - axes.turning
        if slides and not profile.slides[1]:
            raise _refusal(profile, path, "IRL711", joint=axes.names[axes.turning])
        fits = (
            profile.turning[0] <= axes.turning <= profile.turning[1]
            and slides <= profile.slides[1]
            and 0 < header.joints <= profile.most_joints
        )
        if not fits:
            found = _counted(axes.turning, "turning joint")
            found += f" and {_counted(slides, 'slide')}" if slides else ""
            raise _refusal(profile, path, "IRL710", wanted=profile.joints_wanted, found=found)
        return axes

    def _check_values(self, ticks: Integers, q: Floats) -> None:
        scale = np.empty(len(self.axes.order))
        scale[list(self.axes.order)] = self.axes.scale
        # A comparison that is false for what is not a number, too.
        good = np.abs(q) <= LARGEST_VALUE / scale
        if not good.all():
            row, joint = (int(places[0]) for places in np.nonzero(~good))
            found = {"joint": self.header.joint_names[joint], "value": f"{q[row, joint]:g}"}
            unit = self.header.joint_units[joint]
            raise self.refuse("IRL714", **found, unit=unit, tick=int(ticks[row]))

    def _check_gaps(self, ticks: Integers) -> None:
        if not self.profile.every_tick:
            return
        before = np.concatenate(([self._last_tick], ticks[:-1]))
        gaps = ticks - before > 1
        if gaps.any():
            row = int(np.argmax(gaps))
            previous = int(before[row])
            first = previous < 0
            raise self.refuse("IRL713", tick=int(ticks[row]), previous="the beginning" if first else previous)

    def _keep_last(self, ticks: Integers, q: Floats) -> None:
        """Remember the last two rows, which say whether the stream ends at rest."""
        self._last_rows = np.concatenate((self._last_rows, q[-2:]))[-2:]
        self._last_step = int(ticks[-1]) - int(ticks[-2] if len(ticks) > 1 else self._last_tick)

    def _check_rest(self) -> None:
        if not self.profile.ends_at_rest or len(self._last_rows) < 2:
            return
        step = self._last_rows[1] - self._last_rows[0]
        if step.any():
            joint = int(np.argmax(np.abs(step)))
            speed = float(step[joint]) / (self._last_step * self.header.dt)
            unit = self.header.joint_units[joint]
            found = {"joint": self.header.joint_names[joint], "speed": f"{speed:.3g} {unit}/s"}
            raise self.refuse("IRL715", tick=self._last_tick, **found)


def _check_tick(profile: Profile, path: Path, header: StreamHeader) -> None:
    only, shortest = profile.tick_ns, profile.shortest_tick_ns
    if only is not None and header.tick_ns != only:
        wanted = f"of {_milliseconds(only)} ms and no other"
    elif shortest is not None and header.tick_ns < shortest:
        wanted = f"of {_milliseconds(shortest)} ms or more"
    else:
        return
    tick = _milliseconds(only or shortest or 0)
    found = _milliseconds(header.tick_ns)
    raise _refusal(profile, path, "IRL712", wanted=wanted, found=found, tick=tick)


def _refusal(profile: Profile, path: Path, code: str, **data: str | int) -> StreamError:
    words: dict[str, Any] = {"target": profile.title, **data}
    return StreamError(report(code, Place(str(path)), **words))


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def _milliseconds(ns: int) -> str:
    return f"{ns / 1e6:.12g}"
