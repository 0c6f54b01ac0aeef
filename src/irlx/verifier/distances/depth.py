"""How deep convex sets overlap: the least shift that parts them."""

from __future__ import annotations

import numpy as np

from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.distances.placed import Convex, unit

_REFINED = 6
_STEPS = 60
_SAMPLES = 48
_PEAKS = 3
_SHRINKS = 50


def overlap_depth(
    first: Convex, second: Convex, known: Floats, thorough: bool = True
) -> tuple[Floats, Floats]:
    """Widest slab (M,) between M pairs of sets, m, below 0 where they overlap, and its direction (M, 3).

    Every direction gives a slab, so none found is wider than the widest. That lies across a face of either or
    two edges, or on a circle of normals (of an edge, of the side of a cylinder or cone), or, between rims,
    where the width is smooth: there it is climbed to from the best of all these, of directions all round, and
    of those `known` (M, 3). Not `thorough`, bodies with round faces may seem deeper than they are.
    """
    directions = _candidates(first, second, known)
    search = thorough and (first.round or second.round)
    if search:
        around = np.broadcast_to(_AROUND, (len(known), *_AROUND.shape))
        directions = np.concatenate([directions, _on_ridges(first, second), around], axis=1)
    widths = np.stack([_width(first, second, directions[:, i]) for i in range(directions.shape[1])], axis=1)
    best = np.argsort(-widths, axis=1)[:, : _REFINED if search else 1]
    rows = np.repeat(np.arange(len(best)), best.shape[1])
    width, found = widths[rows, best.ravel()], directions[rows, best.ravel()]
    if search:
        width, found = _widened(first.take(rows), second.take(rows), found, width)
    width = width.reshape(len(best), -1)
    top = np.argmax(width, axis=1)
    each: Integers = np.arange(len(best))
    return width[each, top], found.reshape(len(best), -1, 3)[each, top]


def _on_ridges(first: Convex, second: Convex) -> Floats:
    """Directions (M, D, 3): on every circle of normals those across which the slab is widest nearby.

    Outward normals of the second set point against the direction from the first.
    """
    ridges = np.concatenate([first.ridges, second.ridges * np.array([-1.0, -1.0, -1.0, 1.0])], axis=1)
    found = [_widest_on(first, second, ridges[:, i]) for i in range(ridges.shape[1])]
    count = len(first.centres)
    return np.concatenate(found, axis=1) if found else np.zeros((count, 0, 3))


def _widest_on(first: Convex, second: Convex, ridge: Floats) -> Floats:
    """Directions (M, P, 3): the best of samples around a circle (M, 4), each moved in steps that shrink."""
    axis, cosine = ridge[:, :3], ridge[:, 3:]
    sine = np.sqrt(1.0 - cosine**2)
    least = np.eye(3)[np.argmin(np.abs(axis), axis=1)]
    across = unit(np.cross(axis, least))
    other = np.cross(axis, across)

    def at(angle: Floats) -> Floats:
        turned = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * other
        return np.asarray(cosine * axis + sine * turned)

    angles = np.linspace(0.0, 2.0 * np.pi, _SAMPLES, endpoint=False)
    widths = np.stack([_width(first, second, at(np.full(len(axis), angle))) for angle in angles], axis=1)
    before, behind = np.roll(widths, 1, axis=1), np.roll(widths, -1, axis=1)
    peaks = (widths >= before) & (widths >= behind)
    order = np.argsort(-np.where(peaks, widths, -np.inf), axis=1)[:, :_PEAKS]
    found = []
    for place in order.T:
        angle, width = angles[place], widths[np.arange(len(axis)), place]
        step = np.full(len(axis), np.pi / _SAMPLES)
        for _ in range(_SHRINKS):
            for side in (step, -step):
                tried = _width(first, second, at(angle + side))
                better = tried > width
                angle, width = np.where(better, angle + side, angle), np.where(better, tried, width)
            step = 0.6 * step
        found.append(at(angle))
    return np.stack(found, axis=1)


def _width(first: Convex, second: Convex, directions: Floats) -> Floats:
    """Width (M,) of the slab across unit directions (M, 3), -inf where a direction is 0."""
    corner = first.support(directions) - second.support(-directions)
    width = -np.einsum("mi,mi->m", corner, directions)
    return np.where(directions.any(axis=1), width, -np.inf)


def _candidates(first: Convex, second: Convex, known: Floats) -> Floats:
    faces = np.concatenate([first.faces, second.faces], axis=1)
    edges = np.cross(first.edges[:, :, None], second.edges[:, None])
    lines = np.concatenate([faces, unit(edges.reshape(len(known), -1, 3))], axis=1)
    centres = unit(second.centres - first.centres)[:, None]
    return np.concatenate([lines, -lines, known[:, None], centres], axis=1)


def _widened(first: Convex, second: Convex, directions: Floats, width: Floats) -> tuple[Floats, Floats]:
    """Climb from directions (M, 3): the slab widens away from its support point, in steps halved at need."""
    step = np.ones(len(width))
    for _ in range(_STEPS):
        corner = first.support(directions) - second.support(-directions)
        across = corner - np.einsum("mi,mi->m", corner, directions)[:, None] * directions
        scale = step / np.maximum(np.linalg.norm(corner, axis=1), 1e-300)
        tried = unit(directions - scale[:, None] * across)
        wider = _width(first, second, tried)
        better = wider > width
        directions = np.where(better[:, None], tried, directions)
        width = np.where(better, wider, width)
        step = np.where(better, np.minimum(2.0 * step, 8.0), 0.5 * step)
    return width, directions


def _spiral(count: int) -> Floats:
    """Unit vectors (count, 3) about evenly spread."""
    index = np.arange(count) + 0.5
    up, turn = 1.0 - 2.0 * index / count, np.pi * (1.0 + 5.0**0.5) * index
    out = np.sqrt(1.0 - up * up)
    return np.stack([out * np.cos(turn), out * np.sin(turn), up], axis=1)


_AROUND = _spiral(40)
