"""Random motions under drawn limits: every one holds every bound and its path, or is refused at its place.

Limits are drawn around what the motion uses when it is free. A failing case is repeated by its tick, robot
and seed, which are in the id of the test and in the message.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.cell.cell import Cell
from irlx.cell.load import load_cell
from irlx.cell.robot_data import robot_data_folder
from long_run import diagonal
from machines import machine
from stream_judge import Written, excess, on_line

pytestmark = [pytest.mark.req("MOT-20"), pytest.mark.req("MOT-22"), pytest.mark.req("QA-05")]

TICKS = [0.25, 1.0, 4.0, 10.0, 50.0]
ROBOTS = ["panda", "arm7", "rail6", "koch11"]
QUICK, LONG = 1, 300
REFUSALS = {"IRL520", "IRL521", "IRL523", "IRL524"}
SIZES = {"panda": 1.0, "arm7": 1.0, "rail6": 1.0, "koch11": 6.0}
"""How much wider and faster than an ordinary arm a robot moves."""


@dataclass(frozen=True)
class Drawn:
    """Targets in mm and deg (ORIZYX), speeds and accelerations in mm and deg, per s."""

    targets: tuple[tuple[np.ndarray, np.ndarray], ...]
    laws: tuple[float, float, float, float]

    def text(self) -> str:
        moves = (f"  MOVE LIN (({join(p)}), ORIZYX({join(angles)}));\n" for p, angles in self.targets)
        return "PROGRAM drawn;\nBEGIN\n" + "".join(moves) + "ENDPROGRAM;\n"

    def pose(self, number: int) -> tuple[np.ndarray, Rotation]:
        """Pose of a target, counted from 0, m."""
        position, angles = self.targets[number]
        return position / 1e3, Rotation.from_euler("ZYX", angles, degrees=True)


def join(values) -> str:
    return ", ".join(repr(float(value)) for value in values)


def in_units(robot, values) -> np.ndarray:
    """Values per joint in mm and deg, as cells have them."""
    slides = np.array([axis.is_prismatic for axis in robot.axes])
    return np.where(slides, 1e3 * values, np.degrees(values))


def drawn_program(rng: np.random.Generator, name: str) -> Drawn:
    """One or two lines near the start: tiny, repeated, exactly straight and ordinary ways mixed."""
    robot, size = machine(name), SIZES[name]
    position, rotation = robot.pose(robot.start)
    at, angles = 1e3 * position, Rotation.from_matrix(rotation).as_euler("ZYX", degrees=True)
    targets = []
    for _ in range(rng.integers(1, 3)):
        if rng.random() < 0.9:
            way = rng.normal(size=3) * rng.choice([1.0, 1.0, 0.0], size=3)
            at = at + rng.choice([0.0, 1e-13, 1e-7, 5.0, 150.0, 250.0, 250.0]) * size * way
            angles = angles + rng.choice([0.0, 1e-14, 2.0, 20.0, 30.0]) * rng.normal(size=3)
        targets.append((at, angles))
    laws = (
        size * rng.uniform(150, 700),
        size * rng.uniform(800, 4000),
        rng.uniform(40, 150),
        rng.uniform(200, 900),
    )
    return Drawn(tuple(targets), laws)


def cell_text(name: str, drawn: Drawn, tick: float, limits: dict[str, list]) -> str:
    speed, acc, speed_ori, acc_ori = drawn.laws
    robot = machine(name)
    lines = [
        "[robot]",
        f'model = "{name}"',
        f"start = [{join(in_units(robot.robot, robot.start))}]",
        "[robot.limits]",
    ]
    lines += [f"{kind} = [{', '.join(entries)}]" for kind, entries in limits.items()]
    lines += ["[robot.self_collision]", "active = false"]
    lines += ["[motion]", f"tick_ms = {tick!r}", f"speed = {speed!r}", f"acc = {acc!r}"]
    return "\n".join([*lines, f"speed_ori = {speed_ori!r}", f"acc_ori = {acc_ori!r}"])


def free_use(folder: Path, name: str, drawn: Drawn) -> np.ndarray | None:
    """Rows of the motion without speed and acceleration limits at 10 ms, None where there is none."""
    none = {kind: ["false"] * machine(name).n for kind in ("speed", "acceleration")}
    (folder / "drawn.toml").write_text(cell_text(name, drawn, 10.0, none), encoding="utf-8")
    try:
        return irlx.run(folder / "drawn.irl").q
    except irlx.RunError:
        return None


def drawn_limits(rng: np.random.Generator, name: str, rows: np.ndarray) -> dict[str, list]:
    """Speeds 0.4 to 1.5, accelerations 0.4 to 3 of the use; one range cut, starts on a limit, zeros."""
    robot = machine(name)
    units = in_units(robot.robot, np.ones(robot.n))
    v = np.diff(rows, axis=0, prepend=rows[:1]) / 0.01
    a = np.diff(v, axis=0, prepend=0.0 * v[:1]) / 0.01
    n, limits = robot.n, {}
    scale = 1.0 if rng.random() < 0.2 else 0.0
    speed = np.max(np.abs(v), axis=0) * np.maximum(rng.uniform(0.4, 1.5, n), scale) + 1e-3
    down = np.where(rng.random(n) < 0.2, rng.uniform(0.8, 1.2, n), 1.0) * speed
    if rng.random() < 0.15:
        joint = rng.integers(n)
        speed[joint], down[joint] = [(0.0, 0.0), (0.0, down[joint])][rng.integers(2)]
    limits["speed"] = [
        f"[{low!r}, {high!r}]"
        for low, high in zip((-down * units).tolist(), (speed * units).tolist(), strict=True)
    ]
    acceleration = np.max(np.abs(a), axis=0) * np.maximum(rng.uniform(0.4, 3.0, n), scale) + 1e-2
    if rng.random() < 0.05:
        acceleration[rng.integers(n)] = 0.0
    given = rng.random() < 0.8
    limits["acceleration"] = [repr(float(x)) if given else "false" for x in acceleration * units]
    limits["position"] = drawn_ranges(rng, robot, rows)
    return limits


def drawn_ranges(rng: np.random.Generator, robot, rows: np.ndarray) -> list[str]:
    """The robot's own ranges, one cut within what the motion uses, one with the start exactly on its end."""
    limits, start = robot.limits, in_units(robot.robot, robot.start)
    lower = in_units(robot.robot, limits.position_lower)
    upper = in_units(robot.robot, limits.position_upper)
    low, high = (in_units(robot.robot, side) for side in (rows.min(axis=0), rows.max(axis=0)))
    cut, on = rng.integers(robot.n, size=2)
    share = rng.uniform(0.3, 1.0)
    if high[cut] - start[cut] > start[cut] - low[cut]:
        upper[cut] = start[cut] + share * (high[cut] - start[cut])
    else:
        lower[cut] = start[cut] - share * (start[cut] - low[cut])
    if rng.random() < 0.3:
        (upper if rng.random() < 0.5 else lower)[on] = start[on]
    entries = zip(np.minimum(lower, start).tolist(), np.maximum(upper, start).tolist(), strict=True)
    return ["false" if np.isinf(a) and np.isinf(b) else f"[{a!r}, {b!r}]" for a, b in entries]


