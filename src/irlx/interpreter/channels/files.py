"""Where the files of a program are."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Literal, Protocol, TypeAlias

Mode: TypeAlias = Literal["READ", "WRITE", "APPEND"]


class Sink(Protocol):
    """A file that is written; both methods raise ChannelFault, IRL548."""

    def write(self, data: bytes) -> None:
        """Write bytes behind those that are there."""

    def close(self) -> None:
        """Let go of the file."""


@dataclass(frozen=True)
class Opened:
    """A file that was opened: the same `identity` is the same file; pieces of its text, or where to write."""

    identity: Hashable
    pull: Callable[[], str] | None = None
    sink: Sink | None = None


class Files(ABC):
    """Opens files by the names that a program gives."""

    @abstractmethod
    def open(self, name: str, mode: Mode, busy: Callable[[Hashable], None]) -> Opened:
        """Open a file; `busy` is called with its identity before anything is changed, and may raise.

        Raises ChannelFault: IRL540 outside of the folder, IRL541 not found, IRL548 for what cannot be
        opened, IRL550, IRL551 for files of the run itself, IRL554 for what cannot be a name.
        """
