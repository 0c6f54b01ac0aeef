"""How a stream was made beside its program, cell and robot: what it takes to make it again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeGuard

NUMBERS = {"max_slow": float, "max_steps": int, "pause": float}


@dataclass(frozen=True)
class Making:
    """Options of a run and the software that it used; the defaults say that nothing is known.

    `cell_sha256` is the SHA-256 of the bytes of the cell file; `max_slow` and `max_steps` are None where the
    run had no such bound of its own; `pause` is the time of each PAUSE, s; `inputs` the name of the CSV file
    of --inputs, with its SHA-256; `replay_of` the SHA-256 of the stream that was replayed. `software` lists
    what numbers depend on, such as 'numpy 2.1.0'. `given` names what a caller gave that no file can tell:
    functions, an open file.
    """

    cell_sha256: str = ""
    max_slow: float | None = None
    max_steps: int | None = None
    pause: float = 0.0
    inputs: str = ""
    inputs_sha256: str = ""
    replay_of: str = ""
    software: tuple[str, ...] = ()
    given: tuple[str, ...] = ()

    def to_plain(self) -> dict[str, Any]:
        """As data that JSON can hold."""
        lists = {"software": list(self.software), "given": list(self.given)}
        return {**self.__dict__, **lists}

    @classmethod
    def from_plain(cls, plain: object) -> Making:
        """What `to_plain` gives; raises ValueError that names the entry."""
        if not isinstance(plain, dict) or set(plain) != set(cls.__dataclass_fields__):
            raise ValueError("making: needs " + ", ".join(cls.__dataclass_fields__))
        values = dict(plain)
        for name, value in plain.items():
            if name in ("software", "given"):
                if not _is_texts(value):
                    raise ValueError(f"making.{name}: needs a list of strings")
                values[name] = tuple(value)
            elif name in NUMBERS:
                if not _is_number(value, NUMBERS[name], optional=name != "pause"):
                    raise ValueError(f"making.{name}: needs a number")
            elif type(value) is not str:
                raise ValueError(f"making.{name}: needs a string")
        return cls(**values)


def _is_texts(value: object) -> TypeGuard[list[str]]:
    return isinstance(value, list) and all(type(entry) is str for entry in value)


def _is_number(value: object, kind: type, *, optional: bool) -> bool:
    """Whether a value is a finite number of 0 or more of this very kind, or None where it may be."""
    if value is None:
        return optional
    return type(value) is kind and 0 <= value < float("inf")  # type: ignore[operator]
