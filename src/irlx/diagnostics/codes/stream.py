"""IRL7xx: joint streams and their verification."""

from irlx.diagnostics.codes.code import Code, error, info, warning

STREAM: tuple[Code, ...] = (
    error(
        "IRL701",
        "this is no valid {format} file: {reason}",
        "write the file again with irlx; do not edit it by hand",
    ),
    error(
        "IRL702",
        "its checksum is {found}..., its content gives {expected}...: the file was changed",
        "write the file again with irlx; do not edit it by hand",
    ),
    error(
        "IRL703",
        "tick {tick} follows tick {previous}: ticks must rise",
        "write the file again with irlx; do not edit it by hand",
    ),
    error("IRL704", "it should hold {said} {what}, but {found} are there", "copy or write the file again"),
    error(
        "IRL705",
        "the file ends inside its header, so nothing of the stream can be read",
        "copy or write the file again",
    ),
    error(
        "IRL706",
        "the file has format version {found}; this irlx reads versions 1 to {known}",
        "read it with the irlx version that wrote it, or run the program again",
    ),
    error("IRL707", "{path}: no stream format has the ending '{ending}'; known: {known}"),
    error(
        "IRL708",
        "the stream cannot be written: {reason}",
        "this is a fault of whatever made the stream, not of your program; please report it",
    ),
    error(
        "IRL709",
        "the stream fails the check '{check}': {finding}",
        "run the program again with this irlx; if it fails again, please report it with program and cell",
    ),
    error("IRL720", "{path}: {title} needs {package}: {command}"),
    error(
        "IRL710",
        "{target} moves {wanted}; this stream has {found}",
        "lock joints in the cell ([robot] locked) that need not move, or choose another target with --to",
    ),
    error(
        "IRL711",
        "{target} has no slides, and joint '{joint}' is one",
        "lock the slide in the cell ([robot] locked), or choose another target with --to",
    ),
    error(
        "IRL712",
        "{target} takes a tick {wanted}; this stream has one of {found} ms",
        "run the program with --tick {tick}: rows between the rows of a stream are never invented",
    ),
    error(
        "IRL713",
        "{target} plays one posture a tick, but tick {tick} follows {previous}",
        "run the program again; its streams have no gaps",
    ),
    error(
        "IRL714",
        "joint '{joint}' is {value} {unit} at tick {tick}, which {target} cannot hold",
        "look at what made the stream; no robot stands there",
    ),
    error(
        "IRL715",
        "the stream ends at tick {tick} while joint '{joint}' still moves at {speed}: {target} ends hard",
        "run the program again: what irlx keeps of an interrupted run ends at a stop",
    ),
    error(
        "IRL716",
        "the stream is not complete, so {target} would end somewhere on the way",
        "run the program to its end, or give --incomplete to have the part that is there",
    ),
    error(
        "IRL717",
        "a program in {target} holds {wanted} points; this stream has {found}",
        "cut the program into several, or choose a longer tick where the target takes one",
    ),
    info(
        "IRL718",
        "the program is called {name}, since '{asked}' is no name in {target}",
        "name the file so as well where the controller wants both to be the same",
    ),
    info(
        "IRL719",
        "{format}: {what} are left out, {number} in this stream",
        "keep the stream that it was made from, which has them",
    ),
    warning(
        "IRL721",
        "link '{link}' is not drawn as its model has it: {cause}",
        "pictures show its collision shapes, or nothing of it; what the robot does is not touched by that",
    ),
    error(
        "IRL722",
        "{path}: a page shows the robot of a cell, and this Run does not know its cell",
        "runs that irlx.run gives back know theirs",
    ),
    info(
        "IRL723",
        "the page lists the first {listed} of {count} blocks; its frames show all of the run",
        "the stream beside it has all blocks",
    ),
    error(
        "IRL725",
        "this format has no blocks, so that there is nothing to be replayed",
        "formats with blocks: {known}",
    ),
    error(
        "IRL726",
        "the recorded execution did not come to its end",
        "run its program again; only a whole execution is replayed",
    ),
    error(
        "IRL727",
        "the robot has the joints {found}; those of the recorded one are {expected}",
        "name the cell of a robot whose joints have these names in this order",
    ),
    error(
        "IRL728",
        "the recorded execution read {recorded} from {name} here, which is {value} now",
        "give inputs as they were, or run the program, which takes the way that belongs to these",
    ),
    warning(
        "IRL729",
        "{title}: the stream that it was made from has no blocks: verify fails it, and it cannot be replayed",
        "convert the stream that the run wrote, in a format with blocks: {known}",
    ),
    error(
        "IRL730",
        "it was not made from {name} as it is: its SHA-256 is {found}..., recorded is {recorded}...",
        "find the file as it was",
    ),
    error(
        "IRL731",
        "it does not say all that it was made with: {missing}",
        "make it again with the call that made it",
    ),
    error(
        "IRL732",
        "made again, the stream differs: {difference}",
        "install the recorded versions: {software}",
    ),
)
