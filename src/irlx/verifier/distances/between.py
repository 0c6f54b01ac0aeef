"""Distances between two bodies, one of which is at many places."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.streams.joint_stream import Floats
from irlx.verifier.distances.body import Body, ConvexBody, HalfspaceBody, MeshBody, SolidBody
from irlx.verifier.distances.mesh_pairs import nearest_triangles
from irlx.verifier.distances.placed import Placed, Resting, backward, onward
from irlx.verifier.distances.separation import Gaps, separation


def distances(
    first: Body,
    second: SolidBody,
    positions: Floats,
    rotations: Floats,
    start: Floats | None = None,
    enough: Floats | None = None,
) -> Gaps:
    """Brackets of the distances between `first`, at the origin, and `second` at M poses in its frame.

    Positions (M, 3) m, rotations (M, 3, 3); `start` (M, 3): directions to begin the search with. Brackets of
    distances that are beyond `enough` (M,), m, may be wide, up to half of that excess. Below 0 the
    bodies overlap: convex ones as deep as the least shift that parts them, a mesh as deep as the worst of its
    triangles does, and where one is wholly inside the other as deep as their surfaces are apart.
    """
    if isinstance(first, HalfspaceBody):
        down = np.broadcast_to([0.0, 0.0, -1.0], positions.shape)
        above = positions[:, 2] - second.height(backward(rotations, down))
        return Gaps(above, above, -down)
    if isinstance(first, ConvexBody) and isinstance(second, ConvexBody):
        resting = Resting(first.core, len(positions))
        beyond = None if enough is None else enough + (first.radius + second.radius)
        found = separation(resting, Placed(second.core, positions, rotations), start, enough=beyond)
    else:
        found = nearest_triangles(first, second, positions, rotations)
        inside = _one_inside(first, second, positions, rotations, found.upper)
        # Both surfaces are apart, by no more than `upper` and no less than `lower`.
        lower = np.where(inside, -found.upper, found.lower)
        found = Gaps(lower, np.where(inside, -found.lower, found.upper), found.direction)
    radii = first.radius + second.radius
    return Gaps(found.lower - radii, found.upper - radii, found.direction)


def slab(first: Body, second: SolidBody, positions: Floats, rotations: Floats, directions: Floats) -> Floats:
    """Widths (M,) of the empty slabs between both across unit `directions` (M, 3): at most the distances."""
    if isinstance(first, HalfspaceBody):
        return distances(first, second, positions, rotations).lower
    away = np.einsum("mi,mi->m", positions, directions)
    return np.asarray(away - second.height(backward(rotations, -directions)) - first.height(directions))


def _one_inside(
    first: SolidBody, second: SolidBody, positions: Floats, rotations: Floats, apart: Floats
) -> NDArray[np.bool_]:
    """Whether one of two bodies with surfaces `apart` (M,) is wholly inside the other, which is a mesh.

    Between rows no more apart than their surfaces were, nothing changes sides.
    """
    inside = np.zeros(len(positions), dtype=np.bool_)
    for_sure = np.flatnonzero(apart > 0.0)
    if not for_sure.size:
        return inside
    asked = for_sure[_changes(second, positions[for_sure], rotations[for_sure], apart[for_sure])]
    found = np.zeros(len(asked), dtype=np.bool_)
    if isinstance(first, MeshBody):
        point = second.corners[0, 0] if isinstance(second, MeshBody) else second.centre
        at = positions[asked] + onward(rotations[asked], np.broadcast_to(point, (len(asked), 3)))
        found |= np.abs(first.winds_around(at)) > 0.5
    if isinstance(second, MeshBody):
        point = first.corners[0, 0] if isinstance(first, MeshBody) else first.centre
        at = backward(rotations[asked], point - positions[asked])
        found |= np.abs(second.winds_around(at)) > 0.5
    inside[for_sure] = found[np.searchsorted(asked, for_sure, side="right") - 1]
    return inside


def _changes(body: SolidBody, positions: Floats, rotations: Floats, apart: Floats) -> NDArray[np.bool_]:
    """Which of M poses in order are further from the one before than the surfaces were `apart` there."""
    moved = displacement(body, positions[1:], rotations[1:], positions[:-1], rotations[:-1])
    return np.concatenate([[True], ~(moved < apart[:-1])])


def displacement(
    body: SolidBody, positions: Floats, rotations: Floats, from_positions: Floats, from_rotations: Floats
) -> Floats:
    """At least the way (M,) of any point of a body between two poses, m.

    Centre c and radius r of a ball around the body: |c' - c| + r |R' - R|, the norm of the difference of two
    rotations being its Frobenius norm over sqrt 2.
    """
    turned = rotations - from_rotations
    centre = np.broadcast_to(body.centre, positions.shape)
    way = np.linalg.norm(positions - from_positions + onward(turned, centre), axis=1)
    turn = np.sqrt(0.5 * np.einsum("mij,mij->m", turned, turned))
    return np.asarray(way + body.reach * turn)
