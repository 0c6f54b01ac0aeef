"""What a robot is, as plain data: joints, links, and the chain that moves the tool."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from enum import Enum
from functools import cached_property
from math import inf

from irlx.solids.placement import Vector3
from irlx.solids.shape import Solid

COORDINATES = ("x", "y", "z", "rx", "ry", "rz")
"""Coordinates of a tool pose, in the tool frame: displacements along its axes, turns about them."""


class JointKind(str, Enum):
    """How a joint moves; CONTINUOUS is a revolute joint without position limits."""

    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"
    FIXED = "fixed"


@dataclass(frozen=True)
class Mimic:
    """What a joint follows: its value is `multiplier` times that of the joint `leader`, plus `offset`.

    Values in rad or m, each joint in its own unit.
    """

    leader: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Joint:
    """One joint of the frame tree.

    `xyz` (m) and `rpy` (rad, fixed axes x, y, z) place the joint frame in the parent link's frame;
    `axis` is a unit vector in the joint frame; `lower`, `upper` in rad or m; `speed` in rad/s or
    m/s. Limits that are not known are infinite. A joint with a `mimic` has no drive of its own.
    """

    name: str
    kind: JointKind
    parent: str
    child: str
    xyz: Vector3 = (0.0, 0.0, 0.0)
    rpy: Vector3 = (0.0, 0.0, 0.0)
    axis: Vector3 = (1.0, 0.0, 0.0)
    lower: float = -inf
    upper: float = inf
    speed: float = inf
    mimic: Mimic | None = None

    @property
    def is_prismatic(self) -> bool:
        """Whether the joint slides (values in m) rather than turns (values in rad)."""
        return self.kind is JointKind.PRISMATIC


@dataclass(frozen=True)
class Inertial:
    """Mass (kg), centre of mass and its frame in the link frame (m, rad), inertia about it (kg m2).

    `inertia` is (ixx, ixy, ixz, iyy, iyz, izz).
    """

    mass: float
    xyz: Vector3
    rpy: Vector3
    inertia: tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class RobotDescription:
    """A robot as a tree of links and joints, with the tool frame `tip` that moves address.

    `joints` holds all joints of the tree; those that move, are not `locked` and follow no other joint are the
    robot's axes where they lie between `root` and `tip`, or between `root` and one of the `carriers`: links
    that carry something of their own, as another hand does. Axes come depth first, branches in the order of
    `joints`; along a plain chain that is the order from the root. `locked` maps a joint name to the value
    it is held at; moving joints that are no axes are held at their locked value or zero. `solids` are the
    shapes of each link that others must not touch, in the link's frame.

    `coordinates` of the tool pose are those of the robot's task: along and about the axes of the tool frame,
    or those of the link `task_frame` (a link of the chain), whose origin does not matter. Of the others those
    in `free` are nobody's business; the rest cannot be moved or follows from the task's own.
    """

    name: str
    root: str
    tip: str
    joints: tuple[Joint, ...]
    inertials: Mapping[str, Inertial] = field(default_factory=dict)
    locked: Mapping[str, float] = field(default_factory=dict)
    coordinates: tuple[str, ...] = COORDINATES
    solids: Mapping[str, tuple[Solid, ...]] = field(default_factory=dict)
    task_frame: str | None = None
    free: tuple[str, ...] = ()
    carriers: tuple[str, ...] = ()

    @cached_property
    def chain(self) -> tuple[Joint, ...]:
        """All joints from the root to the tip, fixed and locked ones included."""
        return self.chain_to(self.tip)

    def chain_to(self, link: str) -> tuple[Joint, ...]:
        """All joints from the root to a link, fixed and locked ones included. KeyError for no link."""
        by_child = {joint.child: joint for joint in self.joints}
        found: list[Joint] = []
        while link != self.root:
            found.append(by_child[link])
            link = by_child[link].parent
        return tuple(reversed(found))

    @cached_property
    def chains(self) -> tuple[Joint, ...]:
        """The joints of all chains, to the tip and to the carriers: depth first, as axes come."""
        wanted = {joint.name for link in (self.tip, *self.carriers) for joint in self.chain_to(link)}
        children: dict[str, list[Joint]] = {}
        for joint in self.joints:
            if joint.name in wanted:
                children.setdefault(joint.parent, []).append(joint)
        found: list[Joint] = []
        waiting = list(reversed(children.get(self.root, [])))
        while waiting:
            joint = waiting.pop()
            found.append(joint)
            waiting += reversed(children.get(joint.child, []))
        return tuple(found)

    @cached_property
    def moving(self) -> tuple[Joint, ...]:
        """The joints of the chains that move: the axes, and those that follow them."""
        return tuple(j for j in self.chains if j.kind is not JointKind.FIXED and j.name not in self.locked)

    @cached_property
    def axes(self) -> tuple[Joint, ...]:
        """The joints that programs move, in the order of MAIN_JOINT's fields."""
        return tuple(joint for joint in self.moving if joint.mimic is None)

    @cached_property
    def coupling(self) -> tuple[tuple[int, float, float], ...]:
        """Of each moving joint the number of the axis that moves it, multiplier and offset of its value."""
        numbers = {joint.name: number for number, joint in enumerate(self.axes)}
        by_name = {joint.name: joint for joint in self.moving}
        found = []
        for joint in self.moving:
            leader, multiplier, offset = joint, 1.0, 0.0
            while leader.mimic is not None:
                offset += multiplier * leader.mimic.offset
                multiplier *= leader.mimic.multiplier
                leader = by_name[leader.mimic.leader]
            found.append((numbers[leader.name], multiplier, offset))
        return tuple(found)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the axes in order."""
        return tuple(joint.name for joint in self.axes)

    @cached_property
    def reach(self) -> float:
        """Upper bound of the distance between the first axis and the tool, m, all slides at the far end."""
        return self.reach_to(self.tip) or 1.0

    def reach_to(self, link: str) -> float:
        """Upper bound of the distance between the first axis that moves a link and the link, m; 0 without."""
        axes = [joint for joint in self.chain_to(link) if joint in self.axes]
        return self._farthest(link, axes[0]) if axes else 0.0

    @cached_property
    def lever(self) -> float:
        """Upper bound of the distance between the first turning axis and the tool, m.

        What a turn of one rad is worth at the tool, at most: strokes of slides that carry the whole arm, a
        rail or a platform, have no part in it. That of `reach` where no axis turns.
        """
        return self.lever_to(self.tip) or self.reach

    def lever_to(self, link: str) -> float:
        """The same of the first axis that turns a link, and that link; 0 where none does."""
        turning = [j for j in self.chain_to(link) if j in self.axes and not j.is_prismatic]
        return self._farthest(link, turning[0]) if turning else 0.0

    def _farthest(self, link: str, first: Joint) -> float:
        """Length of the chain to a link behind one of its axes, m, its slides at their far ends."""
        chain = self.chain_to(link)
        start = chain.index(first)
        total: float = sum(sum(c * c for c in joint.xyz) ** 0.5 for joint in chain[start + 1 :])
        counted = chain[start:]
        for joint, (axis, multiplier, offset) in zip(self.moving, self.coupling, strict=True):
            if joint.is_prismatic and joint in counted:
                leader = self.axes[axis]
                ends = (leader.lower, leader.upper) if multiplier else (0.0,)
                stroke = max(abs(multiplier * end + offset) for end in ends)
                total += stroke if stroke != inf else 0.0
        return total

    @cached_property
    def fingerprint(self) -> str:
        """SHA-256 (hex) of the chains' geometry and task: two robots that move alike have the same one."""
        chain = [_geometry(joint) for joint in self.chains]
        locked = {joint.name: self.locked[joint.name] for joint in self.chains if joint.name in self.locked}
        told: dict[str, object] = {"tip": self.tip, "chain": chain, "locked": locked}
        if self.coordinates != COORDINATES:
            told["task"] = self.coordinates
        if self.task_frame is not None:
            told["task_frame"] = self.task_frame
        if self.free:
            told["free"] = self.free
        text = json.dumps(told, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()


def _geometry(joint: Joint) -> dict[str, object]:
    """What a joint has a part in how a robot moves, in plain words; limits are told as unknown."""
    plain = {one.name: getattr(joint, one.name) for one in fields(joint) if one.name != "mimic"}
    plain |= {"lower": None, "upper": None, "speed": None, "kind": joint.kind.value}
    return plain if joint.mimic is None else {**plain, "mimic": asdict(joint.mimic)}
