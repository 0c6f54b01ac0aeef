"""A dry run of the motion: what `irlx check --motion` finds, at a coarse tick and without a stream."""

from __future__ import annotations

from collections import Counter
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
from irlx.language.words import count
from irlx.pacing.beyond import needs_its_start
from irlx.pacing.cautions import Caution, near_singular, slowed
from irlx.pacing.errors import PacingError
from irlx.pacing.executed import Executed
from irlx.pacing.resolution import Resolution
from irlx.pacing.slowdown.grid import Spacing
from irlx.pipeline import Execution

ROW_TIME = 0.04
"""Time that a row of a dry run stands for at least, s, but of a tick that is long itself `LEAST_TICKS`."""

MOST_FAILURES = 24
"""So often a line is tried again that fails, in a loop or a procedure: to say why takes time."""

MOST_TARGETS = 8
"""So many targets are listed of a line that fails more than once."""

LEAST_TICKS = 5
SPACING = Spacing(6.0, 16)


def resolution_of(dt: float) -> Resolution:
    """How finely a dry run works out motions of ticks of `dt` s."""
    return Resolution(max(LEAST_TICKS, ceil(ROW_TIME / dt)), SPACING)


def dry_run(job: Job) -> list[Diagnostic]:
    """Findings on the motion of a job: errors that a run would end in, and cautions; raises none of them.

    A run ends at its first error; this goes on behind a move that cannot be done, from a posture at its
    target, so that more than one is found. Every finding is told once for each place: cautions at their
    worst, errors as they come first, with how many more there are.
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
        self._more: dict[tuple[str, Place | None], list[str]] = {}
        """Targets of the same errors at the same place that came later, '' where they do not tell theirs."""
        self._failures: Counter[Origin] = Counter()
        self._lost: Place | None = None
        """The move since which nobody knows where the robot stands."""

    @property
    def findings(self) -> list[Diagnostic]:
        """Everything found so far."""
        cautions = [caution.finding for caution in self._cautions.values()]
        errors = [_with_more(one, self._more.get(key, [])) for key, one in self._errors.items()]
        return list(dict.fromkeys([*errors, *self.warnings, *cautions]))

    def tell(self, found: Sequence[Diagnostic]) -> None:
        """Note errors, each once for its place, and how many came there later."""
        for key, one in {(one.code, one.place): one for one in reversed(found)}.items():
            if key in self._errors:
                self._more.setdefault(key, []).append(str(one.data.get("target", "")))
            self._errors.setdefault(key, one)

    def _is_hopeless(self, origin: Origin) -> bool:
        """Whether a line has failed so often that it is not tried again."""
        return self._failures[origin] >= MOST_FAILURES

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
                if self._lost is not None or self._is_hopeless(left[0].origin):
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
                    self._called.tell(error, left[failed : failed + 1], self._locate)
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
        self._failures[block.origin] += 1
        self._stand_beyond(block)

    def _stand_beyond(self, move: MoveBlock) -> None:
        try:
            self._pacer.stand_beyond(move)
            self._lost = None
        except IrlxError:
            self._lost = self._locate(move.origin)

    def _pass_by(self, block: Block) -> None:
        """A block that has failed too often, or comes while nobody knows where the robot stands.

        Of a move only the target counts then: where that can be reached, all that follows is looked at
        again. Raises PacingError, IRL447, where all that follows depends on the posture.
        """
        if not isinstance(block, MoveBlock):
            self._without_posture(block)
        elif self._lost is not None and needs_its_start(block):
            return
        elif self._is_hopeless(block.origin):
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
            self._called.tell(error, [move], self._locate)
            self.tell(error.diagnostics)
            self._failures[move.origin] += 1

    def _without_posture(self, block: Block) -> None:
        if isinstance(block, CyclicBlock) and block.active:
            raise self._end(block.origin)
        if not isinstance(block, ReconfigureBlock):
            for _ in self._pacer.carry_out([block]):
                pass

    def _end(self, origin: Origin) -> PacingError:
        line = self._lost.line if self._lost is not None else None
        return PacingError(report("IRL447", self._locate(origin), line=line))


def _with_more(found: Diagnostic, targets: Sequence[str]) -> Diagnostic:
    """An error with what is to be said of the same one at the same place later on."""
    if not targets:
        return found
    known = list(dict.fromkeys(target for target in targets if target))
    others = len(known) - MOST_TARGETS
    listed = ", ".join(known[:MOST_TARGETS]) + (f" and {count(others, 'other')}" if others > 0 else "")
    times = "once more" if len(targets) == 1 else f"{len(targets)} more times"
    if len(targets) + 1 >= MOST_FAILURES:
        times = f"{len(targets)} more times at least"
    words = f"; so it is {times}{', for ' + listed if listed else ''}"
    return replace(found, message=found.message + words)
