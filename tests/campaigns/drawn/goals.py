"""Where moves go: near and far, exactly where the tool is, and off that by the rounding of a number."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from drawn.body import Pose
from drawn.script import Script
from irlx.verifier.geometry.link_poses import link_poses

RESIDUES = (1e-17, 1e-16, 1e-13, 1e-9, 1e-8, 1e-6, 1e-5, 1e-3)
"""Sizes of ways, m, and turns, rad, that are next to nothing."""


class Goals:
    """Draws goals for the next move of a script."""

    def __init__(self, script: Script) -> None:
        self.script, self.rng, self.body = script, script.rng, script.body

    # ---- Postures

    def posture(self, spread: float | None = None) -> np.ndarray:
        """Joint values about the start; now and then some exactly there, at zero, or on a limit."""
        rng, body, script = self.rng, self.body, self.script
        spread = body.spread if spread is None else spread
        q = body.start + spread * rng.normal(size=body.n)
        chosen = rng.random()
        if chosen < 0.02:
            script.note("goal: huge")
            q = body.start + rng.uniform(-0.8, 0.8, body.n)
        elif chosen < 0.1:
            script.note("goal: some joints stay")
            q = np.where(rng.random(body.n) < 0.6, body.start, q)
        elif chosen < 0.14:
            script.note("goal: on a limit")
            lower, upper = body.cell.limits.pair("position")
            joint = int(rng.integers(body.n))
            side = lower[joint] if rng.random() < 0.5 else upper[joint]
            if abs(side - body.start[joint]) < 0.6:
                q[joint] = side
        elif chosen < 0.18:
            script.note("goal: joints at zero")
            q[(np.abs(body.start) < 0.3) & (rng.random(body.n) < 0.5)] = 0.0
        elif chosen < 0.23:
            script.note("goal: joints of the start")
            q = body.start.copy()
        elif chosen < 0.28:
            script.note("goal: joints and a residue")
            q = body.start + rng.choice(RESIDUES) * rng.normal(size=body.n)
        return body.inside(q)

    def plain(self) -> np.ndarray:
        """Joint values about the start."""
        return self.body.inside(self.body.start + self.body.spread * self.rng.normal(size=self.body.n))

    # ---- Poses

    def of(self, q: np.ndarray) -> Pose:
        """Pose of the tool in use."""
        position, ori = self.body.pose(q)
        tool = self.script.tool
        return position + ori.apply(tool[0]), ori * tool[1]

    def pose(self) -> Pose:
        """Pose of a posture near the start, or one that is hardly another than where the tool is."""
        rng, script = self.rng, self.script
        at, chosen = script.at, rng.random()
        if at is not None and chosen < 0.05:
            script.note("goal: where the tool is")
            return at
        if at is not None and chosen < 0.12:
            script.note("goal: a residue away")
            return at[0] + self.shift(rng.choice(RESIDUES)), at[1] * self.turn(rng.choice([0.0, *RESIDUES]))
        if at is not None and chosen < 0.2 and self.body.robot.turns != "none":
            script.note("goal: a turn on the spot")
            return at[0], at[1] * self.turn(self.body.spread)
        if chosen < 0.26:
            script.note("goal: the start")
            return self.of(self.body.start)
        return self.of(self.posture())

    def shift(self, size: float) -> np.ndarray:
        """A displacement, m, that the robot can make; some of its parts exactly 0."""
        way = size * self.rng.normal(size=3) * self.rng.choice([1.0, 1.0, 0.0], size=3)
        if self.body.robot.flat:
            way[2] = 0.0
        return way

    def turn(self, size: float) -> Rotation:
        """A turn about an axis that the robot has; the identity where it has none."""
        vector = size * self.rng.normal(size=3)
        if self.body.robot.turns == "z":
            vector[:2] = 0.0
        return Rotation.from_rotvec(vector if self.body.robot.turns != "none" else np.zeros(3))

    def circle(self, at: Pose, via: float, end: float) -> tuple[np.ndarray, np.ndarray]:
        """Positions after so many degrees of a circle through where the tool is."""
        rng = self.rng
        u, other = rng.normal(size=3), rng.normal(size=3)
        if self.body.robot.flat:
            u[2] = other[2] = 0.0
        u /= np.linalg.norm(u)
        w = np.cross(u, np.cross(other, u))
        w /= np.linalg.norm(w)
        radius = float(rng.uniform(0.2, 0.6)) * self.body.way * float(rng.choice([1.0, 1.0, 1.0, 1e-2]))
        # Points nearer than a thousandth of a millimetre make no circle.
        radius = max(radius, 5e-5)

        def point(degrees: float) -> np.ndarray:
            angle = np.radians(degrees)
            return at[0] + radius * ((1.0 - np.cos(angle)) * u + np.sin(angle) * w)

        return point(via), point(end)

    # ---- Frames of the cell

    def frame(self, name: str) -> Pose:
        """The frame of the cell that stands still, in the root frame."""
        found = self.body.cell.frames[name]
        w, x, y, z = found.quaternion
        return 1e-3 * np.array(found.position), Rotation.from_quat((x, y, z, w))

    def in_hand(self, q: np.ndarray) -> Pose:
        """Pose of the tool in the frame of the cell that the other hand carries."""
        frame = self.body.cell.link_frames[self.body.hand_frame]
        position, rotation = (
            part[0] for part in link_poses(self.body.cell.robot, q[None], {frame.link})[frame.link]
        )
        hand = Rotation.from_matrix(rotation)
        origin = position + hand.apply(frame.position)
        axes = hand * Rotation.from_quat(frame.orientation)
        tool = self.of(q)
        return axes.inv().apply(tool[0] - origin), axes.inv() * tool[1]
