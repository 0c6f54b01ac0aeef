"""IRL65x and IRL66x: what `irlx robots --check` finds in a URDF, and what `irlx new` says."""

from irlx.diagnostics.codes.code import error, info, warning

ROBOT_MODEL = (
    warning(
        "IRL650",
        "{joint} has no position limits: {cause}",
        "where cables or stops end its way, only limits make irlx keep off them: give robot.limits.position",
    ),
    warning(
        "IRL651",
        "{joint} cannot move: {cause}",
        "give limits between which it may move in robot.limits, or hold it by robot.locked",
    ),
    warning(
        "IRL652",
        "{joint} has no speed limit",
        "it would be moved as fast as a path asks for: give robot.limits.speed in the cell",
    ),
    info(
        "IRL653",
        "a URDF has no acceleration limits",
        "give robot.limits.acceleration in the cell, from the data sheet: no drive changes its speed at once",
    ),
    warning(
        "IRL654",
        "{what} is without a proper mass: {cause}",
        "moves are planned all the same; criteria of dynamics and gravity need the mass of every moving part",
    ),
    info(
        "IRL655",
        "the robot does not stand in the origin of its root frame '{root}': {joint} leads to {found}",
        "poses count from the root frame; R_BASE, or a frame of the cell, can stand for the robot's foot",
    ),
    warning(
        "IRL656",
        "the inertia of '{link}' is that of no body: {cause}",
        "criteria of dynamics come out wrong: take the inertia from CAD, in kg m2 about the centre of mass",
    ),
    warning(
        "IRL657",
        "the inertia of '{link}' is too {word} for {mass} kg: radius of gyration {gyration} mm, link about"
        " {size} mm",
        "often g mm2, kg mm2 or lb in2 taken for kg m2, or an inertia about the joint: check its unit",
    ),
    warning(
        "IRL658",
        "{joint} may move to {found}: are these {other}?",
        "limits of a URDF are {unit}; in a cell robot.limits.position replaces them, in deg | mm",
    ),
    warning(
        "IRL659",
        "{joint} may go at {found}: are these {other} a second?",
        "speeds of a URDF are rad/s | m/s; in a cell robot.limits.speed replaces them, in deg/s | mm/s",
    ),
    warning(
        "IRL660",
        "{what} {found}: is this in another unit?",
        "lengths of a URDF are m: divide millimetres by 1000 everywhere",
    ),
    warning(
        "IRL661",
        "the mesh {file} of '{link}' is {extent} m large: is it in another unit?",
        'meshes count in m: scale="0.001 0.001 0.001" takes their numbers as mm',
    ),
    warning(
        "IRL662",
        "the mesh {file} cannot be looked at: {cause}",
        "OBSTACLE and self-collision need it: put it where the URDF names it, or use primitives",
    ),
    warning(
        "IRL663",
        "the axis of {joint}: {cause}",
        "irlx takes its direction alone; other readers may not: write a vector of length 1",
    ),
    warning(
        "IRL664",
        "no first moves were found: {cause}",
        "the program only goes to a posture; give robot.start with room to every side, and add moves",
    ),
    warning(
        "IRL665",
        "{joint} follows {other} (mimic)",
        "it is no axis: it moves with the other one, by multiplier and offset; IRL612 tells where it cannot",
    ),
    warning(
        "IRL666",
        "the robot has {count} ends, and one must be chosen as the tip: {ends}",
        "name the link that programs are to move: --tip here, robot.tip in the cell; it need not be an end",
    ),
    warning(
        "IRL667",
        "nothing that {which} carries has a <collision> shape",
        "OBSTACLE and self-collision see nothing there: add boxes, spheres or cylinders about the links",
    ),
    warning(
        "IRL668",
        "{found} axes move '{tip}', a pose has six coordinates",
        "irlx new suggests a task: what the joints move, in robot.task, robot.task_frame and robot.free",
    ),
    error(
        "IRL669",
        "{path} is there already",
        "take another name, or --force to replace it",
    ),
)
