"""Random programs that switch options between their moves: every row keeps what is in force at it.

CYCLICSTART, FREEZESTART, the three limit switches and their clauses come and go between LIN, CIRCLE, PTP and
RECONFIGURATION. Judged from the rows, by the verifier's forward kinematics and differences of this file:

- position, speed and acceleration bounds in force, frozen joints bit by bit, at every row;
- every motion begins and ends at rest (TRF-14: what is switched then moves nothing);
- no chattering: a joint goes from one acceleration bound to the other a few times in a motion, not tick by
  tick;
- where no acceleration limit is known, in a move that is drawn to a posture: the speed of a joint changes
  within a tick by no more than the governed rate, its speed limit in 0.2 s, and twice what least motion
  needs of its busiest joint on the same rows (a posture that is kept shares the work out otherwise). Not
  where a joint meets a position or speed limit: with no acceleration to brake by it stops there as late
  as it may, and the others turn with it;
- there the last step into the rest at the end is small, at most four times the governed rate (a posture
  that is drawn along with the tool has the tool's ramp): no joint runs at speed into its stop.

A failing case is repeated by robot, tick and seed, which are in its message.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.cell.robot_data import robot_data_folder
from irlx.verifier.geometry.forward import forward
from long_run import diagonal
from machines import Machine, machine

pytestmark = [pytest.mark.req("TRF-14"), pytest.mark.req("TRF-06"), pytest.mark.req("MOT-20")]

TICKS = [0.25, 1.0, 4.0, 50.0]
ROBOTS = ["panda", "arm7", "koch11"]
SIZES = {"panda": 1.0, "arm7": 1.0, "koch11": 5.0}
QUICK, LONG = 1, 8
REFUSALS = {"IRL343", "IRL345", "IRL424", "IRL520", "IRL521", "IRL522", "IRL523"}
KINDS = ("POSITION", "SPEED", "ACCELERATION")
WORDS = {"POSITION": "JOINTLIMIT", "SPEED": "JOINTSPEEDLIMIT", "ACCELERATION": "JOINTACCELLIMIT"}
TYPES = {"POSITION": "MAIN_JOINT", "SPEED": "MAIN_JOINT_SPEED", "ACCELERATION": "MAIN_JOINT_ACCEL"}
RAMP_TIME, MOST_TURNS, OF_LEAST_MOTION, WITH_THE_TOOL = 0.2, 12, 2.0, 4.0

Pair = tuple[np.ndarray, np.ndarray]


def join(values) -> str:
    return ", ".join(repr(float(value)) for value in values)


def scales(robot: Machine) -> np.ndarray:
    """Units of a program for one rad or m of each joint."""
    return np.array([1e3 if axis.is_prismatic else np.degrees(1.0) for axis in robot.robot.axes])


@dataclass
class State:
    """What is in force, as the program has it so far: limits by kind (rad, m), joints frozen (from 1)."""

    limits: dict[str, Pair] = field(default_factory=dict)
    frozen: tuple[int, ...] = ()
    cyclic: bool = False


@dataclass
class Drawn:
    """A program line by line, and for each line that moves what is in force there and if it is drawn."""

    variables: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)
    in_force: dict[int, tuple[dict[str, Pair], tuple[int, ...], bool]] = field(default_factory=dict)

    def text(self) -> str:
        head = ["PROGRAM drawn;", "VAR", *self.variables, "BEGIN"]
        return "\n".join([*head, *self.lines, "ENDPROGRAM;", ""])


class Drawing:
    """Draws one program."""

    def __init__(self, rng: np.random.Generator, name: str, tick: float) -> None:
        self.rng, self.name, self.robot, self.tick = rng, name, machine(name), tick
        self.units, self.state, self.drawn = scales(self.robot), State(), Drawn()
        self.position, rotation = self.robot.pose(self.robot.start)
        self.angles = Rotation.from_matrix(rotation).as_euler("ZYX", degrees=True)
        # Short ticks, short ways: the same number of rows for all.
        self.size = SIZES[name] * (0.3 if tick < 1.0 else 1.0)
        rng_speed = rng.uniform(0.6, 2.5, self.robot.n)
        self.speed = np.minimum(rng_speed, self.robot.limits.speed_upper)
        self.acceleration = self.speed * rng.uniform(3.0, 20.0, self.robot.n)

    def cell(self) -> str:
        known = self.rng.random() < 0.5
        acceleration = f"[{join(self.acceleration * self.units)}]" if known else "false"
        self.state.limits["SPEED"] = (-self.speed, self.speed)
        if known:
            self.state.limits["ACCELERATION"] = (-self.acceleration, self.acceleration)
        own = self.robot.limits.pair("position")
        self.state.limits["POSITION"] = own
        self.own = dict(self.state.limits)
        return (
            f'[robot]\nmodel = "{self.name}"\nstart = [{join(self.robot.start * self.units)}]\n'
            f"[robot.limits]\nspeed = [{join(self.speed * self.units)}]\nacceleration = {acceleration}\n"
            "[robot.self_collision]\nactive = false\n"
            f"[motion]\ntick_ms = {self.tick!r}\nspeed = {150.0 * self.size!r}\nacc = {800.0 * self.size!r}\n"
            "speed_ori = 60.0\nacc_ori = 240.0\n"
        )

    def range(self, kind: str) -> Pair:
        """Bounds of a kind drawn at random, inside the robot's own."""
        n, start = self.robot.n, self.robot.start
        if kind == "POSITION":
            wide = self.rng.uniform(0.1, 1.0, (2, n))
            lower, upper = start - wide[0], start + wide[1]
        else:
            size = self.speed if kind == "SPEED" else self.acceleration
            upper = size * self.rng.uniform(0.3, 1.0, n)
            lower = -upper
        own = self.own.get(kind, (np.full(n, -np.inf), np.full(n, np.inf)))
        return np.maximum(lower, own[0]), np.minimum(upper, own[1])

    def variable(self, kind: str, pair: Pair) -> str:
        name = f"v{len(self.drawn.variables)}"
        for side, values in zip(("MIN", "MAX"), pair, strict=True):
            self.drawn.variables.append(
                f"  {TYPES[kind]}_{side}: {name}{side} := ({join(values * self.units)});"
            )
        return f"{name}MIN, {name}MAX"

    def switch(self) -> None:
        kind = str(self.rng.choice(["cyclic", "cyclic", "freeze", *KINDS]))
        state, on = self.state, self.rng.random() < 0.6
        if kind == "cyclic":
            self.line("CYCLICSTART;" if on else "CYCLICEND;")
            state.cyclic = on
        elif kind == "freeze":
            spare = self.robot.n - 6
            joints = tuple(
                int(j) + 1
                for j in self.rng.choice(self.robot.n, self.rng.integers(1, spare + 1), replace=False)
            )
            self.line(f"FREEZESTART {', '.join(map(str, joints))};" if on else "FREEZEEND;")
            state.frozen = joints if on else ()
        elif on:
            pair = self.range(kind)
            self.line(f"{WORDS[kind]} {self.variable(kind, pair)};")
            state.limits[kind] = pair
        else:
            self.line(f"{WORDS[kind]}END;")
            if kind in self.own:
                state.limits[kind] = self.own[kind]
            else:
                state.limits.pop(kind, None)

    def pose(self) -> str:
        way = self.size * self.rng.uniform(0.02, 0.12) * self.rng.normal(size=3)
        angles = self.angles + self.rng.choice([0.0, 10.0]) * self.rng.normal(size=3)
        return f"(({join(1e3 * (self.position + way))}), ORIZYX({join(angles)}))"

    def joints(self) -> str:
        away = self.rng.choice([0.05, 0.4]) * self.rng.normal(size=self.robot.n)
        frozen = [number - 1 for number in self.state.frozen]
        away[frozen] = 0.0
        lower, upper = self.state.limits["POSITION"]
        values = np.clip(self.robot.start + away, lower, upper)
        name = f"v{len(self.drawn.variables)}"
        self.drawn.variables.append(f"  MAIN_JOINT: {name} := ({join(values * self.units)});")
        return name

    def move(self) -> None:
        kind = str(self.rng.choice(["LIN", "LIN", "LIN", "CIRCLE", "PTP", "JOINTS", "RECONFIGURATION"]))
        clauses, limits = "", dict(self.state.limits)
        if kind == "RECONFIGURATION":
            self.line(f"RECONFIGURATION {self.joints()};", limits)
            return
        if self.rng.random() < 0.3:
            asked = str(self.rng.choice(KINDS[1:]))
            pair = self.range(asked)
            clauses = f" WITH {WORDS[asked]} {self.variable(asked, pair)}"
            limits[asked] = pair
        drawn = self.state.cyclic
        if kind in {"LIN", "CIRCLE"} and not clauses and self.rng.random() < 0.2:
            count = int(self.rng.integers(1, 3)) if kind == "CIRCLE" else 1
            clauses = f" WITH RECONFIGURATION {', '.join(self.joints() for _ in range(count))}"
            drawn = True
        target = {
            "LIN": lambda: f"LIN {self.pose()}",
            "CIRCLE": lambda: f"CIRCLE {self.pose()}, {self.pose()}",
            "PTP": lambda: f"PTP {self.pose()}",
            "JOINTS": lambda: f"PTP {self.joints()}",
        }[kind]()
        self.line(f"MOVE {target}{clauses};", limits, drawn and kind in {"LIN", "CIRCLE"})

    def line(self, text: str, limits: dict[str, Pair] | None = None, drawn: bool = False) -> None:
        if limits is not None:
            self.drawn.in_force[len(self.drawn.lines)] = limits, self.state.frozen, drawn
        self.drawn.lines.append(f"  {text}")

    def program(self) -> Drawn:
        for _ in range(7):
            while self.rng.random() < 0.5:
                self.switch()
            self.move()
        return self.drawn


