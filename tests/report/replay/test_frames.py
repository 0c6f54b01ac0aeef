"""Frames: at most so many, at the right ticks, and no peak lost."""

import numpy as np
import pytest

from irlx.report.replay.frames import Columns, Frames

pytestmark = pytest.mark.req("REP-04")


def rows_of(count, seed=0):
    rng = np.random.default_rng(seed)
    far = rng.random(count) < 0.5
    room = np.where(far, np.inf, rng.uniform(0.0, 1.0, count))
    return Columns(
        np.arange(count),
        rng.integers(0, 9, count),
        rng.normal(size=(count, 3)),
        rng.normal(size=(count, 7)),
        rng.normal(size=(count, 3)),
        rng.random(count),
        rng.random(count),
        room,
        room + 0.1,
        np.where(far, -1, rng.integers(0, 4, count)),
        rng.random(count) < 0.3,
    )


def part(rows, first, last):
    return Columns(*(column[first:last] for column in rows))


def expected(rows, every):
    """Frames by the definition, one after another."""
    ticks = sorted({*range(0, len(rows.tick), every), len(rows.tick) - 1})
    found, before = [], -1
    for tick in ticks:
        since = slice(before + 1, tick + 1)
        speed = rows.speed[since]
        largest = speed[np.argmax(np.abs(speed), axis=0), np.arange(3)]
        near = before + 1 + int(np.argmin(rows.room[since]))
        state = tick, rows.line[tick], rows.q[tick], rows.tool[tick]
        fastest = rows.tool_speed[since].max(), rows.turn_speed[since].max()
        nearest = rows.room[near], rows.distance[near], rows.pair[near]
        found.append((*state, largest, *fastest, *nearest, any(rows.watched[since])))
        before = tick
    return Columns(*(np.array(column) for column in zip(*found, strict=True)))


@pytest.mark.parametrize("portions", [1, 7, 100, 1001])
@pytest.mark.parametrize(("dt", "every"), [(0.05, 1), (0.02, 1), (0.01, 2), (0.004, 5), (0.012, 2)])
def test_frames_are_the_same_whatever_the_portions(portions, dt, every):
    rows, frames = rows_of(1001), Frames(dt)
    for first in range(0, 1001, portions):
        frames.take(part(rows, first, first + portions))
        if first < 30:
            assert frames.columns.tick[-1] == min(first + portions, 1001) - 1
    assert frames.every == every
    for column, truth in zip(frames.columns, expected(rows, every), strict=True):
        np.testing.assert_array_equal(column, truth)


@pytest.mark.parametrize("count", [2, 63, 64, 65, 128, 1000, 4001])
def test_longer_runs_have_coarser_frames(count):
    rows, frames = rows_of(count, 1), Frames(0.01, most=64)
    for first in range(0, count, 13):
        frames.take(part(rows, first, first + 13))
    assert len(frames.columns.tick) <= 64
    assert count < 128 or len(frames.columns.tick) >= 32
    for column, truth in zip(frames.columns, expected(rows, frames.every), strict=True):
        np.testing.assert_array_equal(column, truth)
