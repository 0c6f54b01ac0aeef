"""Tools that change, targets that are counted on, overrides, weights, joint moves that pass their targets."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import (
    ArcCourse,
    Blend,
    CyclicBlock,
    JointIncrement,
    JointTarget,
    MotionLaw,
    MoveBlock,
    MoveKind,
    PathCourse,
    PoseIncrement,
    PoseTarget,
    Profile,
    ToolBlock,
    WeightsBlock,
)
from irlx.robot.limits import JointLimits
from irlx.streams import BlockRecord, JointStream
from irlx.verifier import verify_stream
from irlx.verifier.way import least_time

pytestmark = [pytest.mark.req("STR-06"), pytest.mark.req("MOT-07")]

START = np.array([0.1, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1])
TOOL = (np.array([0.05, -0.02, 0.1]), Rotation.from_rotvec([0.3, -0.2, 0.1]))


def tool_block(maker, tool=TOOL, recorded=None) -> None:
    shown = tool if recorded is None else recorded
    position, rotation = tuple(shown[0].tolist()), tuple(shown[1].as_quat().tolist())
    maker.record(ToolBlock, position=position, orientation=rotation)


def with_tools(stream: JointStream, tools: dict[int, tuple[np.ndarray, Rotation]]) -> JointStream:
    """Tool poses of a stream whose blocks with these ids set tools."""
    q = stream.q
    tip = np.column_stack([q[:, 0] + q[:, 1], q[:, 2], q[:, 3]])
    turns = Rotation.from_euler("ZYX", q[:, 4:7])
    found = np.empty((len(q), 7))
    own = np.zeros(3), Rotation.identity()
    for block in range(int(stream.block.max()) + 1):
        own = tools.get(block, own)
        here = stream.block == block
        if here.any():
            found[here] = np.column_stack(
                [tip[here] + turns[here].apply(own[0]), (turns[here] * own[1]).as_quat()]
            )
    return replace(stream, tool=found)


def turning(kit, maker, position, step, tool, ticks: int = 60) -> None:
    """A line of a tool, turned by a rotation vector in its own frame."""
    q = maker.rows[-1]
    p0, r0 = kit.pose_of(q)
    at, turned = p0 + r0.apply(tool[0]), r0 * tool[1]
    s = kit.smooth(ticks)
    tools = turned * Rotation.from_rotvec(np.multiply.outer(s, step))
    points = at + s[:, None] * (np.array(position) - at)
    tips = tools * tool[1].inv()
    places = points - tips.apply(tool[0])
    target = PoseTarget(tuple(float(x) for x in position), tuple(tools[-1].as_quat().tolist()))
    number = maker.record(MoveBlock, kind=MoveKind.LIN, target=target, law=kit.LAW)
    rails = np.full(ticks, q[0])
    maker.emit(number, np.column_stack([rails, places[:, 0] - q[0], places[:, 1:], tips.as_euler("ZYX")]))


def with_a_tool(kit, cyclic: bool = False) -> JointStream:
    """A line of the tip, one of a tool, and, after a way there and back, one of the tip again."""
    maker = kit.Maker(START.copy())
    maker.lin((0.6, 0.1, 0.4), (0.1, 0.2, 0.0))
    if cyclic:
        maker.record(CyclicBlock, active=True)
    tool_block(maker)
    number = len(maker.records)
    turning(kit, maker, (0.7, 0.2, 0.5), (0.2, -0.1, 0.3), TOOL)
    turning(kit, maker, (0.6, 0.1, 0.4), (-0.2, 0.3, 0.1), TOOL)
    none = np.zeros(3), Rotation.identity()
    tool_block(maker, none)
    maker.lin((0.5, 0.0, 0.4), (0.1, 0.0, 0.0))
    return with_tools(maker.stream(), {number: TOOL, number + 3: none})


def test_moves_of_a_tool_pass(gantry_kit, robot) -> None:
    stream = with_a_tool(gantry_kit)
    report = verify_stream(stream, robot)
    assert report.passed, str(report)
    assert report["goal position"].worst.value < 1e-11
    # Not a place of the tip: the tool was 0.1 m away from it.
    assert "not judged" not in str(
        verify_stream(with_a_tool(gantry_kit, cyclic=True), robot)["cyclic closure"]
    )


def test_a_tool_that_is_not_there_is_found(gantry_kit, robot) -> None:
    stream = with_a_tool(gantry_kit)
    # Moved as told and told of the tip.
    report = verify_stream(with_tools(stream, {}), robot)
    assert {check.name for check in report.failed} == {"tool position", "tool orientation"}
    assert report["tool position"].first.block == 3
    # Told of the tool and moved as if there were another.
    other = TOOL[0] + np.array([0.0, 0.0, 1e-5]), TOOL[1]
    records = [
        BlockRecord(r.tick, replace(r.block, position=tuple(other[0].tolist()))) if r.block.id == 2 else r
        for r in stream.records
    ]
    report = verify_stream(
        with_tools(
            replace(stream, records=tuple(records)), {2: other, 5: (np.zeros(3), Rotation.identity())}
        ),
        robot,
    )
    assert {"path position", "goal position"} <= {check.name for check in report.failed}
    assert "tool position" not in {check.name for check in report.failed}


def test_without_blocks_the_tool_of_a_motion_is_that_of_its_first_row(gantry_kit, robot) -> None:
    stream = replace(with_a_tool(gantry_kit), records=())
    report = verify_stream(stream, robot, may_lack_blocks=True)
    assert report.passed, str(report)
    assert "the tools of 2 motions" in report["tool position"].detail
    tool = stream.tool.copy()
    tool[80, 2] += 2e-9
    report = verify_stream(replace(stream, tool=tool), robot, may_lack_blocks=True)
    assert [check.name for check in report.failed] == ["tool position"]
    assert report["tool position"].first.tick == 80


@pytest.mark.parametrize(
    ("block", "changes", "words"),
    [
        (
            ToolBlock,
            {"position": (np.inf, 0.0, 0.0), "orientation": (0.0, 0.0, 0.0, 1.0)},
            "its tool lies at",
        ),
        (ToolBlock, {"position": (0.0, 0.0, 0.0), "orientation": (0.0, 0.0, 0.0, 0.0)}, "of length 0"),
        (WeightsBlock, {"weights": (1.0,) * 6}, "6 weights for 7 joints"),
        (WeightsBlock, {"weights": (1.0,) * 6 + (0.0,)}, "a weight is 0.0"),
        (WeightsBlock, {"weights": (1.0,) * 6 + (np.nan,)}, "a weight is nan"),
    ],
)
def test_tools_and_weights_that_cannot_be(block, changes, words: str, gantry_kit, robot) -> None:
    maker = gantry_kit.Maker(START.copy())
    maker.record(block, **changes)
    maker.lin((0.6, 0.1, 0.4))
    check = verify_stream(maker.stream(), robot)["blocks"]
    assert check.status == "failed"
    assert words in check.detail


def test_weights_change_nothing_else(gantry_kit, robot) -> None:
    maker = gantry_kit.Maker(START.copy())
    maker.record(WeightsBlock, weights=(2.0,) * 7)
    maker.lin((0.6, 0.1, 0.4))
    assert verify_stream(maker.stream(), robot).passed


# ---- Increments


def counted_on(stream: JointStream, block: int, target, **more) -> JointStream:
    """The stream with another target for a block."""
    records = [
        BlockRecord(r.tick, replace(r.block, target=target, **more)) if r.block.id == block else r
        for r in stream.records
    ]
    return replace(stream, records=tuple(records))


def one_line(kit) -> tuple[JointStream, np.ndarray, Rotation, np.ndarray, Rotation]:
    """A line behind another one, with the poses at which it starts and ends."""
    maker = kit.Maker(START.copy())
    maker.lin((0.6, 0.1, 0.4), (0.1, 0.2, 0.0))
    p0, r0 = kit.pose_of(maker.rows[-1])
    maker.lin((0.7, -0.1, 0.5), (0.2, 0.0, -0.3))
    return maker.stream(), p0, r0, *kit.pose_of(maker.rows[-1])


def test_increments_count_on_from_where_the_move_starts(gantry_kit, robot) -> None:
    stream, p0, r0, p1, r1 = one_line(gantry_kit)
    own = PoseIncrement(tuple(r0.inv().apply(p1 - p0)), tuple((r0.inv() * r1).as_quat()))
    assert verify_stream(counted_on(stream, 2, own), robot).passed
    off = replace(own, position=tuple(np.add(own.position, (0.0, 0.0, 2e-6))))
    assert "goal position" in {c.name for c in verify_stream(counted_on(stream, 2, off), robot).failed}
    maker = gantry_kit.Maker(START.copy())
    maker.lin((0.6, 0.1, 0.4), (0.1, 0.2, 0.0))
    maker.lin((0.7, -0.1, 0.5))
    stream = maker.stream()
    shift = PoseIncrement(tuple(p1 - p0), None)
    assert verify_stream(counted_on(stream, 2, shift), robot).passed
    in_tool = PoseIncrement(tuple(r0.inv().apply(p1 - p0)), None, "R_TOOL")
    assert verify_stream(counted_on(stream, 2, in_tool), robot).passed
    assert not verify_stream(counted_on(stream, 2, replace(in_tool, frame="R_BASE")), robot).passed
    unknown = verify_stream(counted_on(stream, 2, replace(shift, frame="TABLE")), robot)
    assert "1 moves not checked" in unknown["path position"].detail


def test_joint_increments(gantry_kit, robot) -> None:
    maker = gantry_kit.Maker(START.copy())
    way = np.array([0.1, 0.2, -0.1, 0.05, 0.2, -0.1, 0.3])
    maker.ptp(START + way)
    stream = maker.stream()
    good = verify_stream(counted_on(stream, 1, JointIncrement(tuple(way))), robot)
    assert good.passed
    assert good["joint goal"].status == "ok"
    off = way + np.eye(7)[3] * 2e-9
    report = verify_stream(counted_on(stream, 1, JointIncrement(tuple(off))), robot)
    assert [check.name for check in report.failed] == ["joint goal"]


def test_points_of_a_path_are_counted_from_the_one_before(gantry_kit, robot) -> None:
    """There and back twice as far, as one PATH that stops at its inner point."""
    maker = gantry_kit.Maker(START.copy())
    maker.lin((0.5, -0.1, 0.3))
    maker.lin((0.1, -0.1, 0.3))
    stream = maker.stream()
    first = stream.records[0].block
    p0 = gantry_kit.pose_of(START)[0]
    steps = np.array([0.5, -0.1, 0.3]) - p0, np.array([-0.4, 0.0, 0.0])
    points = [PoseIncrement(tuple(step.tolist()), None) for step in steps]
    path = replace(first, target=points[1], course=PathCourse((points[0],)))
    labels = np.where(stream.block == 2, 1, stream.block)
    joined = replace(stream, records=(BlockRecord(0, path),), block=labels)
    report = verify_stream(joined, robot)
    assert report.passed, str(report)
    both = replace(path, target=PoseIncrement(tuple((steps[0] + steps[1]).tolist()), None))
    assert not verify_stream(replace(joined, records=(BlockRecord(0, both),)), robot).passed


def test_both_points_of_a_circle_are_counted_from_its_start(gantry_kit, robot) -> None:
    maker = gantry_kit.Maker(START.copy())
    maker.circle((0.2, -0.1), 1.0, 2.5)
    stream = maker.stream()
    block = stream.records[0].block
    p0 = gantry_kit.pose_of(START)[0]
    via, end = (
        PoseIncrement(tuple(np.subtract(target.position, p0).tolist()), None)
        for target in (block.course.via, block.target)
    )
    report = verify_stream(counted_on(stream, 1, end, course=ArcCourse(via)), robot)
    assert report.passed, str(report)


# ---- Overrides, S curves


def test_an_override_slows_all_that_is_programmed(gantry_kit, robot) -> None:
    maker = gantry_kit.Maker(START.copy())
    maker.lin((0.6, 0.1, 0.4), ticks=50)
    stream = maker.stream()
    speed = np.max(np.linalg.norm(np.diff(stream.tool[:, :3], axis=0), axis=1)) / gantry_kit.DT
    slow = MotionLaw(speed=2.001 * speed, acc=300.0, speed_ori=30.0, acc_ori=500.0, override=0.5)

    def failed(law: MotionLaw) -> set[str]:
        return {
            c.name
            for c in verify_stream(
                counted_on(stream, 1, stream.records[0].block.target, law=law), robot
            ).failed
        }

    assert failed(slow) == set()
    assert failed(replace(slow, speed=1.999 * speed)) == {"programmed speed"}
    acc = np.max(np.linalg.norm(np.diff(stream.tool[:, :3], n=2, axis=0), axis=1)) / gantry_kit.DT**2
    assert failed(replace(slow, acc=4.001 * acc)) == set()
    assert failed(replace(slow, acc=3.999 * acc)) == {"programmed acceleration"}
    assert failed(replace(slow, duration=0.0999)) == set()
    assert failed(replace(slow, duration=0.1001)) == {"programmed time"}


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize(
    "case", [(1.0, 0.5, 1.0, 10.0), (0.02, 0.5, 1.0, 10.0), (0.0005, 0.5, 1.0, 10.0), (1.0, 0.05, 1.0, 5.0)]
)
def test_the_least_time_of_an_s_curve(case) -> None:
    """Against the way that its phases make, summed up in small steps."""
    length, speed, acc, jerk = case
    due = least_time(*case)

    # The largest way that may be run in so much time: by bisection of the peak speed.
    def way(peak: float) -> tuple[float, float]:
        reached = min(acc, np.sqrt(peak * jerk))
        ramp = reached / jerk + peak / reached
        return peak * ramp, ramp

    low, high = 0.0, speed
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if way(middle)[0] <= length else (low, middle)
    ran, ramp = way(low)
    assert due == pytest.approx(2.0 * ramp + max(length - ran, 0.0) / low, rel=1e-6)
    assert due >= length / speed


def test_an_s_curve_takes_its_time(gantry_kit, robot) -> None:
    maker = gantry_kit.Maker(START.copy())
    maker.lin((0.6, -0.1, 0.3), ticks=50)
    stream = maker.stream()
    law = replace(gantry_kit.LAW, profile=Profile.S_CURVE)
    target = stream.records[0].block.target
    for jerk, passes in ((1e5, True), (200.0, False)):
        report = verify_stream(counted_on(stream, 1, target, law=replace(law, jerk=jerk)), robot)
        assert report.passed is passes, str(report)
    assert [check.name for check in report.failed] == ["programmed jerk", "programmed time"]


# ---- Joint moves that pass their targets


def joined_ptps(kit, shares=(1.0, 1.0)) -> JointStream:
    """Two PTPs round a corner in joint space: the second begins where the first one slows down."""
    maker = kit.Maker(START.copy())
    one, other = np.array([0.3, 0.0, 0.2, 0.0, 0.3, 0.0, 0.0]), np.array([0.0, 0.3, 0.0, 0.1, 0.0, 0.2, 0.0])
    up = kit.smooth(60)[:, None]
    first, second = np.vstack([up, np.ones((30, 1))]), np.vstack([np.zeros((30, 1)), up])
    rows = START + first * one + second * other
    targets = START + one, START + one + other
    for k, (target, part) in enumerate(zip(targets, (rows[:45], rows[45:]), strict=True)):
        law = replace(kit.LAW, speed_ptp=shares[k], acc_ptp=1.0)
        block = {"kind": MoveKind.PTP, "target": JointTarget(tuple(target)), "law": law}
        number = maker.record(MoveBlock, **block, blend=None if k else Blend(share=0.8))
        maker.emit(number, part, holds=k)
    return maker.stream()


def test_joint_moves_pass_their_targets(gantry_kit, robot) -> None:
    stream = joined_ptps(gantry_kit)
    report = verify_stream(stream, robot)
    assert report.passed, str(report)
    assert report["joint goal"].worst.block == 2
    stopped = counted_on(stream, 1, stream.records[0].block.target, blend=None)
    failed = {check.name for check in verify_stream(stopped, robot).failed}
    assert {"stops", "joint goal", "PTP straight"} <= failed
    missed = counted_on(stream, 2, JointTarget(tuple(np.add(stream.records[1].block.target.values, 2e-9))))
    assert [check.name for check in verify_stream(missed, robot).failed] == ["joint goal"]


def test_joined_joint_moves_keep_their_shares(gantry_kit, robot) -> None:
    speeds = np.abs(np.diff(joined_ptps(gantry_kit).q, axis=0)) / gantry_kit.DT
    most = np.max(speeds)
    infinite = np.full(7, np.inf)
    limits = JointLimits(-infinite, infinite, np.full(7, -most), np.full(7, most), -infinite, infinite)
    for shares, block in (((1.0, 1.0), None), ((0.9, 1.0), 1), ((1.0, 0.6), 2)):
        stream = joined_ptps(gantry_kit, shares)
        stream = replace(stream, header=replace(stream.header, limits=limits))
        report = verify_stream(stream, robot)
        assert report.passed is (block is None), str(report)
        if block is not None:
            assert [check.name for check in report.failed] == ["programmed speed"]
            assert report["programmed speed"].first.block == block


def test_where_a_joint_move_hands_over_the_larger_share_holds(gantry_kit, robot) -> None:
    """The rail comes to rest in the second move: its first rows may be as fast as the first move."""
    stream = joined_ptps(gantry_kit)
    speeds = np.abs(np.diff(stream.q[:, 0])) / gantry_kit.DT
    behind = speeds[np.flatnonzero(stream.block == 2)[0] - 1 :]
    infinite = np.full(7, np.inf)
    fastest = np.array([np.max(speeds), *infinite[1:]])
    limits = JointLimits(-infinite, infinite, -fastest, fastest, -infinite, infinite)
    for share, passes in ((1.001 * behind[3], True), (0.999 * behind[3], False)):
        slow = joined_ptps(gantry_kit, (1.0, share / np.max(speeds)))
        report = verify_stream(replace(slow, header=replace(slow.header, limits=limits)), robot)
        assert report.passed is passes, str(report)
