"""What the interpreter may know of a cell."""

from __future__ import annotations

import re
from pathlib import PurePath
from unicodedata import normalize

from irlx.cell.cell import Cell
from irlx.interpreter.setting import Default, Setting


def setting_of(cell: Cell) -> Setting:
    """Joints, defaults of the system variables, and what has a name in a cell, in program units."""
    motion = cell.motion
    defaults: dict[str, Default] = {
        "R_SPEED": motion.speed,
        "R_ACC": motion.acc,
        "R_SPEED_ORI": motion.speed_ori,
        "R_ACC_ORI": motion.acc_ori,
        "R_SPEED_PTP": motion.speed_ptp,
        "R_ACC_PTP": motion.acc_ptp,
        "R_JERK": motion.jerk,
        "R_C_CP": motion.c_cp,
        "R_C_PTP": motion.c_ptp,
        "R_C_PASS": motion.c_pass,
        "R_PROFILE": motion.profile,
        "R_OVERRIDE": motion.override,
    }
    poses = {
        normalize("NFC", name): (frame.position, frame.quaternion) for name, frame in cell.frames.items()
    }
    axes = cell.robot.axes
    slides, weights = tuple(axis.is_prismatic for axis in axes), tuple(map(float, cell.weights))
    obstacles = {normalize("NFC", name).casefold(): name for name in cell.scene.names}
    moving = {normalize("NFC", name).casefold(): frame for name, frame in cell.link_frames.items()}
    return Setting(
        cell.robot.joint_names,
        slides,
        defaults,
        poses,
        weights,
        _robot_names(cell),
        obstacles,
        moving,
    )


def _robot_names(cell: Cell) -> tuple[str, ...]:
    """Names of the robot as a program can write them: what no name may hold becomes _."""
    given = (cell.robot.name, PurePath(cell.model).stem)
    return tuple(dict.fromkeys(re.sub(r"\W", "_", normalize("NFC", name)) for name in given))
