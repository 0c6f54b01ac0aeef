"""Chains of moves with one thing wrong: each is found under its name, at its line."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import ArcCourse, Blend, FreezeBlock, JointTarget, MoveKind, PathCourse, PoseTarget
from irlx.streams import BlockRecord, JointStream
from irlx.verifier import Report, verify_stream
from made_chains import (
    CORNER,
    DT,
    LAW,
    lin,
    lines,
    path,
    polyline,
    pose_at,
    run,
    smooth_path,
    start_of,
    stopping_polyline,
    straight_on,
    three_lines,
    with_an_arc,
)
from passing_moves import trapezoid, way_of
from small_circles import (
    ROUND,
    round_before_a_line,
    round_before_a_ptp,
    round_in_two_ticks,
    stands_where_it_begins,
)

pytestmark = [pytest.mark.req("MOT-06"), pytest.mark.req("STR-06")]


def with_q(stream: JointStream, q: np.ndarray) -> JointStream:
    """The stream with other joint values, its tool poses in keeping."""
    turns = Rotation.from_euler("ZYX", q[:, 4:7]).as_quat()
    return replace(stream, q=q, tool=np.column_stack([q[:, 0] + q[:, 1], q[:, 2], q[:, 3], turns]))


def with_block(stream: JointStream, block: int, **changes: object) -> JointStream:
    records = [
        BlockRecord(r.tick, replace(r.block, **changes)) if r.block.id == block else r for r in stream.records
    ]
    return replace(stream, records=tuple(records))


def off(stream: JointStream, row: int, joint: int, amount: float) -> JointStream:
    q = stream.q.copy()
    q[row, joint] += amount
    return with_q(stream, q)


def last_of(stream: JointStream, block: int) -> int:
    return int(np.flatnonzero(stream.block == block)[-1])


def relabelled(stream: JointStream, block: int, ticks: int) -> JointStream:
    """The next block takes over so many ticks later, its record as well."""
    labels, last = stream.block.copy(), last_of(stream, block)
    begin, end = sorted((last, last + ticks))
    labels[begin + 1 : end + 1] = block if ticks > 0 else block + 1
    records = [BlockRecord(r.tick + ticks * (r.block.id == block + 1), r.block) for r in stream.records]
    return replace(stream, block=labels, records=tuple(records))


def backwards(stream: JointStream) -> JointStream:
    q = stream.q.copy()
    q[[400, 401]] = q[[401, 400]]
    return with_q(stream, q)


def fast_round(kit) -> JointStream:
    """No faster than SPEED and ACC along the path, too fast for ACC across it."""
    slow = replace(LAW, acc=0.5)
    maker = kit.Maker(np.array([0.0, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]))
    curves = lines(start_of(kit), [(0.3, 0, 0), (0, 0.3, 0)], [(0, 0, 0), (0, 0, 0)])
    way = way_of(curves, [0.02])
    blocks = [lin(curves[0], Blend(distance=0.02), law=slow), lin(curves[1], law=slow)]
    run(maker, way, blocks, trapezoid(way.length, 0.2, 0.4, DT))
    return maker.stream()


def tight_corner(kit, speed: float, distance: float = 1e-4) -> JointStream:
    """Lines of 2 mm and a blend on which hardly any row lies."""
    maker = kit.Maker(np.array([0.0, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]))
    curves = lines(start_of(kit), [(0.002, 0, 0), (0, 0.002, 0)], [(0, 0, 0), (0, 0, 0)])
    way = way_of(curves, [distance])
    blocks = [lin(curves[0], Blend(distance=distance)), lin(curves[1])]
    run(maker, way, blocks, trapezoid(way.length, speed, 1.5, DT))
    return maker.stream()


def sharp_corner_passed(kit) -> JointStream:
    """Through the very points of a PATH, without a stop."""
    maker = kit.Maker(np.array([0.0, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]))
    curves = lines(start_of(kit), [(0.3, 0, 0), (0, 0.3, 0)], [(0, 0, 0), (0, 0, 0)])
    way = way_of(curves, [0.0])
    s = trapezoid(way.length, 0.2, 0.4, DT)
    run(maker, way, [path(MoveKind.LIN, [pose_at(curve, curve.length) for curve in curves])], s)
    return maker.stream()


def with_something_between(stream: JointStream) -> JointStream:
    """A block between two moves that asks for a stop."""
    first, *rest = stream.records
    origin = first.block.origin
    freeze = BlockRecord(rest[0].tick, FreezeBlock(id=2, origin=origin, joints=()))
    moved = [BlockRecord(r.tick, replace(r.block, id=r.block.id + 1)) for r in rest]
    labels = np.where(stream.block > 1, stream.block + 1, stream.block)
    return replace(stream, records=(first, freeze, *moved), block=labels)


def cut_short(stream: JointStream, rows: int = 30) -> JointStream:
    """The last rows stay where the tool was."""
    q = stream.q.copy()
    q[-rows:] = q[-rows]
    return with_q(stream, q)


DAMAGES = {
    "once more round than the rows": (
        lambda kit: round_in_two_ticks(kit, 6.0 * np.pi).stream(),
        "path progress",
        5,
    ),
    "a circle that is not run": (lambda kit: stands_where_it_begins(kit).stream(), "path progress", 5),
    "once more round before a PTP": (
        lambda kit: round_before_a_ptp(kit, 3.0 * ROUND).stream(),
        "path progress",
        5,
    ),
    "once more round before a line": (
        lambda kit: round_before_a_line(kit, 3.0 * ROUND).stream(),
        "programmed speed",
        5,
    ),
    "5e-6 m off a blend": (
        lambda kit: off(corner(kit), last_of(corner(kit), 1), 3, 5e-6),
        "path position",
        4,
    ),
    "3e-6 rad off in a blend": (
        lambda kit: off(corner(kit), last_of(corner(kit), 1), 4, 3e-6),
        "path orientation",
        4,
    ),
    "another distance": (lambda kit: three_lines(kit, (0.05, 0.049)).stream(), "path position", 5),
    "C_CP farther than half of a line": (
        lambda kit: three_lines(kit, (0.115, 0.05), (Blend(distance=0.115), CORNER)).stream(),
        "path position",
        4,
    ),
    "another tangent": (lambda kit: three_lines(kit, tangent=1.2).stream(), "path position", 4),
    "C_PASS farther than half of a line": (
        lambda kit: three_lines(kit, (0.118, 0.02), (Blend(), Blend())).stream(),
        "path position",
        4,
    ),
    "C_PASS by another tangent": (
        lambda kit: three_lines(kit, (0.03, 0.02), (Blend(), Blend()), tangent=1.2).stream(),
        "path position",
        4,
    ),
    "too fast in the second move": (
        lambda kit: with_block(corner(kit), 2, law=replace(LAW, speed=0.08)),
        "programmed speed",
        5,
    ),
    "too fast in the first move": (
        lambda kit: with_block(corner(kit), 1, law=replace(LAW, speed=0.08)),
        "programmed speed",
        4,
    ),
    "turning too fast": (
        lambda kit: with_block(corner(kit), 3, law=replace(LAW, speed_ori=0.05)),
        "programmed speed",
        6,
    ),
    "slowed by an override that rows ignore": (
        lambda kit: with_block(corner(kit), 2, law=replace(LAW, speed=0.15, override=0.5)),
        "programmed speed",
        5,
    ),
    "accelerating too much": (
        lambda kit: with_block(corner(kit), 1, law=replace(LAW, acc=0.39)),
        "programmed acceleration",
        4,
    ),
    "accelerating too much for an override": (
        lambda kit: with_block(corner(kit), 1, law=replace(LAW, override=0.44)),
        "programmed acceleration",
        4,
    ),
    "too fast round the corner": (fast_round, "programmed speed", 4),
    "too fast round a corner between two rows": (lambda kit: tight_corner(kit, 0.05), "programmed speed", 5),
    "corner cut and no blend asked for": (lambda kit: with_block(corner(kit), 1, blend=None), "stops", 4),
    "corner cut behind what stops": (lambda kit: with_something_between(corner(kit)), "stops", 4),
    "a blend into a PTP": (
        lambda kit: with_block(corner(kit), 2, kind=MoveKind.PTP, target=JointTarget((0.0,) * 7)),
        "PTP straight",
        5,
    ),
    "a blend into a PTP with TIME": (
        lambda kit: with_block(
            corner(kit),
            2,
            kind=MoveKind.PTP,
            target=JointTarget((0.0,) * 7),
            law=replace(LAW, duration=1.0),
        ),
        "stops",
        4,
    ),
    "backwards": (lambda kit: backwards(corner(kit)), "path progress", 4),
    "handed over late": (lambda kit: relabelled(corner(kit), 1, 4), "path progress", 4),
    "handed over early": (lambda kit: relabelled(corner(kit), 1, -4), "path progress", 5),
    "not to the end": (lambda kit: cut_short(corner(kit)), "goal position", 6),
    "less than the TIME asked for": (
        lambda kit: with_block(corner(kit), 2, law=replace(LAW, duration=3.0)),
        "programmed time",
        5,
    ),
    "another point on a PATH": (
        lambda kit: inner_moved(polyline(kit).stream(), 1, (0.0, 1e-4, 0.0)),
        "path position",
        4,
    ),
    "points of a PATH passed without a stop": (sharp_corner_passed, "programmed acceleration", 4),
    "a stop that is not at the point": (
        lambda kit: inner_moved(stopping_polyline(kit).stream(), 0, (5e-6, 0.0, 0.0)),
        "path position",
        4,
    ),
    "a spline that is a polyline": (
        lambda kit: with_block(smooth(kit), 2, kind=MoveKind.LIN),
        "path position",
        5,
    ),
    "5e-6 m off a spline": (lambda kit: off(smooth(kit), 700, 2, 5e-6), "path position", 5),
    "3e-6 rad off on a spline": (
        lambda kit: off(smooth(kit), 700, 5, 3e-6),
        "path orientation",
        5,
    ),
    "another point of a spline": (
        lambda kit: inner_moved(smooth(kit), 1, (0.0, 0.0, 1e-4), 2),
        "path position",
        5,
    ),
    "another angle of an arc": (
        lambda kit: with_arc_angle(with_an_arc(kit).stream(), 2.01),
        "path position",
        5,
    ),
    "turned otherwise straight on": (
        lambda kit: off(straight_on(kit).stream(), 500, 5, 3e-6),
        "path orientation",
        4,
    ),
}


@cache
def corner(kit) -> JointStream:
    """Damages are made in copies: this stream and the next one are made once."""
    return three_lines(kit).stream()


@cache
def smooth(kit) -> JointStream:
    return smooth_path(kit).stream()


def inner_moved(stream: JointStream, point: int, by, block: int = 1) -> JointStream:
    course = next(r.block for r in stream.records if r.block.id == block).course
    points = list(course.points)
    points[point] = replace(points[point], position=tuple(np.add(points[point].position, by).tolist()))
    return with_block(stream, block, course=PathCourse(tuple(points)))


def with_arc_angle(stream: JointStream, angle: float) -> JointStream:
    course = next(r.block for r in stream.records if r.block.id == 2).course
    assert isinstance(course, ArcCourse)
    return with_block(stream, 2, course=replace(course, angle=angle))


@pytest.mark.parametrize("name", DAMAGES)
def test_what_is_off_is_found(name: str, gantry_kit, robot) -> None:
    make, check, line = DAMAGES[name]
    report: Report = verify_stream(make(gantry_kit), robot)
    assert report[check].status == "failed", str(report)
    assert report[check].first.line == line, report[check].text


def test_a_corner_between_two_rows_may_be_run_as_fast_as_it_bends(gantry_kit, robot) -> None:
    """The blend is 7 um long and allows 2.6 mm/s, 10 um a tick: a row before it, one behind."""
    report = verify_stream(tight_corner(gantry_kit, 0.0025, 4e-6), robot)
    assert report.passed, str(report)


def test_a_tick_earlier_or_later_may_hand_over(gantry_kit, robot) -> None:
    for ticks in (-1, 1):
        report = verify_stream(relabelled(corner(gantry_kit), 1, ticks), robot)
        assert report.passed, str(report)


def test_a_stream_that_breaks_off_is_judged_as_far_as_it_goes(gantry_kit, robot) -> None:
    """Where a move passes its target nobody knows whither, the stream ending before the next one."""
    stream = corner(gantry_kit)
    for rows, records in ((last_of(stream, 1) + 1, 1), (last_of(stream, 1) + 40, 2), (100, 1)):
        cut = replace(
            stream,
            records=stream.records[:records],
            ticks=stream.ticks[:rows],
            q=stream.q[:rows],
            block=stream.block[:rows],
            tool=stream.tool[:rows],
            complete=False,
        )
        report = verify_stream(cut, robot)
        assert [check.name for check in report.failed] == ["complete"], str(report)
        # In the first move, and, where the next one is known, on the blend behind it.
        for row in (min(rows, 60) - 1, *[last_of(stream, 1) + 20] * (records - 1)):
            worse = off(cut, row, 3, 5e-6)
            assert "path position" in {check.name for check in verify_stream(worse, robot).failed}, row


@pytest.mark.parametrize("portion", [*(pytest.param(size, marks=pytest.mark.slow) for size in (1, 7)), 16])
def test_portions_do_not_matter(portion: int, gantry_kit, robot, monkeypatch) -> None:
    from irlx.verifier import rows

    streams = [polyline(gantry_kit, Blend(), (0.03, 0.02, 0.01)).stream(), with_an_arc(gantry_kit).stream()]
    whole = [verify_stream(stream, robot).to_plain() for stream in streams]
    monkeypatch.setattr(rows, "PORTION", portion)
    for stream, due in zip(streams, whole, strict=True):
        found = verify_stream(stream, robot)
        assert found.passed
        for check, other in zip(found.to_plain()["checks"], due["checks"], strict=True):
            assert check["status"] == other["status"]
            if check["worst"] is not None and other["worst"]["value"] != 0.0:
                assert check["worst"]["value"] == pytest.approx(other["worst"]["value"], rel=1e-6, abs=2e-9)


WRONG_BLOCKS = [
    ({"kind": MoveKind.SPLINE}, "a SPLINE needs points"),
    ({"course": PathCourse(())}, "no points before the target"),
    (
        {"kind": MoveKind.PTP, "course": PathCourse((PoseTarget((0, 0, 0), None),))},
        "does not run along a PATH",
    ),
    ({"blend": Blend(distance=-0.01)}, "cannot pass its target at -0.01 m"),
    ({"blend": Blend(distance=np.inf)}, "cannot pass its target at inf m"),
    ({"blend": Blend(share=1.5)}, "with a share of 1.5"),
    ({"law": replace(LAW, override=0.0)}, "its override is 0.0"),
    ({"law": replace(LAW, override=1.5)}, "its override is 1.5"),
    ({"law": replace(LAW, jerk=0.0)}, "its jerk is 0.0"),
    ({"course": PathCourse((PoseTarget((0, 0, 0), (0, 0, 0, 2)),))}, "length 2"),
    ({"course": PathCourse((JointTarget((0.0,)),))}, "1 values for 7 joints"),
    (
        {"course": PathCourse((PoseTarget((0, 0, 0), None),), (JointTarget((0.0,) * 7),) * 2)},
        "2 postures for the 1 points",
    ),
    (
        {"course": PathCourse((PoseTarget((0, 0, 0), None),), (JointTarget((0.0,)),))},
        "its posture has 1 values for 7 joints",
    ),
]


@pytest.mark.parametrize(("changes", "words"), WRONG_BLOCKS, ids=[words for _, words in WRONG_BLOCKS])
def test_blocks_that_cannot_be(changes: dict, words: str, gantry_kit, robot) -> None:
    check = verify_stream(with_block(corner(gantry_kit), 1, **changes), robot)["blocks"]
    assert check.status == "failed"
    assert words in check.detail
