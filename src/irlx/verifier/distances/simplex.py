"""The point of a simplex nearest to the origin, for many simplices at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.streams.joint_stream import Floats

_FLAT = 1e-24
"""Squared sine of the angle between two edges below which a triangle counts as a line."""


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
    best, points = np.einsum("mi,mi->m", newest, newest), newest.copy()
    needs = np.zeros_like(held)
    for i in range(3):
        along = -np.einsum("mi,mi->m", newest, edges[:, i])
        usable = held[:, i] & (squares[:, i] > 0.0) & (along > 0.0)
        share = np.minimum(np.divide(along, squares[:, i], out=np.zeros_like(along), where=usable), 1.0)
        foot = newest + share[:, None] * edges[:, i]
        size = np.einsum("mi,mi->m", foot, foot)
        better = usable & (size < best)
        best[better], points[better] = size[better], foot[better]
        needs[better] = np.arange(3) == i
    normals = {}
    for i, j in ((0, 1), (0, 2), (1, 2)):
        normal = _cross(edges[:, i], edges[:, j])
        normals[i, j] = normal
        area = np.einsum("mi,mi->m", normal, normal)
        usable = held[:, i] & held[:, j] & (area > _FLAT * squares[:, i] * squares[:, j])
        first = np.einsum("mi,mi->m", _cross(edges[:, j], newest), normal)
        second = np.einsum("mi,mi->m", _cross(newest, edges[:, i]), normal)
        usable &= (first >= 0.0) & (second >= 0.0) & (first + second <= area)
        height = np.einsum("mi,mi->m", newest, normal)
        # Along the normal, not as a sum of corners: so its direction is right even where it is tiny.
        share = np.divide(height, area, out=np.zeros_like(area), where=usable)
        better = usable & (share * height < best)
        best[better], points[better] = (share * height)[better], (share[:, None] * normal)[better]
        needs[better] = (np.arange(3) == i) | (np.arange(3) == j)
    inside = _inside(newest, edges, normals, squares) & held.all(axis=1)
    points[inside], needs[inside] = 0.0, True
    return Nearest(points, needs, inside)


def _inside(
    newest: Floats, edges: Floats, normals: dict[tuple[int, int], Floats], squares: Floats
) -> NDArray[np.bool_]:
    """Whether the origin is in the tetrahedron: all its shares of the corners are at least 0."""
    volume = np.einsum("mi,mi->m", edges[:, 0], normals[1, 2])
    sign = np.where(volume >= 0.0, 1.0, -1.0)
    shares = (
        -np.einsum("mi,mi->m", newest, normals[1, 2]) * sign,
        np.einsum("mi,mi->m", newest, normals[0, 2]) * sign,
        -np.einsum("mi,mi->m", newest, normals[0, 1]) * sign,
    )
    volume = np.abs(volume)
    found: NDArray[np.bool_] = volume**2 > _FLAT * np.prod(squares, axis=1)
    for share in shares:
        found &= share >= 0.0
    return np.asarray(found & (sum(shares) <= volume))


def _cross(a: Floats, b: Floats) -> Floats:
    """Cross products (M, 3), some times quicker than numpy's general one."""
    found = np.empty_like(a)
    found[:, 0] = a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1]
    found[:, 1] = a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2]
    found[:, 2] = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return found
