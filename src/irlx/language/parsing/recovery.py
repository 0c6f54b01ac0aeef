"""What to do where a token does not fit: the likely mistakes first, then on to the next statement."""

from __future__ import annotations

from contextlib import suppress

from irlx.diagnostics import Span
from irlx.language.lexing import is_open_string, token_span
from irlx.language.parsing.blocks import (
    BRANCH_WORDS,
    CLOSERS,
    COMPOUND_HEADS,
    PART_WORDS,
    STATEMENT_WORDS,
    is_end_word,
)
from irlx.language.parsing.driver import Driver, ParseStopped
from irlx.language.parsing.machine import END
from irlx.language.parsing.missing_ends import (
    branch_of_outer_block,
    close_block,
    end_of_file,
    missing_end_of_record,
    missing_end_of_routine,
    wrong_end_word,
)
from irlx.language.parsing.misspelling import end_of_something, misspelt_here, misspelt_start
from irlx.language.parsing.repairs import (
    comma_for_semicolon,
    decimal_comma,
    equals_for_assignment,
    keyword_as_name,
    missing_begin,
    missing_parentheses,
    missing_then_or_do,
    missing_token,
    superfluous_token,
)
from irlx.language.parsing.wording import construct, expected_words, found_words

__all__ = ["close_all", "missing_semicolon", "recover"]

_COMPARISONS = frozenset({"EQUAL", "UNEQUAL", "LESS", "GREATER", "LESS_EQUAL", "GREATER_EQUAL"})
_RESUMING = STATEMENT_WORDS | PART_WORDS | BRANCH_WORDS | frozenset(CLOSERS.values())


def recover(driver: Driver) -> None:
    """Make the parse go on after the machine refused the next token; raises ParseStopped where it cannot."""
    for strategy in _STRATEGIES:
        if strategy(driver):
            return
    expected = expected_words(driver.machine.expected())
    driver.report("IRL101", token_span(driver.token), expected=expected, found=found_words(driver.token))
    _resume_at_next_statement(driver)


def missing_semicolon(driver: Driver) -> None:
    """Report a missing ``;`` at the end of the token before, and go on as if it stood there."""
    statement = driver.statement_tokens
    last = statement[-1].type if statement else ""
    after_obstacle_end = len(statement) == 2 and statement[0].type == "OBSTACLEEND"
    forgiven = last == "CYCLICSTART" or after_obstacle_end or is_end_word(driver.token.type)
    end = driver.previous_end
    driver.report("IRL103" if forgiven else "IRL102", Span(end, end), construct=construct(statement))
    driver.insert("SEMICOLON")


def _open_string(driver: Driver) -> bool:
    """A string without its end has been reported; its line says nothing more."""
    if not any(token.type == "STRING" and is_open_string(token) for token in driver.statement_tokens):
        return False
    if not driver.on_new_line:
        _resume_at_next_statement(driver)
        return True
    driver.complete = False
    driver.roll_back()
    if not driver.machine.accepts(driver.token.type):
        driver.index = _after(driver, "SEMICOLON", 0)
    return True


def _chained_comparison(driver: Driver) -> bool:
    if driver.token.type not in _COMPARISONS or not driver.machine.accepts("AND"):
        return False
    driver.report("IRL115", token_span(driver.token))
    _resume_at_next_statement(driver)
    return True


def _missing_semicolon_before(driver: Driver) -> bool:
    kind = driver.token.type
    if not driver.machine.accepts("SEMICOLON", kind) or kind in ("SEMICOLON", END):
        return False
    same_line_name = kind == "NAME" and not driver.on_new_line
    if same_line_name and not driver.machine.accepts("SEMICOLON", kind, driver.following.type):
        return False
    missing_semicolon(driver)
    return True


def _text_after_end(driver: Driver) -> bool:
    if not driver.machine.accepts(END):
        return False
    what = {"MODULE": "module", "DATALIST": "data list"}.get(driver.tokens[0].type, "program")
    driver.report("IRL109", token_span(driver.token), what=what, found=found_words(driver.token))
    raise ParseStopped


def _no_program(driver: Driver) -> bool:
    if driver.index:
        return False
    if driver.token.type == END:
        driver.report("IRL117", Span(0, 0))
    else:
        driver.report("IRL116", token_span(driver.token), found=found_words(driver.token))
    raise ParseStopped


_STRATEGIES = (
    _open_string,
    end_of_something,
    misspelt_here,
    misspelt_start,
    equals_for_assignment,
    _chained_comparison,
    decimal_comma,
    comma_for_semicolon,
    _missing_semicolon_before,
    missing_then_or_do,
    missing_begin,
    missing_end_of_record,
    missing_token,
    missing_parentheses,
    missing_end_of_routine,
    branch_of_outer_block,
    wrong_end_word,
    keyword_as_name,
    _text_after_end,
    _no_program,
    end_of_file,
    superfluous_token,
)


def close_all(driver: Driver) -> None:
    """Close what is open after the parse has stopped, so that the tree of what came before stays."""
    driver.complete = False
    if not driver.machine.accepts(END):
        if not (driver.at_boundary or driver.machine.accepts("SEMICOLON")):
            driver.roll_back()
        with suppress(ParseStopped):
            while driver.blocks and close_block(driver):
                pass
    driver.machine.feed(driver.tokens[-1])


def _resume_at_next_statement(driver: Driver) -> None:
    """Drop the statement with the mistake; the head of a compound statement is replaced by a sound one."""
    driver.complete = False
    head = driver.head if not driver.at_boundary else ""
    if driver.token.type == END:
        raise ParseStopped
    depth = driver.depth
    driver.roll_back()
    dummy = COMPOUND_HEADS.get(head)
    if dummy is not None:
        driver.index = _after(driver, dummy[-1], depth)
        driver.insert(*dummy)
        return
    driver.index = _after(driver, "SEMICOLON", 0)


def _after(driver: Driver, wanted: str, depth: int) -> int:
    """Index after the next `wanted`, or of a word before it that begins something new on its line."""
    for index in range(driver.index, len(driver.tokens)):
        token = driver.tokens[index]
        kind = token.type
        if kind == END:
            raise ParseStopped
        if kind == wanted and depth <= 0:
            return index + 1
        depth += (kind == "LEFT_PAREN") - (kind == "RIGHT_PAREN")
        new_line = index == 0 or (token.line or 0) > (driver.tokens[index - 1].line or 0)
        if new_line and kind in _RESUMING and (wanted != "SEMICOLON" or driver.machine.accepts(kind)):
            return index
        if kind == "SEMICOLON" and depth <= 0 and driver.tokens[index + 1].type != wanted:
            return index + 1
    raise ParseStopped
