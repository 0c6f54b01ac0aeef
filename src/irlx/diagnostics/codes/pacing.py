"""IRL34x, IRL35x and IRL42x to IRL44x: options and targets that do not fit the robot as it stands."""

from irlx.diagnostics.codes.code import error, info, warning

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
        "{frozen} joints are frozen, but a robot of {joints} joints can spare {spare}: the tool needs {rows}",
        "freeze fewer joints",
    ),
    warning(
        "IRL348",
        "the line ends at the target's pose, but {joint} is {difference} away from the target's posture",
        "limits, frozen joints or the way there held it; MOVE PTP reaches a posture exactly",
    ),
    warning(
        "IRL349",
        "the posture of RECONFIGURATION is not reached, {left} are left: {why}",
        "a posture with the same tool pose, on the same side of the arm, inside the limits can be reached",
    ),
    warning(
        "IRL350",
        "RECONFIGURATION asks for {joint} at {value}, outside its limits {lower} to {upper}; it is led to "
        "the nearest posture inside",
        "choose a value inside the limits, or end the JOINTLIMIT before",
    ),
    error(
        "IRL351",
        "this move breaks the constraint '{name}' of the cell by {broken} (rad or m)",
        "PTP goes straight from posture to posture; choose a target that keeps the constraint, or LIN",
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
    error(
        "IRL427",
        "{points} of the circle are {distance} mm apart: three different points make a circle",
        "a move starts where the last one ended; a full circle takes ANGLE := 360 and two other points",
    ),
    error(
        "IRL428",
        "start, via and end point lie on a line, {height} mm from it at most: they make no circle",
        "move the via point off the line, or use MOVE LIN",
    ),
    error(
        "IRL429",
        "the tool is to turn through the via orientation, but ANGLE {angle} deg does not take it past the "
        "via point at {via} deg",
        "give a larger ANGLE, or leave out CIRC_ORI",
    ),
    error(
        "IRL430",
        "the target is off where no joint of {robot} moves the tool: {off}, in {frame}",
        "give the target the values that the tool has there; the robot's task leaves them out",
    ),
    info(
        "IRL432",
        "the move stops at {where} instead of blending: {reason}",
        "leave out C_CP and C_PASS where the stop is meant",
    ),
    info(
        "IRL433",
        "the blend of {asked} mm at {where} is cut to {used} mm: half of the shorter way beside it",
        "ask for a smaller C_CP, or put the targets farther apart",
    ),
    error(
        "IRL434",
        "{first} and {last} of the PATH are {distance} mm apart: neighbours must differ",
        "leave one of the two points out",
    ),
    error(
        "IRL435",
        "the spline turns back on itself at point {point} of the PATH, where it has no direction",
        "put a point beside the way, or use MOVE LIN PATH, which stops there",
    ),
    info(
        "IRL436",
        "the move passes its target by {miss} mm: its way is left {left} mm before the corner, and the next "
        "one's is reached {joined} mm behind it",
        "ask for a smaller C_CP or C_PTP to come nearer, for a larger one to be quicker",
    ),
    error(
        "IRL437",
        "{robot} has no joint for all of this target: at its end the tool is off it by {off}, in {frame}",
        "the nearest pose that {robot} can meet is {pose} (mm and deg in the root frame of the robot)",
    ),
    error(
        "IRL440",
        "a motion in the frame '{frame}', which moves with a link, cannot be corrected",
        "corrections and obstacles that are seen count in the world: run the program without them",
    ),
    error(
        "IRL441",
        "the poses of this move break the constraint '{name}', by {broken} rad or m",
        "what it asks for is told by the pose alone: give the targets an orientation that keeps it",
    ),
    error(
        "IRL442",
        "poses in the frame '{frame}', which moves with a link, ask for all turns of the tool, but the task "
        "of {robot} leaves out {left}",
        "leave robot.task whole, and give the turns that may be free in each move: WITH TOLERANCE",
    ),
    warning(
        "IRL445",
        "limits make {what} {lost} s longer than programmed, {share} %: at {way} of {length}{of} the tool "
        "has {achieved} of {requested}, for {held}",
        "program a lower SPEED or ACC, widen the limit, or start the move from another posture",
    ),
    warning(
        "IRL446",
        "this move passes near a singular posture: at {way} of {length} the smallest singular value is "
        "{sigma}, {share} % of the largest",
        "lead the path round it, or start the move from another posture (RECONFIGURATION before it)",
    ),
    info(
        "IRL447",
        "the dry run ends here: what follows depends on where the robot stands, and that is not known since "
        "the move of line {line}",
        "correct that move, and check again",
    ),
    error("IRL424", "the target puts {joint} at {value}, outside its limits {lower} to {upper}"),
)
