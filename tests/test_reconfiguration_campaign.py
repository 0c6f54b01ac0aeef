"""Random RECONFIGURATION statements on four robots, judged from the rows that come out.

What is judged, by the verifier's forward kinematics and differences of this file's own:

- the tool stays within 1e-6 m and rad of where it was, at every row; position limits hold exactly, speeds
  and accelerations by backward differences, the way into the first row and the hold row among them;
- no overshoot. The weighted distance to the posture asked for never rises again by more than 1e-3 of what it
  was at the start. Once the motion has come within a tenth of its whole way to its end, the
  weighted distance to the end posture does not rise by more than 1e-3 of the whole way either, and a joint
  that came there without turning back does not pass its end value by more than that: on the last
  tenth the way is nearly straight, before it a joint may well have to turn back. Where several joints are
  spare the steepest way still bends there, along one spare direction after the other: 1e-2 of it then;
- it ends at the posture asked for, or at the best one for it that the limits leave: the conditions of
  Karush, Kuhn and Tucker, with a Jacobian of this file, hold to 1e-6; a warning says what is left.

A failing case is repeated by robot, tick and seed, which are in its message.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import lsq_linear
from scipy.spatial.transform import Rotation

import irlx
from irlx.cell.cell import Cell
from irlx.cell.load import load_cell
from irlx.cell.robot_data import robot_data_folder
from irlx.verifier.geometry.forward import forward
from long_run import diagonal
from machines import machine

pytestmark = [pytest.mark.req("TRF-05"), pytest.mark.req("TRF-15"), pytest.mark.req("LANG-65")]

TICKS = [0.25, 1.0, 10.0, 50.0]
ROBOTS = ["arm7", "panda", "rail6", "koch11"]
QUICK, LONG = 1, 200
KINDS = ["fibre", "fibre", "off", "off", "near", "beyond", "same", "residue"]
POSE, OVERSHOOT, TURNING, AT_REST = 1e-6, 1e-3, 1e-2, 1e-6
LONGEST_CPU = 30.0


def join(values) -> str:
    return ", ".join(repr(float(value)) for value in values)


def scales(name: str) -> np.ndarray:
    """Units of a program for one rad or m of each joint."""
    return np.array([1e3 if axis.is_prismatic else np.degrees(1.0) for axis in machine(name).robot.axes])


def jacobian(name: str, q: np.ndarray) -> np.ndarray:
    """Jacobian (6, n) by central differences of the verifier's kinematics: m and rad in the world."""
    h = 1e-6
    rows = np.vstack([q + h * np.eye(q.size), q - h * np.eye(q.size)])
    position, rotation = forward(machine(name).robot, rows)
    ahead, behind = Rotation.from_matrix(rotation[: q.size]), Rotation.from_matrix(rotation[q.size :])
    turns = (ahead * behind.inv()).as_rotvec()
    return np.hstack([position[: q.size] - position[q.size :], turns]).T / (2.0 * h)


def along_fibre(rng: np.random.Generator, name: str, q: np.ndarray, way: float) -> np.ndarray:
    """Another posture of the same tool pose, some way along a direction drawn at random."""
    robot = machine(name).robot
    target, turned = (part[0] for part in forward(robot, q[None]))
    heading = rng.normal(size=q.size)
    for _ in range(int(way / 0.02)):
        inverse = np.linalg.pinv(jacobian(name, q))
        heading = heading - inverse @ (jacobian(name, q) @ heading)
        heading = heading / max(float(np.linalg.norm(heading)), 1e-12)
        q = q + 0.02 * heading
        for _ in range(3):
            position, rotation = forward(robot, q[None])
            turn = Rotation.from_matrix(turned @ rotation[0].T).as_rotvec()
            q = q + np.linalg.pinv(jacobian(name, q)) @ np.concatenate([target - position[0], turn])
    return q


