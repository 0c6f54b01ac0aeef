"""What a cell changes of its robot: origins of joints, and the coordinates that moves ask for."""

from __future__ import annotations

from dataclasses import replace
from math import radians
from typing import TYPE_CHECKING, Any

from irlx.cell.errors import CellError
from irlx.cell.schema import OriginSection, RobotSection
from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.robot.description import COORDINATES, Joint, RobotDescription
from irlx.solids.placement import Vector3

if TYPE_CHECKING:
    from irlx.robot.kinematics import Kinematics


def with_origins(robot: RobotDescription, section: RobotSection, file: str) -> RobotDescription:
    """The robot with the origins of joints that the cell gives: calibrated, or of other link lengths.

    Raises CellError, IRL606, for names of no joint.
    """
    known = tuple(joint.name for joint in robot.joints)
    errors = [_no_joint(name, known, file) for name in section.origins if name not in known]
    if errors:
        raise CellError(errors)
    if not section.origins:
        return robot
    joints = (
        _placed(joint, section.origins[joint.name]) if joint.name in section.origins else joint
        for joint in robot.joints
    )
    return replace(robot, joints=tuple(joints))


def _no_joint(name: str, known: tuple[str, ...], file: str) -> Diagnostic:
    key = f"robot.origins.{name}"
    data: dict[str, Any] = {"key": key, "name": name, "near": near_matches(name, known)}
    return report("IRL606", Place(file, key=key), known=", ".join(known), **data)


def _placed(joint: Joint, origin: OriginSection) -> Joint:
    xyz = joint.xyz if origin.xyz is None else _three(value * 1e-3 for value in origin.xyz)
    rpy = joint.rpy if origin.rpy is None else _three(radians(value) for value in origin.rpy)
    return replace(joint, xyz=xyz, rpy=rpy)


def _three(values: Any) -> Vector3:
    x, y, z = values
    return x, y, z


def with_task(robot: RobotDescription, section: RobotSection, file: str) -> RobotDescription:
    """The robot with the task of its section: all coordinates that are not free where it names none.

    Raises CellError: IRL613 fewer axes than coordinates, IRL615 a coordinate left out that joints move
    whatever the others do, IRL622 a frame that is no link between root and tip, IRL623 coordinates that
    joints do not move independently.
    """
    free = tuple(name for name in COORDINATES if name in section.free)
    asked = section.task or COORDINATES
    coordinates = tuple(name for name in COORDINATES if name in asked and name not in free)
    robot = replace(robot, coordinates=coordinates, task_frame=section.task_frame, free=free)
    links = (robot.root, *(joint.child for joint in robot.chain))
    if section.task_frame is not None and section.task_frame not in links:
        data: dict[str, Any] = {"name": section.task_frame, "near": near_matches(section.task_frame, links)}
        place = Place(file, key="robot.task_frame")
        raise CellError(report("IRL622", place, tip=robot.tip, known=", ".join(links), **data))
    if len(robot.axes) < len(robot.coordinates):
        names = ", ".join(robot.joint_names) or "none"
        data = {"tip": robot.tip, "found": len(robot.axes), "names": names}
        place = Place(file, key="robot.model")
        raise CellError(report("IRL613", place, rows=len(robot.coordinates), **data))
    if coordinates != COORDINATES:
        # Imported here: most robots are asked for whole poses, and looking at a cell stays light.
        from irlx.robot.kinematics import Kinematics

        kinematics = Kinematics(robot)
        _check_coordinates(kinematics, file)
        # Of an orientation of which two turns are as they come nobody can ask for the third.
        if len(free) == 2 and kinematics.following.size:
            robot = replace(robot, free=COORDINATES[3:])
    return robot


def _check_coordinates(kinematics: Kinematics, file: str) -> None:
    place, task = Place(file, key="robot.task"), kinematics.task
    rank = kinematics.task_rank
    if rank < task.size:
        raise CellError(report("IRL623", place, task=", ".join(task.coordinates), rank=rank, rows=task.size))
    moved = [*(name for name in kinematics.following.coordinates if name in COORDINATES[:3])]
    moved += [name for name in kinematics.unbound.coordinates if name not in moved]
    if len(kinematics.description.free) == 1 and kinematics.following.size:
        # Beside one turn that is as it comes no other one can be told to follow.
        moved += [name for name in kinematics.following.coordinates if name not in moved]
    if moved:
        raise CellError(report("IRL615", place, names=", ".join(moved)))
