"""Where obstacles are seen while a program runs."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from irlx.scene.trajectory import Way


class Sightings:
    """The last poses of obstacles that somebody sees, by name whatever its case, tick by tick.

    An obstacle stays where it was seen last; of the time before this tick its last pose alone is kept.
    `count` grows with each change.
    """

    def __init__(self) -> None:
        self._now: dict[str, pin.SE3] = {}
        self._before: dict[str, pin.SE3] = {}
        self.count = 0

    def begin_tick(self) -> None:
        """Begin a tick: what is seen now was before it."""
        if self._before != self._now:
            self._before = dict(self._now)
            self.count += 1

    def place(self, name: str, pose: pin.SE3) -> None:
        """Note where the frame of an obstacle is in the world from this tick on."""
        last = self._now.get(name.casefold())
        if last is None or not np.array_equal(last.homogeneous, pose.homogeneous):
            self._now[name.casefold()] = pose
            self.count += 1

    def known(self, name: str) -> bool:
        """Whether an obstacle has been seen at all."""
        return name.casefold() in self._now

    def pose(self, name: str, time: float, own: Way, before: bool = False) -> pin.SE3:
        """Pose of an obstacle's frame as it is seen, or was `before` this tick.

        Of one that has not been seen, what its `own` way says of a time (s).
        """
        seen = (self._before if before else self._now).get(name.casefold())
        return own.pose(time) if seen is None else seen
