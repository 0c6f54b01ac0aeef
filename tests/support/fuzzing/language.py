"""What has to hold of every program text, and what a campaign draws to see whether it does."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from random import Random

from fuzzing.case import Case, Fault, Outcome
from fuzzing.findings import look_at, wording
from fuzzing.known_texts import known_texts, parts_of
from fuzzing.text_damage import damaged, damaged_bytes, known_tokens, random_tokens
from irlx.checking import check
from irlx.diagnostics import IrlxError
from irlx.diagnostics.codes.data_lists import DATA_LISTS
from irlx.diagnostics.codes.lints import LINTS
from irlx.diagnostics.codes.names import NAMES
from irlx.diagnostics.codes.redundancy import REDUNDANCY
from irlx.diagnostics.codes.static_types import STATIC_TYPES
from irlx.diagnostics.codes.syntax import SYNTAX
from irlx.diagnostics.codes.types import TYPES
from irlx.diagnostics.rendering import MACHINE_FORMATS
from irlx.language import tree
from irlx.language.format import format_source
from irlx.language.parser import parse
from irlx.language.source import source_text
from irlx.program import names_around

KIND = "program"
CODES = tuple(
    code.id for group in (SYNTAX, NAMES, TYPES, STATIC_TYPES, LINTS, DATA_LISTS, REDUNDANCY) for code in group
)
"""Codes that a check of a text may give."""
_THOROUGH, _FORMATTED = 16, 4
"""One case of so many is looked at from all sides, one of so many is formatted if it is accepted."""
_MOST_ERRORS = 60
"""Errors of the syntax: twenty of a program, and as many of a data list and of a module."""
_PORT = re.compile(r"(?i)\ba?(?:in|out)_[0-9]")


class LanguageJudge:
    """Checks program texts as `irlx check` does, from files in a folder of its own."""

    area = "language"
    promises = "codes of the language"
    expected_codes = CODES

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._path = folder / "p.irl"
        self._beside: list[Path] = []
        self.endings = {KIND: ".irl"}

    def draw(self, chance: Random, pool: Sequence[Case]) -> Case:
        """A case to look at; `pool` are some that showed something new."""
        choice = chance.random()
        if choice < 0.08:
            return Case(KIND, random_tokens(chance).encode("utf-8", "replace"))
        if pool and choice < 0.5:
            text = pool[int(len(pool) * chance.random() ** 0.5)].content.decode("utf-8", "replace")
        elif choice < 0.55:
            text = chance.choice(known_texts())
        else:
            text = "".join(known_tokens(chance))
        if choice > 0.96:
            return Case(KIND, damaged_bytes(text.encode("utf-8", "replace"), chance))
        return Case(KIND, damaged(text, chance).encode("utf-8", "replace"))

    def beginnings(self) -> Sequence[Callable[[], Case]]:
        """Undamaged programs."""
        return [partial(Case, KIND, text.encode("utf-8", "replace")) for text in known_texts()]

    def patience(self, kind: str) -> float:
        """A check may take as long as anything."""
        return 1.0

    def judge(self, case: Case, thorough: bool | None = None) -> Outcome:
        """What the check says of a case. Raises Fault, or what the check itself raises."""
        self._write(case.content)
        found = check(self._path)
        chosen = int(case.digest, 16)
        thorough = chosen % _THOROUGH == 0 if thorough is None else thorough
        for one in found:
            look_at(one, thorough)
        if sum(one.is_error and one.code.startswith("IRL1") for one in found) > _MOST_ERRORS:
            raise Fault("more errors than one wants to read")
        if thorough:
            self._look_at_tree(case.content)
            if check(self._path) != found:
                raise Fault("another check says something else", found[0].code if found else "")
            for name, rendered in MACHINE_FORMATS.items():
                if not isinstance(rendered(found), str):
                    raise Fault("no text", name)
        accepted = not any(one.is_error for one in found)
        if accepted and (thorough or chosen % _FORMATTED == 0):
            self._format(parts_of(case.content)[0][1], thorough)
        codes = frozenset(one.code for one in found)
        return Outcome(accepted, codes, frozenset([*map(wording, found), (len(codes), accepted)]))

    def _look_at_tree(self, content: bytes) -> None:
        """All nodes lie in the text; a tree can be compared, kept in a set and printed."""
        text = parts_of(content)[0][1].decode("utf-8", "replace")
        source = source_text("t", text)
        root = parse(source).tree
        if root is None:
            return
        if any(node.span.end > len(source.text) for node in tree.walk(root)):
            raise Fault("a node behind the end of the text")
        hash(root)
        repr(root)

    def _write(self, content: bytes) -> None:
        for path in self._beside:
            path.unlink(missing_ok=True)
        (_, first), *others = parts_of(content)
        self._path.write_bytes(first)
        self._beside = [self._folder / name for name, _ in others]
        for path, (_, text) in zip(self._beside, others, strict=True):
            path.write_bytes(text)

    def _format(self, content: bytes, thorough: bool) -> None:
        """An accepted text has a form, which is the same program, is accepted, and stays as it is."""
        text = content.decode("utf-8-sig")
        around = names_around(self._path)
        try:
            formatted = format_source(text, str(self._path), *around)
        except IrlxError as error:
            raise Fault("an accepted text cannot be formatted", error.reason.code, str(error)) from error
        if not _PORT.search(text):
            before, after = (
                parse(source_text("t", one.replace("\r\n", "\n"))).tree for one in (text, formatted)
            )
            if before != after:
                raise Fault("formatted it is another program")
        if thorough:
            if format_source(formatted, str(self._path), *around) != formatted:
                raise Fault("formatted again it changes")
            self._path.write_bytes(formatted.encode("utf-8"))
            errors = [str(one) for one in check(self._path) if one.is_error]
            if errors:
                raise Fault("formatted it has errors", "", "\n".join(errors))
