"""Where obstacles have been seen while a program runs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pinocchio as pin

from irlx.scene.trajectory import Way


class _Seen(NamedTuple):
    """Where an obstacle is from the time `since` (s) on, and what held before."""

    pose: pin.SE3
    since: float
    before: pin.SE3 | None


class Sightings:
    """The last poses of obstacles that somebody sees, by name whatever its case.

    A sighting holds from its time on until the next one; of the time before it the last sighting alone is
    kept. `count` grows with each.
    """

    def __init__(self) -> None:
        self._seen: dict[str, _Seen] = {}
        self.count = 0

    def place(self, name: str, pose: pin.SE3, since: float) -> None:
        """Note where the frame of an obstacle is in the world from the time `since` (s) of the run on."""
        key = name.casefold()
        last = self._seen.get(key)
        if last is not None and np.array_equal(last.pose.homogeneous, pose.homogeneous):
            # It rests: there is nothing before it that differs.
            self._seen[key] = last._replace(before=last.pose)
            return
        self._seen[key] = _Seen(pose, since, None if last is None else last.pose)
        self.count += 1

    def known(self, name: str) -> bool:
        """Whether an obstacle has been seen at all."""
        return name.casefold() in self._seen

    def pose(self, name: str, time: float, own: Way) -> pin.SE3:
        """Pose of an obstacle's frame at a time (s): as it is seen, before that its `own` way."""
        seen = self._seen.get(name.casefold())
        if seen is None:
            return own.pose(time)
        if time >= seen.since:
            return seen.pose
        return own.pose(time) if seen.before is None else seen.before
