"""One input of a campaign, and what came of it."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass


@dataclass(frozen=True)
class Case:
    """The bytes of one file; `kind` says which reader gets them."""

    kind: str
    content: bytes

    @property
    def digest(self) -> str:
        """A short name for it."""
        return hashlib.sha256(self.kind.encode() + b"\0" + self.content).hexdigest()[:12]


@dataclass(frozen=True)
class Outcome:
    """`codes` are those of the findings; without an error among them the input was accepted.

    `features` are signs of what was gone through: an input that shows a new one is worth damaging again.
    """

    accepted: bool
    codes: frozenset[str]
    features: frozenset[object]


class Fault(Exception):
    """A promise that an input breaks. `promise` names it, `where` the place in irlx, `detail` says more."""

    def __init__(self, promise: str, where: str = "", detail: str = "") -> None:
        self.promise = promise
        self.where = where
        self.detail = detail
        super().__init__(f"{promise} {where}".strip())

    @property
    def key(self) -> str:
        """Faults of the same key are taken for the same one."""
        return f"{self.promise} {self.where}".strip()
