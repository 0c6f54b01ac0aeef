"""The check of clearance on streams made by hand: what comes near is found, in its very tick."""

from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from clearance_streams import StreamMaker, clearance_of, obstacle, scene_of
from irlx.promises import CLEARANCE
from irlx.robot.urdf import read_urdf
from irlx.scene.obstacle import Waypoint
from irlx.scene.scene import LinkClearance
from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Point, Sphere
from irlx.streams.scan import scan_of
from irlx.verifier.clearance.obstacle_poses import obstacle_poses, pose_of
from irlx.verifier.clearance.search import NEAREST_WITHIN
from irlx.verifier.clearance.spans import obstacle_spans, rows_in
from irlx.verifier.distances.between import distances
from irlx.verifier.distances.body import body_of
from irlx.verifier.geometry.link_poses import link_poses, moved_links
from irlx.verifier.outline import outline_of

SEED = 20261129
MODELS = Path(irlx.__file__).parent / "cell" / "robots"


@pytest.fixture(scope="module")
def planar():
    """Four links of 0.4, 0.3, 0.25, 0.15 m about z, cylinders of radius 0.035 m along x."""
    return read_urdf((MODELS / "planar4.urdf").read_text(encoding="utf-8"), tip="tool")


@pytest.fixture(scope="module")
def arm():
    return read_urdf((MODELS / "arm7.urdf").read_text(encoding="utf-8"), tip="tool")


def swing(start: float, end: float, rows: int) -> np.ndarray:
    """The first joint of planar4 turns, the arm stretched out."""
    q = np.zeros((rows, 4))
    q[:, 0] = np.linspace(start, end, rows)
    return q


def planar_gap(angle: float, y: float, reach: float = 1.1, radius: float = 0.035) -> float:
    """Distance of the stretched arm, at an angle to x, from a wall that begins at `y`: that of the rim of its
    last cylinder."""
    return y - (reach * np.sin(angle) + radius * np.cos(angle))


WALL = Box((4.0, 0.2, 1.0))


def wall(y: float, margin: float = 0.02, **data):
    """A wall across y whose face is at y."""
    return obstacle("wall", WALL, (0.0, y + 0.1, 0.0), margin=margin, **data)


@pytest.mark.req("STR-06")
def test_the_smallest_distance_is_told_though_all_is_well(planar):
    maker = StreamMaker(planar, np.zeros(4))
    maker.switch("Wall")
    maker.move(swing(0.0, 0.5, 400))
    maker.move(swing(0.5, 0.0, 400))
    found = clearance_of(maker, scene_of(wall(0.7)))
    assert found.status == "ok"
    assert found.worst.value == pytest.approx(planar_gap(0.5, 0.7), abs=NEAREST_WITHIN)
    assert found.worst.allowed == 0.02
    assert found.worst.pair == "link_4 and wall"
    assert 399 <= found.worst.tick <= 402
    assert found.worst.unit == "m"
    assert "link_4 and wall" in str(found.worst)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("beyond", [1e-3, 1e-6, 2e-9])
def test_a_single_row_among_many_is_found(planar, beyond):
    """One row inside the margin by so much, its neighbours well clear of it."""
    angle = np.arcsin(0.5)
    maker = StreamMaker(planar, np.zeros(4))
    maker.switch("wall")
    rows = swing(0.0, angle - 0.05, 3000)
    rows[1234, 0] = angle
    first = maker.move(rows)
    face = 0.02 - beyond + 1.1 * np.sin(angle) + 0.035 * np.cos(angle)
    found = clearance_of(maker, scene_of(wall(face)))
    assert found.status == "failed"
    assert found.first.tick == found.worst.tick == first + 1234
    assert found.first.value == pytest.approx(0.02 - beyond, abs=1e-12)
    assert found.first.line == maker.records[-1].block.origin.line
    assert found.first.block == maker.records[-1].block.id
    # And by less than the promised number it is not.
    assert clearance_of(maker, scene_of(wall(face + beyond - 0.5 * CLEARANCE))).status == "ok"


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("late", [False, True])
def test_only_rows_between_obstacle_and_its_end_count(planar, late):
    """Inside the margin before OBSTACLE and behind OBSTACLEEND: nobody promised anything."""
    maker = StreamMaker(planar, np.zeros(4))
    maker.move(swing(0.0, 0.5, 200))
    maker.move(swing(0.5, 0.0, 200))
    maker.switch("wall")
    on = maker.move(swing(0.0, 0.3, 200))
    maker.move(swing(0.3, 0.0, 200))
    if not late:
        maker.switch("WALL", active=False)
    after = maker.move(swing(0.0, 0.5, 200))
    maker.switch("wall", active=False)
    found = clearance_of(maker, scene_of(wall(0.56)))
    if late:
        due = after + int(np.argmax(planar_gap(np.linspace(0.0, 0.5, 200), 0.56) < 0.02))
        assert (found.status, found.first.tick) == ("failed", due)
        return
    assert found.status == "ok"
    assert found.worst.value == pytest.approx(planar_gap(0.3, 0.56), abs=NEAREST_WITHIN)
    assert on + 199 <= found.worst.tick <= on + 202


