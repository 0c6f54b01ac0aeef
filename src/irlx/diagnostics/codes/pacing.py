"""IRL34x and IRL42x: options and targets that do not fit the robot as it stands."""

from irlx.diagnostics.codes.code import error, warning

PACING = (
    error("IRL340", "{word}: the lower bound is above the upper one for {joints}", "exchange the two"),
    warning(
        "IRL341",
        "{word} is wider than the robot allows for {joints}; the robot's own bound stays",
        "a program can only narrow the limits of the cell",
    ),
    error("IRL342", "{word}: the range does not contain standstill (0) for {joints}"),
    error(
        "IRL343",
        "PTP would have to move {joint}, which is frozen",
        "end the freeze before this move, or choose a target with the frozen value",
    ),
    error(
        "IRL345",
        "{joint} stands at {value}, {side} the bound {bound} that begins to hold here",
        "move the joint inside before the limit begins, or widen the limit",
    ),
    error("IRL346", "FREEZESTART names joint {number}; the robot has joints 1 to {joints}"),
    error(
        "IRL347",
        "{frozen} joints are frozen, but a robot of {joints} joints can spare {spare}: the tool needs 6",
        "freeze fewer joints",
    ),
    warning(
        "IRL348",
        "the line ends at the target's pose, but {joint} is {difference} away from the target's posture",
        "limits, frozen joints or the way there held it; MOVE PTP reaches a posture exactly",
    ),
    error(
        "IRL421",
        "TIME {asked} s is shorter than the {least} s that {governor} allow",
        "raise the limit that governs, or ask for more time",
    ),
    error(
        "IRL422",
        "a turn of {angle} deg has no defined axis: half a turn can go either way",
        "put a target with an orientation between the two",
    ),
    error(
        "IRL423",
        "PTP needs a limit to go by; {joint} moves and has no speed limit",
        "give robot.limits.speed in the cell file, or JOINTSPEEDLIMIT, or TIME",
    ),
    error(
        "IRL425",
        "this move would take {duration} s, {ticks} ticks; a move may have at most {most}",
        "check the target, and the units of SPEED, ACC and TIME; a longer tick needs fewer of them",
    ),
    error(
        "IRL426",
        "PTP has to move {joint}, whose speed or acceleration limit is 0",
        "widen the limit, or choose a target that leaves the joint where it is",
    ),
    error("IRL424", "the target puts {joint} at {value}, outside its limits {lower} to {upper}"),
)
