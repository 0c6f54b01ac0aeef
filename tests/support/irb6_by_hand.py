"""The kinematics of irb6 worked out on paper: poses, differential decomposition, inverse.

In the plane of the arm, which joint 1 turns about the vertical, with e_r outwards, e_t sideways, e_z up:

    upper arm (sin t2, cos t2), forearm (cos t3, -sin t3), tool axis (cos t4, -sin t4) by (e_r, e_z),
    r = a2 sin t2 + a3 cos t3 + d5 cos t4,    z = h + a2 cos t2 - a3 sin t3 - d5 sin t4.

Inclinations are those against the world, so that t2 and t3 do not turn the tool: it turns by
w = dt1 e_z + dt4 e_t + dt5 u, u its axis. With n = u x e_t = cos t4 e_z + sin t4 e_r, the wrist's third axis,

    w e_t = dt4,    w u = dt5 - dt1 sin t4,    w n = dt1 cos t4.

The first two are asked for; the third is what the position ties it to: dt1 = dp e_t / r.
"""

from __future__ import annotations

import numpy as np

HEIGHT, UPPER, FOREARM, HAND = 0.70, 0.45, 0.67, 0.095
LENGTHS = (HEIGHT, UPPER, FOREARM, HAND)


def wrist_axes(q: np.ndarray) -> np.ndarray:
    """Columns u, e_t, n (3, 3) in the world."""
    c1, s1, c4, s4 = np.cos(q[0]), np.sin(q[0]), np.cos(q[3]), np.sin(q[3])
    e_r, e_t = np.array([c1, s1, 0.0]), np.array([-s1, c1, 0.0])
    e_z = np.array([0.0, 0.0, 1.0])
    return np.stack([c4 * e_r - s4 * e_z, e_t, c4 * e_z + s4 * e_r], axis=1)


def radius(q: np.ndarray, lengths: tuple[float, ...] = LENGTHS) -> float:
    """Distance of the tool from the axis of the base, m."""
    _, a2, a3, d5 = lengths
    return float(a2 * np.sin(q[1]) + a3 * np.cos(q[2]) + d5 * np.cos(q[3]))


def pose(q: np.ndarray, lengths: tuple[float, ...] = LENGTHS) -> tuple[np.ndarray, np.ndarray]:
    """Rotation (3, 3) and position (3,) m of the tool."""
    h, a2, a3, d5 = lengths
    r = radius(q, lengths)
    z = h + a2 * np.cos(q[1]) - a3 * np.sin(q[2]) - d5 * np.sin(q[3])
    u, e_t, n = wrist_axes(q).T
    c5, s5 = np.cos(q[4]), np.sin(q[4])
    rotation = np.stack([u, c5 * e_t + s5 * n, c5 * n - s5 * e_t], axis=1)
    return rotation, np.array([r * np.cos(q[0]), r * np.sin(q[0]), z])


def joint_step(q: np.ndarray, moved: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """Joint steps (5,) for a displacement (3,) m and a turn (3,) rad of the tool, both in the world."""
    (_, a2, a3, d5), (u, e_t, _) = LENGTHS, wrist_axes(q).T
    e_r = np.array([np.cos(q[0]), np.sin(q[0]), 0.0])
    d1 = moved @ e_t / radius(q)
    d4 = turned @ e_t
    d5_ = turned @ u + d1 * np.sin(q[3])
    # What the hand does not do of it is left to the two arms.
    dr = moved @ e_r + d5 * np.sin(q[3]) * d4
    dz = moved[2] + d5 * np.cos(q[3]) * d4
    opened = np.cos(q[1] - q[2])
    d2 = (np.cos(q[2]) * dr - np.sin(q[2]) * dz) / (a2 * opened)
    d3 = -(np.sin(q[1]) * dr + np.cos(q[1]) * dz) / (a3 * opened)
    return np.array([d1, d2, d3, d4, d5_])


def posture(rotation: np.ndarray, position: np.ndarray) -> np.ndarray:
    """The posture (5,) of a pose that the arm can meet, reaching forward with its elbow up and behind."""
    (h, a2, a3, d5) = LENGTHS
    t1 = np.arctan2(position[1], position[0])
    e_r, e_t = np.array([np.cos(t1), np.sin(t1), 0.0]), np.array([-np.sin(t1), np.cos(t1), 0.0])
    u = rotation[:, 0]
    t4 = np.arctan2(-u[2], u @ e_r)
    t5 = np.arctan2(-rotation[:, 2] @ e_t, rotation[:, 1] @ e_t)
    x, y = position @ e_r - d5 * np.cos(t4), position[2] - h + d5 * np.sin(t4)
    # The elbow from the triangle of shoulder, elbow and wrist: it lies above the line to the wrist.
    reach, slope = np.hypot(x, y), np.arctan2(y, x)
    beside = np.arccos((reach**2 + a2**2 - a3**2) / (2.0 * reach * a2))
    t2 = np.pi / 2 - (slope + beside)
    elbow = a2 * np.array([np.sin(t2), np.cos(t2)])
    t3 = np.arctan2(-(y - elbow[1]), x - elbow[0])
    return np.array([t1, t2, t3, t4, t5])
