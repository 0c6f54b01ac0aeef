"""Named tolerances of the inverse transform; the promises they serve are in `irlx.promises`."""

POSITION_TOLERANCE = 1e-7
"""Pose error before the last Newton step of a tick, m; that step squares it."""

ORIENTATION_TOLERANCE = 1e-7
"""Pose error before the last Newton step of a tick, rad."""

TOUCHED_POSE = 1e-11
"""What bounds may lack to a pose for a tick to be solved all the same, displacements by the robot's lever:
where they meet the path in one point its step is lost by rounding, and the search for it ends at a tenth."""

SETTLED_STEP = 1e-9
"""Length (rad and m) of a Newton step from which on a tick may be settled."""

SETTLED_ERROR = 1e-13
"""What a settled tick leaves of the criterion's minimum (rad or m), by the shrinking of its steps."""

ROUNDING_STEP = 1e-14
"""Length (rad and m) of a Newton step that nothing but rounding asks for."""

MOST_CALM_STEPS = 6
"""Newton steps within `SETTLED_STEP` after which a tick is settled whatever the estimate says."""

MAX_ITERATIONS = 30
"""Newton steps of a tick before it counts as impossible."""

MAX_NEWTON_STEP = 0.5
"""Largest change of a joint (rad or m) in one Newton step; longer ones are shortened as a whole."""

RESTRAINTS = (0.01, 0.1, 1.0, 10.0)
"""How a criterion on whose minimum a tick does not settle is held back, tried in turn: see `Restrained`."""

SINGULAR_RATIO = 1e-4
"""Smallest over largest singular value of the scaled Jacobian below which iterates are damped."""

BOUND_RESERVE = 1e-6
"""Part of each speed and acceleration bound that a tick leaves unused, so that rounding stays inside."""

EMPTY_INTERVAL = 1e-12
"""A lower bound above the upper one by no more than this (rad or m) is rounding, not a conflict."""

QP_EXCESS = 1e-9
"""A QP solver's step outside its bounds by more than this (rad or m) is an error of the solver."""

AT_BOUND = 1e-6
"""A joint of an unsolved tick stands on a bound when it is this near to it (rad or m)."""
