"""Source text to tree: drives the machine and calls recovery where a token does not fit."""

from __future__ import annotations

import re
from dataclasses import dataclass

from irlx.diagnostics import Diagnostic, SourceText, Span
from irlx.language.builtins import MOVE_PARAMETERS
from irlx.language.lexing import Lexed, lex
from irlx.language.parsing.blocks import BRANCH_WORDS, CLOSERS, PART_WORDS
from irlx.language.parsing.driver import MAX_ERRORS, TRACKED, Driver, ParseStopped
from irlx.language.parsing.indentation import Hints, read_indentation
from irlx.language.parsing.machine import END
from irlx.language.parsing.missing_ends import follow_hints
from irlx.language.parsing.misspelling import misspelt_alone
from irlx.language.parsing.nesting import too_deep
from irlx.language.parsing.recovery import close_all, missing_semicolon, recover
from irlx.language.parsing.repairs import decimal_comma, ends_with_comma, number_with_comma
from irlx.language.token import Token
from irlx.language.tree import DataList, Module, Program

__all__ = ["Parse", "parse"]


@dataclass(frozen=True)
class Parse:
    """What a text gives: a tree, partial after a mistake or None, findings, and comments.

    `complete` is False where recovery left text out, so that what is missing proves nothing; `lexed` is the
    text split into words, as it was read.
    """

    tree: Program | Module | DataList | None
    findings: tuple[Diagnostic, ...]
    comments: tuple[Span, ...]
    complete: bool
    lexed: Lexed


_NO_HINTS = Hints()
_DOUBT = re.compile(r"(?:(?!\}|\*\))[\s\S])*")
_LINES_FOR_A_MISTAKE = 5
_STRUCTURE = frozenset({"IRL107", "IRL108"})
_ANY_NUMBER = 10 * MAX_ERRORS


def parse(source: SourceText) -> Parse:
    """Parse a text; never raises.

    Where there are mistakes, comments that hold the beginning of another one are ended early if code comes
    to light; where blocks do not fit each other, the text is read again as its indentation shows them.
    """
    found = _attempt(source, lex(source))
    in_signs = any(finding.is_error for finding in found.lexed.findings)
    if (found.errors or in_signs) and found.lexed.doubtful:
        other = _attempt(source, lex(source, trust_comments=False))
        if _is_code(source, other):
            found = other
    if any(finding.code in _STRUCTURE for finding in found.driver.findings):
        hints = read_indentation(found.driver.tokens)
        if hints:
            guided = _attempt(source, found.lexed, hints)
            if hints.trustworthy or guided.errors <= found.errors:
                found = guided
    return found.result()


@dataclass(frozen=True)
class _Attempt:
    """One reading of a text; `errors` counts the mistakes the parser met."""

    lexed: Lexed
    driver: Driver
    told: tuple[Diagnostic, ...]

    @property
    def errors(self) -> int:
        return sum(finding.is_error for finding in self.told)

    def result(self) -> Parse:
        lexed, driver = self.lexed, self.driver
        findings = _first_errors([*lexed.findings, *self.told])
        complete = driver.complete and not lexed.torn
        return Parse(driver.machine.result, findings, lexed.comments, complete, lexed)


def _is_code(source: SourceText, attempt: _Attempt) -> bool:
    """Whether what was in doubtful comments before is code: few mistakes for its length."""
    in_doubt = [_lines(source, _DOUBT.match(source.text, span.end)) for span in attempt.lexed.torn]
    lines = sum(len(exposed) for exposed in in_doubt)
    errors = sum(any(f.place and f.place.line in exposed for exposed in in_doubt) for f in attempt.told)
    return errors <= 1 + lines // _LINES_FOR_A_MISTAKE


def _lines(source: SourceText, exposed: re.Match[str] | None) -> range:
    """Numbers of the lines behind the first one of a stretch of text."""
    if exposed is None:
        return range(0)
    first, last = (source.line_and_column(offset)[0] for offset in exposed.span())
    return range(first + 1, last + 1)


def _attempt(source: SourceText, lexed: Lexed, hints: Hints = _NO_HINTS) -> _Attempt:
    driver = Driver(source, lexed.tokens)
    try:
        _run(driver, hints)
    except ParseStopped:
        close_all(driver)
    tree = driver.machine.result
    deep = too_deep(tree, driver) if tree is not None else None
    if deep is not None:
        driver.machine.result = None
        driver.findings.append(deep)
    return _Attempt(lexed, driver, tuple(_without_consequences(lexed, driver)))


