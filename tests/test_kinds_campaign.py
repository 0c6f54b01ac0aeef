"""Random programs of every kind for platforms, gantries and snakes, with constraints of their links.

The programs are those of `good_streams`: all statements, switches, clauses and criteria. Each runs to its end
or is refused with a coded message; what was executed until then verifies. A failing case is repeated by its
seed, and its texts are in the message.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import good_streams
import irlx
from good_streams import MOTIONS, MOTIONS_EACH, NEED_LIMITS, TICKS, Case, Drawing
from irlx.verifier.geometry.link_poses import link_poses
from long_run import first
from machines import machine

pytestmark = [pytest.mark.req("TRF-20"), pytest.mark.req("TRF-22"), pytest.mark.req("QA-05")]

SIZES = {"mobile9": 1.0, "gantry9": 1.0, "snake20": 1.0}
QUICK, LONG, PORTION = (5, 6, 8, 0, 3), range(3000, 3120), 15


def drawn(seed: int) -> Case:
    """A case of one of the robots, as `drawn_case` draws them, with a constraint in two cases of three."""
    name, tick = list(SIZES)[seed % 3], TICKS[seed % len(TICKS)]
    good_streams.SIZES.update(SIZES)
    drawing = Drawing(np.random.default_rng(seed), name, tick)
    dealt = [list(MOTIONS)[(MOTIONS_EACH * seed + i) % len(MOTIONS)] for i in range(MOTIONS_EACH)]
    cell = drawing.cell(NEED_LIMITS.isdisjoint(dealt))
    for motion in drawing.rng.permutation(dealt):
        if drawing.rng.random() < 0.4:
            drawing.switch()
        MOTIONS[str(motion)](drawing)
    case = Case(seed, name, tick, cell, drawing.text(), tuple(dealt))
    return replace(case, cell=case.cell + constraint(seed, name))


def constraint(seed: int, name: str) -> str:
    """A constraint that the start keeps: a path of a link through where it stands, or an axis of one."""
    rng = np.random.default_rng([7, seed])
    robot, start = machine(name).robot, machine(name).start
    kind = str(rng.choice(["none", "path", "axis"]))
    link = {"mobile9": "platform", "gantry9": "mast", "snake20": "link_12"}[name]
    position, rotation = (part[0] for part in link_poses(robot, start[None], {link})[link])
    if kind == "none" or (kind == "axis" and name != "snake20"):
        return ""
    if kind == "axis":
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        return table(link, f"axis = {axis.tolist()}\ndirection = {(rotation @ axis).tolist()}")
    x, y = (1e3 * position[:2]).tolist()
    along = rotation[:2, 0] / np.linalg.norm(rotation[:2, 0])
    heading = name == "mobile9" and rng.random() < 0.5
    if heading or rng.random() < 0.3:
        a, b = -1500.0 * along + [x, y], 1500.0 * along + [x, y]
        return table(link, f"path = [{a.tolist()}, {b.tolist()}]\nheading = {str(heading).lower()}")
    bent = rng.uniform(-200.0, 200.0, 2)
    points = [[x - 900.0, y + bent[0]], [x, y], [x + 900.0, y + bent[1]]]
    return table(link, f"path = {[[float(c) for c in point] for point in points]}")


def table(link: str, rest: str) -> str:
    return f'[[constraint]]\nname = "kept"\nlink = "{link}"\n{rest}\n'


def judged(seed: int, folder: Path) -> tuple[str, int]:
    """How a case ended, and its rows."""
    case = drawn(seed)
    program = case.write(folder)
    try:
        run, end = irlx.run(program), "complete"
    except irlx.RunError as refused:
        run, end = refused.run, refused.reason.code
    assert end != "IRL090", str(case)
    report = irlx.verify(run, program=program, cell=folder / "drawn.toml")
    failed = {check.name for check in report.failed} - ({"complete"} if end != "complete" else set())
    assert not failed, f"{failed}\n{report}\n{case}"
    if "[[constraint]]" in case.cell:
        assert report["constraints"].status == "ok", str(case)
    return end, len(run.q)


@pytest.mark.parametrize("seed", first(2, QUICK))
def test_robots_of_every_kind(tmp_path: Path, seed: int) -> None:
    end, rows = judged(seed, tmp_path)
    print(f"seed {seed}: {end}, {rows} rows")
    assert rows >= 1


@pytest.mark.slow
@pytest.mark.parametrize("first", range(LONG.start, LONG.stop, PORTION))
def test_long_campaign(tmp_path: Path, first: int) -> None:
    ends = [judged(seed, tmp_path) for seed in range(first, first + PORTION)]
    print(f"seeds {first} to {first + PORTION - 1}: {Counter(end for end, _ in ends)}")
    assert sum(rows > 1 for _, rows in ends) > PORTION // 2
