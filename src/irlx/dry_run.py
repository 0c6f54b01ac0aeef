"""A dry run of the motion: what `irlx check --motion` finds, at a coarse tick and without a stream."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import ceil

from irlx.blocks import (
    AskAvoidingPosture,
    AskClearance,
    AskNearestPosture,
    AskPosture,
    Block,
    CyclicBlock,
    MoveBlock,
    Origin,
    Question,
    ReconfigureBlock,
)
from irlx.diagnostics import Diagnostic, IrlxError, Place, report
from irlx.job import Job
from irlx.pacing.beyond import needs_its_start
from irlx.pacing.cautions import Caution, near_singular, slowed
from irlx.pacing.errors import PacingError
from irlx.pacing.executed import Executed
from irlx.pacing.resolution import Resolution
from irlx.pacing.slowdown.grid import Spacing
from irlx.pipeline import Execution

ROW_TIME = 0.04
"""Time that a row of a dry run stands for at least, s, but of a tick that is long itself `LEAST_TICKS`."""

LEAST_TICKS = 5
SPACING = Spacing(6.0, 16)


def resolution_of(dt: float) -> Resolution:
    """How finely a dry run works out motions of ticks of `dt` s."""
    return Resolution(max(LEAST_TICKS, ceil(ROW_TIME / dt)), SPACING)


def dry_run(job: Job) -> list[Diagnostic]:
    """Findings on the motion of a job: errors that a run would end in, and cautions; raises none of them.

    A run ends at its first error; this goes on behind a move that cannot be done, from a posture at its
    target, so that more than one is found. Every finding is told once for each place, at its worst.
    """
    execution = _DryExecution(job, resolution_of(job.tick_ns / 1e9))
    try:
        for executed in execution:
            execution.consider(executed)
    except IrlxError as error:
        execution.tell(error.diagnostics)
    return execution.findings


class _DryExecution(Execution):
    """An execution that notes what it finds, and goes on behind moves that cannot be done."""

    def __init__(self, job: Job, resolution: Resolution) -> None:
        super().__init__(job, resolution)
        # A check writes no file.
        self.channels = job.channels.in_memory(None)
        self._errors: dict[tuple[str, Place | None], Diagnostic] = {}
        self._cautions: dict[tuple[str, Place], Caution] = {}
        self._failed: set[Origin] = set()
        self._lost: Place | None = None
        """The move since which nobody knows where the robot stands."""

    @property
    def findings(self) -> list[Diagnostic]:
        """Everything found so far."""
        cautions = [caution.finding for caution in self._cautions.values()]
        return list(dict.fromkeys([*self._errors.values(), *self.warnings, *cautions]))

    def tell(self, found: Sequence[Diagnostic]) -> None:
        """Note errors, each once for its place."""
        for one in found:
            self._errors.setdefault((one.code, one.place), one)

    def consider(self, executed: Executed) -> None:
        """Note what is to be said of a block that was carried out."""
        rows = executed.rows
        if rows is None or not isinstance(executed.block, MoveBlock):
            return
        place, robot = self._locate(executed.block.origin), self.kinematics
        found = (
            slowed(rows, robot, self.job.cell.limits, self.job.tick_ns / 1e9, place),
            near_singular(rows, robot, place),
        )
        for caution in found:
            if caution is None:
                continue
            key = (caution.finding.code, place)
            if key not in self._cautions or self._cautions[key].weight < caution.weight:
                self._cautions[key] = caution

    def _answer(self, question: Question) -> tuple[float, ...]:
        if self._lost is not None and self._needs_posture(question):
            raise self._end(question.origin)
        return super()._answer(question)

    def _needs_posture(self, question: Question) -> bool:
        """Whether an answer depends on where the robot stands, or on when it gets there."""
        if isinstance(question, AskClearance):
            return self.job.cell.scene.moves
        return isinstance(question, AskPosture | AskNearestPosture | AskAvoidingPosture)

    def _all(self, groups: Sequence[tuple[Block, ...]]) -> Iterator[Executed]:
        for group in groups:
            left: Sequence[Block] = group
            while left:
                if self._lost is not None or left[0].origin in self._failed:
                    self._pass_by(left[0])
                    left = left[1:]
                    continue
                done = 0
                try:
                    for executed in self._pacer.carry_out(left):
                        done += executed.begins
                        yield executed
                    left = ()
                except IrlxError as error:
                    failed = self._index_of_failed(left, done, error)
                    self._go_beyond(left[failed], error)
                    left = left[failed + 1 :]

    def _index_of_failed(self, group: Sequence[Block], done: int, error: IrlxError) -> int:
        """Which block of a group an error ended, `done` of them begun before it."""
        if done and isinstance(last := group[done - 1], MoveBlock) and last.path is not None:
            # A move along a PATH may have been done in part: up to a point where it stops.
            return done - 1 if error.reason.place == self._locate(last.origin) else done
        return done

    def _go_beyond(self, block: Block, error: IrlxError) -> None:
        """Note why a move cannot be done, and go on behind it. Raises the error of any other block."""
        if not isinstance(block, MoveBlock):
            raise error
        self.tell(error.diagnostics)
        self._failed.add(block.origin)
        self._stand_beyond(block)

    def _stand_beyond(self, move: MoveBlock) -> None:
        try:
            self._pacer.stand_beyond(move)
            self._lost = None
        except IrlxError:
            self._lost = self._locate(move.origin)

    def _pass_by(self, block: Block) -> None:
        """A block that has failed before, or comes while nobody knows where the robot stands.

        Of a move only the target counts then: where that can be reached, all that follows is looked at
        again. Raises PacingError, IRL447, where all that follows depends on the posture.
        """
        if not isinstance(block, MoveBlock):
            self._without_posture(block)
        elif self._lost is not None and needs_its_start(block):
            return
        elif block.origin in self._failed:
            self._stand_beyond(block)
        else:
            self._look_for_robot(block)

    def _look_for_robot(self, move: MoveBlock) -> None:
        """Know again where the robot stands: at the target of a move, or say why that is not reached."""
        self._stand_beyond(move)
        if self._lost is None:
            return
        try:
            for _ in self._pacer.carry_out([replace(move, blend=None)]):
                self._lost = None
        except IrlxError as error:
            self.tell(error.diagnostics)
            self._failed.add(move.origin)

    def _without_posture(self, block: Block) -> None:
        if isinstance(block, CyclicBlock) and block.active:
            raise self._end(block.origin)
        if not isinstance(block, ReconfigureBlock):
            for _ in self._pacer.carry_out([block]):
                pass

    def _end(self, origin: Origin) -> PacingError:
        line = self._lost.line if self._lost is not None else None
        return PacingError(report("IRL447", self._locate(origin), line=line))
