"""IRL240 to IRL245, IRL264, IRL265: data lists."""

from irlx.diagnostics.codes.code import error, warning

DATA_LISTS = (
    error(
        "IRL240",
        "no data list '{name}': there is no file {path}{near}",
        "a data list NAME is the file NAME.dat beside the program",
    ),
    error("IRL241", "the data list '{name}' cannot be read from {path}: {cause}"),
    error(
        "IRL242",
        "expected a data list, found {found}",
        "a data list begins with DATALIST name; and ends with ENDDATALIST",
    ),
    warning(
        "IRL243",
        "the data list is called '{found}' here and '{name}' where it is imported",
        "write DATALIST {name};",
    ),
    error("IRL244", "the data list '{name}' is imported twice", "remove one of the two"),
    warning("IRL264", "the value of '{name}' is not written back: {why}"),
    error(
        "IRL265",
        "{path} is not written: the file was changed while the program ran",
        "run the program again",
    ),
    error(
        "IRL245",
        "a value of a data list cannot use '{name}', {what}",
        "values are made of literals, constructors, and names further up in the list",
    ),
)
