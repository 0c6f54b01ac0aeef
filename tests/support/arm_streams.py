"""Streams of arms with any joints, at any tick, as a controller could play them."""

from __future__ import annotations

import numpy as np

import gantry
from irlx.robot.limits import JointLimits
from irlx.streams import BlockRecord, JointStream


def arm_header(units: str, tick_ms: float = 2.0, **changes: object):
    """Header of joints A1, A2, ..; `units` has 'r' for a turning joint, 'm' for a slide, from the base on."""
    count = len(units)
    bound = np.full(count, np.inf)
    entries = {
        "joint_names": tuple(f"A{k + 1}" for k in range(count)),
        "joint_units": tuple("m" if unit == "m" else "rad" for unit in units),
        "limits": JointLimits(-bound, bound, -bound, bound, -bound, bound),
        "weights": (1.0,) * count,
        "tick_ns": round(tick_ms * 1e6),
        "robot_name": "arm",
        "program_name": "weld.irl",
    }
    return gantry.header(**{**entries, **changes})


def arm_stream(
    units: str = "rrrrrr",
    tick_ms: float = 2.0,
    q: np.ndarray | None = None,
    *,
    ticks: np.ndarray | None = None,
    complete: bool = True,
    blocks: bool = True,
    **changes: object,
) -> JointStream:
    """A stream with the rows `q` (N, n), those of `there_and_back` where none are given."""
    q = there_and_back(len(units)) if q is None else np.asarray(q, dtype=float)
    rows = len(q)
    ticks = np.arange(rows, dtype=np.int64) if ticks is None else np.asarray(ticks, dtype=np.int64)
    origin = gantry.Origin("weld.irl", 10, 15, 4)
    record = BlockRecord(0, gantry.FreezeBlock(id=1, origin=origin, joints=(1,)))
    tool = np.tile([0.5, 0.0, 0.4, 0.0, 0.0, 0.0, 1.0], (rows, 1))
    return JointStream(
        arm_header(units, tick_ms, **changes),
        (record,) if blocks else (),
        ticks,
        q,
        np.zeros(rows, dtype=np.int64),
        tool,
        complete,
    )


def there_and_back(joints: int, seed: int = 5, ticks: int = 40) -> np.ndarray:
    """Rows from rest to rest, twice, with stops of 1 and of 7 rows; zeros and 1e-16 among the values."""
    rng = np.random.default_rng(seed)
    stops = rng.uniform(-3.0, 3.0, (3, joints))
    stops[0, 0], stops[1, -1], stops[2, 1 % joints] = 0.0, -1e-16, -np.pi
    rows = [stops[0]]
    for start, goal, hold in zip(stops, stops[1:], (1, 7), strict=False):
        for s in gantry.smooth(ticks):
            rows.append(start + s * (goal - start))
        rows[-1] = goal
        rows += [goal.copy() for _ in range(hold)]
    return np.array(rows)