def one_case(folder: Path, tick: float, name: str, seed: int) -> str:
    """Run a drawn case: 'as programmed', 'planned', or the code of its refusal."""
    rng = np.random.default_rng([seed, int(1000 * tick), ROBOTS.index(name)])
    drawn = drawn_program(rng, name)
    (folder / "drawn.irl").write_text(drawn.text(), encoding="utf-8")
    rows = free_use(folder, name, drawn)
    if rows is None or len(rows) < 3:
        return "no motion"
    limits = drawn_limits(rng, name, rows)
    (folder / "drawn.toml").write_text(cell_text(name, drawn, tick, limits), encoding="utf-8")
    cell = load_cell(folder / "drawn.toml")
    where = f"robot {name}, tick {tick} ms, seed {seed}"
    try:
        run = irlx.run(folder / "drawn.irl")
    except irlx.RunError as error:
        refused = error
    else:
        return judged(folder, run, cell, drawn, where)
    assert refused.reason.code in REFUSALS, f"{where}: {refused}"
    assert refused.reason.place.line is not None, where
    assert_bounds_hold(folder, refused.run, cell, where)
    return str(refused.reason.code)


def judged(folder: Path, run: irlx.Run, cell: Cell, drawn: Drawn, where: str) -> str:
    """A finished run: bounds, path, and irlx's own verifier."""
    written = assert_bounds_hold(folder, run, cell, where)
    assert_path_kept(written, drawn, where)
    report = irlx.verify(run, cell=folder / "drawn.toml")
    assert report.passed, f"{where}: {[check.text for check in report.failed]}"
    return "planned" if run.summary.planned else "as programmed"