@pytest.mark.req("STR-06")
def test_a_sabotaged_record_is_noticed(planar):
    maker = StreamMaker(planar, np.zeros(4))
    maker.switch("wall")
    maker.move(swing(0.0, 0.5, 200))
    found = clearance_of(maker, scene_of(obstacle("wand", WALL, (0.0, 5.0, 0.0))))
    assert found.status == "failed"
    assert found.detail == "the cell has no obstacle 'wall'"
    assert clearance_of(maker, None).status == "not checked"
    assert clearance_of(maker, None).detail == "no cell is known"


@pytest.mark.req("STR-06")
def test_there_is_no_case_without_an_obstacle_that_is_on(planar):
    maker = StreamMaker(planar, np.zeros(4))
    maker.move(swing(0.0, 0.5, 200))
    assert clearance_of(maker, scene_of(wall(0.6))).status == "no case"
    assert clearance_of(maker, None).status == "no case"


@pytest.mark.req("STR-06")
def test_what_is_on_counts_to_the_very_row_of_its_end(planar):
    maker = StreamMaker(planar, np.zeros(4))
    maker.switch("wall")
    maker.switch("all")
    maker.move(swing(0.0, 0.1, 9))
    maker.switch("WALL", active=False)
    maker.move(swing(0.1, 0.0, 9))
    maker.switch("all", active=False)
    maker.move(swing(0.0, 0.1, 9))
    maker.switch("wall")
    maker.move(swing(0.1, 0.0, 9))
    maker.switch("nobody")
    scene = scene_of(wall(0.6), replace(wall(0.6), name="far"), all=("wall", "far"))
    outline = outline_of(partial(scan_of, maker.stream()))
    assert obstacle_spans(outline, scene) == ({"wall": ((1, 20), (31, 40)), "far": ((1, 20),)}, ("nobody",))
    rows = np.arange(42)
    assert np.flatnonzero(rows_in(((1, 20), (31, 40)), rows)).tolist() == [*range(1, 21), *range(31, 41)]


@pytest.mark.req("STR-06")
def test_a_group_is_on_as_long_as_any_of_its_names(planar):
    """`both` begins, `wall` begins, `wall` ends: it still counts; `both` ends: it does not."""
    maker = StreamMaker(planar, np.zeros(4))
    maker.switch("Both")
    maker.switch("wall")
    maker.switch("wall", active=False)
    near = maker.move(swing(0.0, 0.5, 100))
    far = wall(5.0)
    scene = scene_of(wall(0.56), replace(far, name="far"), both=("wall", "far"))
    assert clearance_of(maker, scene).worst.tick >= near
    assert clearance_of(maker, scene).status == "failed"
    quiet = StreamMaker(planar, np.zeros(4))
    quiet.switch("both")
    quiet.switch("both", active=False)
    quiet.move(swing(0.0, 0.5, 100))
    assert clearance_of(quiet, scene).status == "no case"


@pytest.mark.req("TRF-13")
def test_a_motion_that_starts_inside_the_margin_may_only_leave(planar):
    start, scene = swing(0.4, 0.4, 1)[0], scene_of(wall(planar_gap(0.4, 0.0) * -1.0 + 0.005))
    maker = StreamMaker(planar, start)
    maker.switch("wall")
    maker.move(swing(0.4, 0.39, 200))
    maker.move(swing(0.39, 0.2, 200))
    left = clearance_of(maker, scene)
    assert left.status == "ok"
    assert left.worst.value == pytest.approx(left.worst.allowed, abs=NEAREST_WITHIN)
    assert left.worst.allowed >= 0.005 - 1e-12
    assert left.detail == "a motion starts inside the margin and comes no nearer: link_4 and wall"
    back = maker.move(swing(0.2, 0.4, 2000))
    found = clearance_of(maker, scene)
    assert found.status == "failed"
    # The one that starts outside keeps the margin: where it is met, and in that very row, by the closed form.
    angles = np.linspace(0.2, 0.4, 2000)
    due = back + int(np.argmax(planar_gap(angles, 0.005 - planar_gap(0.4, 0.0)) < 0.02))
    assert found.first.tick == due
    assert found.first.allowed == 0.02


