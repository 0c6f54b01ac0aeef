"""Random programs of every form of the grammar, and random blanks and comments between their words."""

from hypothesis import strategies as st

NAMES = st.sampled_from(["x", "Y", "p1", "via_2", "ściana_1", "home", "Step", "at", "TO", "sec", "Datalist"])
"""Some are words with a second use."""
TYPES = st.sampled_from(["REAL", "int", "Pose", "MAIN_JOINT"])
INTS = st.sampled_from(["0", "1", "007", "42"])
LITERALS = st.one_of(
    INTS,
    st.sampled_from(["1.", ".5", "1.5E-3", "12.250", "true", "FALSE", "'it''s'", '"a {b}"', "'(* no *)'"]),
)
OPERATORS = st.sampled_from(["+", "-", "*", "/", "DIV", "mod", "@", "AND", "or", "EXOR"])
COMPARISONS = st.sampled_from(["=", "<>", "<", ">", "<=", ">="])


def words(*parts):
    """Strategy of the words of all parts, in order; a part is a word or a strategy of words."""
    chosen = [st.just([part]) if isinstance(part, str) else part for part in parts]
    return st.tuples(*chosen).map(lambda lists: [word for one in lists for word in one])


def one(strategy):
    return strategy.map(lambda word: [word])


def listed(item, least=1, most=4, separator=","):
    def join(items):
        joined = []
        for index, words_of_item in enumerate(items):
            joined += [separator] * bool(index) + words_of_item
        return joined

    return st.lists(item, min_size=least, max_size=most).map(join)


def maybe(*parts):
    return st.one_of(st.just([]), words(*parts))


def repeated(item, most=3):
    return st.lists(item, max_size=most).map(lambda lists: [word for one in lists for word in one])


NAME = one(NAMES)


def _larger(smaller):
    return st.one_of(
        words("(", smaller, ")"),
        words("(", listed(smaller, 2, 5), ")"),
        words(NAME, "(", listed(smaller, 0, 3), ")"),
        words(NAME, "[", listed(smaller, 1, 2), "]", maybe(".", NAME)),
        words(smaller, one(OPERATORS), smaller),
        words(st.sampled_from([["-"], ["+"], ["NOT"], ["-", "-"]]), one(LITERALS)),
    )


ATOM = st.one_of(one(LITERALS), NAME, words(NAME, ".", NAME))
EXPRESSION = st.recursive(ATOM, _larger, max_leaves=8)
CONDITION = st.one_of(EXPRESSION, words("(", ATOM, one(COMPARISONS), ATOM, ")", "AND", ATOM))
RANGE = words(ATOM, "..", ATOM)
PARAMETER_NAMES = st.sampled_from(["SPEED", "acc", "Time", "C_CP", "home"])
"""MOVE knows all but the last, which therefore begins a statement where it stands at the start of a line."""
PARAM = words(one(PARAMETER_NAMES), ":=", EXPRESSION)
PARAMS = st.lists(st.tuples(st.booleans(), PARAM), min_size=1, max_size=4).map(
    lambda params: [word for comma, param in params for word in ([","] * comma + param)]
)
LIMIT = st.sampled_from([["JOINTLIMIT"], ["jointspeedlimit"], ["JOINTACCELLIMIT"]])
CLAUSE = st.one_of(
    words("WITH", LIMIT, EXPRESSION, ",", EXPRESSION),
    words("with", "RECONFIGURATION", listed(EXPRESSION)),
    words("WITH", "TOLERANCE", EXPRESSION),
    words("WITH", "CRITERION", NAME, st.one_of(st.just([]), PARAMS)),
)
KIND = st.sampled_from([["PTP"], ["lin"], ["CIRCLE"], ["Spline"]])
MOVE = words(
    st.sampled_from([["MOVE"], ["move_inc"]]),
    KIND,
    st.one_of(listed(EXPRESSION, 1, 6), words("PATH", "(", listed(EXPRESSION, 2, 6), ")")),
    st.one_of(st.just([]), PARAMS),
    repeated(CLAUSE, 2),
)
SIMPLE = st.one_of(
    words(NAME, ":=", EXPRESSION),
    words(NAME, "[", EXPRESSION, "]", ":=", EXPRESSION),
    words(NAME, maybe("(", listed(EXPRESSION, 0, 3), ")")),
    words("WRITE", "(", NAME, ":", INTS.map(lambda word: [word]), ":", ATOM, ")"),
    words("RETURN", st.one_of(st.just([]), EXPRESSION)),
    words("GOTO", NAME),
    st.sampled_from([["EXIT"], ["halt"], ["PAUSE"], ["FREEZEEND"], ["CYCLICSTART"], ["JOINTLIMITEND"]]),
    words("WAIT", EXPRESSION, "SEC"),
    words("WAIT", "FOR", CONDITION, maybe("TIMEOUT", ATOM, "sec")),
    words("FREEZESTART", listed(EXPRESSION)),
    words("OBSTACLE", NAME),
    words("CRITERION", NAME, st.one_of(st.just([]), PARAMS)),
    words(LIMIT, EXPRESSION, ",", EXPRESSION),
    words("RECONFIGURATION", EXPRESSION),
    MOVE,
)


