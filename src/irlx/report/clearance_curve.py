"""How far the robot of a stream is from what it keeps clear of, over its rows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.nearest_rows import FAR, WITHIN
from irlx.report.clearances import Clearances
from irlx.robot.description import RobotDescription
from irlx.scene.scene import Scene
from irlx.verifier.clearance.pairs import Bodies, Pair, Places, link_pairs, meetings, obstacle_pairs
from irlx.verifier.clearance.search import capped_distances
from irlx.verifier.clearance.spans import obstacle_spans, rows_in
from irlx.verifier.outline import Outline

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

_ALWAYS = ((0, int(np.iinfo(np.int64).max)),)


def clearances_over(
    outline: Outline, robot: RobotDescription, scene: Scene, q: Array, rows: Integers
) -> Clearances | None:
    """What comes nearest in postures q (K, n) of the rows (K,), None where nothing is kept clear of.

    Distances are measured by the verifier, from the influence of an obstacle on; obstacles count where the
    program has them on. Raises ValueError where a shape or its file cannot be used.
    """
    watched = _watched(outline, robot, scene)
    if not watched:
        return None
    places = Places(robot, q, np.asarray(rows * outline.header.dt, dtype=np.float64))
    least, room = np.full(len(rows), np.inf), np.full(len(rows), np.inf)
    nearest = np.full(len(rows), FAR, dtype=np.int64)
    for number, (pair, influence, spans) in enumerate(watched):
        here = np.flatnonzero(rows_in(spans, rows))
        for meeting in meetings(pair, places):
            found = capped_distances(meeting, here, np.full(len(here), influence))
            counts = found < WITHIN * influence
            nearer = counts & (found - pair.margin < room[here])
            which = here[nearer]
            least[which], nearest[which] = found[nearer], number
            room[which] = found[nearer] - pair.margin
    names = tuple((pair.link, pair.other) for pair, _, _ in watched)
    margins = np.array([pair.margin for pair, _, _ in watched])
    kept_clear = np.any([rows_in(spans, rows) for _, _, spans in watched], axis=0)
    return Clearances(nearest, least, names, margins, kept_clear)


_Watched = tuple[Pair, float, tuple[tuple[int, int], ...]]
"""A pair, the distance from which on it counts (m), and the rows in which it does."""


def _watched(outline: Outline, robot: RobotDescription, scene: Scene) -> list[_Watched]:
    bodies = Bodies()
    found: list[_Watched] = []
    if scene.links is not None:
        found += [(pair, scene.links.influence, _ALWAYS) for pair in link_pairs(robot, scene, bodies)]
    spans, _ = obstacle_spans(outline, scene)
    for name, rows in spans.items():
        obstacle = scene.obstacles[name]
        found += [(pair, obstacle.influence, rows) for pair in obstacle_pairs(robot, obstacle, bodies)]
    return found
