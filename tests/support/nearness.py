"""How near the links of an arm come to boxes and points of a cell.

The URDF and the cell are read anew, distances are those of coal.
"""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import coal
import numpy as np
from scipy.spatial.transform import Rotation

import irlx

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROBOTS = Path(irlx.__file__).parent / "cell" / "robots"

Pose = tuple[np.ndarray, np.ndarray]
"""Positions (3,) m and rotation (3, 3)."""


def nearest(
    run: irlx.Run, cell: Path, chosen: np.ndarray | slice = slice(None)
) -> dict[tuple[str, str], np.ndarray]:
    """Distance (N,) m, below 0 where they overlap, of every link that moves from every obstacle.

    In all rows of the run, or in those that are chosen.
    """
    chain = run.q[chosen]
    told = tomllib.loads(cell.read_text(encoding="utf-8"))
    boxes = {one["name"]: one for one in told["obstacle"] if one["shape"] != "group"}
    placed = {name: (_shape(one), _transform(*_pose(one))) for name, one in boxes.items()}
    solids, joints = _arm(told["robot"]["model"])
    found: dict[tuple[str, str], np.ndarray] = {
        (link, name): np.full(len(chain), np.inf) for link in solids for name in placed
    }
    for row, q in enumerate(chain):
        poses = _links(joints, dict(zip(run.stream.header.joint_names, q, strict=True)))
        for link, parts in solids.items():
            for shape, at in parts:
                there = _transform(*_after(poses[link], at))
                for name, (other, where) in placed.items():
                    apart = _distance(shape, there, other, where)
                    found[link, name][row] = min(found[link, name][row], apart)
    return found


def least(distances: dict[tuple[str, str], np.ndarray]) -> float:
    """The smallest of all, m."""
    return float(min(rows.min() for rows in distances.values()))


def _distance(first, at, second, there) -> float:
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    # Of depths coal finds no more than 1e-6; asked for more it may give up.
    request.gjk_tolerance, request.epa_tolerance = 1e-9, 1e-6
    found = float(coal.distance(first, at, second, there, request, result))
    assert abs(found) < 100.0, "coal found no distance"
    return found


def _transform(position: np.ndarray, rotation: np.ndarray):
    return coal.Transform3s(rotation, position)


def _shape(one: dict):
    if one["shape"] == "point":
        return coal.Sphere(0.0)
    assert one["shape"] == "box", one
    return coal.Box(*(np.array(one["size"]) / 1000.0))


def _pose(one: dict) -> Pose:
    assert "frame" not in one
    turns = Rotation.from_euler("xyz", one.get("rpy", [0.0, 0.0, 0.0]), degrees=True)
    return np.array(one["xyz"]) / 1000.0, turns.as_matrix()


@cache
def _arm(model: str):
    """Solids of the links that joints move, with their poses; the joints from the root outwards."""
    root = ElementTree.parse(ROBOTS / f"{model}.urdf").getroot()
    joints = []
    for joint in root.iter("joint"):
        axis = joint.find("axis")
        along = np.array([1.0, 0.0, 0.0]) if axis is None else _numbers(axis.get("xyz"))
        names = joint.find("parent").get("link"), joint.find("child").get("link")
        mimic = joint.find("mimic")
        led = None if mimic is None else (mimic.get("joint"), float(mimic.get("multiplier")))
        joints.append((joint.get("name"), joint.get("type"), *names, _origin(joint), along, led))
    solids = {
        link.get("name"): [(_solid(c), _origin(c)) for c in link.iter("collision")]
        for link in root.iter("link")
    }
    return {name: parts for name, parts in solids.items() if parts and name != joints[0][2]}, joints


def _links(joints, values: dict[str, float]) -> dict[str, Pose]:
    """Poses of all links; joints of a URDF of ours stand in the order of the chain."""
    poses = {joints[0][2]: (np.zeros(3), np.eye(3))}
    for name, kind, parent, child, origin, axis, led in joints:
        at = _after(poses[parent], origin)
        value = values.get(name, 0.0) if led is None else led[1] * values[led[0]]
        if kind == "prismatic":
            at = _after(at, (axis * value, np.eye(3)))
        elif kind != "fixed":
            at = _after(at, (np.zeros(3), Rotation.from_rotvec(axis * value).as_matrix()))
        poses[child] = at
    return poses


def _after(first: Pose, second: Pose) -> Pose:
    return first[0] + first[1] @ second[0], first[1] @ second[1]


def _origin(element) -> Pose:
    origin = element.find("origin")
    if origin is None:
        return np.zeros(3), np.eye(3)
    turns = Rotation.from_euler("xyz", _numbers(origin.get("rpy", "0 0 0")))
    return _numbers(origin.get("xyz", "0 0 0")), turns.as_matrix()


def _solid(collision):
    (shape,) = collision.find("geometry")
    if shape.tag == "box":
        return coal.Box(*_numbers(shape.get("size")))
    if shape.tag == "sphere":
        return coal.Sphere(float(shape.get("radius")))
    assert shape.tag == "cylinder", shape.tag
    return coal.Cylinder(float(shape.get("radius")), float(shape.get("length")))


def _numbers(text: str) -> np.ndarray:
    return np.array([float(word) for word in text.split()])