def _first_errors(findings: list[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Findings in the order of the text, no more errors than one wants to read."""
    findings.sort(key=lambda f: f.place.span.start if f.place is not None and f.place.span else 0)
    errors = 0
    kept: list[Diagnostic] = []
    for finding in findings:
        errors += finding.is_error
        if errors > MAX_ERRORS or len(kept) > _ANY_NUMBER:
            break
        kept.append(finding)
    return tuple(kept)


def _without_consequences(lexed: Lexed, driver: Driver) -> list[Diagnostic]:
    """Findings of the parser without those that follow from a mistake found before.

    A comment without end and a sign without meaning tear their lines apart.
    """
    text = driver.source
    torn: set[int] = set()
    for span in lexed.torn:
        first, last = (text.line_and_column(offset)[0] for offset in (span.start, span.end))
        torn.update(range(first, last + 1))
        # What such a comment has swallowed at the end of the text is not missing.
        if not text.text[span.end :].strip():
            torn.add(text.line_count)

    def stands_alone(finding: Diagnostic) -> bool:
        return finding.place is None or finding.place.line not in torn

    return [finding for finding in driver.findings if stands_alone(finding)] if torn else driver.findings


def _run(driver: Driver, hints: Hints) -> None:
    machine, tokens, guided = driver.machine, driver.tokens, bool(hints)
    feed, shifted = machine.feed, driver.shifted
    while True:
        if guided and follow_hints(driver, hints):
            continue
        token = tokens[driver.index]
        kind = token.type
        if kind in _LOOKED_AT and _looked_at(driver, kind):
            continue
        # A word that ends a block makes the machine reduce the block even where the word is wrong,
        # and what has been reduced cannot be continued.
        if kind in _REDUCING and not machine.accepts(kind):
            recover(driver)
        elif feed(token):
            if kind == END:
                return
            if driver.at_boundary or kind in TRACKED:
                shifted(token)
            driver.index += 1
        else:
            recover(driver)


_REDUCING = PART_WORDS | BRANCH_WORDS | frozenset(CLOSERS.values()) | {END}
_OPEN_ENDED = frozenset({"MOVE", "MOVE_INC", "RETURN"})
_LOOKED_AT = frozenset({"NAME", "SEMICOLON", "COMMA"})


def _looked_at(driver: Driver, kind: str) -> bool:
    """Mistakes that the grammar lets pass; True where the parse has moved on."""
    if kind == "NAME":
        previous = driver.previous
        if previous is not None and previous.type == "COMMA":
            return driver.depth == 0 and driver.on_new_line and _new_after_comma(driver)
        if driver.head in _OPEN_ENDED and _begins_statement(driver):
            missing_semicolon(driver)
    elif kind == "SEMICOLON":
        alone = (
            driver.head == "NAME" and driver.index == driver.statement_index + 1 and not driver.at_boundary
        )
        return alone and driver.machine.accepts(kind) and misspelt_alone(driver)
    elif driver.depth == 0 and number_with_comma(driver) and not _may_part_values(driver):
        return decimal_comma(driver)
    return False


def _new_after_comma(driver: Driver) -> bool:
    """Whether a name on a new line begins something of its own although a comma stands before it."""
    following = driver.following.type
    if driver.head in ("MOVE", "MOVE_INC") and following == "ASSIGN":
        new = not _may_be_parameter(driver)
    elif driver.head in ("MOVE", "MOVE_INC"):
        new = _is_assignment(driver.tokens, driver.index)
    else:
        new = following == "COLON" and driver.head not in ("WHEN", "CASE")
    return new and ends_with_comma(driver)


def _may_part_values(driver: Driver) -> bool:
    """Whether a number may follow the comma: none does in a list of variables, or behind ``SPEED := 0``."""
    if driver.head in _OPEN_ENDED and any(token.type == "ASSIGN" for token in driver.statement_tokens):
        return False
    return driver.machine.accepts("COMMA", driver.following.type)


def _begins_statement(driver: Driver) -> bool:
    """Whether a name on a new line begins a statement although it could go on with a MOVE or RETURN."""
    if driver.at_boundary or not driver.on_new_line or not driver.machine.accepts("SEMICOLON"):
        return False
    if driver.head == "RETURN":
        return _is_assignment(driver.tokens, driver.index)
    if driver.following.type == "ASSIGN":
        return not _may_be_parameter(driver)
    return True


def _may_be_parameter(driver: Driver) -> bool:
    """Whether ``name :=`` may be a parameter of the MOVE before it, or of a criterion in it."""
    if any(token.type == "CRITERION" for token in driver.statement_tokens):
        return True
    return driver.token.casefold() in MOVE_PARAMETERS


def _is_assignment(tokens: list[Token], index: int) -> bool:
    """Whether the tokens from a name on are a designator and ``:=``."""
    depth = 0
    for position in range(index + 1, len(tokens)):
        token = tokens[position]
        if token.type == "LEFT_BRACKET":
            depth += 1
        elif token.type == "RIGHT_BRACKET":
            depth -= 1
        elif depth == 0 and token.type not in ("DOT", "NAME"):
            return token.type == "ASSIGN"
        elif token.type in ("SEMICOLON", END):
            return False
    return False
