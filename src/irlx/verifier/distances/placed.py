"""Many convex sets at once, each at a place of its own, in one common frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.distances.core import Core


class Convex(Protocol):
    """M convex sets."""

    def support(self, directions: Floats) -> Floats:
        """Points (M, 3) of the sets furthest in directions (M, 3)."""

    def take(self, which: Integers) -> Convex:
        """Those of the given indices."""

    @property
    def round(self) -> bool:
        """Whether they have faces or edges that bend."""

    @property
    def centres(self) -> Floats:
        """A point (M, 3) inside each."""

    @property
    def faces(self) -> Floats:
        """Normals (M, F, 3) of flat faces."""

    @property
    def edges(self) -> Floats:
        """Directions (M, E, 3) of straight edges."""

    @property
    def ridges(self) -> Floats:
        """Axes x, y, z and cosines (M, K, 4) of circles of normals at which support points jump."""


@dataclass(frozen=True, eq=False)
class Placed:
    """One core at M poses: positions (M, 3) m, rotations (M, 3, 3)."""

    core: Core
    positions: Floats
    rotations: Floats

    def support(self, directions: Floats) -> Floats:
        """Points (M, 3) furthest in directions (M, 3)."""
        own = self.core.support(backward(self.rotations, directions))
        return self.positions + onward(self.rotations, own)

    def take(self, which: Integers) -> Placed:
        """Those of the given indices."""
        return Placed(self.core, self.positions[which], self.rotations[which])

    @property
    def round(self) -> bool:
        """Whether they have faces or edges that bend."""
        return self.core.round

    @property
    def centres(self) -> Floats:
        """Their origins (M, 3)."""
        return self.positions

    @property
    def faces(self) -> Floats:
        """Normals (M, F, 3) of flat faces."""
        return np.asarray(np.einsum("mij,fj->mfi", self.rotations, self.core.faces))

    @property
    def edges(self) -> Floats:
        """Directions (M, E, 3) of straight edges."""
        return np.asarray(np.einsum("mij,fj->mfi", self.rotations, self.core.edges))

    @property
    def ridges(self) -> Floats:
        """Axes x, y, z and cosines (M, K, 4) of circles of normals at which support points jump."""
        own = self.core.ridges
        axes = np.einsum("mij,fj->mfi", self.rotations, own[:, :3])
        return np.concatenate([axes, np.broadcast_to(own[:, 3:], (*axes.shape[:2], 1))], axis=2)


@dataclass(frozen=True, eq=False)
class Resting:
    """One core, M times at the origin."""

    core: Core
    count: int

    def support(self, directions: Floats) -> Floats:
        """Points (M, 3) furthest in directions (M, 3)."""
        return self.core.support(directions)

    def take(self, which: Integers) -> Resting:
        """As many as there are indices."""
        return Resting(self.core, len(which))

    @property
    def round(self) -> bool:
        """Whether they have faces or edges that bend."""
        return self.core.round

    @property
    def centres(self) -> Floats:
        """Origins (M, 3)."""
        return np.zeros((self.count, 3))

    @property
    def faces(self) -> Floats:
        """Normals (M, F, 3) of flat faces."""
        return np.broadcast_to(self.core.faces, (self.count, *self.core.faces.shape))

    @property
    def edges(self) -> Floats:
        """Directions (M, E, 3) of straight edges."""
        return np.broadcast_to(self.core.edges, (self.count, *self.core.edges.shape))

    @property
    def ridges(self) -> Floats:
        """Axes x, y, z and cosines (M, K, 4) of circles of normals at which support points jump."""
        return np.broadcast_to(self.core.ridges, (self.count, *self.core.ridges.shape))


@dataclass(frozen=True, eq=False)
class Triangles:
    """M triangles with corners (M, 3, 3), m."""

    corners: Floats

    def support(self, directions: Floats) -> Floats:
        """Corners (M, 3) furthest in directions (M, 3)."""
        best = np.argmax(np.einsum("mij,mj->mi", self.corners, directions), axis=1)
        return np.asarray(self.corners[np.arange(len(best)), best])

    def take(self, which: Integers) -> Triangles:
        """Those of the given indices."""
        return Triangles(self.corners[which])

    @property
    def round(self) -> bool:
        """Whether they have faces or edges that bend."""
        return False

    @property
    def centres(self) -> Floats:
        """Means (M, 3) of the corners."""
        return np.asarray(self.corners.mean(axis=1))

    @property
    def faces(self) -> Floats:
        """Normals (M, 1, 3), 0 where the corners lie on a line."""
        return unit(np.cross(self.edges[:, 0], self.edges[:, 1]))[:, None]

    @property
    def edges(self) -> Floats:
        """Directions (M, 3, 3) of the edges, 0 where two corners are one."""
        return unit(np.roll(self.corners, -1, axis=1) - self.corners)

    @property
    def ridges(self) -> Floats:
        """Axes x, y, z and cosines (M, 3, 4) of circles of normals at which support points jump."""
        return np.concatenate([self.edges, np.zeros((len(self.corners), 3, 1))], axis=2)


def onward(rotations: Floats, vectors: Floats) -> Floats:
    """Products R v (M, 3)."""
    return np.asarray(np.einsum("mij,mj->mi", rotations, vectors))


def backward(rotations: Floats, vectors: Floats) -> Floats:
    """Products R' v (M, 3)."""
    return np.asarray(np.einsum("mji,mj->mi", rotations, vectors))


def unit(vectors: Floats) -> Floats:
    """Vectors (.., 3) divided by their length; 0 stays 0."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0.0))
