"""IRL0xx: the command line, files, and errors of irlx itself."""

from irlx.diagnostics.codes.code import error, warning

COMMAND = (
    error("IRL001", "no such file: {path}{near}", "give the path of an existing file"),
    error("IRL002", "cannot read {path}: {cause}"),
    error("IRL003", "cannot write {path}: {cause}", "name another file"),
    error("IRL004", "-o {path}: no format has the ending '{ending}'; known: {known}"),
    error("IRL005", "{option} {path} would overwrite an input of this run", "name another file"),
    error("IRL006", "{option} {value}: {cause}"),
    error("IRL007", "{path} is a folder, not a file"),
    error("IRL008", "{name} is a {kind}, which does not run by itself", "run a PROGRAM that imports from it"),
    error(
        "IRL009",
        "the plugin {name} cannot be imported: {cause}",
        "name a module that Python finds, or a file that ends with .py",
    ),
    error("IRL010", "{command} needs {package}: pip install 'irlx[{extra}]'"),
    error("IRL012", "--html {path} is also {what}", "give the page a name of its own"),
    error("IRL013", "--html {path}: the name of a page ends with .html", "for example --html {example}"),
    error(
        "IRL011",
        "{first} and {second} cannot be drawn over each other: {cause}",
        "compare streams of robots with the same joints",
    ),
    error(
        "IRL014",
        "the page cannot be served on {where} of {host}: {cause}",
        "name another port with --port, 0 for any that is free; --host 127.0.0.1 is this machine",
    ),
    warning(
        "IRL015",
        "{name} was made with another {robot} than the one of {cell}: what is shown is not where it was",
        "name the cell that it was made in with --cell",
    ),
    error("IRL016", "irlx has no command '{name}'{near}", "irlx --help lists the commands"),
    error("IRL017", "{command} has no option {option}{near}", "{command} --help lists its options"),
    error(
        "IRL018",
        "{path} is not empty, and irlx demo replaces nothing",
        "name a folder that is empty or new: irlx demo {other}",
    ),
    warning("IRL019", "{what} is left out: {cause}"),
    error(
        "IRL090",
        "internal error: {cause}",
        "this is a fault of irlx, not of your program; please report it with the program and the cell",
    ),
)