def least_motion(name: str, q: np.ndarray, weights: np.ndarray, frozen: list[int]) -> np.ndarray:
    """Steps (N - 1, n) that least motion would take between the tool poses of rows q (N, n)."""
    robot, n, h = machine(name).robot, q.shape[1], 1e-6
    position, rotation = forward(robot, q)
    turns = (Rotation.from_matrix(rotation[1:]) * Rotation.from_matrix(rotation[:-1]).inv()).as_rotvec()
    twists = np.hstack([np.diff(position, axis=0), turns])
    columns = np.empty((len(q) - 1, 6, n))
    for joint in range(n):
        ahead, behind = (forward(robot, q[:-1] + side * np.eye(n)[joint]) for side in (h, -h))
        turned = Rotation.from_matrix(ahead[1]) * Rotation.from_matrix(behind[1]).inv()
        columns[:, :, joint] = np.hstack([ahead[0] - behind[0], turned.as_rotvec()]) / (2.0 * h)
    columns[:, :, frozen] = 0.0
    scaled = columns / weights
    k = np.linalg.solve(scaled @ np.swapaxes(columns, 1, 2), twists[:, :, None])
    return (np.swapaxes(scaled, 1, 2) @ k)[:, :, 0]


@dataclass(frozen=True)
class Motion:
    """Rows (N, n) of one motion with the row before it, and what was in force."""

    rows: np.ndarray
    limits: dict[str, Pair]
    frozen: list[int]
    drawn: bool
    dt: float

    @property
    def differences(self) -> Pair:
        v = np.diff(self.rows, axis=0) / self.dt
        return v, np.diff(np.vstack([0.0 * v[:1], v]), axis=0) / self.dt

    def assert_bounds(self, unit: float) -> None:
        v, a = self.differences
        lower, upper = self.limits["POSITION"]
        # Bounds went through degrees.
        assert np.all((self.rows >= lower - 1e-12) & (self.rows <= upper + 1e-12)), "position"
        for kind, values, slack in (
            ("SPEED", v, 2.0 * unit / self.dt),
            ("ACCELERATION", a, 4.0 * unit / self.dt**2),
        ):
            if kind in self.limits:
                lower, upper = self.limits[kind]
                over = np.maximum(values - upper * (1 + 1e-9), lower * (1 + 1e-9) - values) - slack
                assert np.max(over) <= 0.0, f"{kind} by {np.max(over):.3g}"
        assert np.all(self.rows[:, self.frozen] == self.rows[0, self.frozen]), "frozen"
        assert np.array_equal(self.rows[-1], self.rows[-2]), "no rest at the end"

    def turns(self) -> int:
        """Times that the joint which does so most goes from one acceleration bound to the other."""
        if "ACCELERATION" not in self.limits:
            return 0
        a = self.differences[1]
        lower, upper = self.limits["ACCELERATION"]
        sides = (a >= 0.9 * upper).astype(int) - (a <= 0.9 * lower).astype(int)
        most = 0
        for column in sides.T:
            held = column[column != 0]
            most = max(most, int(np.count_nonzero(np.diff(held))))
        return most

    def meets_limit(self) -> bool:
        """Whether a joint that moves comes to its position or speed limit."""
        lower, upper = self.limits["POSITION"]
        near = (self.rows - lower <= 3e-3) | (upper - self.rows <= 3e-3)
        fast = np.abs(self.differences[0]) >= 0.99 * self.limits["SPEED"][1]
        return bool(np.any(near & (np.ptp(self.rows, axis=0) > 0.0)) or np.any(fast))

    def stop(self, name: str, weights: np.ndarray) -> float:
        """Speed of the last step less what least motion needs, as a share of the governed rate."""
        if not self.drawn or len(self.rows) < 3:
            return 0.0
        needed = np.max(np.abs(least_motion(name, self.rows[-3:-1], weights, self.frozen)))
        step = np.abs(self.rows[-2] - self.rows[-3]) - OF_LEAST_MOTION * needed
        return float(np.max(step / (self.limits["SPEED"][1] * self.dt**2 / RAMP_TIME)))

    def beyond_governed(self, name: str, weights: np.ndarray) -> float:
        """Change of speed in a tick less what least motion needs, as a share of the governed rate."""
        least = least_motion(name, self.rows, weights, self.frozen) / self.dt
        needed = np.max(np.abs(np.diff(np.vstack([0.0 * least[:1], least]), axis=0)))
        change = np.max(np.abs(self.differences[1]), axis=0) * self.dt
        governed = self.limits["SPEED"][1] * self.dt / RAMP_TIME
        return float(np.max((change - OF_LEAST_MOTION * needed) / governed))


