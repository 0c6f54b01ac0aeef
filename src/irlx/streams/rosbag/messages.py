"""The topics of a bag, and their messages as MCAP has them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from irlx.streams.joint_stream import Floats, Integers, StreamHeader
from irlx.streams.rosbag.form import Bytes, Form

FRAME = "root"
"""Frame of all poses: the root frame of the robot."""

SECOND = 1_000_000_000
LONGEST_TIME_NS = 2**31 * SECOND
"""Times of ROS count seconds with 32 bits, one of them the sign."""

ROWS_OF_A_CHUNK = 1024

MESSAGE = b"\x05"
MESSAGE_HEAD = 31
"""Length of what stands before the content of a message's record: code, length, channel, number, times."""


class Topic(IntEnum):
    """The topics by their channel number."""

    JOINT_STATES = 1
    TOOL_POSE = 2
    BLOCK = 3
    JOINT_TRAJECTORY = 4
    HEADER = 5
    RECORD = 6
    END = 7


TOPICS: dict[Topic, tuple[str, str]] = {
    Topic.JOINT_STATES: ("/joint_states", "sensor_msgs/msg/JointState"),
    Topic.TOOL_POSE: ("/tool_pose", "geometry_msgs/msg/PoseStamped"),
    Topic.BLOCK: ("/irlx/block", "std_msgs/msg/Int64"),
    Topic.JOINT_TRAJECTORY: ("/joint_trajectory", "trajectory_msgs/msg/JointTrajectory"),
    Topic.HEADER: ("/irlx/header", "std_msgs/msg/String"),
    Topic.RECORD: ("/irlx/record", "std_msgs/msg/String"),
    Topic.END: ("/irlx/end", "std_msgs/msg/String"),
}
"""Name and message type of every topic."""


class RowForm:
    """One row as three messages with the same time: joint state, tool pose, id of the block."""

    def __init__(self, header: StreamHeader) -> None:
        self._tick_ns = header.tick_ns
        joints = header.joints
        state = Form().begin().number("sec", "<i4").number("nanosec", "<u4").text(FRAME)
        state.texts(header.joint_names).length(joints).numbers("q", joints)
        state.length(joints).numbers("qd", joints).length(0)
        pose = Form().begin().number("sec", "<i4").number("nanosec", "<u4").text(FRAME).numbers("tool", 7)
        block = Form().begin().number("block", "<i8")
        self._messages = (Topic.JOINT_STATES, state), (Topic.TOOL_POSE, pose), (Topic.BLOCK, block)
        self._parts: list[Form] = []
        for topic, form in self._messages:
            self._parts += [_message_head(topic, len(form)), form]

    def __len__(self) -> int:
        return sum(map(len, self._parts))

    def records(self, ticks: Integers, q: Floats, qd: Floats, block: Integers, tool: Floats) -> Bytes:
        """Records (N, length) of N rows."""
        times = ticks * self._tick_ns
        head = {"log": times, "publish": times}
        stamp = {"sec": times // SECOND, "nanosec": times % SECOND}
        state, pose, of_block = {**stamp, "q": q, "qd": qd}, {**stamp, "tool": tool}, {"block": block}
        values: list[dict[str, Any]] = [head, state, head, pose, head, of_block]
        pairs = zip(self._parts, values, strict=True)
        return np.concatenate([form.copies(len(ticks), **given) for form, given in pairs], axis=1)

    def offsets(self, rows: int) -> dict[int, Integers]:
        """Where the records (rows,) of each topic begin, by channel."""
        starts = np.cumsum([0, *map(len, self._parts)])[0:-1:2].tolist()
        lines = np.arange(rows, dtype=np.int64) * len(self)
        return {int(topic): lines + start for (topic, _), start in zip(self._messages, starts, strict=True)}

    def read(self, data: bytes) -> tuple[Integers, Floats, Floats, Integers, Floats]:
        """What `records` was given; raises ValueError for bytes that it would not have made of anything."""
        if len(data) % len(self):
            raise ValueError("a row is not whole")
        raw = np.frombuffer(data, np.uint8).reshape(-1, len(self))
        edges = np.cumsum([0, *map(len, self._parts)])
        head, state, _, pose, _, block = (
            form.read(np.ascontiguousarray(raw[:, start:stop]).tobytes())
            for form, start, stop in zip(self._parts, edges[:-1], edges[1:], strict=True)
        )
        ticks = (head["log"] // self._tick_ns).astype(np.int64)
        rows = ticks, state["q"].copy(), state["qd"].copy(), block["block"].copy(), pose["tool"].copy()
        if ticks.size and not (ticks.min() >= 0 and int(ticks.max()) * self._tick_ns < LONGEST_TIME_NS):
            raise ValueError("a time is out of range")
        if not np.array_equal(self.records(*rows), raw):
            raise ValueError("messages of a row have another form than irlx gives them")
        return rows


@dataclass(frozen=True)
class TrajectoryForm:
    """Message of a trajectory: all before its points, and one point."""

    head: bytes
    point: Form
    pad: int
    """Bytes that are missing behind the length in the first point, as it begins elsewhere."""

    @classmethod
    def of(cls, header: StreamHeader) -> TrajectoryForm:
        """Form of the trajectories of a stream. The stamp is 0: a controller begins when it hears it."""
        head = Form().begin().length(0).length(0).text(FRAME).texts(header.joint_names).length(0)
        joints = header.joints
        point = Form().length(joints).numbers("q", joints).length(joints).numbers("qd", joints)
        point.length(0).length(0).number("sec", "<i4").number("nanosec", "<u4")
        fixed = head.copies(1).tobytes()
        return cls(fixed[:-4], point, 4 if len(fixed) % 8 == 0 and joints else 0)

    def points(self, times: Integers, q: Floats, qd: Floats) -> bytes:
        """N points, as they follow others: times (N,) in ns from the start, q and qd (N, n)."""
        values = {"q": q, "qd": qd, "sec": times // SECOND, "nanosec": times % SECOND}
        return self.point.copies(len(times), **values).tobytes()


def text_message(topic: Topic, words: str, time_ns: int) -> bytes:
    """Record of a string."""
    content = Form().begin().text(words).copies(1).tobytes()
    return message_head(topic, len(content), time_ns) + content


def message_head(topic: Topic, length: int, time_ns: int) -> bytes:
    """What stands before `length` bytes of content in a message's record."""
    return _message_head(topic, length).copies(1, log=time_ns, publish=time_ns).tobytes()


def _message_head(topic: Topic, length: int) -> Form:
    fixed = MESSAGE + (22 + length).to_bytes(8, "little") + int(topic).to_bytes(2, "little") + bytes(4)
    return Form().constant(fixed).packed("log", "<u8").packed("publish", "<u8")
