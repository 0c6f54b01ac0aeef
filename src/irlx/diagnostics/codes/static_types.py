"""IRL246 to IRL252 and IRL280: types and routines, as far as the text tells."""

from irlx.diagnostics.codes.code import Code, error, warning

STATIC_TYPES: tuple[Code, ...] = (
    error(
        "IRL246",
        "type {type} is defined with {found}, but {other} with {expected}",
        "both get one field a joint of the robot",
    ),
    error("IRL247", "RETURN of the function {name} needs a value of type {type}"),
    error("IRL248", "RETURN gives a value, but {where} has no result", "only a FUNCTION returns a value"),
    error("IRL249", "{where} needs a variable, found {found}"),
    error(
        "IRL250",
        "'{name}' is {found}, not {expected}",
        "a procedure is called by a statement of its own and has no value",
    ),
    error(
        "IRL251",
        "the constant '{name}' has no value",
        "write CONST type: name := value; a variable is declared below VAR",
    ),
    error("IRL252", "{label} is chosen by an earlier label of this CASE"),
    warning(
        "IRL280",
        "this means {ours}; Pascal would read {pascals}",
        "write the parentheses that are meant",
    ),
)
