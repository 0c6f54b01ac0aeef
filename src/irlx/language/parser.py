"""Source text to tree: drives the machine and calls recovery where a token does not fit."""

from __future__ import annotations

from dataclasses import dataclass

from lark import Token

from irlx.diagnostics import Diagnostic, SourceText, Span
from irlx.language.builtins import MOVE_PARAMETERS
from irlx.language.lexing import Lexed, lex
from irlx.language.parsing.blocks import BRANCH_WORDS, CLOSERS, PART_WORDS
from irlx.language.parsing.driver import Driver, ParseStopped
from irlx.language.parsing.machine import END
from irlx.language.parsing.nesting import too_deep
from irlx.language.parsing.recovery import close_all, missing_semicolon, recover
from irlx.language.tree import DataList, Module, Program

__all__ = ["Parse", "parse"]


@dataclass(frozen=True)
class Parse:
    """What a text gives: a tree, partial after a mistake or None, findings, and comments.

    `complete` is False where recovery left text out, so that what is missing proves nothing.
    """

    tree: Program | Module | DataList | None
    findings: tuple[Diagnostic, ...]
    comments: tuple[Span, ...]
    complete: bool


def parse(source: SourceText) -> Parse:
    """Parse a text; never raises."""
    lexed = lex(source)
    driver = Driver(source, lexed.tokens)
    try:
        _run(driver)
    except ParseStopped:
        close_all(driver)
    tree = driver.machine.result
    deep = too_deep(tree, driver) if tree is not None else None
    if deep is not None:
        tree = None
        driver.findings.append(deep)
    findings = (*lexed.findings, *_without_consequences(lexed, driver))
    complete = driver.complete and not any(finding.is_error for finding in findings)
    return Parse(tree, findings, lexed.comments, complete)


def _without_consequences(lexed: Lexed, driver: Driver) -> list[Diagnostic]:
    """Findings of the parser without those that follow from a mistake found before.

    A comment without end makes the text end early; a sign without meaning tears its line apart.
    """
    end = len(driver.source.text) if any(f.code == "IRL110" for f in lexed.findings) else None
    torn = {f.place.line for f in lexed.findings if f.code == "IRL112" and f.place}

    def stands_alone(finding: Diagnostic) -> bool:
        place = finding.place
        if place is None or place.span is None:
            return True
        return place.line not in torn and (end is None or place.span.start < end)

    return [finding for finding in driver.findings if stands_alone(finding)]


def _run(driver: Driver) -> None:
    machine, tokens = driver.machine, driver.tokens
    while True:
        token = tokens[driver.index]
        if token.type == "NAME" and driver.head in _OPEN_ENDED and _begins_statement(driver):
            missing_semicolon(driver)
        # A word that ends a block makes the machine reduce the block even where the word is wrong,
        # and what has been reduced cannot be continued.
        if token.type in _REDUCING and not machine.accepts(token.type):
            recover(driver)
        elif machine.feed(token):
            if token.type == END:
                return
            driver.shifted(token)
            driver.index += 1
        else:
            recover(driver)


_REDUCING = PART_WORDS | BRANCH_WORDS | frozenset(CLOSERS.values()) | {END}
_OPEN_ENDED = frozenset({"MOVE", "MOVE_INC", "RETURN"})


def _begins_statement(driver: Driver) -> bool:
    """Whether a name on a new line begins a statement although it could go on with a MOVE or RETURN."""
    if driver.at_boundary or not driver.on_new_line or not driver.machine.accepts("SEMICOLON"):
        return False
    if driver.head == "RETURN":
        return _is_assignment(driver.tokens, driver.index)
    if driver.following.type == "ASSIGN":
        if any(token.type == "CRITERION" for token in driver.statement_tokens):
            return False
        return driver.token.casefold() not in MOVE_PARAMETERS
    return True


def _is_assignment(tokens: tuple[Token, ...], index: int) -> bool:
    """Whether the tokens from a name on are a designator and ``:=``."""
    depth = 0
    for token in tokens[index + 1 :]:
        if token.type == "LEFT_BRACKET":
            depth += 1
        elif token.type == "RIGHT_BRACKET":
            depth -= 1
        elif depth == 0 and token.type not in ("DOT", "NAME"):
            return token.type == "ASSIGN"
        elif token.type in ("SEMICOLON", END):
            return False
    return False