@pytest.mark.req("TRF-13")
@pytest.mark.parametrize("away", [0.005, -0.01])
def test_nearer_than_at_its_start_is_an_offence(planar, away):
    """Also of a motion that starts inside the obstacle itself."""
    face = away - planar_gap(0.4, 0.0)
    maker = StreamMaker(planar, swing(0.4, 0.4, 1)[0])
    maker.switch("wall")
    rows = swing(0.4, 0.3, 500)
    rows[100, 0] = 0.4 + 3e-6
    first = maker.move(rows)
    found = clearance_of(maker, scene_of(wall(face)))
    assert found.status == "failed"
    assert found.first.tick == found.worst.tick == first + 100
    assert found.first.allowed == pytest.approx(away, abs=1e-10)
    assert found.first.value == pytest.approx(away - 3e-6 * 1.1 * np.cos(0.4), abs=6e-8)


@pytest.mark.req("STR-06")
def test_a_base_that_cannot_move_is_exempt(planar):
    """The base stands in the floor and nothing can be done about it; the links are above."""
    maker = StreamMaker(planar, np.zeros(4))
    maker.switch("floor")
    maker.move(swing(0.0, 0.5, 100))
    found = clearance_of(maker, scene_of(obstacle("floor", Halfspace(), (0.0, 0.0, -0.1), margin=0.05)))
    assert found.status == "ok"
    assert found.worst.value == pytest.approx(0.1 - 0.035, abs=1e-12)
    assert moved_links(planar) == {"link_1", "link_2", "link_3", "link_4", "tool"}


@pytest.mark.req("STR-06")
def test_an_obstacle_that_moves_is_where_its_row_is_in_time(planar):
    """A ball passes the arm at rest; and it comes near the base, which is then no exemption."""
    waypoints = tuple(
        Waypoint(time, Placement((x, y, 0.0)))
        for time, x, y in ((1.0, 0.7, 1.0), (3.0, 0.7, 0.2), (4.0, 0.7, 1.0))
    )
    ball = obstacle("ball", Sphere(0.1), margin=0.05, trajectory=waypoints)
    maker = StreamMaker(planar, np.zeros(4), dt=0.01)
    maker.switch("ball")
    maker.move(swing(0.0, 0.0, 600))
    found = clearance_of(maker, scene_of(ball))
    assert found.status == "ok"
    assert found.worst.tick == 300
    assert found.worst.value == pytest.approx(0.2 - 0.1 - 0.035, abs=1e-12)
    wider = replace(ball, margin=0.08)
    failed = clearance_of(maker, scene_of(wider))
    # It falls short of the margin when y < 0.08 + 0.135, going down by 0.4 m/s.
    assert failed.status == "failed"
    assert failed.first.tick == int(np.ceil(100 + 100 * (1.0 - 0.215) / 0.4 + 1e-9))
    assert failed.worst.tick == 300
    to_base = replace(ball, trajectory=(waypoints[0], Waypoint(3.0, Placement((0.0, 0.0, -0.35)))))
    assert clearance_of(maker, scene_of(to_base)).worst.pair == "base_link and ball"


