"""IRL5xx, but for clearances and files, and IRL438: what a running program meets."""

from irlx.diagnostics.codes.code import error, warning

RUN = (
    error(
        "IRL501",
        "'{name}' has no value yet",
        "assign to it, or give it an initial value where it is declared",
    ),
    error("IRL502", "division by zero"),
    error("IRL503", "{what} leaves the range of {type}", "{range}"),
    error("IRL504", "index {index} of '{name}' is outside {low}..{high}"),
    error("IRL507", "an array of {size} elements is too large; at most {most} are kept", "split it"),
    error("IRL508", "the range {low}..{high} is empty", "the lower bound comes first"),
    error("IRL505", "{param} must be {expected}, found {value}"),
    error("IRL506", "{function} has no value at {value}"),
    error(
        "IRL510",
        "the program has executed {most} statements and goes on; is there a loop without end?",
        "allow more with --max-steps, or max_steps= in Python",
    ),
    error(
        "IRL511",
        "{depth} calls wait for each other and their variables hold {values} values; "
        "{most} calls and {held} values may",
        "is there a way out of the recursion?",
    ),
    error("IRL512", "a text of {length} characters is too long; at most {most} are kept"),
    error("IRL513", "this is nested too deeply to be executed", "split it"),
    error("IRL514", "RETURN {need}"),
    error("IRL515", "the frame '{name}' moves with the link {link}, which {robot} does not have{near}"),
    error(
        "IRL520",
        "the tool cannot follow this move beyond {way} of {length} (tick {tick}), on its way to {target}, at "
        "any speed: {held}; smallest singular value {sigma}; {missing}",
        "widen the limit, or start the move from another posture (RECONFIGURATION before it)",
    ),
    error(
        "IRL521",
        "the tool cannot reach its pose at {way} of {length} (tick {tick}), on its way to {target}: {held}; "
        "smallest singular value {sigma}; {missing}",
        "check the target, and the frame and units it is given in",
    ),
    error(
        "IRL522",
        "no posture within the limits reaches the target {target}; the nearest one found leaves "
        "{distance} mm and {angle} deg",
        "check the target, and the frame and units it is given in",
    ),
    error(
        "IRL523",
        "{joint} would pass its {kind} limit {bound} with {value} at tick {tick}",
        "slowing down does not help here: start the move from another posture, or widen the limit",
    ),
    error(
        "IRL524",
        "the tool would have to stand still at {way} of {length}: no slower clock gets {bound} over this "
        "place; smallest singular value {sigma}",
        "widen the limit, or start the move from another posture (RECONFIGURATION before it)",
    ),
    error(
        "IRL525",
        "the joints' limits make this move take {duration} s instead of {programmed} s, {factor} times "
        "as long; {allowed} times is allowed",
        "widen the limits, start from another posture, or allow more (--max-slow)",
    ),
    error(
        "IRL530",
        "nothing says what the input {name} ({port}) is{near}",
        "give it a trace in [signals.inputs] of the cell or with --inputs, or a function in Python; traces "
        "there are: {known}",
    ),
    error("IRL531", "the input {name} is {value} at {time} s, which is no {kind}"),
    error(
        "IRL532",
        "WAIT FOR {condition} can never end: no input that it reads changes any more",
        "give the input a later change, or the wait a TIMEOUT",
    ),
    error(
        "IRL533",
        "WAIT FOR {condition} has waited {waited} s, the longest time that a wait without TIMEOUT may take",
        "give it a TIMEOUT",
    ),
    error(
        "IRL570",
        "{name} has no orientation: the length of its quaternion is {length}",
        "assign the whole orientation at once: {name}.ORI := ORIZYX(0, 180, 0)",
    ),
    error(
        "IRL571",
        "this tool frame does not go with the robot {robot}, whose task is {task} of the tool: joints would "
        "move {lost} as well, for which nobody asks",
        "turn the tool only about the axis that the robot turns it about",
    ),
    error(
        "IRL572",
        "the cell has no robot '{name}'{near}",
        "its robot is {known}: name that robot, or give the cell of the other one",
    ),
    error(
        "IRL573",
        "the cell has no obstacle or group '{name}'{near}",
        "names that it has: {known}; [[obstacle]] of the cell file adds one",
    ),
    error(
        "IRL574",
        "nothing tells how far {robot} is from '{name}': none of its links that move has a shape",
        "give the links of its URDF <collision> elements",
    ),
    error(
        "IRL580",
        "the sensor's correction for tick {tick} is no six numbers, but {found}",
        "return (dx, dy, dz, rx, ry, rz), m and rad, or None to leave the correction as it is",
    ),
    error(
        "IRL581",
        "the sensor's correction for tick {tick} is not finite: {found}",
        "return None where the sensor sees nothing",
    ),
    error(
        "IRL582",
        "the sensor's correction for tick {tick} is {distance} m and {angle} rad; at most {farthest} m and "
        "half a turn can be asked for",
        "corrections are in m and rad",
    ),
    error(
        "IRL583",
        "a sensor cannot correct a robot whose cell has constraints: {names}",
        "remove [[constraint]] from the cell, or correct nothing",
    ),
    error(
        "IRL438",
        "a sensor cannot correct a robot whose task is told in the frame of a link: {frame}",
        "leave robot.task_frame out of the cell, or correct nothing",
    ),
    error(
        "IRL584",
        "a correction holds {joint} {offset} off its programmed value, which this move has no room for "
        "between {lower} and {upper}; the joint is frozen or may not move",
        "let the sensor take the correction back before, or end the freeze or the limit of its speed",
    ),
    error(
        "IRL585",
        "obstacles for tick {tick} are given by {found}, not by three or six numbers for each name",
        "return {{name: (x, y, z)}} or {{name: (x, y, z, rx, ry, rz)}}, m and rad, or None for as before",
    ),
    error(
        "IRL586",
        "obstacles for tick {tick} name '{name}', which is no obstacle of the cell{near}",
        "obstacles that it has: {known}; a group is moved by placing its members",
    ),
    warning(
        "IRL587",
        "{pair} came within {distance} (tick {tick}), {margin} are kept: no posture within limits and on the"
        " path was farther away in time",
        "let the obstacle come slower, raise its margin and influence, or slow the program down",
    ),
    error(
        "IRL590",
        "this version of irlx reads {what} but does not execute it yet",
        "docs/reference/language.md lists what is executed",
    ),
    warning(
        "IRL591",
        "this version of irlx reads {what} but does not execute it yet; a run would end here",
        "docs/reference/language.md lists what is executed",
    ),
)
