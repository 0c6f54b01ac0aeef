"""The tool of a robot at many postures at once: poses, Jacobians and what is left to demands, by numpy."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pinocchio as pin

from irlx.robot.kinematics import Array, Kinematics
from irlx.robot.twists import twists_between

_UP, _DOWN = -1.0, 1.0


class _Stop(NamedTuple):
    """A moving joint on the way from the tool to the frame in which its poses are told.

    `hop` (4, 3) leads there from the stop before: the rotation of the joint's frame, transposed, and its
    origin, as seen from that stop. The frame is turned so that its z is the joint's axis. `sense` tells
    whether the way goes against the joint (up, to the parent) or along it; `place` is the joint's among those
    of the way in the order of the model.
    """

    hop: Array
    slides: bool
    sense: float
    place: int


def _along_z(axis: tuple[float, float, float]) -> pin.SE3:
    """A rotation whose third column is a unit vector; exact for axes of the frame."""
    third = np.array(axis)
    first = np.cross(np.eye(3)[np.argmin(np.abs(third))], third)
    first /= np.linalg.norm(first)
    return pin.SE3(np.column_stack([first, np.cross(third, first), third]), np.zeros(3))


def _hop(pose: pin.SE3) -> Array:
    return np.vstack([pose.rotation.T, pose.translation])


class ChainBatch:
    """Poses and Jacobians of the tool of `kinematics` at N postures in one go, a microsecond or two a row.

    What it gives agrees with `Kinematics.tool_poses` and `Kinematics.tool_difference` to rounding, not bit
    for bit: what is written to a stream does not come from here. Arrays are views whose memory has the row as
    its last index, `array.transpose(1, 2, 0)` of (N, .., ..) is contiguous; they are new ones at each call.

    The way is walked from the tool to the root, so that axes and origins of all joints come in the tool
    frame: a joint that turns about the axis z at the origin d moves the tool by the twist (d x z, z), one
    that slides by (z, 0). To a frame on another link the way leads on, down the other branch, and those
    joints count with the other sign.
    """

    def __init__(self, kinematics: Kinematics) -> None:
        self._kinematics = kinematics
        model = kinematics.model
        tool, seen_from = (model.frames[frame] for frame in kinematics.end_frames)
        ups, downs = (list(model.supports[frame.parentJoint]) for frame in (tool, seen_from))
        shared = sum(a == b for a, b in zip(ups, downs, strict=False))
        ups, downs = ups[: shared - 1 : -1], downs[shared:]
        joints = {joint.name: joint for joint in kinematics.description.moving}
        columns = sorted(joint - 1 for joint in (*ups, *downs))
        self._columns = np.array(columns, dtype=np.int64)
        self._stops: list[_Stop] = []
        # Leads from the last stop to the frame of the joint that comes next.
        onwards = tool.placement.inverse()
        for joint in (*ups, *downs):
            told = joints[model.names[joint]]
            sense, turn = _UP if joint in ups else _DOWN, _along_z(told.axis)
            own = model.jointPlacements[joint]
            there = onwards * turn if sense == _UP else onwards * own * turn
            self._stops.append(_Stop(_hop(there), told.is_prismatic, sense, columns.index(joint - 1)))
            onwards = turn.inverse() * own.inverse() if sense == _UP else turn.inverse()
        self._last = _hop(onwards * seen_from.placement)
        by_place = sorted(self._stops, key=lambda stop: stop.place)
        self._senses = np.array([stop.sense for stop in by_place]).reshape(-1, 1)
        self._slides = np.array([stop.slides for stop in by_place], dtype=bool)
        self._against = bool(downs)

    def poses(self, q: Array) -> tuple[Array, Array]:
        """Rotations (N, 3, 3) and positions (N, 3) m of the tool at postures q (N, n)."""
        rotation, position = self._pose(*self._walked(q))
        return rotation.transpose(2, 0, 1), position.T

    def poses_and_jacobians(self, q: Array) -> tuple[Array, Array, Array]:
        """`poses`, and the Jacobians (N, 6, n) in the tool frame, linear rows first."""
        frames, origins = self._walked(q)
        rotation, position = self._pose(frames, origins)
        jacobian = self._jacobian(frames, origins)
        return rotation.transpose(2, 0, 1), position.T, jacobian.transpose(2, 0, 1)

    def differences(self, q: Array, targets: tuple[Array, Array]) -> tuple[Array, Array]:
        """log6(T(q)^-1 T_target) (N, 6) and the Jacobians (N, 6, n), as `Kinematics.tool_difference` of each
        row; `targets` are rotations (N, 3, 3) and positions (N, 3) m."""
        frames, origins = self._walked(q)
        rotations, positions = targets
        # Copied into the layout of the rest: numpy is slow where arrays are laid out differently.
        goal = np.ascontiguousarray(rotations.transpose(1, 2, 0)), np.ascontiguousarray(positions.T)
        left = twists_between(self._pose(frames, origins), goal)
        return left.T, self._jacobian(frames, origins).transpose(2, 0, 1)

    def _walked(self, q: Array) -> tuple[Array, Array]:
        """Frames (k + 1, 4, 3, N) and origins (k + 1, 3, N) of the k joints of the way, in the tool frame.

        The first three of the four are the frame's x, y and z; x and y are those behind the joint, z is its
        axis. The last frame is that in which poses are told.
        """
        rows, last = len(q), len(self._stops)
        frames, origins = np.empty((last + 1, 4, 3, rows)), np.empty((last + 1, 3, rows))
        values = self._senses * self._kinematics.expanded(q).T[self._columns]
        cosines, sines = np.cos(values), np.empty((last, 2, 1, rows))
        np.sin(values, out=sines[:, 0, 0])
        np.negative(sines[:, 0], out=sines[:, 1])
        before = None
        for hop, slides, _, place in self._stops:
            _go(hop, before, frames[place], origins[place])
            frame, origin = frames[place], origins[place]
            if slides:
                # Its own place does not matter to a slide, so that it may hold the place behind it.
                origin += frame[2] * values[place]
            else:
                crossed = frame[1::-1] * sines[place]
                frame[:2] *= cosines[place]
                frame[:2] += crossed
            before = frame, origin
        _go(self._last, before, frames[last], origins[last])
        return frames, origins

    def _pose(self, frames: Array, origins: Array) -> tuple[Array, Array]:
        """Rotation (3, 3, N) and position (3, N) of the tool: the inverse of the way's end."""
        rotation = frames[-1, :3]
        position = (rotation * origins[-1]).sum(axis=1)
        return rotation, np.negative(position, out=position)

    def _jacobian(self, frames: Array, origins: Array) -> Array:
        """Jacobian (6, n, N) by the axes."""
        axes, offsets = frames[:-1, 2].transpose(1, 0, 2), origins[:-1].transpose(1, 0, 2)
        moved = np.empty((6, len(self._stops), len(frames[0, 0, 0])))
        for row, (a, b) in enumerate(((1, 2), (2, 0), (0, 1))):
            np.multiply(offsets[a], axes[b], out=moved[row])
            moved[row] -= offsets[b] * axes[a]
        moved[3:] = axes
        if self._slides.any():
            moved[:3, self._slides] = axes[:, self._slides]
            moved[3:, self._slides] = 0.0
        if self._against:
            moved *= -self._senses
        joints = self._kinematics.model.nv
        if len(self._columns) < joints:
            whole = np.zeros((6, joints, moved.shape[2]))
            whole[:, self._columns] = moved
            moved = whole
        coupling = self._kinematics.coupling
        return moved if coupling is None else np.asarray(coupling.T @ moved)


def _go(hop: Array, before: tuple[Array, Array] | None, frame: Array, origin: Array) -> None:
    """Write frame (4, 3, N) and origin (3, N) to which a hop leads from those before it, or the tool's."""
    if before is None:
        frame[:] = hop[:, :, None]
        origin[:] = hop[3][:, None]
        return
    rows = frame.shape[2]
    np.dot(hop, before[0][:3].reshape(3, 3 * rows), out=frame.reshape(4, 3 * rows))
    np.add(before[1], frame[3], out=origin)
