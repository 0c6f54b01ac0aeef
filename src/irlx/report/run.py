"""A finished run: what `irlx.run` returns."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import Diagnostic, IrlxError
from irlx.report.clearances import Clearances, clearances
from irlx.report.message import Message
from irlx.report.outcome import Outcome
from irlx.report.replay.names import is_page
from irlx.report.replay.source import ReplaySource
from irlx.report.signals import Signal, signals_of
from irlx.robot.limits import JointLimits
from irlx.streams.formats import write_stream
from irlx.streams.joint_stream import JointStream

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Run(Outcome):
    """The joint stream of one execution with its events, summary and warnings.

    Arrays of N samples and n joints: `t` (N,) s; `q`, `qd`, `qdd` (N, n) rad | m and per s, s2, the
    rates being backward differences of the emitted q, from rest before tick 0; `tool` (N, 7) x y z in
    m and unit quaternion x y z w of the tool frame in the world; `block` (N,) id of the move.
    `clearances` is what came nearest in each sample; `limits` are those of the joints, each with the tick
    from which on it is in force; `messages` what was written to STANDARD_OUT, each with its tick and line;
    `source` what a replay page shows beside all this. See `Outcome` for what else there is.
    """

    stream: JointStream
    clearances: Clearances = field(default_factory=lambda: clearances(()))
    limits: tuple[tuple[int, JointLimits], ...] = ()
    messages: tuple[Message, ...] = ()
    source: ReplaySource | None = field(default=None, repr=False)

    @property
    def t(self) -> Array:
        """Time of each sample, s."""
        return self.stream.t

    @property
    def q(self) -> Array:
        """Joint values, rad or m."""
        return self.stream.q

    @property
    def qd(self) -> Array:
        """Backward differences of q, per s."""
        return self.stream.qd

    @property
    def qdd(self) -> Array:
        """Backward differences of qd, per s2."""
        return self.stream.qdd

    @property
    def tool(self) -> Array:
        """Pose of the tool frame in the world."""
        return self.stream.tool

    @property
    def block(self) -> NDArray[np.int64]:
        """Id of the move block in execution, 0 before the first."""
        return self.stream.block

    @property
    def signals(self) -> tuple[Signal, ...]:
        """Outputs set and inputs read, in the order of time."""
        return signals_of(self.stream.records, self.stream.dt)

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        """What IPython shows where it shows text: the summary."""
        printer.text(repr(self) if cycle else str(self))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the stream in the format of the ending: .irdata, .npz, .jsonl, .csv, .parquet, .rosbag.

        With the ending .html it is a page that replays the run: robot, program and curves in one file.
        The file, or the folder of a .rosbag, appears whole or not at all. Raises StreamError: IRL003 not
        writable, IRL004 unknown ending, IRL720 an extra is missing, IRL722 a page of a run without `source`.
        """
        if is_page(path):
            from irlx.report.replay.writing import write_page

            write_page(self, Path(path))
        else:
            write_stream(self.stream, path)

    def _repr_html_(self) -> str:
        """What a notebook shows: the summary, and a small replay."""
        from irlx.report.replay.writing import notebook_html

        return notebook_html(self)


class RunError(IrlxError):
    """A run that ended in an error; `run` holds what was executed until then, marked incomplete.

    That is a `Run` where `irlx.run` raises, the `Outcome` where `irlx.record` does. Where nothing went wrong
    but that a file could not be ended, that is complete.
    """

    def __init__(self, diagnostics: tuple[Diagnostic, ...], run: Outcome) -> None:
        super().__init__(diagnostics)
        self.run = run


class RunInterrupted(KeyboardInterrupt):
    """The user stopped the run; `run` holds what was executed until then, as that of `RunError`."""

    def __init__(self, run: Outcome) -> None:
        super().__init__("interrupted")
        self.run = run
