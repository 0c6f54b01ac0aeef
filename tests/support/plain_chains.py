"""Chains of joints as plain numbers: forward kinematics and Jacobians without irlx and Pinocchio."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation


@dataclass(frozen=True)
class Chain:
    """Joints from the root to the tool: `at` (n + 1, 6) is xyz and rpy to each joint, then the tool."""

    axes: np.ndarray
    slides: np.ndarray
    at: np.ndarray
    task: tuple[int, ...]

    @property
    def n(self):
        return len(self.axes)

    @cached_property
    def fixed(self):
        """Rotations (n + 1, 3, 3) of the places of the joints."""
        return Rotation.from_euler("xyz", self.at[:, 3:]).as_matrix()

    @cached_property
    def crosses(self):
        """Matrices (n, 3, 3) of the cross products with the axes."""
        return np.cross(np.eye(3)[None], -self.axes[:, None, :]).transpose(0, 2, 1)

    def poses(self, q):
        """Rotations (N, 3, 3) and positions (N, 3) of the tool in postures q (N, n)."""
        rotation, position = np.broadcast_to(np.eye(3), (len(q), 3, 3)), np.zeros((len(q), 3))
        for number in range(self.n):
            position = position + rotation @ self.at[number, :3]
            rotation = rotation @ self.fixed[number]
            value = q[:, number, None]
            if self.slides[number]:
                position = position + (rotation @ self.axes[number]) * value
                continue
            cross = self.crosses[number]
            sine, cosine = np.sin(value)[..., None], np.cos(value)[..., None]
            rotation = rotation @ (np.eye(3) + sine * cross + (1.0 - cosine) * (cross @ cross))
        return rotation @ self.fixed[-1], position + rotation @ self.at[-1, :3]

    def pose(self, q):
        rotations, positions = self.poses(q[None])
        return rotations[0], positions[0]

    def all_left(self, q, target):
        """Coordinates (N, m) of the task that are missing from the tool at q (N, n) to the target."""
        rotations, positions = self.poses(q)
        back = rotations.transpose(0, 2, 1)
        shift = (back @ (target[1] - positions)[..., None])[..., 0]
        turn = Rotation.from_matrix(back @ target[0]).as_rotvec()
        return np.concatenate([shift, turn], axis=1)[:, list(self.task)]

    def left(self, q, target):
        return self.all_left(q[None], target)[0]

    def slope(self, q, target, h=3e-4):
        """Derivative (m, n) of `left`, by central differences of the fourth order."""
        units = np.eye(self.n) * h
        near, back, far, behind = np.split(
            self.all_left(np.concatenate([q + units, q - units, q + 2 * units, q - 2 * units]), target), 4
        )
        return ((8 * (near - back) - (far - behind)) / (12 * h)).T

    def urdf(self):
        """The same for irlx."""
        joints = ""
        for number, place in enumerate(self.at):
            moves = number < self.n
            kind = ("prismatic" if self.slides[number] else "revolute") if moves else "fixed"
            axis = f'<axis xyz="{numbers(self.axes[number])}"/>' if moves else ""
            limit = '<limit lower="-9" upper="9" velocity="1" effort="1"/>' if moves else ""
            joints += (
                f'<joint name="j{number}" type="{kind}"><parent link="l{number}"/>'
                f'<child link="l{number + 1}"/>'
                f'<origin xyz="{numbers(place[:3])}" rpy="{numbers(place[3:])}"/>{axis}{limit}</joint>'
            )
        links = "".join(f'<link name="l{number}"/>' for number in range(self.n + 2))
        return f'<robot name="chain">{links}{joints}</robot>'


def numbers(values):
    return " ".join(repr(float(value)) for value in values)
