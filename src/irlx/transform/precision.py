"""Named tolerances of the inverse transform; the promises they serve are in `irlx.robot.promises`."""

POSITION_TOLERANCE = 1e-7
"""Pose error before the last Newton step of a tick, m; that step squares it."""

ORIENTATION_TOLERANCE = 1e-7
"""Pose error before the last Newton step of a tick, rad."""

SETTLED_STEP = 1e-9
"""Largest joint step (rad or m) of the last Newton iteration: the criterion has settled."""

MAX_ITERATIONS = 30
"""Newton steps of a tick before it counts as impossible."""

MAX_NEWTON_STEP = 0.5
"""Largest change of a joint (rad or m) in one Newton step; longer ones are shortened as a whole."""

SINGULAR_RATIO = 1e-4
"""Smallest over largest singular value of the scaled Jacobian below which iterates are damped."""

BOUND_RESERVE = 1e-6
"""Part of each speed and acceleration bound that a tick leaves unused, so that rounding stays inside."""

EMPTY_INTERVAL = 1e-12
"""A lower bound above the upper one by no more than this (rad or m) is rounding, not a conflict."""

FINAL_CLIP = 1e-9
"""A solution outside its bounds by more than this (rad or m) is an error of the solver."""

AT_BOUND = 1e-6
"""A joint of an unsolved tick stands on a bound when it is this near to it (rad or m)."""
