"""IRL56x: what a robot keeps clear of."""

from irlx.diagnostics.codes.code import error, warning

CLEARANCE = (
    error(
        "IRL560",
        "the tool cannot go beyond {way} of {length} (tick {tick}) at any speed and keep clear:"
        " {pair} would be {distance} apart, {floor} are kept",
        "come there in another posture (RECONFIGURATION before the move), free joints, or lessen the margin",
    ),
    error(
        "IRL561",
        "{word} comes too near: at tick {tick} {pair} are {distance} apart, {floor} are kept",
        "lead it round by targets on the way: only moves along a path keep clear by themselves",
    ),
    error(
        "IRL562",
        "{pair} overlap by {depth} where the robot stands: it cannot keep clear of what it is in",
        "move out of it first, or correct where the cell puts it; may_touch names links that may touch",
    ),
    warning(
        "IRL563",
        "{pair} are {distance} apart where the robot stands, inside the margin of {margin}",
        "moves keep them from coming nearer and widen the gap where they can",
    ),
    warning(
        "IRL564",
        "while the robot stood, {pair} came within {distance} (tick {tick}), {floor} are kept",
        "at rest nothing is avoided: let the move out of its way last until it has passed",
    ),
    warning(
        "IRL565",
        "the posture that POSTURE finds is not clear of {name}: {pair} are {distance} apart, not {floor}",
        "another posture of the pose may be: lead the robot nearer to it before, or ask for another pose",
    ),
)
"""Codes of obstacles and links that come too near."""
