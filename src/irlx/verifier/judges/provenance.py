"""Checks of what a stream says of its robot, and of the times, rates and poses that it states itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from irlx.promises import TOOL_ORIENTATION, TOOL_POSITION, rounding_allowance
from irlx.robot.description import RobotDescription
from irlx.robot.limits import JointLimits
from irlx.robot.relation import Relation
from irlx.scene.scene import Scene
from irlx.streams.joint_stream import Floats, StreamHeader
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import FAILED, NOT_CHECKED, OK, Check
from irlx.verifier.geometry.rotations import angle_between, from_quaternion
from irlx.verifier.rows import Rows, Stretch
from irlx.verifier.tools import Pose


@dataclass(frozen=True)
class Reference:
    """What a stream is judged by: a robot, and of its cell the robot's own limits and the start posture (n,),
    rad or m; None where no cell is given. `relations` between the joints hold in that cell; `scene` is what
    stands around its robot, None where that is not known."""

    robot: RobotDescription
    limits: JointLimits | None = None
    start: Floats | None = None
    relations: tuple[Relation, ...] = ()
    scene: Scene | None = None


def check_robot(header: StreamHeader, reference: Reference | None) -> Check:
    """The stream was made for this robot: same joints, units, tool frame, geometry."""
    if reference is None:
        return Check("robot", NOT_CHECKED, detail="no robot is known")
    robot = reference.robot
    units = tuple("m" if joint.is_prismatic else "rad" for joint in robot.axes)
    for what, found, due in (
        ("joints", ", ".join(header.joint_names), ", ".join(robot.joint_names)),
        ("units", ", ".join(header.joint_units), ", ".join(units)),
        ("tool frame", header.tip, robot.tip),
        ("fingerprint", header.robot_fingerprint, robot.fingerprint),
    ):
        if found != due:
            return Check("robot", FAILED, detail=f"{what} in the stream: {found}; of the robot: {due}")
    return Check("robot", OK)


def check_robot_limits(header: StreamHeader, reference: Reference | None, other_robot: bool) -> Check:
    """The limits that the stream gives as the robot's own are those of the cell, which has that robot."""
    if other_robot:
        return Check("robot limits", NOT_CHECKED, detail="the check 'robot' failed")
    if reference is None or reference.limits is None:
        return Check("robot limits", NOT_CHECKED, detail="no cell is given")
    for kind in ("position", "speed", "acceleration"):
        sides = zip(header.limits.pair(kind), reference.limits.pair(kind), ("least", "greatest"), strict=True)
        for found, due, side in sides:
            other = np.flatnonzero(found != due)
            if other.size:
                joint = int(other[0])
                detail = (
                    f"{side} {kind} of {header.joint_names[joint]} in the stream: {found[joint]}; "
                    f"in the cell: {due[joint]}"
                )
                return Check("robot limits", FAILED, detail=detail)
    return Check("robot limits", OK)


class ToolChecks:
    """The recorded tool pose is the one that the joint values give.

    A format without blocks does not tell which tool a motion has: there it is that of its first row.
    """

    def __init__(self, evidence: Evidence) -> None:
        outline = evidence.outline
        self._tells = bool(outline.records) or not outline.ids.any()
        self._own = np.zeros((1, 3)), np.eye(3)[None]
        self._changes = 0
        self._position = evidence.tally("tool position", "m")
        self._orientation = evidence.tally("tool orientation", "rad")

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        in_world = rows.in_world[0][1:], rows.in_world[1][1:]
        positions, rotations = in_world if self._tells else self._told(rows)
        apart = np.linalg.norm(rows.tool[:, :3] - positions, axis=1)
        self._position.add(rows.rows, apart, TOOL_POSITION)
        quaternions = rows.tool[:, 3:]
        turned = angle_between(from_quaternion(quaternions), rotations)
        # Of some orientations a quaternion of any length gives the matrix.
        odd = np.abs(np.linalg.norm(quaternions, axis=1) - 1.0)
        self._orientation.add(rows.rows, np.maximum(turned, odd), TOOL_ORIENTATION)

    def _told(self, rows: Rows) -> Pose:
        """Poses (R, ..) of tools that change with the first row of a motion, if that has another one."""
        found = [self._of_stretch(rows, stretch) for stretch in rows.stretches]
        positions, rotations = zip(*found, strict=True)
        if self._changes:
            words = f"without blocks the tools of {self._changes} motions are taken from their first rows"
            self._position.detail = self._orientation.detail = words
        return np.concatenate(positions), np.concatenate(rotations)

    def _of_stretch(self, rows: Rows, stretch: Stretch) -> Pose:
        tips = rows.tips[0][stretch.after], rows.tips[1][stretch.after]
        if stretch.begins and stretch.block:
            recorded = rows.tool[stretch.part.start]
            turned = tips[1][0].T @ from_quaternion(recorded[3:])
            tool = (tips[1][0].T @ (recorded[:3] - tips[0][0]))[None], turned[None]
            same = np.linalg.norm(tool[0] - self._own[0]) <= TOOL_POSITION
            if not same or angle_between(turned, self._own[1][0]) > TOOL_ORIENTATION:
                self._own = tool
                self._changes += 1
        if not self._changes:
            return tips
        return tips[0] + tips[1] @ self._own[0][0], tips[1] @ self._own[1][0]

    def checks(self) -> list[Check]:
        """Tool position and orientation."""
        return [self._position.check(), self._orientation.check()]


class RateChecks:
    """Times and rates that a file states beside the joint values are those that follow from these."""

    def __init__(self, evidence: Evidence) -> None:
        header = evidence.outline.header
        self._tick_ns = header.tick_ns
        self._tally = evidence.tally("written rates", "rad/s|m/s")
        largest = np.array([evidence.outline.largest])
        self._allowance = rounding_allowance(largest, header.dt)

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        if rows.rates is None:
            return
        due = rows.rows * self._tick_ns / 1e9
        off, allowed = np.abs(rows.rates.t - due), np.spacing(np.abs(due))
        self._tally.add(rows.rows, off, allowed, rank=off / allowed, unit="s")
        for stated, own, allowance, unit in (
            (rows.rates.qd, rows.qd, self._allowance[0], ""),
            (rows.rates.qdd, rows.qdd, self._allowance[1], "per s2"),
        ):
            off = np.abs(stated - own)
            self._tally.add(rows.rows, off, allowance, rank=off / allowance, unit=unit)

    def checks(self) -> list[Check]:
        """Written rates."""
        return [self._tally.check()]