def _block_of(statement):
    return repeated(st.one_of(words(statement, ";"), words(NAME, ":"), st.just([";"])), 4)


def _compound(smaller):
    block = _block_of(smaller)
    return st.one_of(
        words(
            *("IF", CONDITION, "THEN", block, repeated(words("ELSIF", CONDITION, "then", block), 2)),
            *(maybe("ELSE", block), "ENDIF"),
        ),
        words(
            *("CASE", EXPRESSION, "of"),
            repeated(words("WHEN", listed(st.one_of(ATOM, RANGE)), ":", block), 3),
            *(maybe("DEFAULT", ":", block), "ENDCASE"),
        ),
        words(
            *("for", NAME, ":=", EXPRESSION, st.sampled_from([["TO"], ["downto"]]), EXPRESSION),
            *(maybe("STEP", ATOM), "DO", block, "ENDFOR"),
        ),
        words("WHILE", CONDITION, "DO", block, "endwhile"),
        words("REPEAT", block, "UNTIL", CONDITION),
    )


STATEMENT = st.recursive(SIMPLE, _compound, max_leaves=6)
BLOCK = _block_of(STATEMENT)
ARRAY = words("ARRAY", "[", listed(words(ATOM, "..", ATOM), 1, 2), "]", "OF", one(TYPES))
FIELD = words(NAME, st.sampled_from([[], [".", "max"], [".", "s", ".", "MIN"]]))
RECORD = words("RECORD", repeated(words(one(TYPES), ":", listed(FIELD), ";")), "ENDRECORD")
TYPE = st.one_of(one(TYPES), ARRAY, RECORD)
VARIABLE = words(NAME, maybe(":=", EXPRESSION))
VARIABLES = words(TYPE, ":", listed(VARIABLE, 1, 5), ";")
SIGNAL = words(NAME, "AT", EXPRESSION)
SIGNALS = words(
    st.sampled_from([["INPUT", "BOOL"], ["output", "REAL"], ["DIGITAL", "INPUT"], ["ANALOG", "OUTPUT"]]),
    *(":", listed(SIGNAL), ";"),
)
LOCAL = st.one_of(
    words("CONST", repeated(words(TYPE, ":", listed(words(NAME, ":=", EXPRESSION)), ";"))),
    words("TYPE", repeated(words(TYPE, "=", NAME, ";"))),
    words("var", repeated(st.one_of(VARIABLES, SIGNALS))),
)
PARAMETER = words(st.sampled_from([[], ["IN"], ["var"]]), one(TYPES), ":", listed(NAME, 1, 2))
PARAMETERS = st.one_of(st.just([]), words("(", listed(PARAMETER, 0, 4, ";"), ")"))
PART = st.one_of(
    LOCAL,
    words("SYSTEM", "SPECIFICATION", NAME, ";"),
    words("FROM", NAME, "IMPORT", listed(NAME), ";"),
    words("IMPORT", "DATALIST", NAME, ";"),
    words("EXPORT", listed(one(st.sampled_from(["x", "y"]))), maybe("TO", NAME), ";"),
    words("ROBOT", NAME, ":=", NAME, ";"),
    words("STANDARD_OUT", "=", NAME, ";"),
    words("PROCEDURE", NAME, PARAMETERS, ";", repeated(LOCAL, 2), "BEGIN", BLOCK, "ENDPROC", ";"),
    words(
        *("FUNCTION", NAME, PARAMETERS, ":", one(TYPES), ";", repeated(LOCAL, 1), "BEGIN", BLOCK),
        *("ENDFCT", ";"),
    ),
)
END = maybe(";")
TEXTS = st.one_of(
    words("PROGRAM", NAME, ";", repeated(PART, 4), "BEGIN", BLOCK, "ENDPROGRAM", END),
    words("module", NAME, ";", repeated(PART, 4), "ENDMODULE", END),
    words("DATALIST", NAME, ";", repeated(VARIABLES, 4), "ENDDATALIST", END),
)
"""Words of whole texts."""

COMMENTS = st.sampled_from(
    [
        "{ one }",
        "{}",
        "(* two *)",
        "(**)",
        "{ over\n     two lines }",
        "(* a\n\n  b\n*)",
        "{ it's }",
        "{ " + "x" * 90 + " }",
    ]
)
BLANKS = st.sampled_from([" ", " ", " ", " ", "  ", "\n", "\n", "\n\n", "\n\n\n", "\t", " \n    "])
GAPS = st.one_of(
    BLANKS,
    BLANKS,
    BLANKS,
    st.tuples(BLANKS, COMMENTS, BLANKS).map("".join),
    st.tuples(BLANKS, COMMENTS, BLANKS, COMMENTS, BLANKS).map("".join),
    COMMENTS,
)


@st.composite
def spaced(draw, tokens):
    """A text with these words, and anything that may stand between them."""
    count = len(tokens) + 1
    gaps = draw(st.lists(GAPS, min_size=count, max_size=count))
    return "".join(part for pair in zip(gaps, tokens, strict=False) for part in pair) + gaps[-1]


PROGRAMS = TEXTS.flatmap(spaced)
"""Whole texts."""
