"""IRL54x and IRL55x: files and channels of a running program."""

from irlx.diagnostics.codes.code import error, warning

FILES = (
    error(
        "IRL540",
        "'{name}' is outside of the folder of the program's files: {cause}",
        "another folder is named by --files DIR, or files= in Python",
    ),
    error("IRL541", "there is no file '{name}'{near}", "files are looked for in {folder}"),
    error("IRL542", "the file '{name}' is not open", "OPEN it first"),
    error("IRL543", "'{variable}' is open already, on '{name}'", "CLOSE it first"),
    error(
        "IRL544",
        "the file '{name}' is open already, by {variable} to {mode}",
        "CLOSE it first; only reading is possible twice at a time",
    ),
    error(
        "IRL545",
        "the file '{name}' is open to {mode} and cannot be {done}",
        "CLOSE it and OPEN it with '{needed}'",
    ),
    error(
        "IRL546",
        "{name}, line {line}, column {column}: expected {expected}, but this is the end",
        "EOF tells whether something is left",
    ),
    error("IRL547", "{name}, line {line}, column {column}: expected {expected}, found {found}"),
    error("IRL548", "{name} cannot be {done}: {cause}"),
    warning(
        "IRL549",
        "the file '{name}' was still open at the end of the program, and has been closed",
        "write CLOSE({variable});",
    ),
    error("IRL550", "{name} is no text in UTF-8: byte {offset} is not part of it"),
    error("IRL551", "'{name}' is {what} and cannot be written", "choose another name"),
    error(
        "IRL552",
        "'{name}' would be more than the {most} files that may be open at a time",
        "CLOSE those that are not needed",
    ),
    error("IRL553", "the program has written too much to {what}: at most {most} a run"),
    error("IRL554", "'{name}' cannot be the name of a file: {cause}"),
)