def motions(run: irlx.Run, drawn: Drawn) -> list[tuple[int, Motion]]:
    """Motions of a run with the index of their statements."""
    found, block = [], np.asarray(run.stream.block)
    lines = {record.block.id: record.block.origin.line for record in run.stream.records}
    for number in sorted(set(block[block > 0].tolist())):
        rows = np.flatnonzero(block == number)
        index = lines[number] - len(drawn.variables) - 4
        if index in drawn.in_force and rows.size > 1:
            limits, frozen, is_drawn = drawn.in_force[index]
            q = run.q[rows[0] - 1 : rows[-1] + 1]
            found.append((index, Motion(q, limits, [j - 1 for j in frozen], is_drawn, run.stream.dt)))
    return found


def one_case(folder: Path, name: str, tick: float, seed: int) -> tuple[str, int]:
    """Run and judge a drawn program: how it ended, and how many motions it had until then."""
    rng = np.random.default_rng([seed, int(1000 * tick), ROBOTS.index(name)])
    drawing = Drawing(rng, name, tick)
    (folder / "drawn.toml").write_text(drawing.cell(), encoding="utf-8")
    drawn = drawing.program()
    (folder / "drawn.irl").write_text(drawn.text(), encoding="utf-8")
    where, told = f"robot {name}, tick {tick} ms, seed {seed}", ""
    try:
        run, end = irlx.run(folder / "drawn.irl"), "complete"
        assert irlx.verify(run).passed, where
    except irlx.RunError as error:
        run, end, told = error.run, str(error.reason.code), str(error)
    assert end in {"complete", *REFUSALS}, f"{where}: {told}"
    if len(run.q) < 2:
        return end, 0
    unit = float(np.spacing(np.max(np.abs(run.q))))
    weights = np.asarray(run.stream.header.weights)
    found = motions(run, drawn)
    assert found, where
    for index, motion in found:
        told = f"{where}, {drawn.lines[index].strip()[:60]}"
        try:
            motion.assert_bounds(unit)
        except AssertionError as error:
            raise AssertionError(f"{told}: {error}") from error
        assert motion.turns() <= MOST_TURNS, f"{told}: {motion.turns()} turns between acceleration bounds"
        stop = motion.stop(name, weights)
        assert stop <= WITH_THE_TOOL, f"{told}: stops with {stop:.3g} of the governed rate"
        if motion.drawn and "ACCELERATION" not in motion.limits and not motion.meets_limit():
            beyond = motion.beyond_governed(name, weights)
            assert beyond <= 1.0, f"{told}: {beyond:.3g} of the governed rate"
    return end, len(found)


