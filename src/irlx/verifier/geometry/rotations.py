"""Rotation matrices by the verifier's own formulas; all functions work on stacks of them."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from irlx.streams.joint_stream import Floats


def cross_matrix(axis: Floats) -> Floats:
    """Matrix K (3, 3) with K v = axis x v."""
    x, y, z = axis
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def about_axis(axis: Floats, angles: Floats) -> Floats:
    """Turns about a unit axis (3,) by angles (N,) rad: I + sin a K + (1 - cos a) K^2, shape (N, 3, 3)."""
    k = cross_matrix(axis)
    half = np.sin(0.5 * angles)
    return np.eye(3) + np.sin(angles)[:, None, None] * k + (2.0 * half * half)[:, None, None] * (k @ k)


@lru_cache(maxsize=1024)
def from_rpy(rpy: tuple[float, float, float]) -> Floats:
    """Rz(yaw) Ry(pitch) Rx(roll), shape (3, 3), of turns about the fixed axes x, y, z, rad.

    Not to be changed: each is made once, a robot's joints having the same ones in all portions of rows.
    """
    turns = [about_axis(axis, np.array([angle]))[0] for axis, angle in zip(np.eye(3), rpy, strict=True)]
    found: Floats = turns[2] @ turns[1] @ turns[0]
    found.setflags(write=False)
    return found


def from_quaternion(xyzw: Floats) -> Floats:
    """Matrices (..., 3, 3) of unit quaternions (..., 4), scalar last.

    Quaternions of another length give matrices that are no rotations, and show as such.
    """
    x, y, z, w = np.ascontiguousarray(np.moveaxis(xyzw, -1, 0))
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    found = np.empty((*x.shape, 3, 3))
    for i, row in enumerate(rows):
        for j, value in enumerate(row):
            found[..., i, j] = value
    return found


def angle_between(first: Floats, second: Floats) -> Floats:
    """Angle (...) rad between rotations (..., 3, 3): |A - B| = 2 sqrt(2) sin(angle / 2).

    The Frobenius norm keeps full relative accuracy for small angles, where the trace does not.
    """
    apart = first - second
    distance = np.sqrt(np.einsum("...ij,...ij->...", apart, apart))
    return np.asarray(2.0 * np.arcsin(np.minimum(distance / np.sqrt(8.0), 1.0)))


def rotation_vectors(rotations: Floats) -> Floats:
    """Axis times angle (N, 3), rad, angles in [0, pi], of rotations (N, 3, 3).

    By quaternion components: of the four, the largest is taken from the diagonal, the others from
    sums and differences of the off-diagonal elements, so that no angle is ill-conditioned.
    """
    r = rotations
    trace = r[:, 0, 0] + r[:, 1, 1] + r[:, 2, 2]
    squares = np.stack([trace, *(2 * r[:, i, i] - trace for i in range(3))], axis=1) + 1.0
    w_row = [squares[:, 0], r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]]
    x_row = [w_row[1], squares[:, 1], r[:, 0, 1] + r[:, 1, 0], r[:, 0, 2] + r[:, 2, 0]]
    y_row = [w_row[2], x_row[2], squares[:, 2], r[:, 1, 2] + r[:, 2, 1]]
    z_row = [w_row[3], x_row[3], y_row[3], squares[:, 3]]
    candidates = np.stack([np.stack(row, axis=1) for row in (w_row, x_row, y_row, z_row)], axis=1)
    best = candidates[np.arange(len(r)), np.argmax(squares, axis=1)]
    best = best * np.where(best[:, :1] < 0.0, -1.0, 1.0)
    length = np.linalg.norm(best[:, 1:], axis=1)
    angle = 2.0 * np.arctan2(length, best[:, 0])
    scale = np.divide(angle, length, out=np.zeros_like(angle), where=length > 0.0)
    return np.asarray(best[:, 1:] * scale[:, None])
