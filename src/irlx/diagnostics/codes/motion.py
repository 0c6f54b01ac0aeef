"""IRL4xx: motion, as far as the text tells."""

from irlx.diagnostics.codes.code import Code, error, warning

MOTION: tuple[Code, ...] = (
    error("IRL401", "PATH does not go with {kind}", "write MOVE LIN PATH or MOVE SPLINE PATH"),
    error("IRL402", "SPLINE needs PATH", "write MOVE SPLINE PATH (p1, p2, p3)"),
    error("IRL403", "CIRCLE needs pairs of via point and end point, found {count} target(s)"),
    error("IRL404", "{param} does not go with {kind}", "it belongs to a MOVE CIRCLE"),
    error(
        "IRL405",
        "{targets} target(s), but {postures} posture(s) after RECONFIGURATION",
        "give one posture for each target, of a CIRCLE for each via and end point or for each end point",
    ),
    error("IRL406", "WITH {clause} is given twice"),
    warning(
        "IRL407",
        "WITH {clause} does nothing on a PTP, which goes straight in joint space",
        "remove it, or use MOVE LIN or MOVE CIRCLE",
    ),
)
