"""Writes the grammar of the language reference from `grammar/irl.lark`.

python docs/reference/make_grammar.py           # rewrites the appendix of language.md
python docs/reference/make_grammar.py --check   # exit code 1 where it is not up to date
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
GRAMMAR = HERE.parent.parent / "grammar" / "irl.lark"
REFERENCE = HERE / "language.md"
BEGIN = "<!-- grammar: written by make_grammar.py -->\n"
END = "<!-- end of grammar -->\n"
WIDTH = 110

_RULE = re.compile(r"^[?!]?(?P<name>_?[a-z]\w*)\s*:\s*(?P<body>.*)$")
_TERMINAL = re.compile(r"^(?P<name>[A-Z]\w*)(?:\.-?\d+)?:\s*(?P<body>.*)$")
_WORD = re.compile(r"\"[^\"]*\"|[A-Za-z_]\w*|[()|?*+]")
# Terminals with a text of their own; what is in no program is left out.
_LEFT_OUT = ("WRONG_CHARACTER", "FOREIGN_")


def ebnf(grammar: str) -> str:
    """EBNF of a Lark grammar: rules in order, keywords in quotes, helper names and aliases taken off."""
    lines: list[str] = []
    keywords = set(re.findall(r"\w+", " ".join(re.findall(r"^%declare (.*)$", grammar, re.MULTILINE))))
    signs = dict(re.findall(r"^([A-Z_]+): (\"[^\"]+\")$", grammar, re.MULTILINE))
    for name, body in _definitions(grammar):
        if not name:
            lines += ["", f"(* {body} *)"]
        elif name in signs or name.startswith(_LEFT_OUT):
            continue
        elif name.isupper():
            lines.append(f"{name} = {body}")
        else:
            lines += _rule(name.lstrip("_"), body, keywords, signs)
    return "\n".join(lines).strip() + "\n"


def _definitions(grammar: str) -> list[tuple[str, str]]:
    """Names and bodies of rules and terminals in order; a heading has no name."""
    found: list[tuple[str, str]] = []
    for line in grammar.splitlines():
        heading = re.match(r"^// ---- ([^;:]*)", line)
        start = _RULE.match(line) or _TERMINAL.match(line)
        if heading:
            found.append(("", heading[1].strip()))
        elif start:
            found.append((start["name"], start["body"].strip()))
        elif line.startswith(" ") and found:
            name, body = found.pop()
            found.append((name, f"{body} {line.strip()}"))
    return found


def _rule(name: str, body: str, keywords: set[str], signs: dict[str, str]) -> list[str]:
    body = re.sub(r"\s*->\s*\w+", "", body)
    words = []
    for word in _WORD.findall(body):
        if word in keywords:
            words.append(f'"{word}"')
        else:
            words.append(signs.get(word, word if word.startswith('"') else word.lstrip("_")))
    text = " ".join(words)
    text = re.sub(r"\( ", "(", re.sub(r" (?=[)?*+])(?! )", "", re.sub(r" (?=[)?*+](?: |$))", "", text)))
    return _wrapped(f"{name} = {text}")


def _wrapped(text: str) -> list[str]:
    """Lines of a rule, broken between words."""
    lines, line = [], ""
    for word in text.split(" "):
        if line and len(line) + 1 + len(word) > WIDTH:
            lines.append(line)
            line = f"    {word}"
        else:
            line = f"{line} {word}" if line else word
    return [*lines, line]


def with_grammar(reference: str, grammar: str) -> str:
    """The reference with the grammar between its two marks."""
    before, rest = reference.split(BEGIN)
    _, after = rest.split(END)
    return f"{before}{BEGIN}```ebnf\n{ebnf(grammar)}```\n{END}{after}"


def main() -> int:
    """Rewrite the reference, or tell whether that would change it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--check", action="store_true", help="change nothing, tell whether it is up to date")
    asked = parser.parse_args()
    reference = REFERENCE.read_text(encoding="utf-8")
    wanted = with_grammar(reference, GRAMMAR.read_text(encoding="utf-8"))
    if asked.check:
        return int(wanted != reference)
    REFERENCE.write_text(wanted, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
