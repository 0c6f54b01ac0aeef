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
)
