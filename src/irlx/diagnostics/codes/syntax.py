"""IRL1xx: the text of a program."""

from irlx.diagnostics.codes.code import Code, error, warning

SYNTAX: tuple[Code, ...] = (
    error("IRL101", "expected {expected}, found {found}"),
    error("IRL102", "missing ';' after {construct}", "end it with ';'"),
    warning("IRL103", "missing ';' after {construct}", "end it with ';'"),
    warning("IRL104", "missing {word} after the condition of {head}", "write {head} condition {word}"),
    warning("IRL105", "'=' taken for ':='", "':=' sets a value, '=' compares two"),
    error("IRL106", "{word} is a keyword and cannot be a name", "choose another name"),
    error(
        "IRL107",
        "missing {closer} for the {opener} of line {line}, found {found}",
        "close the {opener} with {closer}",
    ),
    error("IRL108", "{word} without {opener}", "remove it, or write the {opener} that it closes"),
    error("IRL109", "nothing may follow the end of the {what}, found {found}"),
    error("IRL110", "comment without end", "close {{ with }} and (* with *); comments do not nest"),
    error("IRL111", "text without closing {quote}", "a text ends on its line; a quote inside is doubled"),
    error("IRL112", "{character} has no meaning outside texts and comments"),
    error("IRL113", "number outside the range of {type}"),
    error(
        "IRL114",
        "{item} stands after WITH or out of order in the MOVE",
        "the order is: targets, then IN FRAME, then name := value, then WITH clauses",
    ),
    error("IRL115", "comparisons cannot be chained", "compare twice and join with AND: a < b AND b < c"),
    error(
        "IRL116",
        "expected PROGRAM, MODULE or DATALIST at the start, found {found}",
        "begin the file with PROGRAM name;, MODULE name; or DATALIST name;",
    ),
    error("IRL117", "the file holds no program", "begin it with PROGRAM name;"),
    error("IRL118", "{what} nested deeper than {limit} levels", "use variables for parts, or procedures"),
    error("IRL120", "missing {word} before {found}", "write {word} here"),
    error("IRL121", "'{name}' is no word of the language; did you mean {word}?", "write {word}"),
    error("IRL122", "',' found where ';' has to end {construct}", "write ';' between statements"),
    error("IRL123", "{found} is not known here", "{instead}"),
    error("IRL124", "',' inside a number", "numbers are written with a decimal point: {number}"),
    error(
        "IRL125",
        "ELSE IF begins a second IF, and there is no ENDIF for it",
        "write ELSIF for another condition of the same IF",
    ),
    warning(
        "IRL126",
        "this comment holds the beginning of another one, in line {line}",
        "comments do not nest; close this one before, or write another sign in it",
    ),
    warning(
        "IRL140",
        "nothing on this line gives {ignored}: the comment ignores nothing",
        "remove the code; a comment ignores what begins on its own line",
    ),
    warning(
        "IRL141", "{ignored} is an error and cannot be ignored", "remove the code, and repair what it says"
    ),
    warning("IRL142", "no message has the code {unknown}{near}", "irlx explain lists all codes"),
    warning(
        "IRL143",
        "this comment to irlx is not understood: {cause}",
        "write {{ irlx: ignore IRL205 }}, several codes with commas between",
    ),
    error(
        "IRL144",
        "the formatter would not keep {what}; the text stays as it was",
        "this is a fault of irlx, not of your program; please report it with the program",
    ),
    error("IRL130", "not UTF-8 text: byte {byte} at offset {offset}", "save the file as UTF-8"),
    error("IRL131", "not a text file: NUL byte at offset {offset}", "save the file as UTF-8 text"),
)
