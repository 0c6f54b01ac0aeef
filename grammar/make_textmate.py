"""Writes the TextMate grammar of editors from `grammar/irl.lark` and the registry of predefined names.

python grammar/make_textmate.py           # rewrites grammar/irl.tmLanguage.json
python grammar/make_textmate.py --check   # exit code 1 where it is not up to date

Editors match line by line and know nothing of what a name means, so that some names get their kind by rules
of thumb here. Scopes are those that themes know. All patterns mean the same to Oniguruma and to Python.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Iterable
from pathlib import Path

from irlx.language.builtins import (
    BARE_FUNCTIONS,
    FUNCTIONS,
    PORT_NAME,
    PROCEDURES,
    STANDARD_CHANNELS,
    SYSTEM_VARIABLES,
    TYPES,
)
from irlx.language.highlight import Kind
from irlx.language.highlight.words import keyword_kinds, sign_kinds
from irlx.language.keywords import NAMES_TOO
from irlx.language.terminals import terminals

FILE = Path(__file__).resolve().with_name("irl.tmLanguage.json")
SCOPES = {
    Kind.COMMENT: "comment.block.irl",
    Kind.INSTRUCTION: "comment.block.documentation.irl",
    Kind.DECLARATION: "keyword.other.declaration.irl",
    Kind.CONTROL: "keyword.control.irl",
    Kind.MOTION: "keyword.other.motion.irl",
    Kind.REDUNDANCY: "keyword.other.redundancy.irl",
    Kind.WORD_OPERATOR: "keyword.operator.wordlike.irl",
    Kind.CONSTANT: "constant.language.boolean.irl",
    Kind.INT: "constant.numeric.integer.irl",
    Kind.REAL: "constant.numeric.float.irl",
    Kind.STRING: "string.quoted.irl",
    Kind.OPERATOR: "keyword.operator.irl",
    Kind.PUNCTUATION: "punctuation.separator.irl",
    Kind.TYPE: "support.type.irl",
    Kind.OWN_TYPE: "entity.name.type.irl",
    Kind.FUNCTION: "support.function.irl",
    Kind.PROCEDURE: "support.function.procedure.irl",
    Kind.SYSTEM_VARIABLE: "variable.language.irl",
    Kind.PORT: "support.variable.irl",
    Kind.CHANNEL: "support.constant.irl",
    Kind.PARAMETER: "variable.parameter.irl",
    Kind.ROUTINE: "entity.name.function.irl",
    Kind.PART: "entity.name.section.irl",
    Kind.LABEL: "entity.name.label.irl",
    Kind.FIELD: "variable.other.member.irl",
    Kind.WRONG: "invalid.illegal.irl",
}
"""Scope of each kind; blanks and names without a meaning of their own have none."""

PATTERNS = {one.name: re.sub(r"\((?!\?)", "(?:", one.pattern) for one in terminals() if not one.is_sign}
NAME = PATTERNS["NAME"]
END = r"(?!\w)"
_PLAIN_NAMES = sorted(NAMES_TOO)
_BEHIND = {"FRAME": "IN", "DATALIST": "IMPORT", "SPECIFICATION": "SYSTEM"}
"""Keywords that may be names too, and that are keywords behind another one only."""


def words(of: Iterable[str]) -> str:
    """Pattern of any of some words, in any case, whole."""
    return rf"(?i:{'|'.join(sorted(of, key=lambda word: (-len(word), word)))}){END}"


def rule(pattern: str, *kinds: Kind | None) -> dict[str, object]:
    """Match of a pattern whose groups have kinds; one kind is that of all of it."""
    if re.compile(pattern).groups == 0:
        return {"match": pattern, **_named(kinds[0])}
    captures = {str(group): _named(kind) for group, kind in enumerate(kinds, 1) if kind is not None}
    return {"match": pattern, "captures": captures}


def _named(kind: Kind | None) -> dict[str, str]:
    return {} if kind is None else {"name": SCOPES[kind]}


def _group(name: str) -> dict[str, str]:
    return {"include": f"#{name}"}


def comments() -> list[dict[str, object]]:
    """Comments, those that speak to irlx, and those of other languages."""
    found: list[dict[str, object]] = []
    for begin, end in ((r"\{", r"\}"), (r"\(\*", r"\*\)")):
        for ahead, kind in ((r"(?=\s*(?i:irlx)\s*:)", Kind.INSTRUCTION), ("", Kind.COMMENT)):
            found.append({"begin": begin + ahead, "end": end, **_named(kind)})
    found.append(rule("//.*$", Kind.WRONG))
    found.append({"begin": r"/\*", "end": r"\*/", **_named(Kind.WRONG)})
    return found


def literals() -> list[dict[str, object]]:
    """Texts, whole or without an end, and numbers."""
    found = []
    for quote in "'\"":
        inside = f"(?:[^{quote}]|{quote}{quote})*"
        found.append(rule(f"{quote}{inside}{quote}(?!{quote})", Kind.STRING))
        found.append(rule(f"{quote}{inside}$", Kind.WRONG))
    return [
        *found,
        rule(PATTERNS["FOREIGN_QUOTES"].replace(r"\n", ""), Kind.WRONG),
        rule(PATTERNS["REAL"], Kind.REAL),
        rule(PATTERNS["INT"], Kind.INT),
    ]


def keywords() -> list[dict[str, object]]:
    """Keywords by their kinds; behind one a word that may also be a name is one."""
    found = []
    for first, second in (("IN", "FRAME"), ("IMPORT", "DATALIST"), ("SYSTEM", "SPECIFICATION")):
        pattern = rf"((?i:{first}))\s+((?i:{second}))(?=\s+{NAME})"
        found.append(rule(pattern, keyword_kinds()[first], keyword_kinds()[second]))
    groups: dict[Kind, list[str]] = {}
    for word, kind in keyword_kinds().items():
        if word not in NAMES_TOO:
            groups.setdefault(kind, []).append(word)
    for kind, group in groups.items():
        if kind is Kind.CONSTANT:
            found.append(rule(words(group), kind))
        else:
            found.append(rule(rf"({words(group)})(?:\s+(?:{words(NAMES_TOO)}))?", kind))
    # What ends in one of these may be an operand, and behind one there is no name.
    for kind in {keyword_kinds()[word]: None for word in _PLAIN_NAMES}:
        later = [w for w in _PLAIN_NAMES if keyword_kinds()[w] is kind and w not in _BEHIND]
        if later:
            found.append(rule(rf"(?<=[\w.)\]'\"}}])(?:\s+|(?<!\w))({words(later)})(?!\s*:=)", kind))
    return found


def names() -> list[dict[str, object]]:
    """Names that their word or what stands beside them tells, in statements and in declarations."""
    called = r"(?=\s*\()"
    return [
        rule(rf"(\.)\s*({NAME})", Kind.PUNCTUATION, Kind.FIELD),
        rule(words(SYSTEM_VARIABLES), Kind.SYSTEM_VARIABLE),
        rule(rf"{words(BARE_FUNCTIONS)}(?!\s*:=)", Kind.FUNCTION),
        rule(rf"{words(TYPES)}{called}", Kind.TYPE),
        rule(rf"{words(FUNCTIONS)}{called}", Kind.FUNCTION),
        rule(rf"{NAME}{called}", Kind.ROUTINE),
        rule(rf"(?i:{PORT_NAME.pattern}){END}", Kind.PORT),
        {"match": NAME},
    ]


def declared() -> list[dict[str, object]]:
    """Types and what is declared: names before a colon, behind OF and beside the = of a type."""
    kinds = keyword_kinds()
    routine = rf"((?i:PROCEDURE|FUNCTION))\s+({NAME})"
    part, imported = kinds["PROGRAM"], (kinds["IMPORT"], kinds["DATALIST"], Kind.PART)
    channel = rf"((?i:STANDARD_IN|STANDARD_OUT))\s*(=)\s*({words(STANDARD_CHANNELS.values())})"
    found = [
        rule(rf"((?i:PROGRAM|MODULE|FROM))\s+({NAME})", part, Kind.PART),
        rule(rf"((?i:IMPORT))\s+((?i:DATALIST))\s+({NAME})", *imported),
        rule(rf"^\s*((?i:DATALIST))\s+({NAME})", kinds["DATALIST"], Kind.PART),
        rule(channel, kinds["STANDARD_IN"], Kind.OPERATOR, Kind.CHANNEL),
    ]
    head = kinds["PROCEDURE"], Kind.ROUTINE
    sign = Kind.PUNCTUATION
    for name, kind in ((words(TYPES), Kind.TYPE), (rf"(?!{_hard()}){NAME}", Kind.OWN_TYPE)):
        found += [
            rule(rf"{routine}\s*(:)\s*({name})(?=\s*;)", *head, sign, kind),
            rule(rf"({name})(?=\s*:(?!=))", kind),
            rule(rf"((?i:OF){END})\s+({name})", kinds["OF"], kind),
            rule(rf"((?i:ENDRECORD){END})\s*(=)\s*({name})", kinds["ENDRECORD"], Kind.OPERATOR, kind),
            rule(rf"(\))\s*(:)\s*({name})(?=\s*;)", sign, sign, kind),
        ]
    # Behind those of functions without parameters.
    return [*found, rule(routine, *head)]


def statements() -> list[dict[str, object]]:
    """What only statements have: labels and calls at their beginning, parameters of moves."""
    begins = r"(?:^|(?<=;))\s*"
    return [
        rule(rf"((?i:GOTO))\s+({NAME})", keyword_kinds()["GOTO"], Kind.LABEL),
        {
            "begin": rf"(?={words(('MOVE', 'MOVE_INC', 'CRITERION'))})",
            "end": rf"(?=;|{words(['ENDPROGRAM', 'ENDPROC', 'ENDFCT'])})",
            "patterns": [
                _group("comments"),
                rule(rf"({NAME})(?=\s*:=)", Kind.PARAMETER),
                _group("everywhere"),
            ],
        },
        rule(rf"{begins}(?!{_hard()})({NAME})(?=\s*:(?!=))", Kind.LABEL),
        rule(rf"{begins}({words(PROCEDURES)})(?=\s*[;(])", Kind.PROCEDURE),
        rule(rf"{begins}(?!{_hard()})({NAME})(?=\s*;)", Kind.ROUTINE),
    ]


def _hard() -> str:
    return words(set(keyword_kinds()) - NAMES_TOO)


def signs() -> list[dict[str, object]]:
    """Signs, longer ones first, and what is none."""
    found = [rule(PATTERNS["FOREIGN_SIGN"], Kind.WRONG)]
    by_kind: dict[Kind, list[str]] = {}
    for sign, kind in sign_kinds().items():
        by_kind.setdefault(kind, []).append(re.escape(sign))
    for kind in (Kind.OPERATOR, Kind.PUNCTUATION):
        ordered = sorted(by_kind[kind], key=lambda sign: (-len(sign), sign))
        found.append(rule("|".join(ordered), kind))
    return [*found, rule(PATTERNS["WRONG_CHARACTER"], Kind.WRONG)]


def grammar() -> dict[str, object]:
    """The whole grammar."""
    body = {
        "begin": rf"({words(['BEGIN'])})",
        "beginCaptures": {"1": _named(keyword_kinds()["BEGIN"])},
        "end": rf"(?={words(['ENDPROGRAM', 'ENDPROC', 'ENDFCT'])})",
        "name": "meta.block.irl",
        "patterns": [_group("comments"), _group("statements"), _group("everywhere")],
    }
    repository = {
        "comments": comments(),
        "literals": literals(),
        "keywords": keywords(),
        "names": names(),
        "declared": declared(),
        "statements": statements(),
        "signs": signs(),
        "body": [body],
        "everywhere": [_group(name) for name in ("literals", "keywords", "names", "signs")],
    }
    return {
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "comment": "written by grammar/make_textmate.py",
        "name": "IRL",
        "scopeName": "source.irl",
        "fileTypes": ["irl"],
        "patterns": [_group(name) for name in ("comments", "body", "declared", "everywhere")],
        "repository": {name: {"patterns": rules} for name, rules in repository.items()},
    }


def text() -> str:
    """What stands in the file."""
    return json.dumps(grammar(), indent=2, ensure_ascii=False) + "\n"


def main() -> int:
    """Rewrite the grammar, or tell whether that would change it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--check", action="store_true", help="change nothing, tell whether it is up to date")
    if parser.parse_args().check:
        return int(not FILE.is_file() or FILE.read_text(encoding="utf-8") != text())
    FILE.write_text(text(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
