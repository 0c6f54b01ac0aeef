"""A finished run: what `irlx.run` returns."""

from __future__ import annotations

import os
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import Diagnostic, IrlxError
from irlx.pacing.explanation import TickExplanation
from irlx.report.clearances import Clearances, clearances
from irlx.report.events import LimitActive, Slowed
from irlx.report.signals import Signal, signals_of
from irlx.report.summary import Summary
from irlx.streams.formats import write_stream
from irlx.streams.joint_stream import JointStream

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Run:
    """The joint stream of one execution with its events, summary and warnings.

    Arrays of N samples and n joints: `t` (N,) s; `q`, `qd`, `qdd` (N, n) rad | m and per s, s2, the
    rates being backward differences of the emitted q, from rest before tick 0; `tool` (N, 7) x y z in
    m and unit quaternion x y z w of the tool frame in the world; `block` (N,) id of the move.
    `explanation` is that of the tick asked for with `explain_tick`, None where no motion has it;
    `output` what the program wrote to STANDARD_OUT; `clearances` what came nearest in each sample.
    """

    stream: JointStream
    events: tuple[LimitActive | Slowed, ...]
    summary: Summary
    diagnostics: tuple[Diagnostic, ...]
    explanation: TickExplanation | None = None
    output: str = ""
    clearances: Clearances = field(default_factory=lambda: clearances(()))

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

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints in the order of the columns."""
        return self.stream.header.joint_names

    @property
    def complete(self) -> bool:
        """Whether the program came to its end."""
        return self.stream.complete

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the stream in the format of the path's ending: .irdata, .npz, .jsonl or .csv.

        The file appears whole or not at all. Raises StreamError: IRL003 not writable, IRL004 unknown ending.
        """
        write_stream(self.stream, path)


class RunError(IrlxError):
    """A run that ended in an error; `run` holds what was executed until then, marked incomplete."""

    def __init__(self, diagnostics: tuple[Diagnostic, ...], run: Run) -> None:
        super().__init__(diagnostics)
        self.run = run


class RunInterrupted(KeyboardInterrupt):
    """The user stopped the run; `run` holds what was executed until then, marked incomplete."""

    def __init__(self, run: Run) -> None:
        super().__init__("interrupted")
        self.run = run
