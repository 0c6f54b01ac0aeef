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
        "the joints that move the tool frame {tip} are {names}: {found}, but the task has {rows} coordinates",
        "choose another tip, unlock joints, or say in robot.task which coordinates of the pose count",
    ),
    error("IRL614", "the robot '{model}' is in the package example-robot-data, {cause}: {command}"),
    error(
        "IRL615",
        "robot.task leaves out {names}, but joints move the tool that way",
        "name them in robot.task; coordinates that are left free on purpose are for a later version",
    ),
    error(
        "IRL616",
        "the start posture breaks the constraint '{name}': the sum is {found}, must be {due}",
        "give another robot.start, or leave out the value: then it is that of the start",
    ),
    error(
        "IRL617",
        "no constraint is registered as '{use}'{near}; known are: {known}",
        "irlx.register it before the run, or name its module with --plugin",
    ),
    error(
        "IRL618",
        "line {line} of the inputs: expected {expected}, found {found}",
        "a line for each change: 2.5,IN_3,TRUE below the header time,input,value",
    ),
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
