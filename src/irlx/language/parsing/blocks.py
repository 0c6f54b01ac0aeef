"""Which words open and close what; the parser keeps the open ones to explain missing ends."""

from __future__ import annotations

__all__ = [
    "BOUNDARIES",
    "BRANCH_WORDS",
    "CLOSERS",
    "COMPOUND_HEADS",
    "PART_WORDS",
    "STATEMENT_WORDS",
    "is_end_word",
]

CLOSERS = {
    "PROGRAM": "ENDPROGRAM",
    "MODULE": "ENDMODULE",
    "DATALIST": "ENDDATALIST",
    "PROCEDURE": "ENDPROC",
    "FUNCTION": "ENDFCT",
    "RECORD": "ENDRECORD",
    "IF": "ENDIF",
    "CASE": "ENDCASE",
    "FOR": "ENDFOR",
    "WHILE": "ENDWHILE",
    "REPEAT": "UNTIL",
}

# After these a statement or declaration may begin, so the parser can come back here after a mistake.
BOUNDARIES = frozenset(
    {"SEMICOLON", "BEGIN", "THEN", "ELSE", "DO", "OF", "REPEAT", "VAR", "CONST", "TYPE", "RECORD"}
)

# A mistake between such a word and the end of its head is mended by putting this head in its place.
COMPOUND_HEADS = {
    "IF": ("IF", "NAME", "THEN"),
    "ELSIF": ("ELSIF", "NAME", "THEN"),
    "WHILE": ("WHILE", "NAME", "DO"),
    "FOR": ("FOR", "NAME", "ASSIGN", "NAME", "TO", "NAME", "DO"),
    "CASE": ("CASE", "NAME", "OF"),
    "WHEN": ("WHEN", "NAME", "COLON"),
    "UNTIL": ("UNTIL", "NAME", "SEMICOLON"),
    "PROGRAM": ("PROGRAM", "NAME", "SEMICOLON"),
    "MODULE": ("MODULE", "NAME", "SEMICOLON"),
    "DATALIST": ("DATALIST", "NAME", "SEMICOLON"),
    "PROCEDURE": ("PROCEDURE", "NAME", "SEMICOLON"),
    "FUNCTION": ("FUNCTION", "NAME", "COLON", "NAME", "SEMICOLON"),
    "ENDRECORD": ("ENDRECORD", "EQUAL", "NAME", "SEMICOLON"),
    "ENDIF": ("ENDIF", "SEMICOLON"),
    "ENDCASE": ("ENDCASE", "SEMICOLON"),
    "ENDFOR": ("ENDFOR", "SEMICOLON"),
    "ENDWHILE": ("ENDWHILE", "SEMICOLON"),
    "ENDPROC": ("ENDPROC", "SEMICOLON"),
    "ENDFCT": ("ENDFCT", "SEMICOLON"),
}

STATEMENT_WORDS = frozenset(
    [
        "RETURN",
        "GOTO",
        "IF",
        "CASE",
        "FOR",
        "WHILE",
        "REPEAT",
        "EXIT",
        "HALT",
        "PAUSE",
        "WAIT",
        "MOVE",
        "MOVE_INC",
        "FREEZESTART",
        "CYCLICSTART",
        "OBSTACLE",
        "RECONFIGURATION",
        "CRITERION",
        "JOINTLIMIT",
        "JOINTSPEEDLIMIT",
        "JOINTACCELLIMIT",
    ]
)
PART_WORDS = frozenset(
    [
        "SYSTEM",
        "FROM",
        "IMPORT",
        "EXPORT",
        "ROBOT",
        "STANDARD_IN",
        "STANDARD_OUT",
        "CONST",
        "TYPE",
        "VAR",
        "PROCEDURE",
        "FUNCTION",
        "BEGIN",
    ]
)
BRANCH_WORDS = frozenset({"ELSE", "ELSIF", "WHEN", "DEFAULT"})


def is_end_word(kind: str) -> bool:
    """Whether a missing ``;`` before this word is forgiven."""
    return kind.startswith("END") or kind.endswith("END") or kind == "UNTIL"
