"""IRL6xx: the cell file and the robot."""

from irlx.diagnostics.codes.code import error, warning

CELL = (
    error("IRL601", "the cell file is not TOML: {cause}"),
    error("IRL602", "no such key: {key}{near}", "keys known here: {known}"),
    error("IRL603", "{key}: expected {expected}, found {found}"),
    error("IRL604", "{key} needs one value a joint: {joints}, found {found}"),
    error("IRL605", "the {kind} limit of {joint} is no range: {cause} (found {found})"),
    error("IRL606", "{key}: the robot has no joint '{name}'{near}", "it has {known}"),
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
        "name them in robot.task, or turns (rx, ry, rz) that may be as they come in robot.free",
    ),
    error(
        "IRL616",
        "the start posture breaks the constraint '{name}': the sum is {found}, must be {due}",
        "give another robot.start, or leave out the value: then it is that of the start",
    ),
    error(
        "IRL617",
        "no constraint is registered as '{use}'{near}",
        "known are: {known}; irlx.register it before the run, or name its module with --plugin",
    ),
    error(
        "IRL618",
        "line {line} of the inputs: expected {expected}, found {found}",
        "a line for each change: 2.5,IN_3,TRUE below the header time,input,value",
    ),
    error(
        "IRL619",
        "the start posture breaks the constraint '{name}': {off}",
        "give a robot.start that keeps it: it holds from the first row on",
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
    error(
        "IRL622",
        "robot.task_frame: no link between the root and the tip {tip} is called '{name}'{near}",
        "links of the chain are {known}",
    ),
    error(
        "IRL623",
        "the task {task} has {rows} coordinates, but the joints move only {rank} of them independently",
        "leave out of robot.task what follows from the others, or give them in the frame of another link "
        "(robot.task_frame)",
    ),
    error(
        "IRL624",
        "the constraint '{name}' holds {rows} coordinates, but beside the tool's pose and the constraints "
        "before it joints can move {left} of them",
        "a constraint is for what is left to choose, not for what the pose says already or no joint moves",
    ),
    error(
        "IRL626", "{key}: {cause}", "neighbours are at least 1 mm apart; a path needs two, a closed one three"
    ),
    error(
        "IRL627",
        "{key}: the curve through the points {cause}",
        "bends need a radius of 10 mm, and one part stays 20 mm off another: move or leave out points",
    ),
    error("IRL630", "{key}: no shape '{shape}'{near}", "shapes are {known}"),
    error("IRL631", "{key}: a {shape} needs {missing}"),
    error("IRL632", "{key}: {what} has no {extra}", "a table of this shape takes name, shape, {takes}"),
    error(
        "IRL633",
        "{key}: a margin of {margin} mm is above the influence of {influence} mm",
        "what is kept clear must be felt before: give an influence above the margin",
    ),
    error(
        "IRL634",
        "{key}: '{name}' is the name of another obstacle, '{other}'",
        "programs do not tell capital letters from small ones",
    ),
    error(
        "IRL635",
        "{key}: no program can write the name '{name}'",
        "a letter, then letters, digits or _; no keyword of the language",
    ),
    error("IRL636", "{key}: the cell has no frame '{name}'{near}", "frames are {known}"),
    error("IRL637", "{key}: '{name}' is {cause}{near}", "members of a group are obstacles: {known}"),
    error("IRL638", "{key}: {found} s does not come after {before} s", "times of a trajectory rise"),
    error("IRL639", "{key}: no mesh file '{file}'; looked for {tried}{near}"),
    error("IRL640", "{key}: the mesh {file} cannot be used: {cause}"),
    error("IRL641", "{key}: the mesh {file} cannot be read, {cause}: {command}"),
    warning(
        "IRL642",
        "{key}: the mesh {file} is {extent} mm large",
        "numbers of a mesh file are m, as in a URDF: scale = 0.001 takes them as mm",
    ),
    error("IRL643", "{key}: the robot has no link '{name}'{near}", "it has {known}"),
    error("IRL644", "{key}: {file} does not tell which links may touch: {cause}"),
    warning(
        "IRL645",
        "links are not kept off each other: {cause}",
        "active = false under [robot.self_collision] says that this is meant",
    ),
    error(
        "IRL646",
        "{key}: the frame '{name}' moves with the link {link}, and an obstacle cannot",
        "shapes that move with a link belong to it in the URDF",
    ),
    error(
        "IRL647",
        "{key}: the link {link} moves with the tool frame {tip} at all times: no axis lies between them",
        "bind the frame to a link of another hand",
    ),
    error(
        "IRL649",
        "neither the program nor the cell has an input '{name}'{near}",
        "inputs are {known}; what is given for another one would count for nothing",
    ),
)
