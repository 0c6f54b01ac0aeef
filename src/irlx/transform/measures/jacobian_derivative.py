"""How the tool Jacobian of a chain changes with the joints."""

from __future__ import annotations

import numpy as np

from irlx.transform.measures.measure import Array


def _bracket() -> Array:
    """C (6, 6, 6) with [a, b]_k = sum C_kab a_a b_b of twists (linear, angular)."""
    cross = np.zeros((3, 3, 3))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        cross[i, j, k], cross[i, k, j] = 1.0, -1.0
    table = np.zeros((6, 6, 6))
    table[:3, 3:, :3] = table[:3, :3, 3:] = table[3:, 3:, 3:] = cross
    return table


_BRACKET = _bracket()


def jacobian_derivative(jacobian: Array, nearer_tool: Array) -> Array:
    """Derivative of a Jacobian in the tool frame, shape (6, n), by q: shape (6, n, n), joint of q last.

    `nearer_tool` (n, n) is 1 at (i, j) where joint j comes after joint i on the way to the tool, else 0.

    Column i of the Jacobian is the axis of joint i seen from the tool. A step of a later joint j moves the
    tool, and so the frame it is seen from, by the twist J_j: dJ_i / dq_j = [J_i, J_j] for j after i, else 0,
    with the Lie bracket [a, b] = (w_a x v_b + v_a x w_b, w_a x w_b) of twists (v, w). Holds in any unit of
    length.
    """
    return np.asarray(jacobian.T @ (_BRACKET @ jacobian) * nearer_tool)
