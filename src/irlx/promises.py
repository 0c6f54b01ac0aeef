"""The numbers irlx promises, and every tolerance by which a stream is judged, each with its promise.

Producers aim below these numbers, tests and the verifier hold to them; the table of promises in the
README and docs/reference/verifier.md cite them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# ---- The tool is on the programmed path, and at its goal

PATH_POSITION = 1e-6
"""Largest distance of the tool from the programmed path, from the goal at the end of a move, and from where
it stands during a RECONFIGURATION, m."""

PATH_ORIENTATION = 1e-6
"""Largest angle between the tool's orientation and the programmed one, in the same places, rad."""

TOLERANCE_BAND = 1e-9
"""Largest amount by which the tool passes a band of WITH TOLERANCE, m or rad."""

GOES_ON = 3e-9
"""A path WITH TOLERANCE goes on from where that of the move before ended if the tool stands within its bands
and this much, m or rad."""

FOLLOWED_TURN = 1e-4
"""Largest angle by which a robot with fewer axes may be off a target in a turn that its task leaves out and
that follows from the task's own coordinates, rad: what targets typed by hand lack."""

PATH_STEP = 1e-9
"""What rounding of a tool pose may pretend, m or rad. Never backwards, never faster than programmed: a step
along the path may be shorter than 0 by this, speeds of the tool exceed by 2 PATH_STEP/dt, accelerations by
4 PATH_STEP/dt^2, beside `PROGRAM_EXCESS`."""

PROGRAM_EXCESS = 2e-6
"""Largest relative excess of a programmed speed or acceleration, of the tool or a PTP's joints."""

JERK_TICKS = 60_000
"""Motions of so many ticks at most keep the programmed jerk where joints slow them down: the clocks of longer
ones are planned too coarsely for that. Beside `PROGRAM_EXCESS` it may be more by 8 PATH_STEP/dt^3."""

TICK_SHARE = 1e-6
"""Part of a tick by which a move may be shorter than its TIME, or than SPEED and ACC allow: moves take whole
ticks, and this much more than a whole number of them does not begin another. `PROGRAM_EXCESS` follows: a move
of one tick may be this much faster, and accelerate by twice of it."""

SHORTEST_TICK, LONGEST_TICK = 250e-6, 1.0
"""Least and greatest duration of a tick, s: beyond, rows tell nothing of what a robot does between them."""

# ---- A limit is a promise

LIMIT_EXCESS = 1e-9
"""Largest relative excess of a speed or acceleration bound, beside `rounding_allowance`; position: none."""


def rounding_allowance(q: NDArray[np.float64], dt: float) -> tuple[float, float]:
    """What float64 storage of joint values alone can add to differences of them.

    Backward differences of stored values q (any shape, rad or m) at tick `dt` (s) carry up to
    2 u/dt in speed and 4 u/dt^2 in acceleration, u = ulp(max |q|). Returns (speed, acceleration).
    """
    largest = float(np.max(np.abs(q))) if q.size else 0.0
    unit = float(np.spacing(largest))
    return 2.0 * unit / dt, 4.0 * unit / dt**2


CONDITION = 1e-6
"""Largest amount by which a row breaks a constraint of the cell, in the unit of its first joint, rad or m."""

# ---- The robot keeps clear of obstacles, and of itself

CLEARANCE = 1e-9
"""What a distance may lack to the margin, m: rounding of poses and of the search for the nearest points, some
1e-11 at arm's length. Shapes need nothing: cylinders are round, and a mesh is the triangles of its file."""

STARTED_INSIDE = 2e-6
"""By how much a pair that is inside its margin when a motion begins may come nearer in that motion, m."""

# ---- A closed path under CYCLICSTART ends in the posture it began with

CLOSURE = 1e-6
"""Largest difference per joint between the postures at the ends of a closed cyclic path, rad or m."""

RETURN = 1e-8
"""A target this near the pose of CYCLICSTART, m and rad, is a return to it: further off, the posture may
have to differ by more than `CLOSURE`."""

TOUCH = 1e-9
"""A bound this near, relative to max(1, |value|), is active: it may have kept a posture from closing."""

# ---- Joint moves are straight and end where they are told

JOINT_LINE = 1e-9
"""Largest deviation of a joint from the straight line of a PTP move, and from its joint target, rad or m;
also the longest step back along it."""

# ---- A stream says of itself what is so

TOOL_POSITION = 1e-9
"""Largest distance between the recorded tool position and the one that the joint values give, m."""

TOOL_ORIENTATION = 1e-9
"""Largest angle between the recorded tool orientation and the one that the joint values give, rad."""

UNIT_LENGTH = 1e-6
"""Largest difference from 1 of the length of a recorded quaternion."""

SAME_NUMBER = 1e-12
"""Numbers of recorded blocks and of those that the program gives differ at most by this, relative to
max(1, |value|): what another machine's sine may do."""

# ---- Exactly, without a tolerance: position limits, frozen joints (bit for bit), hold ticks (bit for bit),
# ticks, block ids, checksums, names, fingerprints.