@pytest.mark.req("STR-06")
def test_trajectories_turn_about_one_axis():
    rng = np.random.default_rng(SEED)
    rotations = Rotation.random(5, random_state=rng)
    positions, times = rng.normal(size=(5, 3)), np.array([0.0, 0.4, 1.0, 1.5, 4.0])
    moving = obstacle(
        "ball",
        Point(),
        trajectory=tuple(
            Waypoint(t, Placement(tuple(p), tuple(r.as_quat())))
            for t, p, r in zip(times, positions, rotations, strict=True)
        ),
    )
    asked = np.concatenate([[-1.0, 9.0], times, rng.uniform(0.0, 4.0, 200)])
    found = obstacle_poses(moving, asked)
    for time, position, rotation in zip(asked, *found, strict=True):
        k = min(max(int(np.searchsorted(times, time)) - 1, 0), 3)
        share = min(max((time - times[k]) / (times[k + 1] - times[k]), 0.0), 1.0)
        turn = (rotations[k].inv() * rotations[k + 1]).as_rotvec()
        assert position == pytest.approx(positions[k] + share * (positions[k + 1] - positions[k]), abs=1e-12)
        due = (rotations[k] * Rotation.from_rotvec(share * turn)).as_matrix()
        assert rotation == pytest.approx(due, abs=1e-9)


@pytest.mark.req("STR-06")
def test_links_are_kept_off_each_other_from_the_first_row_on(planar):
    """Elbow and wrist fold: the last link comes back to the first one, by a closed form."""
    rows = np.tile([0.0, np.pi / 2, np.pi / 2, 0.0], (500, 1))
    rows[:, 3] = np.linspace(0.0, 1.2, 500)
    maker = StreamMaker(planar, rows[0])
    first = maker.move(rows)
    # The fourth joint is 0.3 m off the first link's axis, its link turns from parallel towards it.
    gaps = 0.3 - 0.035 - (0.15 * np.sin(rows[:, 3]) + 0.035 * np.cos(rows[:, 3]))
    links = LinkClearance((("link_1", "link_4"),), 0.15, 0.3)
    found = clearance_of(maker, scene_of(links=links))
    assert found.status == "failed"
    assert found.worst.pair == "link_1 and link_4"
    assert found.worst.value == pytest.approx(gaps.min(), abs=1e-9)
    assert found.first.tick == first + int(np.argmax(gaps < 0.15))
    clear = clearance_of(maker, scene_of(links=replace(links, margin=0.05)))
    assert clear.status == "ok"
    assert clear.worst.value == pytest.approx(gaps.min(), abs=NEAREST_WITHIN)


def brute(robot, q, scene, names, links):
    """Least distance and its pair in every row, every solid with every other, nothing left out."""
    poses = link_poses(robot, q, tuple(robot.solids))
    every = {
        name: tuple(np.broadcast_to(part, (len(q), *part.shape[1:])) for part in pose)
        for name, pose in poses.items()
    }

    def placed(solid, pose):
        position, rotation = pose_of(solid.placement)
        return pose[0] + pose[1] @ position, pose[1] @ rotation

    found = {}
    moved = moved_links(robot)
    others = []
    for name in names:
        for known in scene.members(name):
            at = pose_of(known.placement)
            pose = np.repeat(at[0][None], len(q), axis=0), np.repeat(at[1][None], len(q), axis=0)
            others += [(link, known.name, known.solids, pose) for link in robot.solids if link in moved]
    others += [(a, b, robot.solids[b], every[b]) for a, b in links]
    for link, other, solids, pose in others:
        least = np.full(len(q), np.inf)
        for mine, theirs in product(robot.solids[link], solids):
            one, two = placed(theirs, pose), placed(mine, every[link])
            back = np.swapaxes(one[1], 1, 2)
            relative = np.einsum("kij,kj->ki", back, two[0] - one[0]), back @ two[1]
            least = np.minimum(least, distances(body_of(theirs.shape), body_of(mine.shape), *relative).upper)
        found[f"{link} and {other}"] = least
    return found