@dataclass(frozen=True)
class Case:
    """A posture to start from, one to go to, joints frozen (from 1), and the text of the cell's limits."""

    name: str
    kind: str
    start: np.ndarray
    konf: np.ndarray
    frozen: tuple[int, ...]
    limits: str
    law: tuple[float, float]

    def write(self, folder: Path, tick: float) -> Path:
        units = scales(self.name)
        # The posture asked for in the program's own units; R_JOINT_ACT, bit by bit, where nothing is asked.
        konf = "R_JOINT_ACT.M_JOINT" if self.kind == "same" else f"({join(self.konf * units)})"
        freeze = f"  FREEZESTART {', '.join(map(str, self.frozen))};\n" if self.frozen else ""
        program = folder / "drawn.irl"
        program.write_text(
            f"PROGRAM drawn;\nVAR MAIN_JOINT: konf := {konf};\nBEGIN\n{freeze}  RECONFIGURATION konf;\n"
            if self.kind != "same"
            else f"PROGRAM drawn;\nVAR MAIN_JOINT: konf;\nBEGIN\n  konf := {konf};\n"
            f"{freeze}  RECONFIGURATION konf;\n",
            encoding="utf-8",
        )
        with program.open("a", encoding="utf-8") as text:
            text.write("ENDPROGRAM;\n")
        speed, speed_ori = self.law
        (folder / "drawn.toml").write_text(
            f'[robot]\nmodel = "{self.name}"\nstart = [{join(self.start * units)}]\n'
            f"[robot.limits]\n{self.limits}[robot.self_collision]\nactive = false\n"
            f"[motion]\ntick_ms = {tick!r}\nspeed = {speed!r}\nspeed_ori = {speed_ori!r}\n",
            encoding="utf-8",
        )
        return program


def drawn_case(rng: np.random.Generator, name: str) -> Case:
    robot, units = machine(name), scales(name)
    lower, upper = robot.limits.position_lower, robot.limits.position_upper
    lower, upper = np.maximum(lower, robot.start - 3.0), np.minimum(upper, robot.start + 3.0)
    spread = rng.choice([0.1, 0.5])
    start = np.clip(robot.start + spread * rng.normal(size=robot.n), lower + 0.02, upper - 0.02)
    kind = str(rng.choice(KINDS))
    if kind == "fibre":
        konf = along_fibre(rng, name, start, rng.choice([0.05, 0.5, 1.5]))
    elif kind in {"same", "residue"}:
        konf = start * (1.0 + (kind == "residue") * 4e-16 * rng.normal(size=robot.n))
    elif kind == "near":
        konf = start + rng.choice([1e-6, 1e-3, 0.03]) * rng.normal(size=robot.n)
    else:
        konf = rng.uniform(lower, upper) + (kind == "beyond") * rng.normal(size=robot.n)
    narrow = rng.random() < 0.5
    if narrow:
        # Ranges that cut the way, and some ends that are exactly where the robot stands.
        some = rng.random(robot.n) < 0.4
        lower = np.where(some, start - rng.uniform(0.0, 0.6, robot.n), lower)
        upper = np.where(some, start + rng.uniform(0.0, 0.6, robot.n), upper)
        on = rng.random(robot.n) < 0.1
        lower, upper = np.where(on, start, lower), np.where(on & (rng.random(robot.n) < 0.1), start, upper)
    lower, upper = np.minimum(lower, start), np.maximum(upper, start)
    ends = zip((lower * units).tolist(), (upper * units).tolist(), strict=True)
    entries = ", ".join(f"[{a!r}, {b!r}]" for a, b in ends)
    limits = f"position = [{entries}]\n"
    for kind_of_limit, size in (("speed", 1.0), ("acceleration", 4.0)):
        if rng.random() < 0.6:
            values = size * rng.uniform(0.3, 3.0, robot.n) * units
            if rng.random() < 0.05:
                values[rng.integers(robot.n)] = 0.0
            limits += f"{kind_of_limit} = [{join(values)}]\n"
        else:
            limits += f"{kind_of_limit} = false\n"
    spare, frozen = robot.n - 6, ()
    if rng.random() < (0.05 if spare == 1 else 0.4):
        count = int(rng.integers(1, spare + 1))
        frozen = tuple(int(joint) + 1 for joint in rng.choice(robot.n, count, replace=False))
    return Case(name, kind, start, konf, frozen, limits, (rng.uniform(100, 900), rng.uniform(20, 120)))


