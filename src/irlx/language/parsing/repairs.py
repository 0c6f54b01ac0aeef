"""Mistakes that one token too few, too many or of the wrong kind makes."""

from __future__ import annotations

import re

from irlx.diagnostics import Span
from irlx.language.keywords import NAMES_TOO
from irlx.language.lexing import token_span
from irlx.language.parsing.blocks import STATEMENT_WORDS
from irlx.language.parsing.driver import Driver
from irlx.language.parsing.machine import END
from irlx.language.parsing.wording import construct, expected_words, found_words, sign_or_word
from irlx.language.token import Token

__all__ = [
    "comma_for_semicolon",
    "decimal_comma",
    "ends_with_comma",
    "equals_for_assignment",
    "keyword_as_name",
    "missing_begin",
    "missing_parentheses",
    "missing_then_or_do",
    "missing_token",
    "number_with_comma",
    "superfluous_token",
]

# In the order in which they are tried where several would do.
_INSERTABLE = ("THEN", "DO", "OF", "COLON", "ASSIGN", "EQUAL", "SEC", "AT", "IMPORT", "TO")
_BETWEEN_VALUES = ("COMMA", *_INSERTABLE)
_STARTS = STATEMENT_WORDS | {
    "CYCLICEND",
    "FREEZEEND",
    "OBSTACLEEND",
    "CRITERIONEND",
    "JOINTLIMITEND",
    "JOINTSPEEDLIMITEND",
    "JOINTACCELLIMITEND",
}
_GOES_ON = frozenset({"ASSIGN", "LEFT_PAREN", "LEFT_BRACKET", "DOT", "SEMICOLON"})
_BODY_ENDS = frozenset({"ENDPROC", "ENDFCT", "ENDPROGRAM", "PROCEDURE", "FUNCTION", END})
_MOST_PARENS = 8
_THOUSANDS = re.compile(r"[0-9]{1,3}\.[0-9]{3}")


def equals_for_assignment(driver: Driver) -> bool:
    """``=`` where a value is set."""
    if driver.token.type != "EQUAL" or not driver.machine.accepts("ASSIGN"):
        return False
    driver.report("IRL105", token_span(driver.token))
    sign = driver.token
    driver.take(Token("ASSIGN", ":=", start_pos=sign.start_pos, end_pos=sign.end_pos, line=sign.line))
    driver.index += 1
    return True


def missing_then_or_do(driver: Driver) -> bool:
    """IF without THEN and WHILE without DO, which is forgiven."""
    kind = driver.token.type
    if driver.head not in ("IF", "ELSIF", "WHILE") or (kind != "NAME" and kind not in _STARTS):
        return False
    same_line_name = kind == "NAME" and not driver.on_new_line
    after = (driver.following.type,) if same_line_name else ()
    word = "DO" if driver.head == "WHILE" else "THEN"
    if not driver.machine.accepts(word, kind, *after):
        return False
    end = driver.previous_end
    driver.report("IRL104", Span(end, end), word=word, head=driver.head)
    driver.insert(word)
    return True


def missing_token(driver: Driver) -> bool:
    """A sign or word is missing before the next token, which together with the one behind it would fit."""
    kinds, expected = _ahead(driver, 2), driver.machine.expected()
    for kind in _BETWEEN_VALUES if driver.depth > 0 else _INSERTABLE:
        # Where a value is wanted, SEC would be a name, and `=` a comparison.
        other_meaning = (kind in NAMES_TOO and "NAME" in expected) or (kind == "EQUAL" and "LESS" in expected)
        if kind in expected and not other_meaning and driver.machine.accepts(kind, *kinds):
            _report_missing(driver, kind)
            driver.insert(kind)
            return True
    return False


def missing_parentheses(driver: Driver) -> bool:
    """``)`` or ``]`` is missing, or stands where nothing is open."""
    kind = driver.token.type
    if driver.depth <= 0:
        if kind not in ("RIGHT_PAREN", "RIGHT_BRACKET") or not driver.machine.accepts(*_ahead(driver, 2)[1:]):
            return False
        word, opener = ("')'", "'('") if kind == "RIGHT_PAREN" else ("']'", "'['")
        driver.report("IRL108", token_span(driver.token), word=word, opener=opener)
        driver.index += 1
        return True
    for closing in ("RIGHT_PAREN", "RIGHT_BRACKET"):
        for count in range(1, min(driver.depth, _MOST_PARENS) + 1):
            if driver.machine.accepts(*[closing] * count, kind):
                _report_missing(driver, closing)
                driver.insert(*[closing] * count)
                return True
    return False


def _report_missing(driver: Driver, kind: str) -> None:
    end = driver.previous_end
    driver.report("IRL120", Span(end, end), word=sign_or_word(kind), found=found_words(driver.token))


