"""What each reader that is fuzzed has to give."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from pathlib import Path
from random import Random

from fuzzing.case import Case, Fault, Outcome
from fuzzing.findings import look_at, wording
from fuzzing.xml_damage import SECRET
from irlx.diagnostics import Diagnostic


class Reader(ABC):
    """A reader of files of one kind, in a folder of its own."""

    kind: str
    ending: str
    share: float = 1.0
    """How often it has its turn, beside the others."""
    patience: float = 1.0
    """How many times as long as others it may take."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._sound: list[bytes] | None = None

    @property
    def sound(self) -> list[bytes]:
        """Files without damage."""
        if self._sound is None:
            self._sound = self.made()
        return self._sound

    @abstractmethod
    def made(self) -> list[bytes]:
        """Makes the files without damage."""

    @abstractmethod
    def damaged(self, content: bytes, chance: Random) -> bytes:
        """A file damaged in one of many ways."""

    @abstractmethod
    def read(self, content: bytes, thorough: bool) -> tuple[bool, list[Diagnostic]]:
        """Whether a file is accepted, and what is told of it. Raises Fault, or whatever a reader raises."""

    def systematic(self) -> Iterable[Callable[[], bytes]]:
        """What makes damage that is gone through from beginning to end."""
        return ()

    def judge(self, case: Case, thorough: bool) -> Outcome:
        """What comes of a case."""
        accepted, told = self.read(case.content, thorough)
        for one in told:
            look_at(one)
            if SECRET in one.message or SECRET in one.help:
                raise Fault("a message tells what stands in another file", one.code, str(one))
        if accepted and any(one.is_error for one in told):
            raise Fault("accepted with errors", self.kind, "\n".join(map(str, told)))
        if not accepted and not any(one.is_error for one in told):
            raise Fault("refused without an error", self.kind)
        codes = frozenset(one.code for one in told)
        return Outcome(accepted, codes, frozenset([(self.kind, *wording(one)) for one in told] + [self.kind]))
