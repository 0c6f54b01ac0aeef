"""Good streams pass, and each kind of sabotage is caught under its name, tick and joint."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from irlx.streams import JointStream, read_stream, write_stream
from irlx.verifier import CHECKS, Report, verify_stream

Change = Callable[[JointStream], JointStream]


UNASKED = {"program", "robot limits"}
"""Checks that need a program and a cell."""


def with_q(stream: JointStream, row: int, joint: int, value: Callable[[float], float]) -> JointStream:
    q = stream.q.copy()
    q[row, joint] = value(q[row, joint])
    return replace(stream, q=q)


def rows_of(stream: JointStream, block: int) -> np.ndarray:
    return np.flatnonzero(stream.block == block)


def take(stream: JointStream, rows: np.ndarray, ticks: np.ndarray | None = None) -> JointStream:
    arrays = {name: getattr(stream, name)[rows] for name in ("q", "block", "tool")}
    return replace(stream, ticks=stream.ticks[rows] if ticks is None else ticks, **arrays)


def test_good_stream_passes(good: JointStream, robot) -> None:
    report = verify_stream(good, robot)
    assert report.passed, str(report)
    assert {check.name for check in report.unchecked} == UNASKED
    unused = {"constraints", "clearance", "waits still", "waiting time", "tolerance bands", "programmed jerk"}
    absent = (
        {"file", "written rates"} | unused | {name for name in CHECKS if name.startswith("reconfiguration")}
    )
    assert {check.name for check in report.without_case} == absent
    assert tuple(check.name for check in report.checks) == CHECKS


@pytest.mark.parametrize("ending", [".irdata", ".npz", ".jsonl", ".csv"])
def test_written_streams_pass(ending: str, good: JointStream, robot, tmp_path: Path) -> None:
    write_stream(good, tmp_path / f"a{ending}")
    stream = read_stream(tmp_path / f"a{ending}")
    report = verify_stream(stream, robot, may_lack_blocks=ending == ".csv")
    assert report.passed
    assert ("path position" in {check.name for check in report.unchecked}) == (ending == ".csv")


def test_without_a_robot_geometry_is_not_checked(good: JointStream) -> None:
    report = verify_stream(good, None)
    assert report.passed
    tool = CHECKS[CHECKS.index("tool position") :]
    assert {check.name for check in report.unchecked} == {
        "robot",
        "constraints",
        "clearance",
        *UNASKED,
        *tool,
    }


def off(amount: float, joint: int, block: int, place: int) -> Change:
    return lambda s: with_q(s, rows_of(s, block)[place], joint, lambda v: v + amount)


def corner_cut(s: JointStream) -> JointStream:
    """Straight across the corner between the first and the second line."""
    row = rows_of(s, 3)[-1]
    q = s.q.copy()
    q[row - 9 : row + 10] = np.linspace(q[row - 9], q[row + 9], 19)
    return replace(s, q=q)


def goal_missed(s: JointStream) -> JointStream:
    """The whole move and its hold row end short of the goal, along the path."""
    rows = rows_of(s, 6)
    q = s.q.copy()
    start = q[rows[0] - 1]
    q[rows] = start + (q[rows] - start) * (1 - 4e-6)
    return replace(s, q=q)


def ulp(value: float) -> float:
    return float(np.nextafter(value, np.inf))


def with_both(s: JointStream, block: int, joint: int, amount: float) -> JointStream:
    """Last moving row and its hold row moved by the same amount."""
    q = s.q.copy()
    q[rows_of(s, block)[-2:], joint] += amount
    return replace(s, q=q)


def take_back(s: JointStream) -> JointStream:
    rows = rows_of(s, 1)
    q = s.q.copy()
    q[rows[[20, 21]]] = q[rows[[21, 20]]]
    return replace(s, q=q)


def tool_off(s: JointStream, column: int, amount: float) -> JointStream:
    tool = s.tool.copy()
    tool[50, column] += amount
    return replace(s, tool=tool)


def drifted(s: JointStream) -> JointStream:
    """The last line ends at the same pose in another posture."""
    rows = rows_of(s, s.records[-2].block.id)
    q = s.q.copy()
    drift = np.linspace(0, 2e-6, len(rows) - 1)
    drift = np.append(drift, drift[-1])
    q[rows, 0] += drift
    q[rows, 1] -= drift
    return replace(s, q=q)


SABOTAGE: list[tuple[str, Change, str, dict[str, object]]] = [
    ("2e-6 off the path", off(2e-6, 3, 3, 20), "path position", {"line": 6}),
    ("turned 2e-6 off the path", off(2e-6, 4, 3, 20), "path orientation", {"line": 6}),
    ("turned about another axis", off(3e-6, 6, 7, 20), "path orientation", {"line": 10}),
    ("slipped in a pure turn", off(2e-6, 2, 7, 20), "path position", {"line": 10}),
    ("ran backwards", off(-0.02, 2, 6, 40), "path progress", {"line": 9}),
    ("PTP bent", off(2e-9, 2, 1, 20), "PTP straight", {"line": 4, "joint": "y"}),
    ("PTP went back", take_back, "PTP progress", {"line": 4}),
    ("goal missed", goal_missed, "goal position", {"line": 9}),
    ("joint goal missed", lambda s: with_both(s, 1, 4, 3e-9), "joint goal", {"joint": "a"}),
    ("goal turned", lambda s: with_both(s, 6, 6, 2e-6), "goal orientation", {"line": 9}),
    ("frozen one ulp", lambda s: with_q(s, rows_of(s, 6)[7], 0, ulp), "frozen joints", {"joint": "rail"}),
    ("frozen -0.0", lambda s: with_q(s, rows_of(s, 6)[7], 0, lambda v: -v), "frozen joints", {}),
    ("corner cut", corner_cut, "path position", {"line": 6}),
    ("tool recorded wrong", lambda s: tool_off(s, 0, 2e-9), "tool position", {"tick": 50}),
    ("tool turned", lambda s: tool_off(s, 3, 2e-9), "tool orientation", {"tick": 50}),
    ("not unit", lambda s: tool_off(s, 6, 1e-8), "tool orientation", {"tick": 50}),
    ("no end", lambda s: replace(s, complete=False), "complete", {}),
    ("closure", drifted, "cyclic closure", {"line": 15, "joint": "rail"}),
]


def assert_caught(report: Report, name: str, place: dict[str, object]) -> None:
    assert not report.passed
    check = report[name]
    assert check.status == "failed", str(report)
    for key, value in place.items():
        assert check.first is not None
        assert getattr(check.first, key) == value, check


@pytest.mark.req("STR-06")
@pytest.mark.parametrize(
    ("change", "name", "place"), [case[1:] for case in SABOTAGE], ids=[c[0] for c in SABOTAGE]
)
def test_sabotage(change: Change, name: str, place: dict[str, object], good: JointStream, robot) -> None:
    report = verify_stream(change(good), robot)
    assert_caught(report, name, place)
    assert name in str(report)
    assert report.diagnostics("a.irdata")[0].code == "IRL709"
    json.dumps(report.to_plain(), allow_nan=False)


@pytest.mark.req("STR-06")
def test_broken_ticks(good: JointStream, robot) -> None:
    rows = np.arange(len(good.ticks))
    changes = {
        "dropped": (np.delete(rows, 60), 61),
        "doubled": (np.insert(rows, 60, 60), 60),
        "swapped": (np.concatenate([rows[:60], [61, 60], rows[62:]]), 61),
        "late": (rows[1:], 1),
    }
    for kept, tick in changes.values():
        assert_caught(verify_stream(take(good, kept), robot), "ticks", {"tick": tick})
    assert_caught(verify_stream(take(good, rows[:0]), robot), "ticks", {})


@pytest.mark.req("STR-06")
def test_a_row_dropped_and_the_ticks_renumbered(good: JointStream, robot) -> None:
    kept = np.delete(np.arange(len(good.ticks)), 60)
    report = verify_stream(take(good, kept, np.arange(len(kept))), robot)
    assert_caught(report, "blocks", {})
    assert "was recorded at tick 92, but the robot came to rest at 91" in report["blocks"].detail


@pytest.mark.req("STR-06")
def test_hold_row_removed(good: JointStream, robot) -> None:
    stream = take(good, np.arange(len(good.ticks) - 1))
    assert_caught(verify_stream(stream, robot), "stops", {"line": 15})


@pytest.mark.req("STR-06")
def test_not_a_number(good: JointStream, robot) -> None:
    report = verify_stream(with_q(good, 30, 2, lambda _: float("nan")), robot)
    assert_caught(report, "finite values", {"tick": 30, "joint": "y"})
    json.dumps(report.to_plain(), allow_nan=False)


@pytest.mark.req("STR-06")
def test_another_robot(good: JointStream, gantry_kit) -> None:
    report = verify_stream(good, gantry_kit.gantry(offset=1e-9))
    assert_caught(report, "robot", {})
    assert report["tool position"].status == "not checked"


def limited(kit, kind, bound: np.ndarray, clause: bool, own: bool = False) -> JointStream:
    """One line in y of 0.5 m in 50 ticks under a limit given as clause, switch, or the robot's own."""
    changes = {}
    if own:
        name = kind.value.lower()
        changes["limits"] = kit.limits().with_pair(name, -bound, bound)
    maker = kit.Maker(np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1]), changes)
    if not own and not clause:
        maker.switch(kind, bound)
    data = {"limits": (kit.LimitClause(kind, kit.both(bound), kit.Origin("a", 0, 1, 1)),)} if clause else {}
    maker.lin((0.5, 0.75, 0.4), **data)
    return maker.stream()


