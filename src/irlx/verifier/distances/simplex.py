"""The point of a simplex nearest to the origin, for many simplices at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.streams.joint_stream import Floats

_FLAT = 1e-24
"""Squared sine of the angle between two edges below which a triangle counts as a line."""

_ONE, _OTHER = np.array([0, 0, 1]), np.array([1, 2, 2])
"""The older corners of the three faces."""

_NEEDS = np.array(
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 0, 1], [0, 1, 1]], dtype=np.bool_
)
"""Which older corners the newest one, the three edges and the three faces need."""


class Nearest(NamedTuple):
    """Nearest points (M, 3); which of the older corners they need (M, 3); if the origin is inside (M,)."""

    points: Floats
    needs: NDArray[np.bool_]
    inside: NDArray[np.bool_]


def nearest_to_origin(newest: Floats, older: Floats, held: NDArray[np.bool_]) -> Nearest:
    """Nearest points of simplices with corners `newest` (M, 3), and `older` (M, 3, 3) that are `held`.

    Only faces with the newest corner are looked at, each by its own formula, and the best of those whose
    foot of the perpendicular lies in them is taken: no order of cases that rounding could upset.
    """
    edges = older - newest[:, None]
    squares = np.einsum("mij,mij->mi", edges, edges)
    along = -np.einsum("mj,mij->mi", newest, edges)
    usable = held & (squares > 0.0) & (along > 0.0)
    share = np.minimum(np.divide(along, squares, out=np.zeros_like(along), where=usable), 1.0)
    feet = newest[:, None] + share[:, :, None] * edges
    on_edges = np.where(usable, np.einsum("mij,mij->mi", feet, feet), np.inf)
    normals = _cross(edges[:, _ONE], edges[:, _OTHER])
    area = np.einsum("mij,mij->mi", normals, normals)
    usable = held[:, _ONE] & held[:, _OTHER] & (area > _FLAT * squares[:, _ONE] * squares[:, _OTHER])
    across = _cross(np.broadcast_to(newest[:, None], edges.shape), edges)
    first = -np.einsum("mij,mij->mi", across[:, _OTHER], normals)
    second = np.einsum("mij,mij->mi", across[:, _ONE], normals)
    usable &= (first >= 0.0) & (second >= 0.0) & (first + second <= area)
    height = np.einsum("mj,mij->mi", newest, normals)
    # Along the normal, not as a sum of corners: so its direction is right even where it is tiny.
    share = np.divide(height, area, out=np.zeros_like(area), where=usable)
    on_faces = np.where(usable, share * height, np.inf)
    rows, itself = np.arange(len(newest)), np.einsum("mi,mi->m", newest, newest)
    sizes = np.concatenate([itself[:, None], on_edges, on_faces], axis=1)
    # What is no number is nearer than nothing.
    sizes[:, 1:][~(sizes[:, 1:] < itself[:, None])] = np.inf
    best = np.where(np.isnan(itself), 0, np.argmin(sizes, axis=1))
    places = np.concatenate([newest[:, None], feet, share[:, :, None] * normals], axis=1)
    points, needs = places[rows, best], _NEEDS[best]
    inside = _inside(newest, edges, normals, squares) & held.all(axis=1)
    points[inside], needs[inside] = 0.0, True
    return Nearest(points, needs, inside)


def _inside(newest: Floats, edges: Floats, normals: Floats, squares: Floats) -> NDArray[np.bool_]:
    """Whether the origin is in the tetrahedron: all its shares of the corners are at least 0."""
    volume = np.einsum("mi,mi->m", edges[:, 0], normals[:, 2])
    sign = np.where(volume >= 0.0, 1.0, -1.0)
    shares = (
        -np.einsum("mi,mi->m", newest, normals[:, 2]) * sign,
        np.einsum("mi,mi->m", newest, normals[:, 1]) * sign,
        -np.einsum("mi,mi->m", newest, normals[:, 0]) * sign,
    )
    volume = np.abs(volume)
    found: NDArray[np.bool_] = volume**2 > _FLAT * np.prod(squares, axis=1)
    for share in shares:
        found &= share >= 0.0
    return np.asarray(found & (sum(shares) <= volume))


def _cross(a: Floats, b: Floats) -> Floats:
    """Cross products (M, 3, 3) of rows, some times quicker than numpy's general one."""
    found = np.empty(a.shape)
    found[..., 0] = a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1]
    found[..., 1] = a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
    found[..., 2] = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return found