def working(case: Case, cell: Cell) -> tuple[np.ndarray, np.ndarray]:
    """Largest speed and acceleration of each joint, those of the language where the cell has none."""
    slides = np.array([axis.is_prismatic for axis in cell.robot.axes])
    usual = np.where(slides, case.law[0] / 1e3, np.radians(case.law[1]))
    speed = np.where(np.isfinite(cell.limits.speed_upper), cell.limits.speed_upper, usual)
    acceleration = cell.limits.acceleration_upper
    return speed, np.where(np.isfinite(acceleration), acceleration, speed / 0.2)


def left_of_gradient(case: Case, cell: Cell, q: np.ndarray, free: np.ndarray) -> float:
    """Length of W (q - konf) + J'k + m over the free joints, at its least over k and admissible m."""
    weights = np.asarray(cell.weights)[free]
    gradient = weights * (q - case.konf)[free]
    tasks = jacobian(case.name, q)[:, free].T
    tasks = tasks / np.linalg.norm(tasks, axis=0)
    at_upper = (cell.limits.position_upper - q)[free] <= 1e-9
    at_lower = (q - cell.limits.position_lower)[free] <= 1e-9
    pushes = np.hstack([np.eye(free.sum())[:, at_upper], -np.eye(free.sum())[:, at_lower]])
    matrix = np.hstack([tasks, pushes])
    low = np.concatenate([np.full(6, -np.inf), np.zeros(pushes.shape[1])])
    fit = lsq_linear(matrix, -gradient, bounds=(low, np.inf), method="bvls", tol=1e-15)
    return float(np.max(np.abs(matrix @ fit.x + gradient)))


def assert_kept(case: Case, cell: Cell, q: np.ndarray, dt: float) -> None:
    position, rotation = forward(cell.robot, q)
    away = Rotation.from_matrix(rotation[0].T @ rotation).magnitude()
    assert np.max(np.linalg.norm(position - position[0], axis=1)) <= POSE
    assert np.max(away) <= POSE
    assert np.all((q >= cell.limits.position_lower) & (q <= cell.limits.position_upper))
    frozen = [number - 1 for number in case.frozen]
    assert np.all(q[:, frozen] == q[0, frozen])
    v = np.diff(np.vstack([q[:1], q, q[-1:]]), axis=0) / dt
    a = np.diff(np.vstack([v[:1] * 0.0, v]), axis=0) / dt
    unit = float(np.spacing(np.max(np.abs(q))))
    speed, acceleration = working(case, cell)
    assert np.all(np.abs(v) <= speed * (1.0 + 1e-9) + 2.0 * unit / dt)
    assert np.all(np.abs(a) <= acceleration * (1.0 + 1e-9) + 4.0 * unit / dt**2)


def assert_no_overshoot(case: Case, cell: Cell, q: np.ndarray, free: np.ndarray) -> None:
    weights = np.asarray(cell.weights) * free

    def distance(rows: np.ndarray) -> np.ndarray:
        return np.sqrt(np.maximum((weights * rows**2).sum(axis=1), 0.0))

    asked = distance(q - case.konf)
    assert np.all(asked - np.minimum.accumulate(asked) <= OVERSHOOT * asked[0] + 1e-12), (
        f"distance to konf {np.max(asked - np.minimum.accumulate(asked)):.3g} of {asked[0]:.3g}"
    )
    to_end = distance(q - q[-1])
    last = int(np.flatnonzero(to_end >= 0.1 * to_end.max())[-1])
    tail = to_end[last:]
    assert np.all(tail - np.minimum.accumulate(tail) <= OVERSHOOT * to_end.max()), "distance to the end"
    ways = np.diff(q[: last + 1], axis=0)
    side = np.sign(q[last] - q[-1])
    straight = np.all(ways * side <= 0.0, axis=0)
    passed = np.max(-side * (q[last:] - q[-1]), axis=0)
    share = OVERSHOOT if np.count_nonzero(free) == 7 else TURNING
    assert np.all(passed[straight] <= share * to_end.max()), (
        f"joints beyond their end value {passed[straight]} of {to_end.max()}"
    )


