"""Data of a replay page made by hand: a short run that has something of everything the page can show."""

from __future__ import annotations

import base64
from math import cos, pi, sin, sqrt
from typing import Any

import numpy as np

import irlx

FRAMES, TICK = 101, 0.01
TURNED = [0.0, 0.0, sin(pi / 8), cos(pi / 8)]
"""45 degrees about z."""
TOOL_FROM = 50
"""Tick from which on the tool is longer."""

PROGRAM = """PROGRAM made;
{ A line, and <b>a comment</b> }
BEGIN
  WRITELN('</script><script>alert(1)</script>');
  MOVE LIN p1;
  MOVE LIN p2;
ENDPROGRAM
"""


def joint_values() -> np.ndarray:
    """Values (N, 2): a turn in rad, and a slide in m that stands on its limit from tick 60 on."""
    share = np.linspace(0.0, 1.0, FRAMES)
    return np.stack([1.2 * share, np.minimum(0.5 * share, 0.3)], axis=1)


def tool_poses() -> np.ndarray:
    """Poses (N, 7) of the tool, in closed form: an arm in the plane z = 0.5 that turns and grows.

    The slide goes twice as far as its axis and 0.1 m more, along y of a frame turned by 45 degrees.
    """
    found = []
    for tick, (turn, slide) in enumerate(joint_values()):
        length = 2.0 * slide + 0.1
        # Behind the frame turned by 45 degrees, its y axis points to 135 degrees.
        x, y = 1.0 - length / sqrt(2.0), length / sqrt(2.0)
        tool = 0.2 if tick >= TOOL_FROM else 0.0
        x, y = x + tool / sqrt(2.0), y + tool / sqrt(2.0)
        angle = turn + pi / 4
        found.append(
            [
                cos(turn) * x - sin(turn) * y,
                sin(turn) * x + cos(turn) * y,
                0.5,
                0.0,
                0.0,
                sin(angle / 2),
                cos(angle / 2),
            ]
        )
    return np.array(found)


def made_data(**changes: object) -> dict[str, Any]:
    """The data; `changes` replace its entries."""
    q, tool = joint_values(), tool_poses()
    speed = np.vstack([np.zeros(2), np.diff(q, axis=0)]) / TICK
    tool_speed = np.concatenate([[0.0], np.linalg.norm(np.diff(tool[:, :3], axis=0), axis=1)]) / TICK
    ticks = np.arange(FRAMES)
    near = (ticks >= 30) & (ticks < 70)
    data = {
        "format": "irlx page 1",
        "irlx": irlx.__version__,
        "title": "made.irl",
        "small": False,
        "complete": True,
        "program": {
            "name": "made.irl",
            "text": PROGRAM,
            "keywords": ["PROGRAM", "BEGIN", "MOVE", "LIN", "ENDPROGRAM"],
        },
        "cell": {"name": "made.toml"},
        "summary": {
            "text": "made.irl: complete, 1 s, not slowed\nmoves       2\nlimit use   position  100 %",
            "plain": {"moves": 2},
        },
        "tick_s": TICK,
        "ticks_per_frame": 1,
        "joints": [{"name": "swing", "unit": "rad"}, {"name": "stretch", "unit": "m"}],
        "frames": {
            "tick": ticks.tolist(),
            "line": np.where(ticks == 0, 0, np.where(ticks <= 50, 5, 6)).tolist(),
            "q": q.T.tolist(),
            "speed": speed.T.tolist(),
            "tool": tool.T.tolist(),
            "tool_speed": tool_speed.tolist(),
            "turn_speed": np.where(ticks > 0, 1.2, 0.0).tolist(),
            "singular": np.linspace(0.4, 0.2, FRAMES).tolist(),
            "clearance": [0.05 if felt else None for felt in near],
            "nearest": np.where(near, 0, -1).tolist(),
        },
        "pairs": [{"link": "hand", "other": "wall", "margin": 0.02}],
        "limits": [
            {
                "tick": 0,
                "position": [[-2.0, None], [2.0, 0.3]],
                "speed": [[-3.0, None], [3.0, None]],
                "acceleration": [[None, None], [None, None]],
            },
            {
                "tick": 60,
                "position": [[-2.0, -0.3], [2.0, 0.3]],
                "speed": [[-2.0, None], [2.0, None]],
                "acceleration": [[None, None], [None, None]],
            },
        ],
        "tools": [
            {"tick": 0, "xyz": [0.0, 0.0, 0.0], "quat": [0.0, 0.0, 0.0, 1.0]},
            {"tick": TOOL_FROM, "xyz": [0.2, 0.0, 0.0], "quat": [0.0, 0.0, 0.0, 1.0]},
        ],
        "blocks": [
            {"tick": 0, "id": 1, "line": 5, "text": "MOVE LIN p1"},
            {"tick": 50, "id": 2, "line": 6, "text": "MOVE LIN p2"},
        ],
        "events": [
            _event("limit", 60, 100, 6, 1, "stretch at its upper position limit"),
            _event("slowed", 20, 40, 5, 0, "slowed for the speed of swing"),
            _event("nearest", 30, 69, 5, None, "hand near wall"),
            _event("message", 0, 0, 4, None, "</script><b>written</b>"),
        ],
        "robot": {"name": "made", "tip": 3, "links": _links()},
        "meshes": [_tetrahedron()],
        "obstacles": _obstacles(),
        "places": [
            {"name": "fixture", "xyz": [0.6, 0.6, 0.0], "quat": TURNED},
            {"name": "grip", "xyz": [0.0, 0.1, 0.0], "quat": TURNED, "link": 2},
        ],
        "diagnostics": [],
    }
    return {**data, **changes}


