"""Curves over the rows of a stream, against closed forms and finite differences."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from clearance_streams import StreamMaker, obstacle, scene_of
from drawn_streams import DT, LIMITS, DrawnStream, along_y, square_and_slow, trapezoid
from irlx.blocks import JointRange, LimitKind, LinkFrame, ToolBlock
from irlx.report.clearance_curve import clearances_over
from irlx.report.curves import limits_over, outline_of_stream, tool_rates
from irlx.report.programmed_pace import programmed_pace
from irlx.report.singularity import smallest_singular_values
from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.solids.shape import Solid, Sphere
from irlx.streams import BlockRecord
from irlx.verifier.geometry.forward import forward
from irlx.verifier.geometry.link_poses import link_poses
from machines import machine

pytestmark = pytest.mark.req("REP-03")


def test_limits_follow_switches_and_clauses():
    made = DrawnStream()
    made.move([[0.1, 0.0]])
    made.switch_speed(2.0, 0.1)
    narrow = JointRange((-9.0, -9.0), (0.5, 9.0))
    made.move([[0.2, 0.0], [0.3, 0.0]], clause=(LimitKind.POSITION, narrow))
    made.move([[0.4, 0.0]])
    stream = made.stream()
    found = limits_over(outline_of_stream(stream))
    lower, upper = found.bounds("speed", 0, len(stream.t))
    # Rows 0 to 2 stand before the switch; the clause holds in rows 3 to 5, those of its move.
    assert upper[:, 1].tolist() == [0.4] * 3 + [0.1] * 5
    assert lower[:, 0].tolist() == [-3.0] * 3 + [-2.0] * 5
    _, upper = found.bounds("position", 0, len(stream.t))
    assert upper[:, 0].tolist() == [1.0] * 3 + [0.5] * 3 + [1.0] * 2
    assert upper[:, 1].tolist() == [0.5] * 8


def test_blocks_that_are_not_the_streams_change_no_limits():
    made = DrawnStream()
    made.switch_speed(2.0, 0.1)
    made.move([[0.1, 0.0]])
    stream = made.stream()
    moved = type(stream)(
        stream.header, stream.records[::-1], stream.ticks, stream.q, stream.block, stream.tool, True
    )
    found = limits_over(outline_of_stream(moved))
    assert found.bounds("speed", 0, 2)[1].tolist() == [LIMITS.speed_upper.tolist()] * 2


def test_tool_rates_by_hand():
    angles = np.array([0.0, 0.01, 0.05, 0.05])
    tool = np.zeros((4, 7))
    tool[:, 0] = [0.0, 0.003, 0.003, 0.0]
    tool[:, 1] = [0.0, 0.004, 0.004, 0.0]
    tool[:, 3:] = Rotation.from_rotvec(np.outer(angles, [0.0, 0.6, 0.8])).as_quat()
    tool[2, 3:] *= -1.0
    speed, turn = tool_rates(tool, 0.1)
    np.testing.assert_allclose(speed, [0.0, 0.05, 0.0, 0.05], atol=1e-15)
    np.testing.assert_allclose(turn, [0.0, 0.1, 0.4, 0.0], atol=1e-12)


@pytest.mark.parametrize("tool", [None, (0.1, -0.05, 0.2)])
def test_singular_values_by_differences(tool):
    robot = machine("arm7").robot
    rng = np.random.default_rng(11)
    maker = StreamMaker(robot, rng.uniform(-1.0, 1.0, 7))
    if tool is not None:
        number, origin = maker._origin()
        block = ToolBlock(id=number, origin=origin, position=tool, orientation=(0.0, 0.0, 0.0, 1.0))
        maker.records.append(BlockRecord(maker.tick, block))
    maker.move(rng.uniform(-1.0, 1.0, (3, 7)))
    stream = maker.stream()
    found = smallest_singular_values(robot, stream.records, stream.ticks, stream.q)
    offset = np.zeros(3) if tool is None else np.array(tool)
    # The tool is in force behind the row that stood when it was set.
    offsets = [np.zeros(3), *[offset] * 4]
    pairs = zip(stream.q, offsets, strict=True)
    due = [np.linalg.svd(differences(robot, q, own), compute_uv=False)[-1] for q, own in pairs]
    np.testing.assert_allclose(found, due, rtol=1e-6)


def test_singular_values_in_a_frame_that_the_other_hand_carries():
    robot = machine("dual14").robot
    rng = np.random.default_rng(12)
    maker = StreamMaker(robot, rng.uniform(-0.5, 0.5, 14))
    maker.move(rng.uniform(-0.5, 0.5, (2, 14)))
    frame = LinkFrame("pipe", robot.carriers[0], (0.1, 0.0, 0.2), (0.0, 0.0, 0.0, 1.0))
    (record,) = maker.records
    maker.records[0] = BlockRecord(record.tick, replace(record.block, frame=frame))
    stream = maker.stream()
    found = smallest_singular_values(robot, stream.records, stream.ticks, stream.q)
    due = [np.linalg.svd(seen_differences(robot, q, frame), compute_uv=False)[-1] for q in stream.q]
    np.testing.assert_allclose(found, due, rtol=1e-5)


def seen_differences(robot, q, frame):
    """Jacobian (6, n) of the tool as a frame on a link sees it, by central differences."""
    step, columns = 1e-6, []

    def seen(posture):
        position, rotation = forward(robot, posture[None])
        at, turned = (part[0] for part in link_poses(robot, posture[None], (frame.link,))[frame.link])
        at = at + turned @ np.array(frame.position)
        return turned.T @ (position[0] - at), turned.T @ rotation[0]

    for joint in range(q.size):
        unit = step * np.eye(q.size)[joint]
        (one, ahead), (other, behind) = seen(q + unit), seen(q - unit)
        turn = Rotation.from_matrix(ahead @ behind.T).as_rotvec()
        columns.append(np.concatenate([(one - other) / robot.reach, turn]) / (2.0 * step))
    return np.array(columns).T


def differences(robot, q, offset):
    """Jacobian (6, n) of a point of the tool by central differences, lengths divided by the reach."""
    step, columns = 1e-6, []
    _, turned = forward(robot, q[None])
    for joint in range(q.size):
        ends = []
        for side in (step, -step):
            there = q.copy()
            there[joint] += side
            position, rotation = forward(robot, there[None])
            ends.append((position[0] + rotation[0] @ offset, rotation[0]))
        way = (ends[0][0] - ends[1][0]) / robot.reach
        turn = Rotation.from_matrix(ends[0][1] @ ends[1][1].T).as_rotvec()
        columns.append(np.concatenate([turned[0].T @ way, turned[0].T @ turn]) / (2.0 * step))
    return np.array(columns).T


def test_clearance_of_a_ball_by_hand():
    joint = Joint("x", JointKind.PRISMATIC, "base", "hand", axis=(1.0, 0.0, 0.0))
    robot = RobotDescription("ball", "base", "hand", (joint,), solids={"hand": (Solid(Sphere(0.1)),)})
    maker = StreamMaker(robot, np.zeros(1))
    maker.move([[0.1]])
    maker.switch("rock")
    way = np.linspace(0.1, 0.55, 6)[:, None]
    maker.move(way)
    maker.switch("rock", active=False)
    maker.move([[0.5]])
    stream = maker.stream()
    # Felt from 0.5 m on; the ball of 0.1 m comes from x towards one of 0.2 m at x = 1.
    scene = scene_of(obstacle("rock", Sphere(0.2), (1.0, 0.0, 0.0), margin=0.05))
    rows = np.arange(len(stream.t))
    found = clearances_over(outline_of_stream(stream), robot, scene, stream.q, rows)
    distance = 0.7 - stream.q[:, 0]
    on = np.isin(rows, range(3, 10)) & (distance < 0.5)
    np.testing.assert_allclose(found.distance[on], distance[on], atol=1e-9)
    assert np.all(np.isinf(found.distance[~on]))
    assert [found.pairs[number] for number in set(found.pair[on].tolist())] == [("hand", "rock")]
    assert found.smallest.distance == pytest.approx(0.15, abs=1e-9)
    assert found.margin.tolist() == [0.05]
    assert np.flatnonzero(found.watched).tolist() == list(range(3, 10))


def test_nothing_to_keep_clear_of_is_no_curve():
    robot = machine("planar3").robot
    stream = StreamMaker(robot, np.zeros(3)).stream()
    find = partial(clearances_over, outline_of_stream(stream), robot)
    assert find(scene_of(), stream.q, np.arange(1)) is None


def test_pace_of_a_line_as_programmed_and_slower():
    stream = square_and_slow()
    pace = programmed_pace(stream, outline_of_stream(stream))
    speed, _ = tool_rates(stream.tool, stream.dt)
    first = slice(1, 121)
    np.testing.assert_allclose(pace.speed[first], speed[first], rtol=1e-6)
    # Full speed is from 0.2 s to 1 s of the programmed time: 80 ticks, here taken twice.
    (span,) = pace.slowed
    begin = 122 + 20
    assert span == (begin, begin + 159)
    middle = slice(begin, begin + 160)
    np.testing.assert_allclose(pace.speed[middle], 0.2, rtol=1e-6)
    np.testing.assert_allclose(speed[middle], 0.1, rtol=1e-6)
    assert np.isnan(pace.speed[[0, 121, len(speed) - 1]]).all()


def test_pace_of_a_turn():
    made = DrawnStream()
    angle = trapezoid(0.5, 1.0, 10.0, np.arange(1, 61) * DT)
    poses = np.tile(made.tool[-1], (60, 1))
    poses[:, 3:] = Rotation.from_rotvec(np.outer(angle, [0.0, 0.0, 1.0])).as_quat()
    made.move(np.zeros((60, 2)), poses)
    stream = made.stream()
    pace = programmed_pace(stream, outline_of_stream(stream))
    _, turn = tool_rates(stream.tool, stream.dt)
    np.testing.assert_allclose(pace.turn[1:61], turn[1:61], rtol=1e-5)
    assert pace.slowed == ()


def test_what_is_no_line_has_no_pace():
    made = DrawnStream()
    # Faster than its law: whatever this is, it is not that law.
    made.move(np.zeros((60, 2)), along_y(made.tool[-1], trapezoid(0.2, 0.4, 2.0, np.arange(1, 61) * DT)))
    made.move(np.full((3, 2), 0.1))
    stream = made.stream()
    pace = programmed_pace(stream, outline_of_stream(stream))
    assert np.isnan(pace.speed).all()
    assert pace.slowed == ()
