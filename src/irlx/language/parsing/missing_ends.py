"""Blocks that are not closed, or closed by a word that belongs to another."""

from __future__ import annotations

from irlx.diagnostics import Related, Span
from irlx.language.lexing import token_span
from irlx.language.parsing.blocks import BRANCH_WORDS, CLOSERS
from irlx.language.parsing.driver import Driver, ParseStopped
from irlx.language.parsing.indentation import Hints
from irlx.language.parsing.machine import END
from irlx.language.parsing.wording import found_words

__all__ = [
    "branch_of_outer_block",
    "close_block",
    "end_of_file",
    "follow_hints",
    "missing_end_of_record",
    "missing_end_of_routine",
    "wrong_end_word",
]

_OPENER_OF = {closer: opener for opener, closer in CLOSERS.items()}
_MISTAKABLE = frozenset({"IF", "FOR", "WHILE", "CASE"})
_BRANCH_OF = {"ELSE": "IF", "ELSIF": "IF", "WHEN": "CASE", "DEFAULT": "CASE"}


def follow_hints(driver: Driver, hints: Hints) -> bool:
    """Do before the next token what the indentation asks for; True where the parse has moved on."""
    offset = driver.token.start_pos
    for opener in hints.missing.get(offset, ()):
        if not driver.blocks or driver.blocks[-1].start_pos != opener.start_pos:
            break
        _report_missing_end(driver)
        close_block(driver)
    token = driver.token
    if offset in hints.else_ifs and driver.following.type == "IF" and driver.machine.accepts("ELSIF"):
        driver.report("IRL125", token_span(token).to(token_span(driver.following)))
        driver.insert("ELSIF")
        driver.index += 2
        return True
    if offset in hints.extra and token.type in _OPENER_OF and not _closes_its_own(driver):
        _report_extra_end(driver)
        return True
    return False


def _closes_its_own(driver: Driver) -> bool:
    """Whether an END word closes the innermost block and stands as far left as it began."""
    if not driver.blocks:
        return False
    opener = driver.blocks[-1]
    return CLOSERS[opener.type] == driver.token.type and opener.column == driver.token.column


def missing_end_of_routine(driver: Driver) -> bool:
    """A routine whose END is missing before the next routine or the main BEGIN."""
    if driver.token.type not in ("BEGIN", "PROCEDURE", "FUNCTION") or not driver.blocks:
        return False
    opener = driver.blocks[-1].type
    if opener not in ("PROCEDURE", "FUNCTION") or not driver.machine.accepts(CLOSERS[opener]):
        return False
    _report_missing_end(driver)
    return close_block(driver)


def missing_end_of_record(driver: Driver) -> bool:
    """``= name`` after the fields of a record, without ENDRECORD before it."""
    if driver.token.type != "EQUAL" or not driver.blocks or driver.blocks[-1].type != "RECORD":
        return False
    if not _between_statements(driver):
        return False
    _report_missing_end(driver)
    return close_block(driver)


def branch_of_outer_block(driver: Driver) -> bool:
    """ELSE, ELSIF, WHEN or DEFAULT of a block further out: the END of the inner one is missing."""
    kind = driver.token.type
    if kind not in BRANCH_WORDS or not driver.blocks or not _between_statements(driver):
        return False
    openers = [block.type for block in driver.blocks]
    if openers[-1] == _BRANCH_OF[kind] or _BRANCH_OF[kind] not in openers:
        return False
    _report_missing_end(driver)
    return close_block(driver)


def wrong_end_word(driver: Driver) -> bool:
    """An END word that does not fit the innermost block: another END is missing, or it is one too many."""
    kind = driver.token.type
    if kind not in _OPENER_OF or not _between_statements(driver):
        return False
    openers = [block.type for block in driver.blocks]
    if _OPENER_OF[kind] not in openers:
        stands_for_another = openers and openers[-1] in _MISTAKABLE and not _is_closed_later(driver)
        if not stands_for_another:
            _report_extra_end(driver)
            return True
        _report_missing_end(driver)
        close_block(driver)
        driver.complete = False
        driver.index += 1
        if driver.at_boundary and driver.token.type == "SEMICOLON":
            driver.index += 1
        return True
    if openers[-1] == _OPENER_OF[kind]:
        return False
    _report_missing_end(driver)
    if not close_block(driver):
        raise ParseStopped
    return True


def end_of_file(driver: Driver) -> bool:
    """The text ends inside a block."""
    if driver.token.type != END or not driver.blocks or not _between_statements(driver):
        return False
    _report_missing_end(driver)
    raise ParseStopped


def _between_statements(driver: Driver) -> bool:
    return driver.at_boundary or driver.machine.accepts("SEMICOLON")


def _is_closed_later(driver: Driver) -> bool:
    """Whether the innermost block has its END further on."""
    opener = driver.blocks[-1].type
    depth = 0
    for index in range(driver.index, len(driver.tokens)):
        kind = driver.tokens[index].type
        if kind in ("ENDPROC", "ENDFCT", "ENDPROGRAM"):
            return False
        depth += (kind == opener) - (kind == CLOSERS[opener])
        if depth < 0:
            return True
    return False


def _report_extra_end(driver: Driver) -> None:
    """Report an END word that is too many, and leave it out with its ``;``.

    One in the place of a missing END is one mistake, which is told already.
    """
    kind, span = driver.token.type, token_span(driver.token)
    before = driver.findings[-1] if driver.findings else None
    instead = before is not None and before.code == "IRL107" and before.place == driver.place(span)
    if not instead:
        driver.report("IRL108", span, word=kind, opener=_OPENER_OF[kind])
    driver.complete = False
    driver.index += 1
    if kind == "UNTIL":
        while driver.token.type not in ("SEMICOLON", END) and not driver.on_new_line:
            driver.index += 1
    if driver.at_boundary and driver.token.type == "SEMICOLON":
        driver.index += 1


def _report_missing_end(driver: Driver) -> None:
    opener = driver.blocks[-1]
    line, _ = driver.source.line_and_column(opener.start_pos)
    related = Related(f"the {opener.type} that it has to close", driver.place(token_span(opener)))
    where = token_span(driver.token)
    if driver.token.type == END:
        where = Span(where.start, where.start)
    driver.report(
        "IRL107",
        where,
        related=(related,),
        closer=CLOSERS[opener.type],
        opener=opener.type,
        line=line,
        found=found_words(driver.token),
    )
    driver.complete = False


def close_block(driver: Driver) -> bool:
    """Put the END of the innermost block where it is missing; False where it does not fit."""
    if not driver.at_boundary and driver.machine.accepts("SEMICOLON"):
        driver.insert("SEMICOLON")
    opener = driver.blocks[-1].type
    kinds = {"REPEAT": ("UNTIL", "TRUE"), "RECORD": ("ENDRECORD", "EQUAL", "NAME")}.get(
        opener, (CLOSERS[opener],)
    )
    # `ENDRECORD` alone may be missing, with the `= name` of the type still there.
    if opener == "RECORD" and driver.token.type == "EQUAL":
        kinds = kinds[:1]
    if not driver.machine.accepts(*kinds) and driver.machine.accepts("BEGIN", *kinds):
        kinds = ("BEGIN", *kinds)
    if not driver.machine.accepts(*kinds):
        return False
    driver.insert(*kinds)
    if driver.token.type != "EQUAL" and driver.machine.accepts("SEMICOLON") and driver.blocks:
        driver.insert("SEMICOLON")
    return True
