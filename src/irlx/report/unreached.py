"""Ticks that were planned, but did not come."""

from __future__ import annotations

from irlx.diagnostics import Diagnostic


def unreached_time(error: Diagnostic, last_tick: int, dt: float) -> float | None:
    """Time (s) of the tick that an error names, where that is behind the last one of the run; else None.

    A motion is planned as a whole: of one that cannot be done nothing is executed, the robot stays where it
    stood before, and the tick of the message is one of the plan.
    """
    tick = error.data.get("tick")
    return tick * dt if isinstance(tick, int) and tick > last_tick else None
