"""Look-ahead: which moves are carried out together, because they pass their targets instead of stopping."""

from __future__ import annotations

from collections.abc import Callable

from irlx.blocks import (
    AskClearance,
    AskInput,
    AskInputChange,
    AskManipulability,
    AskPause,
    AskPose,
    AskStandstill,
    Block,
    JointIncrement,
    JointTarget,
    MoveBlock,
    MoveKind,
    Origin,
    Question,
    SignalBlock,
)
from irlx.diagnostics import Place
from irlx.motion.plan_chain import lost_blend
from irlx.pacing.notes import Notes

WINDOW = 200
"""Most moves that are joined: a bound on memory, and on how long nothing of a stream comes."""


class Lookahead:
    """Gathers blocks of a program that runs ahead of the robot.

    A group is what `take` and `stop` give back: one block of any kind, or moves that may pass their targets,
    with the signals between them; only after the last one the robot surely stands. Blends that a group cannot
    have because of what comes behind it are noted. While `obstacles_move`, distances from them depend on the
    time, so that questions for them stop the robot.
    """

    def __init__(
        self, locate: Callable[[Origin], Place], notes: Notes, *, obstacles_move: bool = False
    ) -> None:
        self._locate = locate
        self._notes = notes
        self._obstacles_move = obstacles_move
        self._waiting: list[Block] = []
        self._moves = 0

    def take(self, block: Block) -> list[tuple[Block, ...]]:
        """Groups that are complete now that `block` is known."""
        if isinstance(block, SignalBlock) and self._waiting:
            self._waiting.append(block)
            return []
        if not isinstance(block, MoveBlock):
            return [*self.stop(block.origin, _STANDS), (block,)]
        groups = []
        if self._waiting:
            apart = _apart(self._last_move, block) or (_TOO_MANY if self._moves >= WINDOW else "")
            groups = self.stop(block.origin, apart) if apart else []
        self._waiting.append(block)
        self._moves += 1
        return groups if block.blend is not None else [*groups, *self._group()]

    def before(self, question: Question) -> list[tuple[Block, ...]]:
        """Groups to carry out before a question is answered: none where its answer is the same anywhere."""
        if isinstance(question, AskPose | AskManipulability):
            return []
        if isinstance(question, AskClearance):
            why = "the answer depends on where the obstacles are by then"
            return self.stop(question.origin, why) if self._obstacles_move else []
        if isinstance(question, AskStandstill):
            return self.stop(question.origin, "what comes next waits until the moves are done")
        if isinstance(question, AskPause):
            return self.stop(question.origin, _STANDS)
        if isinstance(question, AskInput | AskInputChange):
            return self.stop(question.origin, "an input is read at its moment, with the robot at rest")
        return self.stop(question.origin, "the answer depends on where the robot stands")

    def stop(self, where: Origin | None, why: str) -> list[tuple[Block, ...]]:
        """The group that waits for moves which do not come: at `where` something stops it; None: the end."""
        if self._waiting:
            self._note(self._last_move, where, why)
        return self._group()

    @property
    def _last_move(self) -> MoveBlock:
        return next(block for block in reversed(self._waiting) if isinstance(block, MoveBlock))

    def _group(self) -> list[tuple[Block, ...]]:
        group, self._waiting, self._moves = tuple(self._waiting), [], 0
        return [group] if group else []

    def _note(self, move: MoveBlock, where: Origin | None, why: str) -> None:
        stopping = None if where is None else self._locate(where)
        self._notes.add(lost_blend(self._locate(move.origin), why, stopping, what="this stops it"))


_STANDS = "the robot has to stand there"
_TOO_MANY = f"at most {WINDOW} moves are joined"


def _apart(first: MoveBlock, second: MoveBlock) -> str:
    """Why two moves cannot be joined whatever their geometry, or ''."""
    if first.frame != second.frame:
        return "the two moves lead the tool in different frames"
    for move in (first, second):
        if move.limits or move.criteria or move.tolerance is not None:
            return "a WITH clause holds for one of the two moves alone"
        if move.kind is MoveKind.PTP:
            continue
        if _draws(move):
            return "one of the two moves is to end in a posture"
    if (first.kind is MoveKind.PTP) is (second.kind is MoveKind.PTP):
        return ""
    return _apart_in_kind(first, second)


def _apart_in_kind(first: MoveBlock, second: MoveBlock) -> str:
    """Why a move of the joints and one along a path cannot be joined, or ''."""
    for move in (first, second):
        if move.frame is not None:
            return "beside a PTP a move in a frame that moves with a link starts and ends at rest"
        if isinstance(move.target, JointIncrement):
            return "joint increments count from the posture in which the move before has ended"
        if move.law.duration is not None:
            return "beside a move of the other kind TIME counts from stop to stop"
    return ""


def _draws(move: MoveBlock) -> bool:
    """Whether a move along a path asks for postures."""
    postures = any(isinstance(target, JointTarget | JointIncrement) for target in move.targets)
    return postures or move.reconfiguration is not None
