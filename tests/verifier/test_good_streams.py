"""What irlx makes passes its own verifier: random programs of every kind, in memory and in every format.

A program that irlx refuses leaves a partial stream, which fails in being incomplete and in nothing else.
A failing case is repeated by its seed; the message holds its cell and its program.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

import irlx
from good_streams import MOTIONS, ROBOTS, TICKS, Case, drawn_case
from irlx.streams import KNOWN_ENDINGS
from irlx.verifier import CHECKS, Report
from machines import machine

pytestmark = [pytest.mark.req("STR-06"), pytest.mark.req("QA-05")]

QUICK = (2, 5, 6, 15, 16, 17, 18, 19)
"""Seeds of cases that take little time and together are of every kind."""
LONG = [*(seed for seed in range(24) if seed not in QUICK), *range(1000, 1200)]
NO_BLOCKS = {
    "blocks",
    "clearance",
    "frozen joints",
    "waits still",
    "waiting time",
    *CHECKS[CHECKS.index("PTP straight") :],
}
"""Checks that need block records, which a CSV has not."""


@dataclass(frozen=True)
class Outcome:
    """How the run of a case ended, and its two verifications."""

    case: Case
    run: irlx.Run
    ending: str
    in_memory: Report
    of_file: Report


def outcome_of(seed: int, folder: Path) -> Outcome:
    """Draw, run and verify; formats take turns."""
    case = drawn_case(seed)
    program = case.write(folder)
    try:
        run = irlx.run(program)
    except irlx.RunError as refused:
        run = refused.run
    ending = KNOWN_ENDINGS[(seed + seed // len(ROBOTS)) % len(KNOWN_ENDINGS)]
    file = folder / f"drawn{ending}"
    run.save(file)
    cell = folder / "drawn.toml"
    reports = (irlx.verify(subject, program=program, cell=cell) for subject in (run, file))
    return Outcome(case, run, ending, *reports)


def assert_good(found: Outcome) -> None:
    due = set() if found.run.complete else {"complete"}
    for report, unmade in (
        (found.in_memory, set()),
        (found.of_file, NO_BLOCKS if found.ending == ".csv" else set()),
    ):
        failed = {check.name: check.text for check in report.failed}
        assert set(failed) == due, f"{failed}\n{found.ending}, {found.case}"
        unchecked = {check.name for check in report.unchecked}
        # A return that a limit or a posture asked for led away is told and not judged.
        excused = {"cyclic closure"} if "not judged" in report["cyclic closure"].detail else set()
        assert unchecked <= unmade | excused, f"{report}\n{found.case}"
    assert found.of_file["file"].status == "ok", str(found.case)
    assert found.of_file["written rates"].status == ("no case" if found.ending == ".irdata" else "ok")


@pytest.fixture(scope="module")
def outcome(tmp_path_factory) -> Callable[[int], Outcome]:
    """Outcome of a seed, each found once."""
    known: dict[int, Outcome] = {}

    def found(seed: int) -> Outcome:
        if seed not in known:
            known[seed] = outcome_of(seed, tmp_path_factory.mktemp(f"seed{seed}"))
        return known[seed]

    return found


@pytest.mark.parametrize("seed", QUICK)
def test_a_good_stream_gives_no_alarm(outcome, seed: int) -> None:
    assert_good(outcome(seed))


def test_the_quick_cases_judge_everything(outcome) -> None:
    """Every kind of motion, robot, tick and format; every check was made; some motions were slowed down."""
    found = [outcome(seed) for seed in QUICK]
    assert {motion for one in found for motion in one.case.motions} == set(MOTIONS)
    assert {one.case.robot for one in found} == set(ROBOTS)
    assert {one.case.tick for one in found} == set(TICKS)
    assert {one.ending for one in found} == set(KNOWN_ENDINGS)
    complete = sum(one.run.complete for one in found)
    assert len(found) // 2 <= complete < len(found), complete
    assert sum(one.run.summary.planned for one in found) >= 3
    passed = {
        check.name
        for one in found
        for report in (one.in_memory, one.of_file)
        for check in report.checks
        if check.status == "ok"
    }
    # Conditions between joints and waits are tried in tests/cli, test_constraints.py and test_signals.py,
    # bands in tests/test_tolerance.py.
    assert passed == set(CHECKS) - {"constraints", "waits still", "waiting time", "tolerance bands"}


@pytest.mark.parametrize("way", [(0.00095, 0.0, 0.0), (0.0, 0.00095, 0.0), (0.0, 0.0, 0.00095)])
def test_a_tiny_move_under_cyclicstart_is_no_return(tmp_path: Path, way: tuple[float, ...]) -> None:
    """It ends less than 1e-6 m from where it began, and joints must move further than 1e-6 rad for it."""
    robot = machine("arm7")
    position, _ = robot.pose(robot.start)
    target = ", ".join(map(repr, (1e3 * position + way).tolist()))
    (tmp_path / "a.toml").write_text('[robot]\nmodel = "arm7"\n', encoding="utf-8")
    program = tmp_path / "a.irl"
    program.write_text(
        f"PROGRAM a;\nBEGIN\n  CYCLICSTART;\n  MOVE LIN POSITION({target});\nENDPROGRAM;\n", encoding="utf-8"
    )
    run = irlx.run(program)
    assert run.q[-1].tolist() != run.q[0].tolist()
    report = irlx.verify(run, program)
    assert report.passed, str(report)


@pytest.mark.slow
@pytest.mark.parametrize("seed", LONG)
def test_long_campaign(tmp_path: Path, seed: int) -> None:
    assert_good(outcome_of(seed, tmp_path))
