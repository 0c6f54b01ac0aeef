"""A small engine for TextMate grammars whose patterns mean the same to Python, as far as irlx needs it.

Knows match, begin and end, captures, and includes of the repository. The engine of VS Code, where there
is one, gives the same (`tests/language/highlight/test_textmate.py`).
"""

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Rule:
    """A rule with its patterns compiled; `inside` is filled once all rules are there."""

    match: re.Pattern
    captures: dict
    name: str | None
    end: re.Pattern | None
    inside: list


class Grammar:
    """A grammar, ready to take texts apart."""

    def __init__(self, plain):
        self._repository = plain["repository"]
        self._known = {}
        self._rules = self._compiled(plain["patterns"])

    def _compiled(self, patterns):
        found = []
        for one in patterns:
            if "include" in one:
                name = one["include"].removeprefix("#")
                if name not in self._known:
                    self._known[name] = self._compiled(self._repository[name]["patterns"])
                found += self._known[name]
                continue
            begins = "begin" in one
            captures = one.get("beginCaptures" if begins else "captures", {})
            rule = Rule(
                re.compile(one["begin" if begins else "match"]),
                {int(group): capture["name"] for group, capture in captures.items()},
                one.get("name"),
                re.compile(one["end"]) if begins else None,
                [],
            )
            rule.inside.extend(self._compiled(one.get("patterns", [])))
            found.append(rule)
        return found

    def scopes(self, text):
        """The innermost scope of each character of a text, None where there is none; line ends included."""
        stack, found = [], []
        for line in text.split("\n"):
            found += self._line(line, stack)
            found.append(None)
        return found[:-1]

    def _line(self, line, stack):
        scopes = [stack[-1].name if stack else None] * len(line)
        seen, position = {}, 0
        while True:
            ends, rule, match = self._next(line, position, stack, seen)
            outer = stack[-1].name if stack else None
            start = match.start() if match else len(line)
            scopes[position:start] = [outer] * (start - position)
            if match is None:
                return scopes
            scopes[start : match.end()] = [rule.name] * (match.end() - start)
            for group, name in () if ends else rule.captures.items():
                scopes[match.start(group) : match.end(group)] = [name] * len(match[group] or "")
            if ends:
                stack.pop()
            elif rule.end is not None:
                stack.append(rule)
            elif match.end() == start:
                return scopes
            position = match.end()

    def _next(self, line, position, stack, seen):
        """The earliest match, an end before others: whether it is that of the innermost rule, rule, match."""
        ends, best, first = False, None, None
        if stack:
            best, first = stack[-1], self._found(stack[-1].end, line, position, seen)
            ends = first is not None
        for rule in stack[-1].inside if stack else self._rules:
            if first is not None and first.start() == position:
                break
            match = self._found(rule.match, line, position, seen)
            if match and (first is None or match.start() < first.start()):
                ends, best, first = False, rule, match
        return ends, best, first

    @staticmethod
    def _found(pattern, line, position, seen):
        """The first match from a position on; one that lies ahead still holds."""
        known = seen.get(pattern, False)
        if known is False or (known is not None and known.start() < position):
            known = seen[pattern] = pattern.search(line, position)
        return known
