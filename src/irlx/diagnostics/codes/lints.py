"""IRL268, IRL269, IRL281 to IRL299 and IRL310 to IRL329: what is allowed and seldom meant, told by checks."""

from irlx.diagnostics.codes.code import Code, info, warning

LINTS: tuple[Code, ...] = (
    warning("IRL281", "the {kind} '{name}' is never used"),
    warning("IRL282", "'{name}' is read but never set", "assign to it, or give it an initial value"),
    warning("IRL283", "this statement is never reached"),
    warning(
        "IRL284",
        "this {loop} never ends",
        "EXIT, RETURN, HALT or a GOTO inside it would end it",
    ),
    warning(
        "IRL285",
        "this WAIT FOR may wait for ever",
        "give it a limit: WAIT FOR condition TIMEOUT seconds SEC",
    ),
    warning(
        "IRL286",
        "{op} compares REAL numbers digit for digit",
        "compare the difference with a tolerance: ABS(a - b) < 1E-6",
    ),
    warning("IRL287", "the function {name} can end without a RETURN"),
    warning(
        "IRL288",
        "the blend of this move is lost: {blocker} needs the robot at rest",
        "move that statement, or leave out {param}",
    ),
    info(
        "IRL289",
        "{output} is set while the robot passes the corner, not once it has stopped there",
        "leave out {param} of the move before it, if it shall stop",
    ),
    warning(
        "IRL268",
        "the file '{name}' is used but never opened",
        "OPEN({name}, 'name', 'READ'); comes first, or 'WRITE' or 'APPEND'",
    ),
    warning("IRL269", "the file '{name}' is opened but never closed", "write CLOSE({name});"),
    warning("IRL310", "the lower bound {low} of joint {joint} is above its upper bound {high}"),
    warning(
        "IRL311",
        "the path that begins here at {begin} does not come back: it ends at {end}",
        "CYCLICSTART brings the posture back where the tool comes back",
    ),
    warning(
        "IRL312",
        "STATUS {status} of a ROBTARGET is carried and not compared: it chooses no posture",
        "leave it at 0; a posture is chosen by joint values or by WITH RECONFIGURATION",
    ),
    info(
        "IRL313",
        "a ROBTARGET does not fix the posture of a robot with {joints} joints",
        "teach a JOINT, or say WITH RECONFIGURATION, where the posture matters",
    ),
)
