"""How the limits of the joints are shared between the program and the corrections of a sensor."""

from __future__ import annotations

from irlx.robot.limits import JointLimits

CORRECTION_SHARE = 0.25
"""Part of each joint's speed and acceleration limit that is kept for corrections where a sensor corrects.

Differences of two sums add: what the program plans with the rest and what a correction adds with this part
keep the whole limit together, whatever the two do.
"""


def planned_limits(limits: JointLimits, share: float) -> JointLimits:
    """Limits with `share` of each speed and acceleration; positions stay whole."""
    found = limits
    for kind in ("speed", "acceleration"):
        lower, upper = limits.pair(kind)
        found = found.with_pair(kind, share * lower, share * upper)
    return found


def correction_limits(planned: JointLimits) -> JointLimits:
    """Limits of corrections beside motions that were planned with `planned`, 1 - CORRECTION_SHARE of all."""
    return planned_limits(planned, CORRECTION_SHARE / (1.0 - CORRECTION_SHARE))