def _ahead(driver: Driver, count: int) -> list[str]:
    """Kinds of the next tokens, up to the end of the file."""
    return [token.type for token in driver.tokens[driver.index : driver.index + count]]


def superfluous_token(driver: Driver) -> bool:
    """A token that stands in the way: without it the next three would fit."""
    kinds = _ahead(driver, 4)[1:]
    if len(kinds) < 3 or driver.at_boundary or not driver.machine.accepts(*kinds):
        return False
    expected = expected_words(driver.machine.expected())
    driver.report("IRL101", token_span(driver.token), expected=expected, found=found_words(driver.token))
    driver.complete = False
    driver.index += 1
    return True


def decimal_comma(driver: Driver) -> bool:
    """``1,5`` where no list is: written without blanks, it is a number."""
    number = number_with_comma(driver)
    if not number:
        return False
    driver.report("IRL124", token_span(driver.token), number=number)
    driver.index += 2
    return True


def number_with_comma(driver: Driver) -> str:
    """The number that the tokens before and behind the next one make where that is its comma, else ''.

    Also ``1.000,5``, with a point between thousands.
    """
    before, comma, after = driver.previous, driver.token, driver.following
    if comma.type != "COMMA" or before is None or after.type != "INT":
        return ""
    whole = before.replace(".", "") if _THOUSANDS.fullmatch(before) else before
    if before.end_pos != comma.start_pos or comma.end_pos != after.start_pos or not whole.isdecimal():
        return ""
    return f"{whole}.{after}"


def comma_for_semicolon(driver: Driver) -> bool:
    """``,`` at the end of a line where a list cannot go on but the statement may end."""
    if driver.token.type == "COMMA":
        if not driver.machine.accepts("SEMICOLON", driver.following.type):
            return False
        driver.index += 1
        if not driver.on_new_line:
            driver.index -= 1
            return False
        driver.index -= 1
        return _as_semicolon(driver, driver.token)
    previous = driver.previous
    if previous is None or previous.type != "COMMA" or not driver.on_new_line:
        return False
    return ends_with_comma(driver)


def ends_with_comma(driver: Driver) -> bool:
    """Take the comma that has been taken last for a ``;``, where the next token fits then."""
    comma = driver.previous
    if comma is None or driver.depth > 0 or driver.machine.last is not comma:
        return False
    undone = driver.machine.snapshot(without_last=1)
    if not driver.machine.accepts_from(undone, "SEMICOLON", *_ahead(driver, 2)):
        return False
    driver.machine.restore(undone)
    driver.index -= 1
    return _as_semicolon(driver, comma)


def _as_semicolon(driver: Driver, comma: Token) -> bool:
    driver.report("IRL122", token_span(comma), construct=construct(driver.statement_tokens))
    driver.take(Token("SEMICOLON", ";", comma.start_pos, comma.end_pos, comma.line))
    driver.index += 1
    return True


def missing_begin(driver: Driver) -> bool:
    """Statements where only declarations fit, and no BEGIN follows."""
    kind = driver.token.type
    if driver.at_boundary:
        fits = kind in _STARTS or (kind == "NAME" and driver.following.type in _GOES_ON)
        if not fits or not driver.machine.accepts("BEGIN", kind) or _begin_follows(driver):
            return False
    else:
        statement = driver.statement_tokens
        if len(statement) != 1 or statement[0].type != "NAME" or kind not in _GOES_ON:
            return False
        if not driver.accepts_at_start("BEGIN", "NAME", kind) or _begin_follows(driver):
            return False
        driver.roll_back()
        driver.index = driver.statement_index
    end = driver.previous_end
    driver.report("IRL120", Span(end, end), word="BEGIN", found="the first statement")
    driver.insert("BEGIN")
    return True


def _begin_follows(driver: Driver) -> bool:
    for index in range(driver.index, len(driver.tokens)):
        kind = driver.tokens[index].type
        if kind == "BEGIN" or kind in _BODY_ENDS:
            return kind == "BEGIN"
    return False


def keyword_as_name(driver: Driver) -> bool:
    """A keyword where a name is wanted; each is told once, for it may be used all over the program."""
    token = driver.token
    if token.type in ("NAME", END) or not token[0].isalpha():
        return False
    if driver.on_new_line and driver.following.type != "ASSIGN":
        return False
    if not driver.machine.accepts("NAME", driver.following.type):
        return False
    if token.type not in driver.keywords_as_names:
        driver.keywords_as_names.add(token.type)
        driver.report("IRL106", token_span(token), word=token.type)
    driver.complete = False
    driver.take(Token("NAME", "", start_pos=token.start_pos, end_pos=token.end_pos, line=token.line))
    driver.index += 1
    return True
