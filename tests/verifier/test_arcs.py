"""Arcs rebuilt from blocks: closed-form rows lie on them, and what is off is measured and named."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import ArcCourse, PoseTarget
from irlx.streams import BlockRecord, read_stream, write_stream
from irlx.verifier import verify_stream
from irlx.verifier.geometry.arcs import ArcWay, arc_shape

pytestmark = [pytest.mark.req("MOT-20"), pytest.mark.req("STR-06")]

START = np.array([0.1, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1])


def maker(kit):
    made = kit.Maker(START.copy())
    # (0.3, -0.1) is where the tool stands.
    made.circle((0.2, -0.1), 1.0, 2.5, turn=(0.3, -0.2, 0.5))
    made.circle((0.2, -0.1), 1.0, 2.0, angle=2 * np.pi)
    made.circle((0.0, 0.0), -1.0, -2.0, angle=13.0, turn=(0.0, 0.7, 0.0), ticks=200)
    made.circle((0.0, 0.0), -1.0, -2.0, angle=-1.0)
    return made


def with_q(stream, q):
    """The stream with other joint values, its tool poses in keeping."""
    turns = Rotation.from_euler("ZYX", q[:, 4:7]).as_quat()
    return replace(stream, q=q, tool=np.column_stack([q[:, 0] + q[:, 1], q[:, 2], q[:, 3], turns]))


def rows_of(stream, block: int) -> np.ndarray:
    return np.flatnonzero(stream.block == block)


def test_arcs_pass(gantry_kit, robot) -> None:
    stream = maker(gantry_kit).stream()
    report = verify_stream(stream, robot)
    assert report.passed, str(report)
    for name in ("path position", "path orientation", "goal position", "goal orientation"):
        assert report[name].worst.value < 1e-11, name


@pytest.mark.parametrize("ending", [".irdata", ".npz"])
def test_written_arcs_pass(ending: str, gantry_kit, robot, tmp_path) -> None:
    stream = maker(gantry_kit).stream()
    write_stream(stream, tmp_path / f"a{ending}")
    back = read_stream(tmp_path / f"a{ending}")
    assert back.records == stream.records
    assert verify_stream(back, robot).passed


def off(stream, block: int, place: int, joint: int, amount: float):
    q = stream.q.copy()
    q[rows_of(stream, block)[place], joint] += amount
    return with_q(stream, q)


def backwards(stream):
    """A row of the second round of the third arc, put behind the next one."""
    rows = rows_of(stream, 3)
    q = stream.q.copy()
    q[rows[[100, 101]]] = q[rows[[101, 100]]]
    return with_q(stream, q)


def stopped_short(stream):
    """The full circle ends where it began, but nothing was run."""
    rows = rows_of(stream, 2)
    q = stream.q.copy()
    q[rows] = q[rows[0] - 1]
    return with_q(stream, q)


def chord(stream):
    """The last arc, cut short on a straight line between its ends."""
    rows = rows_of(stream, 4)
    q, share = stream.q.copy(), np.append(np.linspace(0, 1, len(rows) - 1), 1.0)[:, None]
    q[rows] = q[rows[0] - 1] * (1 - share) + q[rows[-1]] * share
    return with_q(stream, q)


def mirrored(stream):
    """The first arc, run on the other side of its chord."""
    rows = rows_of(stream, 1)
    q = stream.q.copy()
    start = q[rows[0] - 1, 1:3]
    way = q[rows[-1], 1:3] - start
    along = np.outer((q[rows, 1:3] - start) @ way / (way @ way), way)
    q[rows, 1:3] = start + 2 * along - (q[rows, 1:3] - start)
    return with_q(stream, q)


def with_course(stream, block: int, **changes):
    records = [
        BlockRecord(r.tick, replace(r.block, course=replace(r.block.course, **changes)))
        if r.block.id == block
        else r
        for r in stream.records
    ]
    return replace(stream, records=tuple(records))


def other_target(stream, block: int, position):
    records = [
        BlockRecord(r.tick, replace(r.block, target=replace(r.block.target, position=position)))
        if r.block.id == block
        else r
        for r in stream.records
    ]
    return replace(stream, records=tuple(records))


SABOTAGE = [
    ("outside the circle", lambda s: off(s, 1, 30, 2, 2e-6), "path position", 4),
    ("out of the plane", lambda s: off(s, 3, 120, 3, 2e-6), "path position", 6),
    ("turned", lambda s: off(s, 1, 30, 4, 3e-6), "path orientation", 4),
    ("turned on a full circle", lambda s: off(s, 2, 30, 6, 3e-6), "path orientation", 5),
    ("ran backwards in the second round", backwards, "path progress", 6),
    ("a full circle that was not run", stopped_short, "path progress", 5),
    ("chord instead of arc", chord, "path position", 7),
    ("the other side", mirrored, "path position", 4),
    ("another angle was asked for", lambda s: with_course(s, 2, angle=6.0), "goal position", 5),
    ("the other way round was asked for", lambda s: with_course(s, 4, angle=1.0), "goal position", 7),
    ("to the end point, not by an angle", lambda s: with_course(s, 4, angle=None), "goal position", 7),
    ("another end", lambda s: other_target(s, 1, (0.2, 0.01, 0.3)), "goal position", 4),
    (
        "points on a line",
        lambda s: other_target(s, 4, tuple(2 * p for p in s.records[3].block.course.via.position)),
        "path position",
        7,
    ),
    (
        "another via point",
        lambda s: with_course(s, 1, via=PoseTarget((0.2, 0.05, 0.3), None)),
        "path position",
        4,
    ),
]


@pytest.mark.parametrize(("change", "name", "line"), [c[1:] for c in SABOTAGE], ids=[c[0] for c in SABOTAGE])
def test_sabotage_is_found(change, name: str, line: int, gantry_kit, robot) -> None:
    report = verify_stream(change(maker(gantry_kit).stream()), robot)
    check = report[name]
    assert check.status == "failed", str(report)
    assert check.first.line == line


def wrong_blocks(kit):
    circle = maker(kit).stream().records[0].block
    yield replace(circle, course=None), "CIRCLE needs a course"
    yield replace(circle, kind=kit.MoveKind.LIN), "LIN has no course"
    yield replace(circle, course=replace(circle.course, angle=0.0)), "cannot turn by 0.0 rad"
    yield replace(circle, course=replace(circle.course, angle=np.inf)), "cannot turn by inf rad"
    yield replace(circle, course=ArcCourse(kit.JointTarget((1.0,)))), "1 values for 7 joints"
    yield replace(circle, course=ArcCourse(PoseTarget((0, 0, 0), (0, 0, 0, 2)))), "length 2"
    via = ArcCourse(PoseTarget((0, 0, 0), None), via_reconfiguration=kit.JointTarget((1.0,) * 7))
    yield replace(circle, course=via), "a posture for its via point and none for its end"
    short = replace(via, via_reconfiguration=kit.JointTarget((1.0,)))
    end = kit.JointTarget((0.0,) * 7)
    yield replace(circle, course=short, reconfiguration=end), "its posture has 1 values for 7 joints"


def test_blocks_that_are_no_circle(gantry_kit, robot) -> None:
    stream = maker(gantry_kit).stream()
    for block, words in wrong_blocks(gantry_kit):
        records = (BlockRecord(0, block), *stream.records[1:])
        check = verify_stream(replace(stream, records=records), robot)["blocks"]
        assert check.status == "failed"
        assert words in check.detail, check


def test_a_frame_that_is_not_known_is_not_checked(gantry_kit, robot) -> None:
    stream = maker(gantry_kit).stream()
    via = replace(stream.records[0].block.course.via, frame="TABLE")
    report = verify_stream(with_course(stream, 1, via=via), robot)
    assert report.passed
    assert "1 moves not checked" in report["path position"].detail


def deviation(points, angle, shares, turns, through=False, step=0.1):
    """Deviation of rows on a circle of radius 2 about (1, 2, 3), tilted, by closed form."""
    frame = Rotation.from_euler("xyz", [0.3, -0.7, 1.1])
    centre = np.array([1.0, 2.0, 3.0])

    def at(phi):
        phi = np.atleast_1d(phi)
        flat = 2.0 * np.column_stack([np.cos(phi), np.sin(phi), np.zeros(len(phi))])
        return centre + frame.apply(flat)

    start, via, goal = at(np.array([0.0, *points]))
    travel = points[1] if angle is None else angle
    shape = arc_shape(start, via, goal, angle)
    rotations = tuple(Rotation.from_rotvec(v).as_matrix() for v in turns)
    course = ArcCourse(PoseTarget(tuple(via), None), angle, through)
    whole = Rotation.from_matrix(rotations[0].T @ rotations[2]).as_rotvec()
    turned = Rotation.from_matrix(rotations[0]) * Rotation.from_rotvec(np.outer(shares, whole))
    way = ArcWay(shape, course, rotations, step)
    return shape, way.deviation(at(shares * travel), turned.as_matrix())


@pytest.mark.parametrize("angle", [None, 1.0, 2 * np.pi, 20.0, -2.0, -2 * np.pi])
@pytest.mark.parametrize("points", [(0.5, 1.0), (3.0, 3.5), (0.1, 6.0)])
def test_points_of_the_arc_are_on_it(points, angle) -> None:
    turns = ((0.1, 0.2, 0.3), (0, 0, 0), (0.5, -0.4, 1.0))
    shape, found = deviation(points, angle, np.linspace(0, 1, 301), turns)
    assert found.position.max() < 1e-12
    assert found.orientation.max() < 1e-12
    assert (np.diff(found.along) > -1e-12).all()
    travel = points[1] if angle is None else abs(angle)
    assert found.along[-1] == pytest.approx(2.0 * travel, abs=1e-12)
    assert shape.travel == pytest.approx(travel, abs=1e-12)


def test_rows_far_apart_are_told_by_the_speed_that_the_program_allows() -> None:
    """Four rows on a whole circle, then three: steps of more than half a turn go forward."""
    turns = ((0, 0, 0), (0, 0, 0), (0.0, 0.0, 1.0))
    for rows, step in ((4, np.pi / 2), (3, 2.2), (2, 3.5)):
        _, found = deviation((1.0, 2.0), 2 * np.pi, np.linspace(0, 1, rows + 1), turns, step=step)
        assert found.orientation.max() < 1e-12
        assert found.along[-1] == pytest.approx(4 * np.pi)


def test_a_half_turn_may_go_either_way() -> None:
    for sign in (1.0, -1.0):
        turns = ((0, 0, 0), (0, 0, 0), (0.0, 0.0, sign * (np.pi - 1e-9)))
        _, found = deviation((1.0, 2.0), None, np.linspace(0, 1, 11), turns)
        assert found.orientation.max() < 1e-12