def judged(case: Case, cell: Cell, run: irlx.Run) -> str:
    """All that is promised; the outcome: 'still', 'konf', 'nearest', or how a flow ended short."""
    q, dt = run.q, run.stream.dt
    speed, acceleration = working(case, cell)
    free = (speed > 0.0) & (acceleration > 0.0)
    free[[number - 1 for number in case.frozen]] = False
    assert run.complete
    assert_kept(case, cell, q, dt)
    if len(q) > 1:
        assert_no_overshoot(case, cell, q, free)
    left = [found.message for found in run.diagnostics if found.code == "IRL349"]
    apart = float(np.max(np.abs(case.konf - q[-1])))
    assert bool(left) == (apart > 1e-6) or 0.9e-6 < apart < 1.1e-6
    if "singular" in "".join(left) or "no posture nearby" in "".join(left):
        return "singular" if "singular" in left[0] else "stalled"
    if np.count_nonzero(free) > 6:
        gradient = left_of_gradient(case, cell, q[-1], free)
        assert gradient < AT_REST, f"projected gradient {gradient:.3g}"
    if len(q) == 1:
        return "still"
    return "nearest" if left else "konf"


def one_case(folder: Path, name: str, tick: float, seed: int) -> str:
    case = drawn_case(np.random.default_rng([seed, int(1000 * tick), ROBOTS.index(name)]), name)
    program = case.write(folder, tick)
    cell = load_cell(folder / "drawn.toml")
    started = time.process_time()
    where = f"robot {name}, tick {tick} ms, seed {seed}, konf {case.kind}"
    try:
        run = irlx.run(program)
        assert time.process_time() - started <= LONGEST_CPU
        # The cell's own numbers, which went through degrees.
        settled = Case(name, case.kind, run.q[0], case.konf, case.frozen, case.limits, case.law)
        return judged(settled, cell, run)
    except (AssertionError, irlx.RunError) as error:
        raise AssertionError(f"{where}: {error}") from error


def cases() -> list:
    lacking = pytest.mark.skipif(robot_data_folder() is None, reason='pip install "irlx[robots]"')
    return [pytest.param(name, marks=lacking if name == "panda" else (), id=name) for name in ROBOTS]


@pytest.mark.parametrize(("name", "tick"), diagonal(cases(), TICKS))
def test_reconfigurations_keep_their_promises(tmp_path, name: str, tick: float) -> None:
    ends = {seed: one_case(tmp_path, name, tick, seed) for seed in range(QUICK)}
    print(f"robot {name}, tick {tick} ms, seeds and ends: {ends}")
    assert len(ends) == QUICK


@pytest.mark.slow
@pytest.mark.parametrize("tick", TICKS)
@pytest.mark.parametrize("name", cases())
def test_long_campaign(tmp_path, name: str, tick: float) -> None:
    """200 statements over robots and ticks; hardly any may end at a singular posture or stall."""
    count = -(-LONG // (len(ROBOTS) * len(TICKS)))
    ends = [one_case(tmp_path, name, tick, 1000 + seed) for seed in range(count)]
    print(f"robot {name}, tick {tick} ms, seeds 1000 to {999 + count}: {sorted(ends)}")
    assert ends.count("stalled") + ends.count("singular") <= count // 3, ends