def cases() -> list:
    lacking = pytest.mark.skipif(robot_data_folder() is None, reason='pip install "irlx[robots]"')
    return [pytest.param(name, marks=lacking if name == "panda" else (), id=name) for name in ROBOTS]


@pytest.mark.parametrize(("name", "tick"), diagonal(cases(), TICKS[1:]))
def test_switching_keeps_every_bound(tmp_path, name: str, tick: float) -> None:
    ends = {seed: one_case(tmp_path, name, tick, seed) for seed in range(QUICK)}
    print(f"robot {name}, tick {tick} ms, seeds and ends: {ends}")
    assert len(ends) == QUICK


@pytest.mark.slow
@pytest.mark.parametrize("tick", TICKS)
@pytest.mark.parametrize("name", cases())
def test_long_campaign(tmp_path, name: str, tick: float) -> None:
    """Eight programs for each robot and tick; what a refused one did before counts too."""
    judged = [one_case(tmp_path, name, tick, 1000 + seed) for seed in range(LONG)]
    ends, count = [end for end, _ in judged], sum(motions for _, motions in judged)
    counts = {end: ends.count(end) for end in sorted(set(ends))}
    print(f"robot {name}, tick {tick} ms, seeds 1000 to {999 + LONG}: {counts}, {count} motions")
    assert count >= LONG, counts
