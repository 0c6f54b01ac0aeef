"""IRL6xx: the cell file and the robot."""

from irlx.diagnostics.codes.code import error, warning

CELL = (
    error("IRL601", "the cell file is not TOML: {cause}"),
    error("IRL602", "no such key: {key}{near}", "keys known here: {known}"),
    error("IRL603", "{key}: expected {expected}, found {found}"),
    error("IRL604", "{key} needs one value a joint: {joints}, found {found}"),
    error("IRL605", "the {kind} limit of {joint} is no range: {cause} (found {found})"),
    error("IRL606", "{key}: the robot has no joint '{name}'{near}", "it has {known}"),
    warning("IRL607", "[{section}] is kept for a later version and has no effect yet"),
    error(
        "IRL609",
        "no cell file found; tried {tried}",
        "give one with --cell, or put SYSTEM SPECIFICATION name; into the program and name.toml beside it",
    ),
    error(
        "IRL610",
        "the cell names no robot",
        'put model = "NAME" under [robot]; packaged: {known}; with irlx[robots]: {extra}',
    ),
    error(
        "IRL611",
        "no robot '{model}'{tried}{near}",
        "give the path of a URDF relative to the cell file, or a packaged robot: {known}; "
        "with irlx[robots]: {extra}",
    ),
    error("IRL612", "the robot model {model} cannot be used: {cause}{near}"),
    error(
        "IRL613",
        "the joints that move the tool frame {tip} are {names}: {found}, but a pose needs at least six",
        "choose another tip, or unlock joints; robots with fewer axes are for a later version",
    ),
    error("IRL614", "the robot '{model}' is in the package example-robot-data, {cause}: {command}"),
    error(
        "IRL620",
        "{joint} starts at {found} {unit}, outside its limits {lower} to {upper} {unit}",
        "a run can only start inside the limits: change robot.start or robot.limits.position",
    ),
    warning(
        "IRL621",
        "no joint has an acceleration limit, so every change of speed within a tick is allowed",
        "give robot.limits.acceleration in the cell file",
    ),
)
