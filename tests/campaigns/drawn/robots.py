"""Robots of random kinds with 3 to 12 joints: those of irlx by name, and URDFs made joint by joint."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from irlx.cell.robot_data import robot_data_folder


@dataclass(frozen=True)
class Robot:
    """A robot for a cell: lines of its table `[robot]`, its files, a posture to begin near.

    `start` in rad and m, None for that of the named robot; `size` m, how far it reaches; `turns` which turns
    of the tool a program may ask for, axes of the root frame: 'all', 'z', or 'none' where a turn follows from
    the rest; `flat` where all motion is in a plane z = const; `hand` a link that another hand brings.
    """

    kind: str
    model: str
    size: float = 1.0
    lines: tuple[str, ...] = ()
    files: dict[str, str] = field(default_factory=dict)
    start: np.ndarray | None = None
    turns: str = "all"
    flat: bool = False
    hand: str = ""
    urdf_name: str = ""


@dataclass
class Urdf:
    """A URDF in the making."""

    name: str
    parts: list[str] = field(default_factory=list)
    count: int = 0

    def link(self, name: str, length: float, radius: float) -> None:
        """A capsule-like link along x or z of its frame, with a mass."""
        solid = (
            f'<origin xyz="0 0 {0.5 * length!r}"/><geometry><cylinder radius="{radius!r}" '
            f'length="{max(0.8 * length, 0.01)!r}"/></geometry>'
        )
        mass = 0.5 + 4.0 * length
        inertia = mass * (0.1 * length**2 + 0.01)
        self.parts.append(
            f'  <link name="{name}">\n    <inertial><origin xyz="0 0 {0.5 * length!r}"/>'
            f'<mass value="{mass!r}"/><inertia ixx="{inertia!r}" ixy="0" ixz="0" iyy="{inertia!r}" iyz="0" '
            f'izz="{inertia!r}"/></inertial>\n'
            f"    <collision>{solid}</collision>\n  </link>"
        )

    def joint(self, kind: str, parent: str, child: str, xyz, axis, pair=None, speed=2.0, mimic="") -> str:
        """A joint, by default with limits of 2.6 rad to both sides; returns its name."""
        self.count += kind != "fixed"
        name = f"j{self.count}" if kind != "fixed" else f"to_{child}"
        limit = ""
        if kind != "fixed":
            sides = "" if kind == "continuous" else f'lower="{pair[0]!r}" upper="{pair[1]!r}" '
            limit = f'<limit {sides}velocity="{speed!r}" effort="100"/>'
        self.parts.append(
            f'  <joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{" ".join(repr(float(x)) for x in xyz)}"/>'
            f'<axis xyz="{" ".join(repr(float(x)) for x in axis)}"/>{limit}{mimic}</joint>'
        )
        return name

    def text(self) -> str:
        return "\n".join([f'<robot name="{self.name}">', *self.parts, "</robot>", ""])


Z, Y, X = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)


def _pair(rng: np.random.Generator, wide: float = 2.6) -> tuple[float, float]:
    return -float(rng.uniform(0.7, 1.0)) * wide, float(rng.uniform(0.7, 1.0)) * wide


def _chain(
    rng: np.random.Generator,
    urdf: Urdf,
    root: str,
    prefix: str,
    n: int,
    slides: int = 0,
    endless: float = 0.0,
) -> list[float]:
    """An arm of n joints up from `root`, slides first; returns a bent start posture."""
    at, above, start = root, 0.0, []
    for k in range(n):
        child = f"{prefix}_{k + 1}"
        if k < slides:
            length = 0.05
            urdf.joint("prismatic", at, child, (0, 0, 0.05), (X, Y, Z)[k], (-0.6, 0.7), 0.8)
            start.append(float(rng.uniform(-0.1, 0.1)))
        else:
            turn = k - slides
            length = float(rng.uniform(0.12, 0.3)) if n - slides < 8 else float(rng.uniform(0.08, 0.16))
            axis = Z if turn % 2 == 0 else Y
            # The last three axes of a short arm stand at right angles as well.
            if n - slides == 6:
                axis, length = ((Z, Y, Y, Z, Y, Z)[turn], length if turn in (1, 2) else 0.08)
            kind = "continuous" if rng.random() < endless else "revolute"
            before = above
            urdf.joint(kind, at, child, (0, 0, before), axis, _pair(rng), float(rng.uniform(1.0, 3.0)))
            start.append(float(rng.uniform(-0.5, 0.5)) if axis is Z else float(rng.uniform(0.5, 1.1)))
        urdf.link(child, length, float(rng.uniform(0.02, 0.04)))
        at, above = child, length
    return start


def _tool(urdf: Urdf, parent: str, name: str = "tool", away: float = 0.1) -> None:
    urdf.joint("fixed", parent, name, (0, 0, away), Z)
    urdf.parts.append(f'  <link name="{name}"/>')


def _made(kind: str, urdf: Urdf, start: list[float], *lines: str, **more) -> Robot:
    lines = ('tip = "tool"', *lines)
    files = {"robot.urdf": urdf.text()}
    return Robot(
        kind, "robot.urdf", lines=lines, files=files, start=np.array(start), urdf_name=urdf.name, **more
    )


def serial(rng: np.random.Generator, kind: str = "serial", slides: int = 0, endless: float = 0.0) -> Robot:
    """An arm of turning axes, slides below it where there are any."""
    n = int(rng.integers(6 + slides, 13))
    urdf = Urdf("drawn_arm")
    urdf.link("base", 0.1, 0.05)
    start = _chain(rng, urdf, "base", "link", n, slides, endless)
    _tool(urdf, f"link_{n}")
    return _made(kind, urdf, start)


def slides(rng: np.random.Generator) -> Robot:
    return serial(rng, "slides", int(rng.integers(1, 4)))


def endless(rng: np.random.Generator) -> Robot:
    return serial(rng, "continuous", endless=0.6)


def planar(rng: np.random.Generator) -> Robot:
    """Axes along z: as many joints as a pose in the plane needs, and more."""
    n = int(rng.integers(3, 7))
    urdf, at, start = Urdf("drawn_plane"), "base", []
    urdf.link("base", 0.1, 0.05)
    for k in range(n):
        length = float(rng.uniform(0.2, 0.4)) if k else 0.0
        kind = "prismatic" if k == 0 and rng.random() < 0.3 and n > 3 else "revolute"
        pair = (-0.5, 0.5) if kind == "prismatic" else _pair(rng)
        urdf.joint(kind, at, f"link_{k + 1}", (length, 0, 0), X if kind == "prismatic" else Z, pair)
        urdf.link(f"link_{k + 1}", 0.05, 0.03)
        start.append(float(rng.uniform(0.4, 0.9)) if kind == "revolute" else 0.0)
        at = f"link_{k + 1}"
    urdf.joint("fixed", at, "tool", (0.2, 0, 0), Z)
    urdf.parts.append('  <link name="tool"/>')
    return _made("planar", urdf, start, 'task = ["x", "y", "rz"]', turns="z", flat=True)


def scara(rng: np.random.Generator) -> Robot:
    """Four or five axes: two or three about z, a slide, and a turn of the tool about z."""
    arms = int(rng.integers(2, 4))
    urdf, at, start = Urdf("drawn_scara"), "base", []
    urdf.link("base", 0.1, 0.05)
    for k in range(arms):
        urdf.joint(
            "revolute", at, f"link_{k + 1}", (0.0 if k == 0 else 0.3, 0, 0.3 if k == 0 else 0), Z, _pair(rng)
        )
        urdf.link(f"link_{k + 1}", 0.05, 0.03)
        start.append(float(rng.uniform(0.4, 0.9)))
        at = f"link_{k + 1}"
    urdf.joint("prismatic", at, "quill", (0.3, 0, 0), Z, (-0.3, 0.3), 0.6)
    urdf.link("quill", 0.1, 0.02)
    urdf.joint(
        "continuous" if rng.random() < 0.3 else "revolute", "quill", "flange", (0, 0, 0), Z, (-3.0, 3.0), 4.0
    )
    urdf.link("flange", 0.03, 0.02)
    _tool(urdf, "flange")
    return _made("scara", urdf, [*start, 0.0, 0.1], 'task = ["x", "y", "z", "rz"]', turns="z")


def free_turns(rng: np.random.Generator) -> Robot:
    """Turns of the tool that nobody asks for: one of a 6- or 7-axis arm, or all of one with 3 to 5."""
    urdf = Urdf("drawn_free")
    urdf.link("base", 0.1, 0.05)
    if rng.random() < 0.5:
        n = int(rng.integers(6, 8))
        start = _chain(rng, urdf, "base", "link", n)
        lines = ['task = ["x", "y", "z", "rx", "ry"]', 'free = ["rz"]']
    else:
        n, at, start = int(rng.integers(3, 6)), "base", []
        for k in range(n):
            axis, before = (Z, 0.1) if k == 0 else (Y, 0.0 if k == 1 else 0.3)
            urdf.joint("revolute", at, f"link_{k + 1}", (0, 0, before), axis, _pair(rng))
            urdf.link(f"link_{k + 1}", 0.3 if k else 0.05, 0.03)
            start.append(float(rng.uniform(0.4, 0.9)))
            at = f"link_{k + 1}"
        lines = ['task = ["x", "y", "z"]', 'free = ["rx", "ry", "rz"]']
    _tool(urdf, f"link_{n}", away=0.3 if n < 6 else 0.1)
    return _made("free turns", urdf, start, *lines)


def mimic(rng: np.random.Generator) -> Robot:
    """An arm with a parallelogram: a joint that follows another one by -1."""
    urdf = Urdf("drawn_mimic")
    urdf.link("base", 0.1, 0.05)
    n = int(rng.integers(6, 9))
    urdf.joint("revolute", "base", "shoulder", (0, 0, 0.1), Z, _pair(rng))
    urdf.link("shoulder", 0.1, 0.04)
    leader = urdf.joint("revolute", "shoulder", "upper", (0, 0, 0.1), Y, (-1.2, 1.3))
    urdf.link("upper", 0.3, 0.03)
    follows = f'<mimic joint="{leader}" multiplier="-1" offset="{float(rng.choice([0.0, 0.3]))!r}"/>'
    urdf.joint("revolute", "upper", "level", (0, 0, 0.3), Y, (-2.0, 2.0), 3.0, follows)
    urdf.link("level", 0.05, 0.03)
    rest = _chain(rng, urdf, "level", "link", n - 2)
    _tool(urdf, f"link_{n - 2}")
    start = [float(rng.uniform(-0.5, 0.5)), float(rng.uniform(0.2, 0.7)), *rest]
    return _made("mimic", urdf, start)


def two_hands(rng: np.random.Generator) -> Robot:
    """A trunk with two arms of three to six joints, of which the second one carries the tool."""
    urdf = Urdf("drawn_pair")
    urdf.link("base", 0.3, 0.05)
    left, right = int(rng.integers(2, 7)), 6
    urdf.joint("fixed", "base", "left", (0, 0.3, 0.3), Z)
    urdf.link("left", 0.02, 0.02)
    urdf.joint("fixed", "base", "right", (0, -0.3, 0.3), Z)
    urdf.link("right", 0.02, 0.02)
    start = _chain(rng, urdf, "left", "l", left) + _chain(rng, urdf, "right", "r", right)
    _tool(urdf, f"r_{right}")
    return _made("two hands", urdf, start, f'hands = ["l_{left}"]', hand=f"l_{left}")


NAMED = {
    "arm7": Robot("named", "arm7"),
    "rail6": Robot("named", "rail6"),
    "planar3": Robot("named", "planar3", turns="z", flat=True),
    "planar4": Robot("named", "planar4", turns="z", flat=True),
    "mobile8": Robot("named", "mobile8"),
    "mobile9": Robot("named", "mobile9"),
    "gantry9": Robot("named", "gantry9"),
    "koch11": Robot("named", "koch11", 8.0),
    "irb6": Robot("named", "irb6", turns="none"),
    "dual14": Robot("named", "dual14", hand="left_hand"),
    **({"panda": Robot("named", "panda")} if robot_data_folder() is not None else {}),
}


def named(rng: np.random.Generator) -> Robot:
    return NAMED[str(rng.choice(list(NAMED)))]


KINDS: dict[str, tuple[float, Callable[[np.random.Generator], Robot]]] = {
    "named": (4.0, named),
    "serial": (3.0, serial),
    "slides": (1.5, slides),
    "continuous": (1.0, endless),
    "planar": (1.5, planar),
    "scara": (1.0, scara),
    "free turns": (1.0, free_turns),
    "mimic": (1.0, mimic),
    "two hands": (1.0, two_hands),
}


def drawn_robot(rng: np.random.Generator, kind: str | None = None) -> Robot:
    """A robot of a kind, by default of any."""
    if kind is None:
        weights = np.array([weight for weight, _ in KINDS.values()])
        kind = str(rng.choice(list(KINDS), p=weights / weights.sum()))
    return KINDS[kind][1](rng)