@pytest.mark.req("MOT-20")
@pytest.mark.parametrize("given", ["clause", "switch", "own"])
def test_limits_hold_to_the_last_digit(given: str, gantry_kit, robot) -> None:
    free = limited(gantry_kit, gantry_kit.LimitKind.SPEED, np.full(7, 100.0), clause=False)
    peaks = {
        "position": float(free.q[:, 2].max()),
        "speed": float(np.abs(free.qd[:, 2]).max()),
        "acceleration": float(np.abs(free.qdd[:, 2]).max()),
    }
    for name, peak in peaks.items():
        kind = gantry_kit.LimitKind[name.upper()]
        for factor, fine in ((1.0, True), (1 - 1e-8, False), (1 / 1.01, False)):
            bound = np.where(np.arange(7) == 2, peak * factor, 1000.0)
            stream = limited(gantry_kit, kind, bound, given == "clause", given == "own")
            report = verify_stream(stream, robot)
            check = report[f"{name} limits"]
            assert check.worst is not None
            assert (check.status == "ok") is fine, (name, factor)
            if not fine:
                assert check.first is not None
                assert check.first.joint == "y"
                assert check.first.allowed in {peak * factor, -peak * factor}
                assert abs(check.worst.value) == pytest.approx(peak, rel=1e-12)


