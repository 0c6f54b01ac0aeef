"""What the interpreter may know of a cell."""

from __future__ import annotations

from unicodedata import normalize

from irlx.cell.cell import Cell
from irlx.interpreter.setting import Setting


def setting_of(cell: Cell) -> Setting:
    """Joints, defaults of the system variables and named poses of a cell, in program units."""
    motion = cell.motion
    defaults = {
        "R_SPEED": motion.speed,
        "R_ACC": motion.acc,
        "R_SPEED_ORI": motion.speed_ori,
        "R_ACC_ORI": motion.acc_ori,
        "R_SPEED_PTP": motion.speed_ptp,
        "R_ACC_PTP": motion.acc_ptp,
    }
    poses = {
        normalize("NFC", name): (frame.position, frame.quaternion) for name, frame in cell.frames.items()
    }
    axes = cell.robot.axes
    return Setting(cell.robot.joint_names, tuple(axis.is_prismatic for axis in axes), defaults, poses)
