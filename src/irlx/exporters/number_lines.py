"""Lines of numbers with a fixed number of digits behind the point, whole arrays at a time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from irlx.streams.joint_stream import Floats, Integers

_GROUP = 10_000
"""Digits are looked up in groups of four."""


def _words(texts: list[bytes]) -> NDArray[np.uint32]:
    """Texts of four bytes as integers that hold them."""
    return np.frombuffer(b"".join(texts), dtype="<u4")


_ZEROS = _words([b"%04d" % number for number in range(_GROUP)])
_FIRST = _words([(b"%d" % number).rjust(4, b"\0") for number in range(_GROUP)])


def number_lines(fronts: Sequence[str], values: Floats, digits: int, tails: Sequence[bytes]) -> bytes:
    """N lines of n numbers: `fronts` (n,) stand before the numbers, `tails` (N,) behind the last one.

    `values` (N, n) are below 1e7 in size; `digits`, a multiple of four up to 12, stand behind the point. What
    rounds to zero has no sign. Neither fronts nor tails may hold a zero byte.
    """
    number = np.dtype(
        [
            ("sign", "u1"),
            ("upper", "<u4"),
            ("lower", "<u4"),
            ("point", "u1"),
            ("fraction", "<u4", (digits // 4,)),
        ]
    )
    columns = [
        (f"{kind} {place}", form)
        for place, front in enumerate(fronts)
        for kind, form in (("front", f"S{max(len(front), 1)}"), ("number", number))
    ]
    ends = np.array(tails)
    table = np.empty(len(values), dtype=[*columns, ("tail", ends.dtype)])
    for place, front in enumerate(fronts):
        table[f"front {place}"] = front.encode("ascii")
        _fill(table[f"number {place}"], values[:, place], digits)
    table["tail"] = ends
    # Fields are padded to one width with zero bytes.
    return table.tobytes().translate(None, b"\0")


def _fill(fields: NDArray[np.void], values: Floats, digits: int) -> None:
    size: Integers = np.rint(np.abs(values) * 10.0**digits).astype(np.int64)
    whole, fraction = np.divmod(size, 10**digits)
    fields["sign"] = np.where((values < 0.0) & (size > 0), ord("-"), 0)
    upper, lower = np.divmod(whole, _GROUP)
    fields["upper"] = np.where(upper > 0, _FIRST[upper], 0)
    fields["lower"] = np.where(upper > 0, _ZEROS[lower], _FIRST[lower])
    fields["point"] = ord(".")
    for place in reversed(range(digits // 4)):
        fraction, group = np.divmod(fraction, _GROUP)
        fields["fraction"][:, place] = _ZEROS[group]
