"""WITH TOLERANCE: the tool may stand off its programmed pose, by joints that are added behind it.

The programmed pose is that of a further link behind the tool. What lies between them is a chain of virtual
joints, one for each coordinate with a band, whose position limits are the band. A motion of the robot with
these joints is a motion like any other: it is solved, slowed down and drawn to postures as such, and the
virtual joints are dropped from its rows.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, pi
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.blocks import FREE_TURN, PoseTarget, ToleranceClause
from irlx.diagnostics import Place
from irlx.pacing.freed import Freed
from irlx.pacing.kept_clear import KeptClear
from irlx.pacing.options import LimitsInForce
from irlx.pacing.posed import Pose, pose_of
from irlx.pacing.posture_term import Asked
from irlx.pacing.postures import posture_of_pose
from irlx.pacing.rows import MotionRows
from irlx.pacing.situation import Situation
from irlx.pacing.virtual_constraint import VirtualConstraint
from irlx.promises import GOES_ON
from irlx.robot.description import COORDINATES, Joint, JointKind, RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

_BEHIND_TOOL = (3, 4, 5, 0, 1, 2)
"""Order of the virtual joints from the tool on: (Trans Rz Ry Rx)^-1 leads from it to the programmed pose."""

_NAMES = ("dx", "dy", "dz", "da", "db", "dc")

_EASE = 1e-3
"""Weight of a virtual turn beside the least one of a joint: it takes next to nothing to stand off."""


@dataclass(frozen=True)
class Widened:
    """What a motion finds, with the virtual joints of a tolerance among the robot's; else as it was.

    `asked` are the postures that it is drawn to. `freed` is None where there is no tolerance.
    """

    situation: Situation
    in_force: LimitsInForce
    asked: Asked | None
    freed: Freed | None = None


def start_of(situation: Situation, clause: ToleranceClause | None) -> Pose:
    """Pose at which the path of a move starts: that of the tool, or the one programmed last.

    Behind a move WITH TOLERANCE one with bands in which the tool stands already goes on from where the path
    before ended, so that the tool may stay off it by as much.
    """
    programmed = situation.programmed
    if clause is None or programmed is None:
        return situation.pose
    stands = standing_off(programmed, situation.pose, clause, situation.kinematics)
    return programmed if stands.inside else situation.pose


class StandingOff(NamedTuple):
    """Coordinates (6,) of a tool pose in the programmed one: m, and rad about x, y, z as in the clause.

    `inside`: all are within the bands, to what rounding may pretend.
    """

    values: Array
    inside: bool


def standing_off(
    programmed: Pose, tool: Pose, clause: ToleranceClause, kinematics: Kinematics
) -> StandingOff:
    """How a tool pose stands off the programmed one: of two ways to tell its turns, the nearer one."""
    apart = pin.SE3(*programmed).actInv(pin.SE3(*tool))
    bands = np.array(clause.bands)
    counts = np.array([name in kinematics.task.coordinates for name in COORDINATES])
    allowed = np.where(counts, bands, inf)
    allowed[3:][allowed[3:] >= FREE_TURN] = inf
    rpy = pin.rpy.matrixToRpy(apart.rotation)
    ways = (rpy, np.remainder(np.array([rpy[0], -rpy[1], rpy[2]]) + 2.0 * pi, 2.0 * pi) - pi)
    found = [np.concatenate([apart.translation, turns]) for turns in ways]
    beyond = [float(np.max(np.maximum(np.abs(values) - allowed, 0.0))) for values in found]
    nearer = int(np.argmin(beyond))
    return StandingOff(found[nearer], beyond[nearer] <= GOES_ON)


def widened(
    situation: Situation,
    in_force: LimitsInForce,
    asked: Asked | None,
    clause: ToleranceClause | None,
    way: tuple[Pose, Pose],
) -> Widened:
    """The situation of a motion whose programmed pose goes from the first to the second of `way`."""
    kinematics = situation.kinematics
    bands = freed_coordinates(clause, kinematics)
    if clause is None or not bands:
        return Widened(situation, in_force, asked)
    bands = _with_free_turns(bands, kinematics)
    begin, end = way
    seat = _seat(situation, begin)
    wide = _kinematics(kinematics, bands, seat)
    names = wide.description.joint_names
    real = np.array([names.index(name) for name in kinematics.description.joint_names])
    virtual = {number: names.index(_joint_name(number)) for number in bands}
    limits = _limits(in_force.limits, real, virtual, bands, wide.joints)
    weights = _weights(situation, real, virtual, wide.joints)

    def posture(q: Array, programmed: Pose) -> Array:
        """A posture (n,) with the virtual joints as they are then, inside their bands."""
        found = np.empty(wide.joints)
        found[real] = q
        rotation, position = kinematics.tool_pose(q)
        stands = standing_off(programmed, (rotation @ seat, position), clause, kinematics)
        for number, place in virtual.items():
            band = limits.position_upper[place]
            found[place] = min(max(stands.values[number], -band), band)
        return found

    setup, options = situation.setup, situation.options
    numbers = tuple(int(real[number - 1]) + 1 for number in options.frozen)
    cyclic = None if options.cyclic_posture is None else posture(options.cyclic_posture, end)
    clearance = situation.clearance
    if clearance is not None:
        found = KeptClear(wide, setup.scene, options).clearance
        clearance = None if found is None else found.beginning(situation.tick * situation.dt)
    freed = Freed(kinematics, wide, real, limits, weights, posture(situation.q, begin)[None])
    inner = replace(
        situation,
        setup=replace(setup, kinematics=wide, weights=weights, limits=limits),
        q=freed.q[0],
        options=replace(options, frozen=numbers, cyclic_posture=cyclic),
        solver=type(situation.solver)(wide, situation.qp),
        clearance=clearance,
        freed=freed,
    )
    if asked is not None:
        inside = tuple((share, posture(q, end)) for share, q in asked.on_the_way)
        asked = Asked(posture(asked.end, end), inside)
    return Widened(inner, replace(in_force, limits=limits), asked, freed)


def posture_within(
    clause: ToleranceClause | None,
    target: PoseTarget,
    near: Array | None,
    situation: Situation,
    in_force: LimitsInForce,
    place: Place,
) -> Array:
    """The posture (n,) of `posture_of_pose`, the tool being free within bands about the pose.

    Raises PacingError as that does.
    """
    pose = pose_of(target, situation.pose)
    asked = None if near is None else Asked(near)
    found = widened(situation, in_force, asked, clause, (pose, pose))
    if found.freed is None:
        return posture_of_pose(target, near, situation, in_force, place)
    drawn = None if found.asked is None else found.asked.end
    reached = posture_of_pose(target, drawn, found.situation, found.in_force, place)
    return np.asarray(reached[found.freed.joints])


def narrowed(rows: MotionRows, freed: Freed | None) -> MotionRows:
    """The rows of the robot alone of a motion with virtual joints."""
    if freed is None:
        return rows
    joints = freed.joints
    q = np.ascontiguousarray(rows.q[:, joints])
    rotation, position = freed.robot.world.tool_poses(q)
    path = rows.path
    if path is not None:
        own = {int(place): number for number, place in enumerate(joints)}
        told = tuple(replace(found, joint=own.get(found.joint, -1)) for found in path.slowings)
        path = replace(path, slowings=told)
    return replace(
        rows,
        q=q,
        tool_rotation=rotation,
        tool_position=position,
        active=np.ascontiguousarray(rows.active[:, joints]),
        path=path,
        freed=replace(freed, q=np.vstack([freed.q, rows.q])),
    )


def freed_coordinates(clause: ToleranceClause | None, kinematics: Kinematics) -> dict[int, float]:
    """Bands by the number of their coordinate, of those that the robot is asked for, in the joints' order."""
    if clause is None:
        return {}
    asked = kinematics.task.coordinates
    return {
        number: clause.bands[number]
        for number in _BEHIND_TOOL
        if clause.bands[number] > 0.0 and COORDINATES[number] in asked
    }


