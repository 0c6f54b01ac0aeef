"""Bytes that are the same in every copy but for some numbers in them: messages as numpy arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]

ENCAPSULATION = b"\0\1\0\0"
"""How a message in CDR, little-endian, begins; alignment counts from behind it."""


class Form:
    """Constants and numbers that follow each other, each number a little-endian array of numpy.

    Numbers are aligned in CDR: to their size, from the last `begin` on.
    """

    def __init__(self) -> None:
        self._bytes = bytearray()
        self._fields: dict[str, tuple[np.dtype[Any], int]] = {}
        self._origin = 0

    def __len__(self) -> int:
        return len(self._bytes)

    def constant(self, data: bytes) -> Form:
        """Bytes as they are."""
        self._bytes += data
        return self

    def begin(self) -> Form:
        """A message begins here."""
        self.constant(ENCAPSULATION)
        self._origin = len(self)
        return self

    def packed(self, name: str, kind: str) -> Form:
        """A number that is not aligned."""
        return self._number(name, np.dtype(kind))

    def number(self, name: str, kind: str) -> Form:
        """One number, aligned."""
        self._align(np.dtype(kind).itemsize)
        return self._number(name, np.dtype(kind))

    def numbers(self, name: str, count: int) -> Form:
        """`count` numbers of 64 bits, aligned: an array without its length."""
        if count:
            self._align(8)
        return self._number(name, np.dtype(("<f8", (count,))))

    def length(self, count: int) -> Form:
        """Length of a sequence."""
        self._align(4)
        return self.constant(count.to_bytes(4, "little"))

    def text(self, words: str) -> Form:
        """A constant string."""
        data = words.encode("utf-8", "backslashreplace") + b"\0"
        return self.length(len(data)).constant(data)

    def texts(self, words: tuple[str, ...]) -> Form:
        """A sequence of constant strings."""
        self.length(len(words))
        for word in words:
            self.text(word)
        return self

    @property
    def kind(self) -> np.dtype[Any]:
        """Structured type of one copy, its fields being the numbers."""
        names = list(self._fields)
        kinds, offsets = [self._fields[name][0] for name in names], [self._fields[name][1] for name in names]
        return np.dtype({"names": names, "formats": kinds, "offsets": offsets, "itemsize": len(self)})

    def copies(self, rows: int, **values: Any) -> Bytes:
        """Bytes (rows, length) of copies with these `values` of the numbers: (rows,) or (rows, count)."""
        copies = np.tile(np.frombuffer(bytes(self._bytes), np.uint8), (rows, 1))
        fields = copies.view(self.kind)[:, 0]
        for name, value in values.items():
            fields[name] = value
        return copies

    def read(self, data: bytes) -> Any:
        """Numbers of the copies that data are made of, an array with fields; constants are not compared."""
        return np.frombuffer(data, self.kind)

    def _align(self, size: int) -> None:
        self._bytes += bytes((self._origin - len(self)) % size)

    def _number(self, name: str, kind: np.dtype[Any]) -> Form:
        self._fields[name] = (kind, len(self))
        self._bytes += bytes(kind.itemsize)
        return self