def test_program_limits_never_widen_the_robots(gantry_kit, robot) -> None:
    own = gantry_kit.limits().with_pair("speed", np.full(7, -1.0), np.full(7, 1.0))
    maker = gantry_kit.Maker(np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1]), {"limits": own})
    maker.switch(gantry_kit.LimitKind.SPEED, np.full(7, 50.0))
    maker.lin((0.5, 0.75, 0.4))
    assert_caught(verify_stream(maker.stream(), robot), "speed limits", {"joint": "y"})


def test_a_clause_replaces_a_switch_and_an_end_ends_it(gantry_kit, robot) -> None:
    kind = gantry_kit.LimitKind.SPEED
    clause = gantry_kit.LimitClause(kind, gantry_kit.both(np.full(7, 50.0)), gantry_kit.Origin("a", 0, 1, 1))
    maker = gantry_kit.Maker(np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1]))
    maker.switch(kind, np.full(7, 0.001))
    maker.lin((0.5, 0.75, 0.4), limits=(clause,))
    maker.switch(kind, None)
    maker.lin((0.5, 0.25, 0.4))
    assert verify_stream(maker.stream(), robot).passed
    maker.switch(kind, np.full(7, 0.001))
    row = maker.tick
    maker.lin((0.5, 0.75, 0.4))
    assert_caught(verify_stream(maker.stream(), robot), "speed limits", {})
    first = verify_stream(maker.stream(), robot)["speed limits"].first
    assert first is not None
    assert first.tick > row