def lets_turn(clause: ToleranceClause | None, kinematics: Kinematics) -> bool:
    """Whether bands leave turns open that the robot is asked for."""
    return any(number >= 3 for number in freed_coordinates(clause, kinematics))


def _with_free_turns(bands: dict[int, float], kinematics: Kinematics) -> dict[int, float]:
    """The bands with those turns that the robot's task leaves free, which are bands without end.

    So the bands lie along the axes of the programmed pose, however the tool is turned about them. Of two free
    turns beside one that is asked for that is another turn than the task's, which stays as it is.
    """
    robot = kinematics.description
    if robot.task_frame is not None or (
        len(robot.free) == 2 and kinematics.task.size > kinematics.task.linear
    ):
        return bands
    every = bands | {COORDINATES.index(name): FREE_TURN for name in robot.free}
    return {number: every[number] for number in _BEHIND_TOOL if number in every}


def _seat(situation: Situation, begin: Pose) -> Array:
    """Rotation (3, 3) behind the tool from which the virtual turns count.

    Where all turns are free they begin at 0: how the tool is turned tells nothing, and far from there a turn
    about y would bring the other two into line.
    """
    if situation.kinematics.task.size > situation.kinematics.task.linear:
        return np.eye(3)
    return np.asarray(situation.kinematics.tool_pose(situation.q)[0].T @ begin[0])


