"""Pairs of links that could meet, against a count over every posture's moving parts."""

from itertools import combinations

import numpy as np
import pytest

from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.robot.link_pairs import pairs_that_could_meet
from irlx.solids.shape import Solid, Sphere

BALL = (Solid(Sphere(0.1)),)


def robot(joints, bare=(), locked=(), tip=None):
    """A robot of joints (parent, child), fixed ones with a third entry; `bare` links have no solid."""
    made = tuple(
        Joint(f"{parent}-{child}", JointKind.FIXED if fixed else JointKind.REVOLUTE, parent, child)
        for parent, child, *fixed in joints
    )
    links = [joints[0][0], *(joint[1] for joint in joints)]
    solids = {link: BALL for link in links if link not in bare}
    held = dict.fromkeys(locked, 0.0)
    return RobotDescription("r", links[0], tip or links[-1], made, {}, held, solids=solids)


def test_neighbours_may_touch():
    assert pairs_that_could_meet(robot([("a", "b"), ("b", "c"), ("c", "d")])) == (
        ("a", "c"),
        ("a", "d"),
        ("b", "d"),
    )


def test_neighbours_across_links_without_solids():
    assert pairs_that_could_meet(robot([("a", "b"), ("b", "c"), ("c", "d")], bare="b")) == (("a", "d"),)
    assert pairs_that_could_meet(robot([("a", "b"), ("b", "c"), ("c", "d")], bare="bc")) == ()


def test_links_that_no_axis_moves_against_each_other():
    fixed = [("a", "b", True), ("b", "c", True), ("c", "d"), ("d", "e", True), ("e", "f", True)]
    assert pairs_that_could_meet(robot(fixed)) == (
        ("a", "d"),
        ("a", "e"),
        ("a", "f"),
        ("b", "d"),
        ("b", "e"),
        ("b", "f"),
        ("c", "e"),
        ("c", "f"),
    )
    locked = robot([("a", "b"), ("b", "c"), ("c", "d")], locked=["b-c"])
    assert pairs_that_could_meet(locked) == (("a", "c"), ("a", "d"), ("b", "d"))
    all_locked = robot([("a", "b"), ("b", "c"), ("c", "d")], locked=["a-b", "b-c", "c-d"])
    assert pairs_that_could_meet(all_locked) == ()


def test_joints_off_the_chain_do_not_move():
    """c hangs on a beside the arm b, d: it moves against neither base nor root, but the arm against it."""
    branched = robot([("a", "c"), ("c", "e"), ("a", "b"), ("b", "d")])
    assert pairs_that_could_meet(branched) == (("a", "d"), ("c", "b"), ("c", "d"), ("b", "e"), ("e", "d"))


@pytest.mark.parametrize("seed", range(20))
def test_random_trees(seed):
    """The same by other means: walks in the graph of links, breadth first."""
    random = np.random.default_rng(seed)
    names = [f"l{k}" for k in range(9)]
    joints = [
        (names[random.integers(k)], names[k], *([True] if random.random() < 0.3 else [])) for k in range(1, 9)
    ]
    bare = {name for name in names if random.random() < 0.3}
    made = robot(joints, bare, tip=names[8])
    axes = set(made.joint_names)
    near = {name: [] for name in names}
    for joint in made.joints:
        near[joint.parent].append((joint.child, joint.name in axes))
        near[joint.child].append((joint.parent, joint.name in axes))

    def reach(start, step):
        found, todo = {start}, [start]
        for link in todo:
            new = [other for other, moves in near[link] if other not in found and step(link, moves)]
            found.update(new)
            todo += new
        return found

    expected = set()
    for one, other in combinations([name for name in names if name not in bare], 2):
        rigid = other in reach(one, lambda _, moves: not moves)
        joined = other in reach(one, lambda link, _, one=one: link == one or link in bare)
        if not rigid and not joined:
            expected.add(frozenset((one, other)))
    found = pairs_that_could_meet(made)
    assert {frozenset(pair) for pair in found} == expected, seed
    assert len(found) == len(expected), seed
