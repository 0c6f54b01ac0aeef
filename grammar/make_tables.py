"""Compiles the grammar: writes the LALR tables that the parser reads from `grammar/irl.lark`.

python grammar/make_tables.py           # rewrites grammar/irl.tables.json
python grammar/make_tables.py --check   # exit code 1 where it is not up to date

Lark is needed here and in tests, not where irlx runs. The file holds the names of all symbols; the rules,
each with its symbol, the length of its right side, the method of the tree builder that takes it (none: the
value of its only child stays, or a list is spliced in elsewhere) and the places of children that are spliced
in; and a row a state, pairs of symbol and action: a state to go to, or -1 - rule to reduce by.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import deque
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lark import Lark, Token
from lark.parsers.lalr_analysis import Shift

from irlx.language.grammar_text import grammar_text
from irlx.language.keywords import keyword_table

FILE = Path(__file__).resolve().with_name("irl.tables.json")


class _KeepForParser:
    """Names the terminals that no rule mentions; irlx takes them out of the stream itself."""

    always_accept = ("COMMENT", "WRONG_CHARACTER", "FOREIGN_COMMENT", "FOREIGN_SIGN", "FOREIGN_QUOTES")

    def process(self, stream: Iterator[Token]) -> Iterator[Token]:
        """Leaves the stream as it is."""
        return stream


def build_grammar(*, debug: bool = False, transformer: Any = None) -> Lark:
    """Compile the grammar from its text; `debug` makes Lark log every conflict."""
    table = keyword_table()

    def retype(token: Token) -> Token:
        token.type = table.get(token.casefold(), token.type)
        return token

    return Lark(
        grammar_text(),
        parser="lalr",
        lexer="basic",
        keep_all_tokens=True,
        maybe_placeholders=False,
        postlex=_KeepForParser(),
        lexer_callbacks={"NAME": retype},
        transformer=transformer,
        debug=debug,
    )


def _inlined(symbol: Any) -> bool:
    """Whether the children of a symbol stand in its place in the rules that use it."""
    return not symbol.is_term and symbol.name.startswith("_")


def _rule(rule: Any) -> list[Any]:
    """Symbol, length, method and spliced children of a rule."""
    inlined = [place for place, symbol in enumerate(rule.expansion) if _inlined(symbol)]
    method = None if _inlined(rule.origin) else rule.alias or rule.origin.name
    if rule.options.expand1 and not rule.alias:
        if len(rule.expansion) != 1 or inlined:
            raise NotImplementedError(f"{rule}: give what is no unit rule a name with ->")
        method = None
    return [rule.origin.name, len(rule.expansion), method, inlined]


def tables() -> str:
    """Text of the file; states are numbered as they are met, so that it is the same each time."""
    conf = build_grammar().parse_interactive().parser_state.parse_conf
    numbers, waiting, rows = {conf.start_state: 0}, deque([conf.start_state]), []
    rules: dict[Any, int] = {}
    symbols = sorted({symbol for row in conf.states.values() for symbol in row})
    while waiting:
        row = []
        for symbol, (action, argument) in sorted(conf.states[waiting.popleft()].items()):
            if action is Shift:
                if argument not in numbers:
                    numbers[argument] = len(numbers)
                    waiting.append(argument)
                row += [symbols.index(symbol), numbers[argument]]
            else:
                row += [symbols.index(symbol), -1 - rules.setdefault(argument, len(rules))]
        rows.append(row)
    parts = {"symbols": symbols, "rules": [_rule(rule) for rule in rules], "rows": rows}
    lines = [f'"end": {numbers[conf.end_state]}']
    for name, values in parts.items():
        entries = ",\n".join(json.dumps(value, separators=(",", ":")) for value in values)
        lines.append(f'"{name}": [\n{entries}\n]')
    return "{\n" + ",\n".join(lines) + "\n}\n"


def main() -> None:
    """Write the file, or compare."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--check", action="store_true", help="compare only")
    text = tables()
    if not parser.parse_args().check:
        FILE.write_text(text, encoding="utf-8")
    elif not FILE.is_file() or FILE.read_text(encoding="utf-8") != text:
        sys.exit(f"{FILE.name} is not up to date: python grammar/make_tables.py")


if __name__ == "__main__":
    main()