def _joint_name(number: int) -> str:
    return f"TOLERANCE {_NAMES[number]}"


def _kinematics(kinematics: Kinematics, bands: dict[int, float], seat: Array) -> Kinematics:
    """The robot with a joint for each band behind the tool, turned by `seat` (3, 3); its tip is where the
    programmed pose is."""
    robot, tool = kinematics.description, kinematics.tool
    x, y, z = (float(value) for value in tool.translation)
    a, b, c = (float(value) for value in pin.rpy.matrixToRpy(tool.rotation @ seat))
    joints = [Joint("TOLERANCE tool", JointKind.FIXED, robot.tip, "TOLERANCE tool", (x, y, z), (a, b, c))]
    for number in bands:
        back = [0.0, 0.0, 0.0]
        back[number % 3] = -1.0
        kind = JointKind.PRISMATIC if number < 3 else JointKind.REVOLUTE
        name = _joint_name(number)
        axis = (back[0], back[1], back[2])
        joints.append(Joint(name, kind, joints[-1].child, name, axis=axis))
    asked = tuple(name for k, name in enumerate(COORDINATES) if name in robot.coordinates or k in bands)
    free = tuple(name for name in robot.free if name not in asked)
    wide = replace(robot, joints=(*robot.joints, *joints), tip=joints[-1].child, coordinates=asked, free=free)
    # What the exact pose would imply is a condition of its own where the pose has room.
    conditions = (*kinematics.constraints, *kinematics.implied)
    found = Kinematics(wide, [VirtualConstraint(item, _real(wide, robot)) for item in conditions])
    return found.of_pose if kinematics.frame is None else found.relative_to(kinematics.frame).of_pose


def _real(wide: RobotDescription, robot: RobotDescription) -> NDArray[np.int64]:
    return np.array([wide.joint_names.index(name) for name in robot.joint_names])


def _limits(
    limits: JointLimits,
    real: NDArray[np.int64],
    virtual: dict[int, int],
    bands: dict[int, float],
    joints: int,
) -> JointLimits:
    found = JointLimits.unlimited(joints)
    for kind in ("position", "speed", "acceleration"):
        lower, upper = (side.copy() for side in found.pair(kind))
        lower[real], upper[real] = limits.pair(kind)
        if kind == "position":
            for number, place in virtual.items():
                band = inf if number >= 3 and bands[number] >= FREE_TURN else bands[number]
                lower[place], upper[place] = -band, band
        found = found.with_pair(kind, lower, upper)
    return found


def _weights(situation: Situation, real: NDArray[np.int64], virtual: dict[int, int], joints: int) -> Array:
    """Weights of all joints: a virtual turn takes little, a virtual shift as much as it turns the robot."""
    found = np.empty(joints)
    found[real] = situation.setup.weights
    turns = np.array([not axis.is_prismatic for axis in situation.robot.axes])
    reach = situation.robot.reach
    scaled = np.where(turns, situation.setup.weights, situation.setup.weights * reach**2)
    for number, place in virtual.items():
        found[place] = _EASE * float(np.min(scaled)) / (1.0 if number >= 3 else reach**2)
    return found
