"""Values of joints in the units of a program (degrees, mm) and in those of blocks (rad, m)."""

from __future__ import annotations

from math import radians

from irlx.interpreter.setting import Setting
from irlx.interpreter.types import Record
from irlx.interpreter.values import RecordValue


def main_joints(type: Record, posture: tuple[float, ...], setting: Setting) -> RecordValue:
    """MAIN_JOINT (deg, mm) of a posture (rad, m)."""
    units = (1e-3 if slides else radians(1.0) for slides in setting.prismatic)
    return RecordValue(type, tuple(value / unit for value, unit in zip(posture, units, strict=True)))


def si_values(value: RecordValue, setting: Setting) -> tuple[float, ...]:
    """Values of a record with one number a joint, or of the main joints of a JOINT, in rad and m."""
    first = value.values[0] if value.values else None
    reals = (first if isinstance(first, RecordValue) else value).reals()
    pairs = zip(reals, setting.prismatic, strict=True)
    return tuple(real * 1e-3 if slides else radians(real) for real, slides in pairs)
