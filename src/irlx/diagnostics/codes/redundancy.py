"""IRL3xx: redundancy options."""

from irlx.diagnostics.codes.code import Code, error, warning

REDUNDANCY: tuple[Code, ...] = (
    warning("IRL301", "{switch} is still on at the end of the program", "switch it off with {end}"),
    warning("IRL302", "{end} although {switch} is not on", "remove it, or switch {switch} on before"),
    warning(
        "IRL303",
        "{switch} is switched on while it is on; the new values replace the old",
        "write {end} between",
    ),
    error("IRL304", "joint {number} is listed twice"),
    error("IRL305", "there is no joint {number}", "joints are counted from 1"),
    error("IRL306", "parameter '{name}' of the criterion {criterion} is given twice"),
    error(
        "IRL360",
        "no criterion is called {name}{near}",
        "known: {known}; one of your own is registered with irlx.register or --plugin",
    ),
    error("IRL361", "the criterion {name} has no parameter {param}", "it takes {known}"),
    error(
        "IRL362",
        "the criterion {name} needs the masses of the links, and {robot} has none",
        "give the links of its URDF <inertial> elements",
    ),
    warning(
        "IRL363",
        "no criterion of the library is called {name}{near}",
        "known: {known}; one of your own must be registered before the program runs",
    ),
)
