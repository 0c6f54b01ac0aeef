"""Samples of rows that come one by one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.pacing.correction.nearness import NearPair
from irlx.streams.sample import Sample

Array = NDArray[np.float64]


class Sampler:
    """Counts ticks of `tick_ns`, and takes differences from rest before the first row.

    `last` is the sample made last.
    """

    last: Sample

    def __init__(self, tick_ns: int) -> None:
        self._tick_ns = tick_ns
        self._tick = -1
        self._q: Array | None = None
        self._qd: Array | None = None
        self._quaternion: Array | None = None

    def sample(
        self,
        q: Array,
        rotation: Array,
        position: Array,
        block: int,
        correction: Array | None,
        nearest: NearPair | None = None,
    ) -> Sample:
        """The next sample: posture (n,), rotation (3, 3) and position (3,) m of the tool, id of the block.

        The sample has arrays of its own.
        """
        dt = self._tick_ns / 1e9
        still = np.zeros_like(q)
        qd = still if self._q is None else (q - self._q) / dt
        qdd = still.copy() if self._qd is None else (qd - self._qd) / dt
        quaternion = Rotation.from_matrix(rotation).as_quat()
        if self._quaternion is not None and float(self._quaternion @ quaternion) < 0.0:
            quaternion = -quaternion
        self._tick, self._q, self._qd, self._quaternion = self._tick + 1, q, qd, quaternion
        tool = np.concatenate([position, quaternion])
        t = self._tick * self._tick_ns / 1e9
        own = None if correction is None else correction.copy()
        self.last = Sample(self._tick, t, q.copy(), qd.copy(), qdd, tool, block, own, nearest)
        return self.last
