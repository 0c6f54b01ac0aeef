"""Where RECONFIGURATION of 7-axis arms ends: at the posture asked for, or at a minimum among its neighbours.

The starts are drawn from the whole range of the joints; the postures asked for are near and far, on another
branch of the inverse kinematics, outside the limits, or off in one joint. Judged from the rows that come
out, with kinematics of this file that reads the URDF by itself:

- every row has the tool within 1e-6 m and rad of where it was; positions, speeds and accelerations, those
  into the first row and out of the last one among them, are within their limits by differences;
- the end is within 1e-6 of the posture asked for (`konf`), or the distance to it, 1/2 (q - konf)'W(q - konf),
  has its minimum there (`optimum`): its slope along the fibre is below 1e-6, or falls only where a joint
  leaves its limits; a thousandth of a radian further along the fibre, on every side that is open, it is
  not smaller; and no row before the end was nearer to konf;
- whatever ends elsewhere (`neither`) is a failure, as is a statement that takes longer than `LONGEST`.

A failing case is repeated by robot and seed, which are in its message.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from threading import Thread
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.cell.cell import Cell
from irlx.cell.load import load_cell
from irlx.cell.robot_data import robot_data_folder
from long_run import first

pytestmark = [pytest.mark.req("TRF-05"), pytest.mark.req("TRF-15"), pytest.mark.req("LANG-65")]

QUICK, LONG = 7, 110
SPARED = {"arm7": [pytest.mark.slow], "panda": []}
"""The other robot stands for this one, of which others look at frozen elbows."""
KINDS = ["near", "far", "branch", "outside", "equal", "one joint", "along"]
TICKS = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0]
POSE, REACHED, SLOPE, ASIDE = 1e-6, 1e-6, 1e-6, 1e-3
LONGEST = 60.0


@dataclass(frozen=True)
class Arm:
    """A chain of URDF joints: origin (m), its rotation, and the axis, None where the joint is fixed."""

    joints: tuple[tuple[np.ndarray, np.ndarray, np.ndarray | None], ...]
    lower: np.ndarray
    upper: np.ndarray

    def tool(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Position (m), rotation, and Jacobian (6, 7) in the world: m and rad per rad."""
        position, rotation = np.zeros(3), np.eye(3)
        values, places, axes = iter(q), [], []
        for xyz, turned, axis in self.joints:
            position, rotation = position + rotation @ xyz, rotation @ turned
            if axis is not None:
                places.append(position)
                axes.append(rotation @ axis)
                rotation = rotation @ Rotation.from_rotvec(next(values) * axis).as_matrix()
        turns = np.array(axes)
        moves = np.cross(turns, position - np.array(places))
        return position, rotation, np.hstack([moves, turns]).T

    def missing(self, q: np.ndarray, pose: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Way (m) and turn (rad) from q to a pose in the world, (6,), and the Jacobian at q."""
        position, rotation, jacobian = self.tool(q)
        turn = Rotation.from_matrix(pose[1] @ rotation.T).as_rotvec()
        return np.concatenate([pose[0] - position, turn]), jacobian

    def onto(
        self, q: np.ndarray, pose: tuple[np.ndarray, np.ndarray], moving: np.ndarray, rounds: int
    ) -> np.ndarray | None:
        """Posture of a pose by Newton steps of the joints `moving` (7,) bool from q; None where not met."""
        q = q.copy()
        for _ in range(rounds):
            left, jacobian = self.missing(q, pose)
            step = np.linalg.pinv(jacobian[:, moving], rcond=1e-6) @ left
            q[moving] += step * min(1.0, 0.3 / max(float(np.max(np.abs(step))), 1e-12))
        return q if np.max(np.abs(self.missing(q, pose)[0])) < 1e-9 else None


@cache
def arm(name: str) -> Arm:
    """The arm of a URDF, read joint by joint from the tool's link back to the base."""
    if name == "arm7":
        text, tip = (files("irlx.cell") / "robots" / "arm7.urdf").read_text(encoding="utf-8"), "tool"
    else:
        path = Path(str(robot_data_folder())) / "panda_description" / "urdf" / "panda.urdf"
        text, tip = path.read_text(encoding="utf-8"), "panda_hand_tcp"
    joints = [
        joint for joint in ElementTree.fromstring(text).iter("joint") if joint.find("child") is not None
    ]
    by_child = {joint.find("child").get("link"): joint for joint in joints}
    chain, ranges = [], []
    while tip in by_child:
        joint = by_child[tip]
        tip = joint.find("parent").get("link")
        origin = joint.find("origin")
        given = {} if origin is None else origin.attrib
        xyz, rpy = ([float(v) for v in given.get(key, "0 0 0").split()] for key in ("xyz", "rpy"))
        axis = None
        if joint.get("type") == "revolute":
            axis = np.array([float(v) for v in joint.find("axis").get("xyz").split()])
            limit = joint.find("limit")
            ranges.append((float(limit.get("lower")), float(limit.get("upper"))))
        chain.append((np.array(xyz), Rotation.from_euler("xyz", rpy).as_matrix(), axis))
    lower, upper = np.array(ranges[::-1]).T
    return Arm(tuple(chain[::-1]), lower, upper)


@dataclass(frozen=True)
class Case:
    """A posture to start from, one to go to (rad), the frozen joint (from 1), limits as text of a cell."""

    kind: str
    start: np.ndarray
    konf: np.ndarray
    frozen: int | None
    limits: str
    tick: float

    def write(self, folder: Path, name: str) -> Path:
        konf = ", ".join(map(repr, np.degrees(self.konf).tolist()))
        freeze = f"  FREEZESTART {self.frozen};\n" if self.frozen else ""
        asked = "R_JOINT_ACT.M_JOINT" if self.kind == "equal" else f"({konf})"
        program = folder / "drawn.irl"
        program.write_text(
            "PROGRAM drawn;\nVAR MAIN_JOINT: konf;\nBEGIN\n"
            f"  konf := {asked};\n{freeze}  RECONFIGURATION konf;\nENDPROGRAM;\n",
            encoding="utf-8",
        )
        start = ", ".join(map(repr, np.degrees(self.start).tolist()))
        (folder / "drawn.toml").write_text(
            f'[robot]\nmodel = "{name}"\nstart = [{start}]\n'
            f"[robot.limits]\n{self.limits}[robot.self_collision]\nactive = false\n"
            f"[motion]\ntick_ms = {self.tick!r}\n",
            encoding="utf-8",
        )
        return program


def drawn_start(rng: np.random.Generator, robot: Arm) -> np.ndarray:
    """Well inside the limits, and not near a singular posture."""
    room = 0.1 * (robot.upper - robot.lower)
    while True:
        q = rng.uniform(robot.lower + room, robot.upper - room)
        values = np.linalg.svd(robot.tool(q)[2], compute_uv=False)
        if values[-1] > 0.03 * values[0]:
            return q


def on_another_branch(rng: np.random.Generator, robot: Arm, start: np.ndarray) -> np.ndarray:
    """A posture of the same pose, found from somewhere else."""
    pose, everything = robot.tool(start)[:2], np.ones(7, dtype=bool)
    for _ in range(200):
        q = robot.onto(rng.uniform(robot.lower, robot.upper), pose, everything, 60)
        if (
            q is not None
            and np.all((q > robot.lower) & (q < robot.upper))
            and np.max(np.abs(q - start)) > 0.5
        ):
            return q
    return start


def along_the_fibre(rng: np.random.Generator, robot: Arm, start: np.ndarray) -> np.ndarray:
    """A posture of the same pose that the joints can get to, unless a singular posture is between."""
    pose, everything = robot.tool(start)[:2], np.ones(7, dtype=bool)
    q, heading = start, rng.normal(size=7)
    for _ in range(int(rng.choice([5, 20, 60]))):
        along = np.linalg.svd(robot.tool(q)[2])[2][-1]
        heading = along * np.sign(along @ heading)
        further = robot.onto(q + 0.02 * heading, pose, everything, 3)
        if further is None or not np.all((further > robot.lower) & (further < robot.upper)):
            break
        q = further
    return q


def drawn_konf(rng: np.random.Generator, robot: Arm, kind: str, start: np.ndarray) -> np.ndarray:
    if kind == "near":
        return start + 10.0 ** rng.uniform(-5.0, -1.3) * rng.normal(size=7)
    if kind == "branch":
        return on_another_branch(rng, robot, start)
    if kind == "along":
        return along_the_fibre(rng, robot, start)
    if kind == "one joint":
        return start + np.eye(7)[rng.integers(7)] * rng.uniform(-1.5, 1.5)
    if kind == "equal":
        return start
    konf = rng.uniform(robot.lower, robot.upper)
    if kind == "outside":
        beyond = rng.random(7) < 0.5
        ends = np.where(rng.random(7) < 0.5, robot.lower - 1.0, robot.upper + 1.0)
        konf = np.where(beyond, ends * rng.uniform(0.9, 1.1, 7), konf)
    return konf


def drawn_case(robot: Arm, seed: int) -> Case:
    rng = np.random.default_rng([65, seed])
    kind = KINDS[seed % len(KINDS)]
    start = drawn_start(rng, robot)
    konf = drawn_konf(rng, robot, kind, start)
    limits = ""
    if rng.random() < 0.4:
        some, below, above = rng.random(7) < 0.5, *rng.uniform(0.02, 0.6, (2, 7))
        lower = np.where(some, np.maximum(start - below, robot.lower), robot.lower)
        upper = np.where(some, np.minimum(start + above, robot.upper), robot.upper)
        pairs = np.degrees(np.column_stack([lower, upper])).tolist()
        limits += f"position = {pairs!r}\n"
    if rng.random() < 0.4:
        limits += f"speed = {np.degrees(rng.uniform(0.1, 1.0, 7)).tolist()!r}\n"
        limits += f"acceleration = {np.degrees(rng.uniform(0.3, 5.0, 7)).tolist()!r}\n"
    frozen = int(rng.integers(1, 8)) if rng.random() < 0.1 else None
    tick = float(rng.choice(TICKS)) if rng.random() < 0.7 else round(float(rng.uniform(1.0, 50.0)), 2)
    return Case(kind, start, konf, frozen, limits, tick)


def within_time(run: Callable[[], irlx.Run]) -> irlx.Run:
    """What `run` returns; raises AssertionError where it takes longer than `LONGEST` (s)."""
    outcome: list[irlx.Run | BaseException] = []

    def take() -> None:
        try:
            outcome.append(run())
        except BaseException as error:
            outcome.append(error)

    worker = Thread(target=take, daemon=True)
    worker.start()
    worker.join(LONGEST)
    assert outcome, f"still running after {LONGEST} s"
    if isinstance(outcome[0], BaseException):
        raise outcome[0]
    return outcome[0]


def assert_kept(robot: Arm, case: Case, cell: Cell, run: irlx.Run) -> None:
    q, dt, limits = run.q, run.stream.dt, cell.limits
    pose = robot.tool(q[0])[:2]
    away = np.array([robot.missing(row, pose)[0] for row in q])
    assert np.max(np.linalg.norm(away[:, :3], axis=1)) <= POSE, "tool moved"
    assert np.max(np.linalg.norm(away[:, 3:], axis=1)) <= POSE, "tool turned"
    assert np.all((q >= limits.position_lower) & (q <= limits.position_upper)), "position"
    if case.frozen:
        assert np.all(q[:, case.frozen - 1] == q[0, case.frozen - 1]), "frozen"
    # At rest before the first row and behind the last one.
    v = np.diff(np.vstack([q[:1], q, q[-1:]]), axis=0) / dt
    a = np.diff(np.vstack([v[:1] * 0.0, v]), axis=0) / dt
    unit = float(np.spacing(np.max(np.abs(q))))
    speed, acceleration = limits.speed_upper, limits.acceleration_upper
    assert np.all(np.abs(v) <= speed * (1.0 + 1e-9) + 2.0 * unit / dt), "speed"
    assert np.all(np.abs(a) <= acceleration * (1.0 + 1e-9) + 4.0 * unit / dt**2), "acceleration"


def distances(case: Case, cell: Cell, rows: np.ndarray) -> np.ndarray:
    return 0.5 * ((rows - case.konf) ** 2) @ np.asarray(cell.weights)


def faults_of_end(robot: Arm, case: Case, cell: Cell, q: np.ndarray) -> list[str]:
    """What keeps q from being a minimum of the distance to konf on its fibre, inside the limits."""
    moving = np.ones(7, dtype=bool)
    if case.frozen:
        moving[case.frozen - 1] = False
    position, rotation, jacobian = robot.tool(q)
    _, values, directions = np.linalg.svd(jacobian[:, moving])
    rank = int(np.count_nonzero(values > 1e-9 * values[0]))
    if rank < 5 or (rank == 5 and not case.frozen):
        return [f"singular posture ({values / values[0]})"]
    if rank == len(directions):
        # The other joints of an arm with a frozen one have no other posture nearby.
        return []
    # The elbow of an arm whose shoulder and wrist are points keeps its angle along the fibre: frozen or not.
    along = np.zeros(7)
    along[moving] = directions[-1]
    slope = float(along @ (np.asarray(cell.weights) * (q - case.konf)))
    at_upper, at_lower = cell.limits.position_upper - q <= 1e-9, q - cell.limits.position_lower <= 1e-9
    faults = []
    here = distances(case, cell, q)
    for way in (along, -along):
        if np.any(at_upper & (way > 1e-9)) or np.any(at_lower & (way < -1e-9)):
            continue
        falls = -slope * np.sign(way @ along)
        if falls > SLOPE:
            faults.append(f"the distance falls with {falls:.3g} along the fibre")
        aside = robot.onto(q + ASIDE * way, (position, rotation), moving, 4)
        if aside is None or np.any(
            (aside > cell.limits.position_upper) | (aside < cell.limits.position_lower)
        ):
            continue
        if distances(case, cell, aside) < here - 2.0 * ASIDE * SLOPE:
            faults.append(f"a posture beside the end is nearer by {here - distances(case, cell, aside):.3g}")
    return faults


def judged(folder: Path, name: str, seed: int) -> tuple[str, str]:
    """Kind of a case and how it ended: `konf`, `optimum`, or `neither` with what is wrong with its end."""
    robot = arm(name)
    case = drawn_case(robot, seed)
    where = f"robot {name}, seed {seed}, {case.kind}, tick {case.tick} ms"
    program = case.write(folder, name)
    cell = load_cell(folder / "drawn.toml")
    try:
        run = within_time(lambda: irlx.run(program))
        assert run.complete
        assert_kept(robot, case, cell, run)
        apart = float(np.max(np.abs(run.q[-1] - case.konf)))
        said = [found.message for found in run.diagnostics if found.code == "IRL349"]
        assert bool(said) == (apart > REACHED) or 0.9 * REACHED < apart < 1.1 * REACHED, "IRL349"
        if apart <= REACHED:
            return case.kind, "konf"
        way = distances(case, cell, run.q)
        assert way[-1] <= np.min(way) + 1e-9 * (1.0 + way[0]), "a row before the end was nearer"
    except (AssertionError, irlx.RunError) as error:
        raise AssertionError(f"{where}: {error}") from error
    faults = faults_of_end(robot, case, cell, run.q[-1])
    return case.kind, f"neither: {where}: {'; '.join(faults)}; said: {said}" if faults else "optimum"


def campaign(folder: Path, name: str, seeds: range) -> None:
    ends, neither, faults = Counter(), [], []
    for seed in seeds:
        try:
            kind, end = judged(folder, name, seed)
        except AssertionError as fault:
            faults.append(str(fault).splitlines()[0])
            continue
        ends[kind, end.split(":")[0]] += 1
        neither += [end] if end.startswith("neither") else []
    print(f"robot {name}, seeds {seeds.start} to {seeds.stop - 1}")
    for kind in KINDS:
        print(f"  {kind}: " + ", ".join(f"{ends[kind, end]} {end}" for end in ("konf", "optimum", "neither")))
    assert not faults + neither, "\n".join(faults + neither)
    assert all(ends[kind, "optimum"] for kind in ("far", "outside")), "hardly anything is asked"
    assert any(ends[kind, "konf"] for kind in ("along", "branch")), "hardly anything is reached"


def robots() -> list:
    lacking = pytest.mark.skipif(robot_data_folder() is None, reason='pip install "irlx[robots]"')
    return [pytest.param("arm7", id="arm7"), pytest.param("panda", marks=lacking, id="panda")]


@pytest.mark.parametrize("name", robots())
def test_jacobian_of_this_file_is_the_derivative_of_its_poses(name: str) -> None:
    robot, rng = arm(name), np.random.default_rng(1)
    steps = 1e-6 * np.eye(7)
    for _ in range(20):
        q = rng.uniform(robot.lower, robot.upper)
        changes = [robot.missing(q - step, robot.tool(q + step)[:2])[0] / 2e-6 for step in steps]
        np.testing.assert_allclose(robot.tool(q)[2], np.transpose(changes), atol=1e-8)


@pytest.mark.parametrize("name", robots())
def test_postures_beside_the_end_are_refused(tmp_path, name: str) -> None:
    """A judge that refuses nothing proves nothing: 1e-5 rad along the fibre are too far from a minimum."""
    robot, case = arm(name), drawn_case(arm(name), 1)
    case = replace(case, limits="", frozen=None)
    run = irlx.run(case.write(tmp_path, name))
    cell = load_cell(tmp_path / "drawn.toml")
    end = run.q[-1]
    assert not faults_of_end(robot, case, cell, end)
    along = np.linalg.svd(robot.tool(end)[2])[2][-1]
    for way in (along, -along):
        aside = robot.onto(end + 1e-5 * way, robot.tool(end)[:2], np.ones(7, dtype=bool), 3)
        if np.all((aside > cell.limits.position_lower) & (aside < cell.limits.position_upper)):
            assert faults_of_end(robot, case, cell, aside)


@pytest.mark.parametrize(
    "name", [pytest.param(*one.values, marks=[*one.marks, *SPARED[one.id]], id=one.id) for one in robots()]
)
def test_reconfigurations_end_at_konf_or_at_a_minimum(tmp_path, name: str) -> None:
    campaign(tmp_path, name, range(QUICK))


@pytest.mark.parametrize("seeds", first(1, [(2360, 0, 1, 2, 4, 5), (2360, *range(6))]), ids=str)
def test_frozen_elbow_does_not_end_the_motion_of_the_others(tmp_path, seeds: tuple[int, ...]) -> None:
    """arm7's shoulder and wrist are points: the elbow's own angle never changes along the fibre."""
    robot, moved = arm("arm7"), 0
    for seed in seeds:
        case = replace(drawn_case(robot, seed), frozen=4)
        run = irlx.run(case.write(tmp_path, "arm7"))
        cell = load_cell(tmp_path / "drawn.toml")
        assert_kept(robot, case, cell, run)
        assert not faults_of_end(robot, case, cell, run.q[-1]), f"seed {seed}"
        moved += len(run.q) > 1
    assert moved > 4


@pytest.mark.slow
@pytest.mark.parametrize("name", robots())
def test_long_campaign(tmp_path, name: str) -> None:
    campaign(tmp_path, name, range(1000, 1000 + LONG))