def _event(kind: str, first: int, last: int, line: int, joint: int | None, label: str) -> dict[str, Any]:
    text = f"{label}, from {first * TICK:g} to {last * TICK:g} s."
    return {
        "kind": kind,
        "first": first,
        "last": last,
        "line": line,
        "joint": joint,
        "label": label,
        "text": text,
    }


def _links() -> list[dict[str, Any]]:
    still = {"quat": [0.0, 0.0, 0.0, 1.0], "multiplier": 1.0, "offset": 0.0}
    swing = {"name": "swing", "kind": "revolute", "xyz": [0.0, 0.0, 0.5], "axis": [0.0, 0.0, 1.0], "of": 0}
    stretch = {"name": "stretch", "kind": "prismatic", "xyz": [1.0, 0.0, 0.0], "quat": TURNED, "of": 1}
    stretch |= {"axis": [0.0, 1.0, 0.0], "multiplier": 2.0, "offset": 0.1}
    fixed = {"name": "end", "kind": "fixed", "xyz": [0.0, 0.0, 0.0], "axis": [1.0, 0.0, 0.0], "of": None}
    along = [0.0, sin(pi / 4), 0.0, cos(pi / 4)]
    arm = _shape("capsule", radius=0.05, length=0.9, xyz=[0.5, 0.0, 0.0], quat=along)
    post = _shape("cylinder", radius=0.08, length=0.5, xyz=[0.0, 0.0, 0.25])
    return [
        {"name": "base", "parent": -1, "shapes": [post, _shape("box", size=[0.4, 0.4, 0.04])]},
        {"name": "arm", "parent": 0, "joint": {**still, **swing}, "shapes": [arm]},
        {
            "name": "hand",
            "parent": 1,
            "joint": {**still, **stretch},
            "shapes": [_shape("mesh", mesh=0, color="#e0a020")],
        },
        {"name": "tip", "parent": 2, "joint": {**still, **fixed}, "shapes": []},
    ]


def _obstacles() -> list[dict[str, Any]]:
    one = {
        "xyz": [0.0, 0.0, 0.0],
        "quat": [0.0, 0.0, 0.0, 1.0],
        "margin": 0.02,
        "influence": 0.2,
        "trajectory": [],
    }
    way = [{"time": 0.2, "xyz": [1.2, 0.0, 0.4], "quat": [0.0, 0.0, 0.0, 1.0]}]
    way += [{"time": 0.8, "xyz": [1.2, 0.6, 0.4], "quat": TURNED}]
    return [
        {**one, "name": "wall", "xyz": [1.0, 1.2, 0.3], "shapes": [_shape("box", size=[0.8, 0.05, 0.6])]},
        {
            **one,
            "name": "cart",
            "trajectory": way,
            "shapes": [_shape("cone", radius=0.1, length=0.3), _shape("sphere", radius=0.06)],
        },
        {**one, "name": "floor", "shapes": [_shape("halfspace")]},
        {**one, "name": "peg", "xyz": [-0.4, 0.4, 0.3], "shapes": [_shape("point")]},
    ]


def _shape(kind: str, **own: object) -> dict[str, Any]:
    still = {"xyz": [0.0, 0.0, 0.0], "quat": [0.0, 0.0, 0.0, 1.0]}
    return {"kind": kind, "color": None, "opacity": 1.0, **still, **own}


def _tetrahedron() -> dict[str, str]:
    corners = np.array([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]], dtype="<f4")
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], dtype="<u2")
    coded = [base64.b64encode(array.tobytes()).decode("ascii") for array in (corners, faces)]
    return {"vertices": coded[0], "faces": coded[1], "index": "u16"}
