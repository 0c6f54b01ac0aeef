"""What moves ask for, one after another: where each starts, where its targets lie, and which pass theirs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import inf, pi

import numpy as np

from irlx.blocks import (
    InputBlock,
    JointIncrement,
    JointTarget,
    MoveBlock,
    MoveKind,
    PoseIncrement,
    PoseTarget,
    SignalBlock,
    Target,
    ToleranceClause,
)
from irlx.promises import GOES_ON, JOINT_LINE, PATH_ORIENTATION, PATH_POSITION
from irlx.robot.description import COORDINATES, RobotDescription
from irlx.streams.joint_stream import Floats
from irlx.verifier.frames import FramesInForce
from irlx.verifier.geometry.allowance import EXACT, Allowance
from irlx.verifier.geometry.arcs import arc_shape
from irlx.verifier.geometry.forward import forward
from irlx.verifier.geometry.rotations import angle_between, from_quaternion
from irlx.verifier.geometry.task_turns import TURNS, TaskTurns, turned_off
from irlx.verifier.moves import MoveRows
from irlx.verifier.outline import Outline
from irlx.verifier.tools import Pose, ToolsInForce

BASE_FRAME, TOOL_FRAME = "R_BASE", "R_TOOL"
"""The frames of targets that the verifier can place, beside those that their blocks describe: the root of the
robot, and for shifts the tool."""


@dataclass(frozen=True, eq=False)
class Place:
    """Where something is or is to be: pose of the tool and posture (n,), None where not known."""

    pose: Pose | None
    posture: Floats | None = None


@dataclass(frozen=True, eq=False)
class Demand:
    """One move: where it starts, its targets (via point, points of a PATH, the last one), where it ends,
    and whether it passes that on its way to the next move, or comes from one that did. `crosses`: whether the
    one that it comes from, and the one that it leads into, is of the other kind: a PTP beside a move of the
    tool."""

    move: MoveRows
    start: Place
    targets: tuple[Place, ...]
    end: Place
    passes: bool
    follows: bool
    crosses: tuple[bool, bool] = (False, False)
    allowance: Allowance = EXACT

    @property
    def gives_orientation(self) -> bool:
        """Whether the last target gives an orientation of its own, and does not keep that of the start."""
        target = self.move.block.target
        return isinstance(target, JointTarget | JointIncrement) or target.orientation is not None


@dataclass(frozen=True, eq=False)
class Placer:
    """Finds the places of targets of a robot, with the tools in force; without a robot only postures.

    Poses are those that the frame of their block sees, that of a link or the world.
    """

    robot: RobotDescription | None
    tools: ToolsInForce
    frames: FramesInForce

    @cached_property
    def turns(self) -> TaskTurns | None:
        """Which turns of the tool count, None for all."""
        return None if self.robot is None else TaskTurns.of(self.robot)

    def attitude(self, rotation: Floats, q: Floats) -> Floats:
        """Attitude (1, ..) of a tool of a rotation (3, 3) in posture q (n,)."""
        return self.attitudes(rotation[None], q[None])

    def attitudes(self, rotations: Floats, q: Floats) -> Floats:
        """Attitudes (N, ..) of tools of rotations (N, 3, 3) in postures q (N, n)."""
        turns = self.turns
        return rotations if turns is None else turns.attitudes(rotations, turns.frames(q))

    def going_on(self, stands: Place, before: Demand, block: int) -> Place:
        """Where a block begins behind a move: where not all turns count with the orientation that was asked
        for there last, unless a PTP went to joint values, the tool is another one since, or bands have let
        it turn."""
        block_before = before.move.block
        joints = isinstance(block_before.target, JointTarget | JointIncrement)
        asked = None if joints and block_before.kind is MoveKind.PTP else before.end.pose
        same = self.tools.number(block) == self.tools.number(before.move.block.id)
        if self.turns is None or stands.pose is None or asked is None or not same or self.turned_by(before):
            return stands
        return Place((stands.pose[0], asked[1]), stands.posture)

    def turned_by(self, demand: Demand) -> bool:
        """Whether bands of a move leave turns open that the robot is asked for."""
        clause, robot = demand.move.block.tolerance, self.robot
        if clause is None or robot is None:
            return False
        turns = zip(TURNS, clause.bands[3:], strict=True)
        return any(band > 0.0 and name in robot.coordinates for name, band in turns)

    def of_posture(self, q: Floats, block: int) -> Pose | None:
        """Pose of the tool of a block in posture q (n,)."""
        return None if self.robot is None else self.of_tip(forward(self.robot, q[None]), q, block)

    def of_tip(self, tip: Pose, q: Floats, block: int) -> Pose:
        """The same of its pose in the world from that of the tip, (1, 3) and (1, 3, 3)."""
        placed = self.tools.placed(tip, np.array([self.tools.number(block)], dtype=np.int64))
        position, rotation = self.frames.seen_from(self.frames.of_block.get(block), placed, q[None])
        return position[0], rotation[0]

    def all_of(self, move: MoveRows, start: Place) -> tuple[Place, ...]:
        """Places of all targets of a move, counted from the one before, or of a CIRCLE from its start."""
        found: list[Place] = []
        for target in move.block.targets:
            counted = start if move.block.arc is not None or not found else found[-1]
            found.append(self.place(target, counted, move.block.id))
        return tuple(found)

    def end(self, move: MoveRows, start: Place, targets: tuple[Place, ...]) -> Place:
        """Place where a move ends: its last target, or of a CIRCLE by an angle the end of that way."""
        last, arc = targets[-1], move.block.arc
        via = targets[0].pose
        if arc is None or arc.angle is None or start.pose is None or via is None or last.pose is None:
            return last
        shape = arc_shape(start.pose[0], via[0], last.pose[0], arc.angle)
        return last if shape is None else Place((shape.end, last.pose[1]))

    def place(self, target: Target, start: Place, block: int) -> Place:
        """Place of a target of a block, counted from `start` where it is an increment or keeps something."""
        if isinstance(target, JointTarget):
            posture = np.array(target.values, dtype=np.float64)
            return Place(self.of_posture(posture, block), posture)
        if isinstance(target, JointIncrement):
            if start.posture is None:
                return Place(None)
            posture = start.posture + np.array(target.values)
            return Place(self.of_posture(posture, block), posture)
        frame = self.frames.of_block.get(block)
        return Place(_pose(target, start.pose, BASE_FRAME if frame is None else frame.name))


def _pose(target: PoseTarget | PoseIncrement, start: Pose | None, base: str) -> Pose | None:
    """Pose of a target in the frame `base` of its block."""
    position = np.array(target.position, dtype=np.float64)
    rotation = None
    if target.orientation is not None:
        quaternion = np.array(target.orientation)
        rotation = from_quaternion(quaternion / np.linalg.norm(quaternion))
    if isinstance(target, PoseTarget):
        kept = None if start is None else start[1]
        rotation = kept if rotation is None else rotation
        return None if target.frame != base or rotation is None else (position, rotation)
    if start is None:
        return None
    if rotation is not None:
        return start[0] + start[1] @ position, start[1] @ rotation
    if target.frame == TOOL_FRAME:
        return start[0] + start[1] @ position, start[1]
    return (start[0] + position, start[1]) if target.frame == base else None


def demands_of(outline: Outline, moves: list[MoveRows], placer: Placer) -> list[Demand]:
    """What every move asks for, in order.

    A move passes its target where it may - it has a blend, and what follows it, signals aside, is a move that
    can join it - and where the rows do: they do not stand at the target.
    """
    joinable, ends = _joinable(outline), _Ends(outline, placer)
    found: list[Demand] = []
    for move in moves:
        follows = bool(found) and found[-1].passes
        start = found[-1].end if follows else ends.place(move.start, move.block.id)
        if found and not follows:
            start = placer.going_on(start, found[-1], move.block.id)
        if found:
            start = _goes_on(found[-1], move, start, placer)
        targets = placer.all_of(move, start)
        end = placer.end(move, start, targets)
        passes = move.block.id in joinable and not _stands(outline, move, end, ends)
        allowance = allowance_of(move.block, placer.robot)
        found.append(Demand(move, start, targets, end, passes, follows, allowance=allowance))
    return _crossing(found)


def allowance_of(block: MoveBlock, robot: RobotDescription | None) -> Allowance:
    """How far the tool may stand off the pose that a move asks for.

    Coordinates that the robot's task leaves out have no band. Beside bands turns that nobody asks the robot
    for are bands without end: one of them, or all. Other turns that are left out turn the frame of the bands.
    """
    if block.tolerance is None:
        return EXACT
    bands, free = _bands(block.tolerance, robot, 0.0, 0.0), () if robot is None else robot.free
    if robot is not None and robot.task_frame is None and (len(free) != 2 or not _asks_turn(robot)):
        for name in free:
            bands[3 + TURNS.index(name)] = pi
    dx, dy, dz, da, db, dc = bands
    turns = zip(TURNS, bands[3:], strict=True)
    follows = robot is not None and any(name not in robot.coordinates and band < pi for name, band in turns)
    return Allowance((dx, dy, dz, da, db, dc), follows)


def _bands(clause: ToleranceClause, robot: RobotDescription | None, shift: float, turn: float) -> list[float]:
    """The six bands, those of coordinates that the robot's task leaves out being `shift` and `turn`."""
    left = [turn if name in TURNS else shift for name in COORDINATES]
    asked = COORDINATES if robot is None else robot.coordinates
    bands = zip(COORDINATES, clause.bands, left, strict=True)
    return [band if name in asked else other for name, band, other in bands]


