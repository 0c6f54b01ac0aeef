"""The kinds of pieces that a program text consists of."""

from __future__ import annotations

from enum import Enum


class Kind(Enum):
    """What a piece of a text is, as far as the text around it tells; nothing is looked up in declarations."""

    SPACE = "space"
    COMMENT = "comment"
    INSTRUCTION = "comment that speaks to irlx"
    DECLARATION = "keyword of program parts"
    CONTROL = "keyword of statements"
    MOTION = "keyword of motion"
    REDUNDANCY = "keyword of the redundancy extension"
    WORD_OPERATOR = "operator that is a word"
    CONSTANT = "TRUE or FALSE"
    INT = "whole number"
    REAL = "number"
    STRING = "text"
    OPERATOR = "operator"
    PUNCTUATION = "sign between parts"
    TYPE = "predefined type"
    OWN_TYPE = "type of the program"
    FUNCTION = "predefined function"
    PROCEDURE = "predefined procedure"
    SYSTEM_VARIABLE = "system variable"
    PORT = "port known by its name"
    CHANNEL = "standard channel"
    PARAMETER = "parameter of a move or a criterion"
    ROUTINE = "routine where it is declared or called"
    PART = "program, module or data list"
    LABEL = "label"
    FIELD = "field behind a dot"
    NAME = "any other name"
    WRONG = "what no program has"
