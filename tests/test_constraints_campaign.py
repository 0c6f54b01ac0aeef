"""Random programs of every kind in cells with random conditions between joints.

The programs are those of `good_streams`: all statements, switches, clauses and criteria. Each runs to its end
or is refused with a coded message; what was executed until then keeps every condition and verifies.
A failing case is repeated by its seed, and its texts are in the message.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import irlx
from good_streams import Case, drawn_case
from irlx.cell.load import load_cell
from irlx.promises import CONDITION
from long_run import first
from machines import machine

pytestmark = [pytest.mark.req("TRF-12"), pytest.mark.req("QA-05")]

QUICK, LONG, PORTION = (*range(1, 5), 0), range(2000, 2180), 20
MOST = {"koch11": 3, "arm7": 1, "rail6": 1, "panda": 1}
"""Conditions that leave a robot the joints it needs for its tool."""


def with_conditions(case: Case) -> Case:
    """The case with conditions of 1 to 3 joints, their factors of either sign, sometimes whole numbers."""
    rng = np.random.default_rng([5, case.seed])
    names = machine(case.robot).robot.joint_names
    sections = []
    for number in range(int(rng.integers(1, MOST[case.robot] + 1))):
        joints = rng.choice(len(names), int(rng.integers(1, 4)), replace=False)
        factors = [float(f) for f in rng.choice([1.0, -1.0, 2.0, rng.normal()], joints.size)]
        table = ", ".join(f"{names[j]} = {f!r}" for j, f in zip(joints, factors, strict=True))
        sections.append(f'[[constraint]]\nname = "condition {number + 1}"\njoints = {{ {table} }}\n')
    return replace(case, cell=case.cell + "".join(sections))


def broken(run: irlx.Run, cell_file: Path) -> float:
    """How far the rows are from the conditions, by sums of this file."""
    cell = load_cell(cell_file)
    names = cell.robot.joint_names
    most = 0.0
    for relation in cell.relations:
        row = np.zeros(len(names))
        for name, factor in relation.factors:
            row[names.index(name)] += factor
        most = max(most, float(np.max(np.abs(run.q @ row - relation.value))))
    return most


def judged(seed: int, folder: Path) -> tuple[str, int]:
    """How a case ended, and its rows."""
    case = with_conditions(drawn_case(seed))
    program = case.write(folder)
    try:
        run, end = irlx.run(program), "complete"
    except irlx.RunError as refused:
        run, end = refused.run, refused.reason.code
    assert end != "IRL090", str(case)
    assert broken(run, folder / "drawn.toml") <= CONDITION, str(case)
    report = irlx.verify(run, program=program, cell=folder / "drawn.toml")
    failed = {check.name for check in report.failed} - ({"complete"} if end != "complete" else set())
    assert not failed, f"{failed}\n{report}\n{case}"
    assert report["constraints"].status == "ok", str(case)
    return end, len(run.q)


@pytest.mark.parametrize("seed", first(4, QUICK))
def test_conditions_hold(tmp_path: Path, seed: int) -> None:
    end, rows = judged(seed, tmp_path)
    print(f"seed {seed}: {end}, {rows} rows")
    assert rows >= 1


@pytest.mark.slow
@pytest.mark.parametrize("first", range(LONG.start, LONG.stop, PORTION))
def test_long_campaign(tmp_path: Path, first: int) -> None:
    ends = [judged(seed, tmp_path) for seed in range(first, first + PORTION)]
    print(f"seeds {first} to {first + PORTION - 1}: {Counter(end for end, _ in ends)}")
    assert sum(rows > 1 for _, rows in ends) > PORTION // 2
