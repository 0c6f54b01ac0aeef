"""A target in words: which one of those of a line in a loop or a procedure a message is about."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics.digits import plain


def target_words(position: Sequence[float] | NDArray[np.float64]) -> str:
    """A position (3,), m, in mm."""
    # A millionth of a mm is rounding.
    return "(" + ", ".join(plain(round(1e3 * float(x), 6) + 0.0, 6) for x in position) + ") mm"