def assert_bounds_hold(folder: Path, run: irlx.Run, cell: Cell, where: str) -> Written | None:
    """What was written, judged by the limits of its cell; an incomplete run may have no motion at all."""
    run.save(folder / "drawn.npz")
    if len(run.q) < 2:
        return None
    written = Written.read(folder / "drawn.npz", urdf_of(cell), cell.robot.tip)
    pairs = (cell.limits.pair(kind) for kind in ("position", "speed", "acceleration"))
    found = excess(written.q, written.dt, *pairs)
    assert found.none, f"{where}: {found}"
    return written


def urdf_of(cell: Cell) -> str:
    if cell.model != "panda":
        return (files("irlx.cell") / "robots" / f"{cell.model}.urdf").read_text(encoding="utf-8")
    return (robot_data_folder() / "panda_description" / "urdf" / "panda.urdf").read_text(encoding="utf-8")


def assert_path_kept(written: Written | None, drawn: Drawn, where: str) -> None:
    assert written is not None, where
    for number in np.unique(written.block[written.block > 0]):
        start, positions, rotations = written.move(int(number))
        on_way = on_line(positions, rotations, start, drawn.pose(int(number) - 1))
        assert on_way.kept, (
            f"{where}, move {number}: {on_way.distance.max():.3g} m, {on_way.angle.max():.3g} rad"
        )


def cases(count: int) -> list:
    lacking = pytest.mark.skipif(robot_data_folder() is None, reason='pip install "irlx[robots]"')
    return [
        pytest.param(name, range(count), marks=lacking if name == "panda" else (), id=name) for name in ROBOTS
    ]


@pytest.mark.parametrize(("name", "seeds", "tick"), diagonal(cases(QUICK), TICKS, 2))
def test_bounds_and_path_hold_or_the_refusal_is_located(
    tmp_path, name: str, seeds: range, tick: float
) -> None:
    ends = {seed: one_case(tmp_path, tick, name, seed) for seed in seeds}
    print(f"robot {name}, tick {tick} ms, seeds and ends: {ends}")
    assert len(ends) == len(seeds)


@pytest.mark.slow
@pytest.mark.parametrize("tick", TICKS)
@pytest.mark.parametrize(("name", "seeds"), cases(LONG // len(ROBOTS)))
def test_long_campaign(tmp_path, name: str, seeds: range, tick: float) -> None:
    """300 motions a tick over four robots; at least some of them must end well."""
    ends = [one_case(tmp_path, tick, name, 1000 + seed) for seed in seeds]
    counts = {end: ends.count(end) for end in sorted(set(ends))}
    print(f"robot {name}, tick {tick} ms, seeds 1000 to {999 + len(seeds)}: {counts}")
    assert counts.get("planned", 0) + counts.get("as programmed", 0) >= len(seeds) // 4, counts
