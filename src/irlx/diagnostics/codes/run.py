"""IRL5xx: what a running program meets."""

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
        "IRL520",
        "the tool cannot follow this move beyond {way} of {length} (tick {tick}): {held}; "
        "smallest singular value {sigma}; {missing}",
        "widen the limit, or start the move from another posture; where a speed or acceleration limit holds "
        "it and the target can be reached, less SPEED helps",
    ),
    error(
        "IRL521",
        "the tool cannot reach its pose at {way} of {length} (tick {tick}): {held}; "
        "smallest singular value {sigma}; {missing}",
        "check the target, and the frame and units it is given in",
    ),
    error(
        "IRL522",
        "no posture within the limits reaches the target of this PTP; the nearest one found leaves "
        "{distance} mm and {angle} deg",
        "check the target, and the frame and units it is given in",
    ),
    error(
        "IRL523",
        "{joint} would pass its {kind} limit {bound} with {value} at tick {tick}",
        "give the move less speed or acceleration",
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