def test_start_outside(good: JointStream, robot) -> None:
    report = verify_stream(with_q(good, 0, 3, lambda _: 2.0 + 1e-8), robot)
    assert_caught(report, "start", {"tick": 0, "joint": "z"})


def test_an_active_limit_excuses_from_closing(gantry_kit, robot) -> None:
    def run(bound: float) -> Report:
        maker = gantry_kit.Maker(np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1]))
        maker.record(gantry_kit.CyclicBlock, active=True)
        maker.lin((0.7, 0.25, 0.4), rail=0.1)
        bounds = gantry_kit.JointRange((bound, *[-9.0] * 6), (9.0,) * 7)
        maker.record(gantry_kit.LimitSwitchBlock, kind=gantry_kit.LimitKind.POSITION, range=bounds)
        maker.lin((0.5, 0.25, 0.4), rail=-0.05)
        return verify_stream(maker.stream(), robot)

    closure = run(0.05)["cyclic closure"]
    assert closure.status == "not checked"
    assert closure.worst is not None
    assert closure.worst.value == pytest.approx(0.05)
    assert "1 of 1 returns not judged" in closure.detail
    assert_caught(run(0.0), "cyclic closure", {})


def test_a_limit_met_after_a_return_does_not_excuse_it(gantry_kit, robot) -> None:
    maker = gantry_kit.Maker(np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1]))
    maker.record(gantry_kit.CyclicBlock, active=True)
    maker.lin((0.7, 0.25, 0.4), rail=0.1)
    maker.lin((0.5, 0.25, 0.4), rail=-0.05)
    row = maker.tick
    maker.lin((0.5, 2.0, 0.4))
    assert_caught(verify_stream(maker.stream(), robot), "cyclic closure", {"tick": row, "joint": "rail"})


def test_incomplete_streams_fail_only_in_being_incomplete(good: JointStream, robot) -> None:
    cut = take(good, np.arange(70))
    records = tuple(record for record in good.records if record.tick < 69)
    report = verify_stream(replace(cut, records=records, complete=False), robot)
    assert {check.name for check in report.failed} == {"complete"}


def renumbered(records):
    """The same blocks with ids from 2 on, as if nothing had stood between."""
    return tuple(replace(r, block=replace(r.block, id=number)) for number, r in enumerate(records, start=2))


REST = ", but the robot came to rest at"


def test_misfitting_blocks(good: JointStream, robot) -> None:
    first = good.records[0]
    for records, words in [
        (good.records[1:], "block 2 stands where 1 is due"),
        (
            (replace(first, tick=-1), *good.records[1:]),
            "block 1 was recorded at tick -1, but the robot came to rest at 0",
        ),
        ((first, first, *good.records[1:]), "block 1 stands where 2 is due"),
        ((first, *renumbered(good.records[2:])), "block 3 was recorded at tick 92"),
        (
            (first, replace(good.records[1], tick=20), *good.records[2:]),
            f"block 2 was recorded at tick 20{REST} 41",
        ),
    ]:
        report = verify_stream(replace(good, records=records), robot)
        assert_caught(report, "blocks", {})
        assert words in report["blocks"].detail


def test_targets_in_unknown_frames_are_not_judged(gantry_kit, robot) -> None:
    maker = gantry_kit.Maker(np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1]))
    maker.lin((0.5, 0.75, 0.4))
    stream = maker.stream()
    block = stream.records[0].block
    moved = replace(block, target=replace(block.target, frame="fixture"))
    report = verify_stream(replace(stream, records=(replace(stream.records[0], block=moved),)), robot)
    assert report.passed
    assert report["path position"].status == "not checked"
    assert "R_BASE" in report["path position"].detail
