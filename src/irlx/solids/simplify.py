"""Surfaces of fewer triangles, for pictures."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from irlx.solids.mesh_file import MeshReaderMissing
from irlx.solids.triangles import Triangles

_KEPT = 256


@lru_cache(maxsize=_KEPT)
def simplified(surface: Triangles, most: int) -> Triangles:
    """A surface of about `most` triangles at most that looks like the given one, by edges that collapse.

    Each collapse is the one that moves the surface least (quadric error, Garland and Heckbert 1997); what
    has no more triangles than that is given back as it is. For the eye alone: a simplified surface may lie
    inside or outside of the real one. Raises MeshReaderMissing without the extra `meshes`.
    """
    if len(surface.faces) <= most:
        return surface
    try:
        from fast_simplification import simplify
    except ImportError as cause:
        raise MeshReaderMissing("the package fast-simplification is not installed") from cause
    points, faces = surface.vertices.astype(np.float32), surface.faces.astype(np.uint32)
    vertices, kept = simplify(points, faces, target_count=most)
    return Triangles(np.asarray(vertices, dtype=float), np.asarray(kept, dtype=np.int64))


def fair_shares(sizes: Sequence[int], budget: int) -> int:
    """The largest share so that parts of these `sizes`, each cut down to it, are no more than `budget`.

    Small parts stay whole; 1 at least.
    """
    left, rest = budget, sorted(sizes)
    while rest:
        share = left // len(rest)
        if rest[0] > share:
            return max(share, 1)
        left -= rest.pop(0)
    return max([1, *sizes])
