"""What to do where a token does not fit: the likely mistakes first, then on to the next statement."""

from __future__ import annotations

from contextlib import suppress

from lark import Token

from irlx.diagnostics import Related, Span
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
from irlx.language.parsing.wording import construct, expected_words, found_words

__all__ = ["missing_semicolon", "recover"]

_COMPARISONS = frozenset({"EQUAL", "UNEQUAL", "LESS", "GREATER", "LESS_EQUAL", "GREATER_EQUAL"})
_OPENER_OF = {closer: opener for opener, closer in CLOSERS.items()}
_MISTAKABLE = frozenset({"IF", "FOR", "WHILE", "CASE"})
_RESUMING = STATEMENT_WORDS | PART_WORDS | BRANCH_WORDS | _OPENER_OF.keys()


def recover(driver: Driver) -> None:
    """Make the parse go on after the machine refused the next token; raises ParseStopped where it cannot."""
    strategies = (
        _open_string,
        _equals_for_assignment,
        _chained_comparison,
        _missing_semicolon_before,
        _missing_then_or_do,
        _missing_end_of_routine,
        _wrong_end_word,
        _keyword_as_name,
        _text_after_end,
        _no_program,
        _end_of_file,
    )
    for strategy in strategies:
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


def _equals_for_assignment(driver: Driver) -> bool:
    if driver.token.type != "EQUAL" or not driver.machine.accepts("ASSIGN"):
        return False
    driver.report("IRL105", token_span(driver.token))
    sign = driver.token
    driver.take(Token("ASSIGN", ":=", start_pos=sign.start_pos, end_pos=sign.end_pos, line=sign.line))
    driver.index += 1
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


def _missing_then_or_do(driver: Driver) -> bool:
    kind = driver.token.type
    if kind != "NAME" and kind not in STATEMENT_WORDS:
        return False
    same_line_name = kind == "NAME" and not driver.on_new_line
    after = (driver.following.type,) if same_line_name else ()
    for word in ("THEN", "DO"):
        if driver.machine.accepts(word, kind, *after):
            end = driver.previous_end
            driver.report("IRL104", Span(end, end), word=word, head=driver.head)
            driver.insert(word)
            return True
    return False


def _missing_end_of_routine(driver: Driver) -> bool:
    """A routine whose END is missing before the next routine or the main BEGIN."""
    if driver.token.type not in ("BEGIN", "PROCEDURE", "FUNCTION") or not driver.blocks:
        return False
    opener = driver.blocks[-1].type
    if opener not in ("PROCEDURE", "FUNCTION") or not driver.machine.accepts(CLOSERS[opener]):
        return False
    _report_missing_end(driver)
    return _close_block(driver)


def _wrong_end_word(driver: Driver) -> bool:
    """An END word that does not fit the innermost block: another END is missing, or it is one too many."""
    kind = driver.token.type
    if kind not in _OPENER_OF or not (driver.at_boundary or driver.machine.accepts("SEMICOLON")):
        return False
    openers = [block.type for block in driver.blocks]
    if _OPENER_OF[kind] not in openers:
        stands_for_another = openers and openers[-1] in _MISTAKABLE and not _is_closed_later(driver)
        if stands_for_another:
            _report_missing_end(driver)
            _close_block(driver)
        else:
            driver.report("IRL108", token_span(driver.token), word=kind, opener=_OPENER_OF[kind])
        driver.complete = False
        driver.index += 1
        if driver.at_boundary and driver.token.type == "SEMICOLON":
            driver.index += 1
        return True
    if openers[-1] == _OPENER_OF[kind]:
        return False
    _report_missing_end(driver)
    if not _close_block(driver):
        raise ParseStopped
    return True


def _is_closed_later(driver: Driver) -> bool:
    """Whether the innermost block has its END further on."""
    opener = driver.blocks[-1].type
    depth = 0
    for token in driver.tokens[driver.index :]:
        if token.type in ("ENDPROC", "ENDFCT", "ENDPROGRAM"):
            return False
        depth += (token.type == opener) - (token.type == CLOSERS[opener])
        if depth < 0:
            return True
    return False


def _report_missing_end(driver: Driver) -> None:
    opener = driver.blocks[-1]
    line, _ = driver.source.line_and_column(opener.start_pos or 0)
    related = Related(f"the {opener.type} that it has to close", driver.place(token_span(opener)))
    driver.report(
        "IRL107",
        token_span(driver.token),
        related=(related,),
        closer=CLOSERS[opener.type],
        opener=opener.type,
        line=line,
        found=found_words(driver.token),
    )
    driver.complete = False


def _close_block(driver: Driver) -> bool:
    """Put the END of the innermost block where it is missing; False where it does not fit."""
    if not driver.at_boundary and driver.machine.accepts("SEMICOLON"):
        driver.insert("SEMICOLON")
    opener = driver.blocks[-1].type
    kinds = {"REPEAT": ("UNTIL", "TRUE"), "RECORD": ("ENDRECORD", "EQUAL", "NAME")}.get(
        opener, (CLOSERS[opener],)
    )
    if not driver.machine.accepts(*kinds) and driver.machine.accepts("BEGIN", *kinds):
        kinds = ("BEGIN", *kinds)
    if not driver.machine.accepts(*kinds):
        return False
    driver.insert(*kinds)
    if driver.machine.accepts("SEMICOLON") and driver.blocks:
        driver.insert("SEMICOLON")
    return True


def _keyword_as_name(driver: Driver) -> bool:
    token = driver.token
    if token.type in ("NAME", END) or not token[0].isalpha() or driver.on_new_line:
        return False
    if not driver.machine.accepts("NAME", driver.following.type):
        return False
    driver.report("IRL106", token_span(token), word=token.type)
    driver.complete = False
    driver.take(Token("NAME", "", start_pos=token.start_pos, end_pos=token.end_pos, line=token.line))
    driver.index += 1
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


def _end_of_file(driver: Driver) -> bool:
    if driver.token.type != END or not driver.blocks:
        return False
    if not (driver.at_boundary or driver.machine.accepts("SEMICOLON")):
        return False
    _report_missing_end(driver)
    raise ParseStopped


def close_all(driver: Driver) -> None:
    """Close what is open after the parse has stopped, so that the tree of what came before stays."""
    driver.complete = False
    if not driver.machine.accepts(END):
        if not (driver.at_boundary or driver.machine.accepts("SEMICOLON")):
            driver.roll_back()
        with suppress(ParseStopped):
            while driver.blocks and _close_block(driver):
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
