"""IRL221 to IRL230: types and values; IRL266, IRL267: files; IRL290, IRL291: frames of the cell."""

from irlx.diagnostics.codes.code import error

TYPES = (
    error(
        "IRL221",
        "type {type} is defined with {found} fields, but the robot has {joints} joints",
        "give it one field a joint: {names}",
    ),
    error("IRL222", "expected {expected}, found {found}"),
    error("IRL223", "{type} takes {expected}, found {found}"),
    error("IRL225", "{type} has no field '{name}'{near}"),
    error(
        "IRL226",
        "'{name}' could mean the field {name}, or {rest} of the field {field}",
        "rename one of the two",
    ),
    error("IRL227", "{op} is not defined for {operands}"),
    error("IRL228", "{function} takes {expected}, found {found}"),
    error(
        "IRL229",
        "these values could be {candidates}",
        "say which with a constructor, or use a declared variable",
    ),
    error("IRL266", "{channel} cannot be '{name}': {cause}"),
    error(
        "IRL267",
        "a FILE cannot be {what}",
        "use the variable itself in OPEN, READ, WRITE, CLOSE, or hand it to a VAR parameter",
    ),
    error("IRL230", "an orientation needs a quaternion of length 1, found length {length}"),
    error("IRL290", "the cell has no frame '{name}'{near}", "frames are {known}"),
    error(
        "IRL291",
        "the frame '{name}' moves with a link of the robot, so that it is no POSE",
        "MOVE .. IN FRAME {name} goes in it; R_BASE takes a frame that stands still",
    ),
)
