"""Events: the spans of ticks in which one bound held one joint, against a walk over the flags."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.report.events import SOURCES, ActiveSpans, LimitActive
from irlx.transform.step_bounds import BoundSource

NAMES = ("j1", "j2", "j3")


def limit_events(active: np.ndarray, dt: float, portions: tuple[int, ...] = ()) -> tuple[LimitActive, ...]:
    """Events of flags that come in portions, cut before these rows."""
    spans = ActiveSpans(NAMES, dt)
    for part in np.split(active, portions):
        spans.take(part)
    return spans.events


def by_walking(active: np.ndarray, dt: float) -> list[tuple]:
    """Spans found flag by flag, as a person would with a pencil."""
    found = []
    for joint, name in enumerate(NAMES):
        begin = None
        column = [*active[:, joint], 0]
        for tick, flag in enumerate(column):
            before = column[tick - 1] if tick else 0
            if flag != before:
                if before:
                    side = "upper" if before > 0 else "lower"
                    found.append((name, SOURCES[abs(before) - 1], side, begin, tick - 1))
                begin = tick
    return sorted(found, key=lambda event: (event[3], event[0]))


@pytest.mark.req("MOT-21")
@pytest.mark.parametrize("seed", range(20))
def test_spans_equal_those_of_a_walk(seed: int) -> None:
    rng = np.random.default_rng(seed)
    active = rng.choice([-4, -1, 0, 0, 0, 1, 2, 3], size=(60, 3)).astype(np.int8)
    active = np.repeat(active, rng.integers(1, 4), axis=0)
    portions = tuple(np.sort(rng.integers(0, len(active) + 1, rng.integers(6))).tolist())
    events = limit_events(active, 0.05, portions)
    found = [(e.joint, e.kind, e.side, e.first_tick, e.last_tick) for e in events]
    assert found == by_walking(active, 0.05), f"seed {seed}"
    for event in events:
        assert event.first_time == pytest.approx(0.05 * event.first_tick)
        assert event.last_time == pytest.approx(0.05 * event.last_tick)


def test_no_flag_no_event() -> None:
    assert limit_events(np.zeros((5, 3), dtype=np.int8), 0.01) == ()


@pytest.mark.parametrize("flag", [1, -2, 3, -4])
def test_a_bound_that_holds_from_first_to_last_tick_is_one_event(flag: int) -> None:
    active = np.zeros((4, 3), dtype=np.int8)
    active[:, 1] = flag
    (event,) = limit_events(active, 0.01)
    assert (event.joint, event.first_tick, event.last_tick) == ("j2", 0, 3)
    assert event.side == ("upper" if flag > 0 else "lower")
    assert event.kind == SOURCES[abs(flag) - 1]
    assert event.to_plain()["event"] == "limit active"


def test_names_of_the_sources_are_those_of_the_inverse_transform() -> None:
    assert [name.upper() for name in SOURCES] == [source.name for source in sorted(BoundSource)]