def _asks_turn(robot: RobotDescription) -> bool:
    return any(name in robot.coordinates for name in TURNS)


def _goes_on(before: Demand, move: MoveRows, start: Place, placer: Placer) -> Place:
    """Where the path of a move starts: WITH TOLERANCE where that of the move before WITH TOLERANCE ended,
    with the same tool and if that stands within the bands about it, else where the tool is."""
    clause, end, here = move.block.tolerance, before.end.pose, start.pose
    tools = placer.tools
    if clause is None or before.move.block.tolerance is None or end is None or here is None:
        return start
    if tools.number(before.move.block.id) != tools.number(move.block.id):
        return start
    # Where the tool stands in what nobody asks for tells nothing.
    dx, dy, dz, da, db, dc = _bands(clause, placer.robot, inf, pi)
    return Place(end, start.posture) if _within(Allowance((dx, dy, dz, da, db, dc)), end, here) else start


def _within(allowance: Allowance, asked: Pose, reached: Pose) -> bool:
    """Whether a pose is as far off another one as it may be, to rounding."""
    left = allowance.shifted_off((asked[1].T @ (reached[0] - asked[0]))[None])
    near = float(np.linalg.norm(left)) <= GOES_ON
    return near and float(allowance.turned_off(reached[1][None], asked[1][None])[0]) <= GOES_ON


