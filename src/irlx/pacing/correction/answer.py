"""Numbers that Python functions of others answer with."""

from __future__ import annotations

from contextlib import suppress
from math import pi

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

HALF_TURN = pi * (1.0 + 1e-12)
"""Longest rotation vector, rad: that of half a turn, which rounding may have made a little longer."""


def numbers_in(answer: object) -> Array | None:
    """Real numbers of an answer that is a list, an array or the like; None for anything else."""
    try:
        found = np.array(answer)
    except Exception:
        # An array of others may raise whatever it likes where it is no plain one.
        return None
    return found.astype(np.float64) if found.dtype.kind in "iuf" else None


def told_answer(answer: object) -> str:
    """What a wrong answer is, in a few words."""
    kind, size = type(answer).__name__, getattr(answer, "shape", None)
    if not size:
        with suppress(Exception):
            size = len(answer)  # type: ignore[arg-type]
    return f"{kind} of {size}" if size else kind