def wandering(rng, robot, rows, middle):
    """Joint values that wander smoothly about a posture, with spikes and stands."""
    time = np.arange(rows) * 0.004
    q = np.tile(middle, (rows, 1))
    for joint in range(len(robot.axes)):
        for speed in (0.3, 0.9, 2.0):
            q[:, joint] += rng.uniform(0.0, 0.3) * np.sin(speed * time + rng.uniform(0.0, 6.3))
    spikes = rng.integers(1, rows - 1, 6)
    q[spikes] += rng.normal(size=(6, len(robot.axes))) * 0.2
    stands = int(rng.integers(1, rows - 50))
    q[stands : stands + 40] = q[stands]
    return q


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("seed", [1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (3, 0, 2, 5))])
def test_no_row_that_is_left_out_would_have_mattered(arm, seed):
    """Against all distances of all rows: first offence, worst one, and that there is none."""
    rng = np.random.default_rng([SEED, seed])
    q = wandering(rng, arm, int(rng.choice([300, 700])), np.array([0.0, 0.6, 0.0, 1.2, 0.0, 0.8, 0.0]))
    shapes = (
        Box((0.6, 0.02, 0.5)),
        Cylinder(0.05, 0.8),
        Sphere(0.08),
        Capsule(0.04, 0.3),
        Cone(0.1, 0.3),
        Point(),
    )
    known = []
    for number, shape in enumerate(rng.choice(len(shapes), 4)):
        xyz = rng.normal(size=3) * [0.4, 0.4, 0.3] + [0.45, 0.0, 0.5]
        known.append(obstacle(f"o{number}", shapes[shape], tuple(xyz), tuple(rng.uniform(-3, 3, 3))))
    known.append(obstacle("floor", Halfspace(), (0.0, 0.0, float(rng.uniform(-0.1, 0.2)))))
    links = (("base_link", "wrist"), ("shoulder", "forearm_2"), ("upper_arm_1", "flange"))
    scene = scene_of(*known)
    least = brute(arm, q, scene, [found.name for found in known], links)
    everything = np.array(list(least.values()))
    for margin in (1e-9, 0.05, float(np.median(everything.min(axis=0)))):
        maker = StreamMaker(arm, q[0])
        marked = [replace(found, margin=margin) for found in known]
        for found in marked:
            maker.switch(found.name)
        maker.move(q[1:])
        check = clearance_of(maker, scene_of(*marked, links=LinkClearance(links, margin, 1.0)))
        start = np.minimum(margin, everything[:, :1])
        start[start >= margin - CLEARANCE] = margin
        short = start - everything
        offends = (short > CLEARANCE).any(axis=0)
        assert (check.status == "failed") == offends.any(), (seed, margin)
        worst = float(short.max())
        assert worst - NEAREST_WITHIN <= check.worst.allowed - check.worst.value <= worst + 1e-9
        name = list(least).index(check.worst.pair)
        assert check.worst.value == pytest.approx(
            everything[name, min(check.worst.tick, len(q) - 1)], abs=1e-9
        )
        if offends.any():
            assert check.first.tick == int(np.argmax(offends)), (seed, margin)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("sizes", [(7, 150), pytest.param((1, 64), marks=pytest.mark.slow)], ids=str)
def test_portions_do_not_change_what_is_found(planar, monkeypatch, sizes):
    """A motion that starts inside its margin, cut anywhere: its floor goes with it."""
    scene = scene_of(
        wall(0.005 - planar_gap(0.4, 0.0)), links=LinkClearance((("link_1", "link_3"),), 0.01, 0.1)
    )
    maker = StreamMaker(planar, swing(0.4, 0.4, 1)[0])
    maker.switch("wall")
    rows = swing(0.4, 0.35, 150)
    rows[140] = 0.4 + 1e-5, 0.0, 0.0, 0.0
    first = maker.move(rows)
    maker.move(swing(0.35, 0.1, 150))
    maker.switch("wall", active=False)
    maker.move(swing(0.1, 0.3, 50))
    maker.switch("wall")
    maker.move(swing(0.3, 0.35, 50))
    whole = clearance_of(maker, scene)
    assert whole.first.tick == first + 140
    for size in sizes:
        monkeypatch.setattr("irlx.verifier.rows.PORTION", size)
        cut = clearance_of(maker, scene)
        assert (cut.status, cut.first, cut.detail) == (whole.status, whole.first, whole.detail)
        assert cut.worst == whole.worst


@pytest.mark.req("STR-06")
def test_numbers_beyond_all_measure_and_robots_without_solids(planar):
    maker = StreamMaker(planar, np.zeros(4))
    maker.switch("wall")
    rows = swing(0.0, 0.1, 20)
    rows[5, 1] = 1e308
    maker.move(rows)
    assert clearance_of(maker, scene_of(wall(5.0))).status in ("ok", "failed")
    maker = StreamMaker(planar, np.zeros(4))
    maker.switch("wall")
    maker.move(swing(0.0, 0.1, 20))
    assert clearance_of(maker, scene_of(wall(1e300))).status == "ok"
    bare = StreamMaker(replace(planar, solids={}), np.zeros(4))
    bare.switch("wall")
    bare.move(swing(0.0, 0.1, 20))
    assert clearance_of(bare, scene_of(wall(5.0))).detail == "the robot's links have no solids"
