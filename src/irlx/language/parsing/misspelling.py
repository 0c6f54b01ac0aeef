"""Keywords that are misspelt, which the lexer takes for names."""

from __future__ import annotations

from difflib import get_close_matches
from functools import lru_cache

from irlx.language.builtins import PROCEDURES, TYPES
from irlx.language.keywords import keyword_table
from irlx.language.lexing import token_span
from irlx.language.parsing.blocks import CLOSERS
from irlx.language.parsing.driver import Driver
from irlx.language.parsing.machine import END
from irlx.language.token import Token

__all__ = ["end_of_something", "misspelt_alone", "misspelt_here", "misspelt_start"]

_LEAST_LIKENESS = 0.75
_ALONE = frozenset(
    {
        "CYCLICSTART",
        "CYCLICEND",
        "FREEZEEND",
        "JOINTLIMITEND",
        "JOINTSPEEDLIMITEND",
        "JOINTACCELLIMITEND",
        "HALT",
        "PAUSE",
        "EXIT",
        "RETURN",
        *CLOSERS.values(),
    }
)


@lru_cache(maxsize=1024)
def _near(fold: str, words: frozenset[str]) -> list[str]:
    """Words like a casefolded name, the likeliest first, those with its letters in another order before."""
    by_fold = {word.casefold(): word for word in sorted(words)}
    close = get_close_matches(fold, list(by_fold), n=3, cutoff=_LEAST_LIKENESS)
    mixed = [word for word in by_fold if len(word) == len(fold) > 2 and sorted(word) == sorted(fold)]
    return [by_fold[word] for word in dict.fromkeys([*mixed, *close])]


@lru_cache(maxsize=1)
def _keywords() -> frozenset[str]:
    return frozenset(keyword_table().values())


def misspelt_start(driver: Driver) -> bool:
    """A statement begins with a name that should be a keyword: ``MOV LIN p``."""
    statement = driver.statement_tokens
    if len(statement) != 1 or statement[0].type != "NAME" or driver.at_boundary or driver.depth:
        return False
    name = statement[0]
    fold = name.casefold()
    if fold in TYPES or fold in PROCEDURES or fold in driver.declared_words:
        return False
    for word in _near(fold, _keywords()):
        if driver.accepts_at_start(word, driver.token.type):
            driver.replace_start(word)
            _report(driver, name, word)
            return True
    return False


def misspelt_here(driver: Driver) -> bool:
    """A name stands where only keywords fit, one of which is like it: ``MOVE LN p``."""
    name = driver.token
    if name.type != "NAME":
        return False
    after = () if driver.following.type == END else (driver.following.type,)
    for word in _near(name.casefold(), driver.machine.expected() & _keywords()):
        if driver.machine.accepts(word, *after):
            _report(driver, name, word)
            driver.replace(word)
            return True
    return False


def misspelt_alone(driver: Driver) -> bool:
    """A call of nothing but a name, complete with its ``;``, that should be a keyword: ``CYCLICSTRAT;``."""
    name = driver.statement_tokens[0]
    fold = name.casefold()
    if fold in PROCEDURES or fold in driver.declared_words:
        return False
    if fold == "end":
        return end_of_something(driver)
    for word in _near(fold, _ALONE):
        if driver.accepts_at_start(word, driver.token.type):
            driver.replace_start(word)
            _report(driver, name, word)
            return True
    return False


def end_of_something(driver: Driver) -> bool:
    """``END``, alone or with a full stop or the word it ends behind it, for the word that ends a block."""
    statement = driver.statement_tokens
    if not statement or statement[0].casefold() != "end" or statement[0].type != "NAME" or not driver.blocks:
        return False
    if len(statement) > 2 or (len(statement) == 2 and statement[1].type != "DOT"):
        return False
    name, opener = statement[0], driver.blocks[-1].type
    last = driver.token.type == END or (driver.token.type == "DOT" and driver.following.type == END)
    word = CLOSERS[driver.blocks[0].type if last else opener]
    if word == "UNTIL":
        return False
    goes_on = driver.token.type == opener and not driver.on_new_line
    if len(statement) == 2 or driver.token.type == "DOT" or goes_on:
        # The full stop, or the word after END, belongs to it.
        del driver.tokens[driver.statement_index + 1]
    driver.replace_start(word)
    _report(driver, name, word)
    return True


def _report(driver: Driver, name: Token, word: str) -> None:
    driver.report("IRL121", token_span(name), name=str(name), word=word)
