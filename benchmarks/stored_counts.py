"""Counts of instructions, what they were made with, and how new ones compare with stored ones."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

MOST = 0.02
"""By what part a count may lie over its stored one."""


@dataclass(frozen=True)
class Counts:
    """Instructions by the name of the piece of work, and versions by the name of what they belong to."""

    made_with: Mapping[str, str]
    instructions: Mapping[str, int]

    @classmethod
    def read(cls, path: Path) -> Counts:
        """Counts of a file. Raises OSError, ValueError, KeyError where they are not there."""
        stored = json.loads(path.read_text(encoding="utf-8"))
        return cls(stored["made_with"], stored["instructions"])

    def write(self, path: Path) -> None:
        """Store the counts in a file."""
        path.write_text(json.dumps(asdict(self), indent=2) + "\n", encoding="utf-8")


@dataclass(frozen=True)
class Comparison:
    """New counts beside stored ones; of these there may be none for some names, or for all."""

    stored: Counts | None
    found: Counts

    def change(self, name: str) -> float | None:
        """By what part a count differs from its stored one, None where there is none."""
        before = None if self.stored is None else self.stored.instructions.get(name)
        return self.found.instructions[name] / before - 1.0 if before else None

    @property
    def over(self) -> list[str]:
        """Names of the counts that have grown by more than is allowed."""
        before = {} if self.stored is None else self.stored.instructions
        return [
            name
            for name, now in self.found.instructions.items()
            if now > before.get(name, now) * (1.0 + MOST)
        ]

    @property
    def without(self) -> list[str]:
        """Names of the counts of which none are stored."""
        return [name for name in self.found.instructions if self.change(name) is None]

    @property
    def updated(self) -> Counts:
        """What is to be stored: the new counts, and the stored ones of names that were not counted now."""
        before = {} if self.stored is None else self.stored.instructions
        return Counts(self.found.made_with, {**before, **self.found.instructions})

    @property
    def other_versions(self) -> list[str]:
        """What the stored counts were made with that is another one now."""
        if self.stored is None:
            return []
        names = dict.fromkeys([*self.stored.made_with, *self.found.made_with])
        then, now = (
            [side.made_with.get(name, "none") for name in names] for side in (self.stored, self.found)
        )
        compared = zip(names, then, now, strict=True)
        return [f"{name} {old}, now {new}" for name, old, new in compared if old != new]

    def table(self) -> list[str]:
        """A line for each count, and one that says with what else the stored ones were made."""
        lines = [f"{'':26}{'stored':>16}{'now':>16}{'change':>10}"]
        for name, count in self.found.instructions.items():
            change, before = self.change(name), "-"
            if change is not None and self.stored is not None:
                before = f"{self.stored.instructions[name]:,}"
            told = "" if change is None else f"{change:+.2%}"
            mark = "  over" if name in self.over else ""
            lines.append(f"{name:26}{before:>16}{count:>16,}{told:>10}{mark}")
        if self.other_versions:
            lines.append("stored with other versions: " + "; ".join(self.other_versions))
        return lines

    def verdict(self) -> list[str]:
        """Why `--check` fails, no lines where it does not."""
        lines = []
        if self.over:
            lines.append(f"more than {MOST:.0%} over the stored count: {'; '.join(self.over)}")
        if self.without:
            lines.append(f"no stored count: {'; '.join(self.without)} (--update stores it)")
        return lines