def _crossing(demands: list[Demand]) -> list[Demand]:
    """The demands, told which of them run from or into moves of the other kind."""
    ptp = [demand.move.block.kind is MoveKind.PTP for demand in demands]
    changes = [False, *(one is not other for one, other in pairwise(ptp)), False]
    return [
        replace(demand, crosses=(demand.follows and changes[k], demand.passes and changes[k + 1]))
        for k, demand in enumerate(demands)
    ]


class _Ends:
    """Places where blocks end, their poses computed all at once."""

    def __init__(self, outline: Outline, placer: Placer) -> None:
        self._outline, self.placer = outline, placer
        self._tips = None if placer.robot is None else forward(placer.robot, outline.ends)

    def place(self, row: int, block: int) -> Place:
        """Place in a row in which a block ends, with the tool and the frame of another one."""
        stretch = int(np.searchsorted(self._outline.lasts, row))
        posture = self._outline.ends[stretch]
        if self._tips is None:
            return Place(None, posture)
        tip = self._tips[0][stretch : stretch + 1], self._tips[1][stretch : stretch + 1]
        return Place(self.placer.of_tip(tip, posture, block), posture)


def _stands(outline: Outline, move: MoveRows, target: Place, ends: _Ends) -> bool:
    """Whether a move ends at rest at its target; where that is not known, whether it ends at rest."""
    if not outline.stands(move.last):
        return False
    reached = ends.place(move.last, move.block.id)
    if target.posture is not None and reached.posture is not None and move.block.kind is MoveKind.PTP:
        return bool((np.abs(reached.posture - target.posture) <= JOINT_LINE).all())
    pose = reached.pose
    if pose is None or target.pose is None:
        return True
    near = float(np.linalg.norm(pose[0] - target.pose[0])) <= PATH_POSITION
    if reached.posture is None:
        return near and float(angle_between(pose[1], target.pose[1])) <= PATH_ORIENTATION
    attitude = ends.placer.attitude(pose[1], reached.posture)
    return near and float(turned_off(attitude, target.pose[1])[0]) <= PATH_ORIENTATION


def _joinable(outline: Outline) -> frozenset[int]:
    """Ids of moves that may pass their target. Between a PTP and a move of the tool that is not so where
    joint increments count from a posture that is not reached, where TIME counts from stop to stop, or where
    the tool is led in a frame that moves; nowhere between two frames."""
    moves = [
        record.block for record in outline.records if not isinstance(record.block, SignalBlock | InputBlock)
    ]
    found = set()
    for block, following in pairwise(moves):
        if not isinstance(block, MoveBlock) or not isinstance(following, MoveBlock) or block.blend is None:
            continue
        if block.frame != following.frame:
            continue
        if block.tolerance is not None or following.tolerance is not None:
            continue
        alike = (block.kind is MoveKind.PTP) is (following.kind is MoveKind.PTP)
        if alike or not any(_needs_stop(move) for move in (block, following)):
            found.add(block.id)
    return frozenset(found)


def _needs_stop(move: MoveBlock) -> bool:
    counts_stops = isinstance(move.target, JointIncrement) or move.law.duration is not None
    return counts_stops or move.frame is not None
