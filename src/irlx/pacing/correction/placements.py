"""Where obstacles are, as Python says."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.pacing.correction.answer import HALF_TURN, numbers_in, told_answer
from irlx.pacing.errors import PacingError
from irlx.scene.scene import Scene

Array = NDArray[np.float64]

FARTHEST = 1e3
"""Farthest from the world's origin that an obstacle may be put, m."""


class Placement(NamedTuple):
    """An obstacle by name, its frame's position (3,) m, and rotation vector (3,) rad, None for as before."""

    name: str
    position: Array
    rotation: Array | None


def read_placements(answer: object, tick: int, scene: Scene, place: Place | None) -> list[Placement]:
    """What is said of obstacles for a tick; nothing where there is nothing new to say.

    Raises PacingError: IRL585 for anything but a mapping from names to three or six finite numbers, IRL586
    for a name that is no obstacle of the scene.
    """
    if answer is None:
        return []
    if not isinstance(answer, Mapping):
        raise PacingError(report("IRL585", place, tick=tick, found=type(answer).__name__))
    found: dict[str, Placement] = {}
    for name, pose in answer.items():
        if not isinstance(name, str):
            raise PacingError(report("IRL585", place, tick=tick, found=f"the name {name!r}"))
        key = name.casefold()
        if key not in scene.obstacles:
            raise PacingError(_unknown(name, tick, scene, place))
        if key in found:
            raise PacingError(report("IRL585", place, tick=tick, found=f"'{name}' twice"))
        if pose is not None:
            numbers = _numbers(name, pose, tick, place)
            turn = numbers[3:] if numbers.size > 3 else None
            found[key] = Placement(scene.obstacles[key].name, numbers[:3], turn)
    return list(found.values())


def _unknown(name: str, tick: int, scene: Scene, place: Place | None) -> Diagnostic:
    known = sorted(obstacle.name for obstacle in scene.obstacles.values())
    near, told = near_matches(name, known), ", ".join(known) or "none"
    return report("IRL586", place, tick=tick, name=name, near=near, known=told)


def _numbers(name: str, pose: object, tick: int, place: Place | None) -> Array:
    def wrong(why: str) -> PacingError:
        return PacingError(report("IRL585", place, tick=tick, found=f"{why} for '{name}'"))

    numbers = numbers_in(pose)
    if numbers is None or numbers.shape not in ((3,), (6,)):
        raise wrong(told_answer(pose))
    if not np.all(np.isfinite(numbers)):
        raise wrong(", ".join(f"{value:.6g}" for value in numbers))
    if np.max(np.abs(numbers[:3])) > FARTHEST:
        raise wrong(f"a place {np.max(np.abs(numbers[:3])):.6g} m away, more than {FARTHEST:g},")
    angle = hypot(*numbers[3:].tolist())
    if angle > HALF_TURN:
        raise wrong(f"a turn of {angle:.6g} rad, more than half of one,")
    return numbers
