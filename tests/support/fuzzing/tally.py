"""What a campaign has found so far; kept in a file, so that it can go on another day."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any


@dataclass
class Tally:
    """Counts of a campaign. `crashes`: by the key of the fault, the saved case and what is known of it."""

    seed: int = 0
    portions: int = 0
    inputs: int = 0
    accepted: int = 0
    codes: Counter[str] = field(default_factory=Counter)
    kinds: Counter[str] = field(default_factory=Counter)
    crashes: dict[str, dict[str, str]] = field(default_factory=dict)
    crashed: int = 0
    seconds: float = 0.0
    slowest: float = 0.0
    slowest_case: str = ""
    memory: int = 0

    def add(self, other: Tally) -> None:
        """Add a portion."""
        self.portions += other.portions
        self.inputs += other.inputs
        self.accepted += other.accepted
        self.codes.update(other.codes)
        self.kinds.update(other.kinds)
        self.crashes = {**other.crashes, **self.crashes}
        self.crashed += other.crashed
        self.seconds += other.seconds
        if other.slowest > self.slowest:
            self.slowest, self.slowest_case = other.slowest, other.slowest_case
        self.memory = max(self.memory, other.memory)

    def save(self, path: Path) -> None:
        """Write it to a file, whole or not at all."""
        path.parent.mkdir(parents=True, exist_ok=True)
        new = path.with_suffix(".new")
        new.write_text(json.dumps(self.plain(), indent=1), encoding="utf-8")
        new.replace(path)

    @classmethod
    def load(cls, path: Path) -> Tally:
        """Read it again."""
        return cls.of(json.loads(path.read_text(encoding="utf-8")))

    def plain(self) -> dict[str, Any]:
        """As JSON has it."""
        return vars(self) | {"codes": dict(self.codes), "kinds": dict(self.kinds)}

    @classmethod
    def of(cls, plain: dict[str, Any]) -> Tally:
        """The tally of its plain form."""
        return cls(**{**plain, "codes": Counter(plain["codes"]), "kinds": Counter(plain["kinds"])})

    def lines(self, expected: tuple[str, ...], what: str) -> list[str]:
        """The last lines of a campaign; `expected` are the codes that it may meet."""
        unmet = [code for code in expected if code not in self.codes]
        counts = "  ".join(f"{code} {count}" for code, count in sorted(self.codes.items()))
        kinds = "  ".join(f"{kind} {count}" for kind, count in sorted(self.kinds.items()))
        rate = self.inputs / self.seconds if self.seconds else 0.0
        met = len(expected) - len(unmet)
        return [
            f"inputs      {self.inputs:,}, {self.accepted:,} accepted ({kinds})",
            f"by code     {counts}",
            f"codes       {len(self.codes)} distinct; of {len(expected)} {what} {met} reached",
            f"not reached {' '.join(unmet) or 'none'}",
            f"time        {self.seconds:,.0f} s of computing, {rate:,.0f} inputs/s, "
            f"the slowest {self.slowest:.2f} s ({self.slowest_case})",
            f"memory      {self.memory / 2**20:,.0f} MB at most",
            f"crashes     {self.crashed}, {len(self.crashes)} distinct",
            *(f"  {key}: {found['case']}" for key, found in sorted(self.crashes.items())),
        ]
