"""Rows of joined moves, handed out to each of them."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.rows import MotionRows, handed_out

BLOCKS = ["first", "second", "third"]


def rows_at(s: list[float]) -> MotionRows:
    """Rows at path parameters, a hold behind the last one."""
    s = np.array([*s, s[-1]])
    n, nothing = len(s), np.zeros(len(s))
    q = np.arange(7.0 * n).reshape(n, 7)
    poses = q[:, :3], np.tile(np.eye(3), (n, 1, 1))
    active = np.zeros((n, 7), dtype=np.int8)
    return MotionRows("whole", 11, q, *poses, nothing, nothing, active, s, float(s[-1]), 5)


@pytest.mark.parametrize(
    ("ends", "counts"),
    [([0.3, 0.5, 1.0], [3, 2, 6]), ([0.26, 0.34, 1.0], [3, 0, 8]), ([0.3, 1.0, 1.0], [3, 7, 1])],
)
def test_each_move_has_the_rows_up_to_the_tick_next_to_its_end(ends: list[float], counts: list[int]) -> None:
    """Ten ticks of a tenth of the way: none is lost, and the ways of the moves are those between the ends."""
    rows = rows_at([0.1 * k for k in range(1, 11)])
    parts = handed_out(rows, BLOCKS, ends)
    assert [0 if part is None else len(part) for part in parts] == counts
    kept = [part for part in parts if part is not None]
    assert np.array_equal(np.vstack([part.q for part in kept]), rows.q)
    ticks = 11
    for part in kept:
        assert (part.first_tick, part.ticks) == (ticks, len(part))
        ticks += len(part)
    for block, part, begin, end in zip(BLOCKS, parts, [0.0, *ends[:-1]], ends, strict=True):
        if part is not None:
            assert part.block == block
            assert part.length == pytest.approx(end - begin, abs=1e-15)
    assert [part.stops for part in kept] == [False] * (len(kept) - 1) + [True]
    assert [part.iterations for part in kept] == [5] + [0] * (len(kept) - 1)
