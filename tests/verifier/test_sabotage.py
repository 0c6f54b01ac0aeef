"""Real streams damaged in many ways: each damage is caught, under its name and at its place.

Two programs on arm7 that together use what the language has are run once. A damage changes the stream and is
written with write_stream, so that the checksum is right again, or changes the bytes of a file. Where joint
values are damaged, the recorded tool poses are left as they were, or made to fit with the verifier's own
forward kinematics: then everything but the damaged quantity speaks for the stream.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.linalg import null_space
from scipy.spatial.transform import Rotation

import irlx
from irlx.blocks import JointRange, MoveKind
from irlx.cell.load import load_cell
from irlx.cli.main import main
from irlx.robot.description import RobotDescription
from irlx.streams import BlockRecord, JointStream, StreamWriter, read_stream, write_stream
from irlx.streams.header_plain import header_to_plain
from irlx.verifier import Report, rows
from irlx.verifier.geometry.forward import forward
from long_run import chequered, first
from machines import machine

pytestmark = [pytest.mark.req("STR-06"), pytest.mark.usefixtures("read_once")]

UNWATCHED = "[robot.self_collision]\nactive = false\n"
"""To look at links that are kept off each other takes a third of the time: few tests of `whole` do."""
CELLS = {
    "whole": f"""[robot]
model = "arm7"
start = [15, 29, 0, 95, 9, 48, -13]
{UNWATCHED}[motion]
tick_ms = 10
speed = 250
acc = 1500
""",
    "limits": """[robot]
model = "arm7"
start = [42, 27, 0, 92, 9, 50, -10]
[robot.limits]
position = [170, 115, [-170, 4], [5, 145], 170, 120, 175]
speed = [20, 20, 30, 30, 40, 40, 40]
acceleration = [60, 60, 80, 80, 100, 100, 100]
[motion]
tick_ms = 10
speed = 2000
acc = 20000
""",
}
PROGRAMS = {
    "whole": """PROGRAM whole;
VAR
  MAIN_JOINT: ready := (42, 27, 0, 92, 9, 50, -10), folded := (50, 27, -12, 92, 20, 50, -20);
  POSE: home := HOME, place;
  MAIN_JOINT_SPEED_MIN: backward := (-15, -15, -15, -15, -20, -20, -20);
  MAIN_JOINT_SPEED_MAX: onward := (15, 15, 15, 15, 20, 20, 20);
BEGIN
  MOVE PTP ready SPEED_PTP := 50;                                      (* ptp *)
  FREEZESTART 3;                                                       (* freezing *)
  MOVE LIN home + POSITION(0, 60, 0);                                  (* frozen *)
  FREEZEEND;
  place := home + POSITION(0, 60, -80);
  MOVE LIN place;                                                      (* line *)
  MOVE LIN place + POSITION(0, -60, 0);                                (* corner *)
  place := (place + POSITION(0, -60, 0)) @ POSE(POSITION(0, 0, 0), ORIZYX(40, 10, 0));
  MOVE LIN place SPEED_ORI := 60;                                      (* turn *)
  MOVE CIRCLE place + POSITION(0, 40, 40), home;                       (* arc *)
  MOVE CIRCLE home + POSITION(0, 40, 40), home + POSITION(0, 0, 80) ANGLE := 360; (* round *)
  JOINTLIMIT (-170, -115, -170, 5, -170, -120, -175), (170, 115, 170, 145, 170, 120, 175); (* switch *)
  CYCLICSTART;                                                         (* cyclic *)
  MOVE LIN home + POSITION(-50, 0, -50);                               (* away *)
  MOVE LIN home;                                                       (* closing *)
  CYCLICEND;
  JOINTLIMITEND;
  RECONFIGURATION folded;                                              (* folding *)
  MOVE LIN home + POSITION(0, 100, 0) SPEED := 1000 WITH JOINTSPEEDLIMIT backward, onward; (* clause *)
  MOVE PTP home;                                                       (* pose *)
  MOVE LIN home + POSITION(0, 0, -60);                                 (* last *)
ENDPROGRAM;
""",
    "limits": """PROGRAM limits;
VAR
  POSE: home := HOME;
  MAIN_JOINT_MIN: low := (-170, -115, -170, 5, -170, -120, -175);
  MAIN_JOINT_MAX: high := (170, 115, 3, 145, 170, 120, 175), lower := (170, 115, 2, 145, 170, 120, 175);
  MAIN_JOINT_SPEED_MIN: backward := (-15, -15, -15, -15, -20, -20, -20);
  MAIN_JOINT_SPEED_MAX: onward := (15, 15, 15, 15, 20, 20, 20);
  MAIN_JOINT_ACCEL_MIN: braking := (-40, -40, -40, -40, -50, -50, -50);
  MAIN_JOINT_ACCEL_MAX: speeding := (40, 40, 40, 40, 50, 50, 50);
BEGIN
  MOVE LIN home + POSITION(-60, 150, -60);                             (* own *)
  MOVE LIN home;
  JOINTLIMIT low, high;
  JOINTSPEEDLIMIT backward, onward;
  JOINTACCELLIMIT braking, speeding;
  MOVE LIN home + POSITION(-60, 150, -60);                             (* switch *)
  MOVE LIN home;
  JOINTLIMITEND;
  JOINTSPEEDLIMITEND;
  JOINTACCELLIMITEND;
  MOVE LIN home + POSITION(-60, 150, -60)                              (* clause *)
    WITH JOINTLIMIT low, lower WITH JOINTSPEEDLIMIT backward, onward WITH JOINTACCELLIMIT braking, speeding;
ENDPROGRAM;
""",
}
LINES = {
    name: {
        tag[1]: number
        for number, line in enumerate(text.splitlines(), 1)
        if (tag := re.search(r"\(\* (\w+) \*\)", line))
    }
    for name, text in PROGRAMS.items()
}
"""Line of each statement that a comment names."""


@dataclass(frozen=True)
class Real:
    """A stream that irlx made, with its program, cell and robot."""

    name: str
    run: irlx.Run
    robot: RobotDescription
    folder: Path

    @property
    def stream(self) -> JointStream:
        return self.run.stream

    @property
    def program(self) -> Path:
        return self.folder / f"{self.name}.irl"

    @property
    def cell(self) -> Path:
        return self.folder / f"{self.name}.toml"

    def verify(self, stream: JointStream, ending: str = ".npz", watched: bool = False) -> Report:
        """Report on a stream, as a file, with program and cell, or one in which links are watched."""
        file = self.folder / f"damaged{ending}"
        write_stream(stream, file)
        return irlx.verify(file, program=self.program, cell=self.watching if watched else self.cell)

    @property
    def watching(self) -> Path:
        """The cell in which links are kept off each other."""
        file = self.folder / "watching.toml"
        file.write_text(CELLS[self.name].replace(UNWATCHED, ""), encoding="utf-8")
        return file


@pytest.fixture(scope="module")
def reals(tmp_path_factory) -> dict[str, Real]:
    """Both runs."""
    robot = machine("arm7")
    position, rotation = robot.pose(np.radians([42.0, 27.0, 0.0, 92.0, 9.0, 50.0, -10.0]))
    x, y, z, w = Rotation.from_matrix(rotation).as_quat().tolist()
    home = f"({tuple((1e3 * position).tolist())}, ORIQUAT{(w, x, y, z)})"
    found = {}
    for name, text in PROGRAMS.items():
        folder = tmp_path_factory.mktemp(name)
        (folder / f"{name}.toml").write_text(CELLS[name], encoding="utf-8")
        (folder / f"{name}.irl").write_text(text.replace("HOME", home), encoding="utf-8")
        run = irlx.run(folder / f"{name}.irl")
        found[name] = Real(name, run, load_cell(folder / f"{name}.toml").robot, folder)
    return found


@pytest.fixture(scope="module")
def whole(reals) -> Real:
    return reals["whole"]


@pytest.mark.parametrize("ending", [".irdata", ".npz", ".csv"])
@pytest.mark.parametrize("name", list(PROGRAMS))
def test_the_good_streams_pass(reals, name: str, ending: str) -> None:
    real = reals[name]
    report = real.verify(real.stream, ending, watched=True)
    assert report.passed, str(report)
    if ending != ".csv":
        assert not report.unchecked, str(report)


# ---- Where in a stream, and how to change it

Change = Callable[[Real], JointStream]


def block_of(real: Real, tag: str) -> int:
    line = LINES[real.name][tag]
    return next(r.block.id for r in real.stream.records if r.block.origin.line == line)


def rows_of(real: Real, tag: str) -> np.ndarray:
    rows = np.flatnonzero(real.stream.block == block_of(real, tag))
    assert rows.size, tag
    return rows


@dataclass(frozen=True)
class Place:
    """A row of a statement: the middle one of its rows, or the last one, and so many further."""

    tag: str
    of_rows: float
    further: int = 0

    def row(self, real: Real) -> int:
        rows = rows_of(real, self.tag)
        return int(rows[int(self.of_rows * (len(rows) - 1) + 0.5)]) + self.further


def mid(tag: str, further: int = 0) -> Place:
    return Place(tag, 0.5, further)


def last(tag: str, further: int = 0) -> Place:
    return Place(tag, 1.0, further)


def fitted(real: Real, stream: JointStream) -> JointStream:
    """The stream with the tool poses that its joint values give."""
    positions, rotations = forward(real.robot, stream.q)
    return replace(stream, tool=np.hstack([positions, Rotation.from_matrix(rotations).as_quat()]))


def with_q(real: Real, rows, values: np.ndarray | float, joint: int | slice = slice(None)) -> JointStream:
    q = real.stream.q.copy()
    q[rows, joint] = values
    return replace(real.stream, q=q)


def with_added(real: Real, rows, amount: np.ndarray | float, joint: int | slice = slice(None)) -> JointStream:
    return with_q(real, rows, real.stream.q[rows, joint] + amount, joint)


def jacobian(real: Real, q: np.ndarray) -> np.ndarray:
    """Jacobian (6, n) by central differences: m and rad in the world."""
    h, n = 1e-6, q.size
    positions, rotations = forward(real.robot, np.vstack([q + h * np.eye(n), q - h * np.eye(n)]))
    ahead, behind = Rotation.from_matrix(rotations[:n]), Rotation.from_matrix(rotations[n:])
    return np.hstack([positions[:n] - positions[n:], (ahead * behind.inv()).as_rotvec()]).T / (2.0 * h)


def tool_step(real: Real, row: int, twist: Sequence[float]) -> np.ndarray:
    """Joint step (n,) that moves the tool by a twist m, rad (what is not given is 0) from a row's posture."""
    whole_twist = np.append(twist, np.zeros(6 - len(twist)))
    return np.linalg.pinv(jacobian(real, real.stream.q[row])) @ whole_twist


def taken(stream: JointStream, rows: np.ndarray, ticks: np.ndarray | None = None) -> JointStream:
    """Some rows of a stream, under their own ticks or under others."""
    arrays = {name: getattr(stream, name)[rows] for name in ("q", "block", "tool")}
    return replace(stream, ticks=stream.ticks[rows] if ticks is None else ticks, **arrays)


# ---- Damages of joint values


def off(place: Place, amount: float, joint: int) -> Change:
    """One value of one joint (from 1) in one row."""
    return lambda real: with_added(real, place.row(real), amount, joint - 1)


def tool_off(place: Place, *twist: float) -> Change:
    """One row with the tool moved by a twist, m and rad."""
    return lambda real: with_added(real, place.row(real), tool_step(real, place.row(real), twist))


def end_off(tag: str, *twist: float) -> Change:
    """The last row that moves and the hold row, the tool moved by a twist."""

    def change(real: Real) -> JointStream:
        rows = rows_of(real, tag)[-2:]
        return with_added(real, rows, tool_step(real, rows[0], twist))

    return change


def one_ulp(place: Place, joint: int) -> Change:
    def change(real: Real) -> JointStream:
        value = real.stream.q[place.row(real), joint - 1]
        return with_q(real, place.row(real), np.nextafter(value, np.inf), joint - 1)

    return change


def minus_zero(place: Place, joint: int) -> Change:
    def change(real: Real) -> JointStream:
        assert str(real.stream.q[place.row(real), joint - 1]) == "0.0"
        return with_q(real, place.row(real), -0.0, joint - 1)

    return change


def exchanged(place: Place) -> Change:
    """Two rows in each other's place."""

    def change(real: Real) -> JointStream:
        pair = np.array([place.row(real), place.row(real) + 1])
        return with_q(real, pair, real.stream.q[pair[::-1]])

    return change


def corner_cut(real: Real) -> JointStream:
    """Straight through joint space from before the stop at a corner to behind it."""
    start, end = last("line", -9).row(real), last("line", 9).row(real)
    q = real.stream.q
    return with_q(real, slice(start, end + 1), np.linspace(q[start], q[end], end - start + 1))


def run_backwards(real: Real) -> JointStream:
    """A piece of the way: forth, back and forth again."""
    rows = rows_of(real, "line")[20:26]
    return with_q(real, rows, real.stream.q[rows[::-1]])


def not_run(real: Real) -> JointStream:
    """A full circle left out: it ends where it begins."""
    rows = rows_of(real, "round")
    return with_q(real, rows, real.stream.q[rows[0] - 1])


def stopped_short(real: Real) -> JointStream:
    """The last move stands still 2e-6 m before its goal, which it never reaches."""
    row = last("last", -1).row(real)
    way = real.stream.tool[row, :3] - real.stream.tool[row - 20, :3]
    step = tool_step(real, row, -2e-6 * way / np.linalg.norm(way))
    return with_added(real, [row, row + 1], step)


def drifted(real: Real) -> JointStream:
    """A closed path ends in another posture, the tool staying on it: each row is led back onto the path."""
    rows = rows_of(real, "closing")
    free = null_space(jacobian(real, real.stream.q[rows[-1]]))[:, 0]
    ramp = np.append(np.linspace(0.0, 1.0, len(rows) - 1), 1.0)
    q = real.stream.q[rows] + ramp[:, None] * 6e-6 * free / np.max(np.abs(free))
    positions, rotations = forward(real.robot, real.stream.q[rows])
    now = forward(real.robot, q)
    turns = (Rotation.from_matrix(rotations) * Rotation.from_matrix(now[1]).inv()).as_rotvec()
    twists = np.hstack([positions - now[0], turns])
    q += [np.linalg.pinv(jacobian(real, row)) @ twist for row, twist in zip(q, twists, strict=True)]
    q[-1] = q[-2]
    return with_q(real, rows, q)


def other_steps(tag: str, *factors: float) -> Change:
    """Steps in the middle of a move longer and shorter on the same way, as long together as they were."""

    def change(real: Real) -> JointStream:
        rows = rows_of(real, tag)
        q = real.stream.q[rows[0] - 1 : rows[-1] + 1]
        way = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(q, axis=0), axis=1)))
        moving = np.append(True, np.diff(way) > 0.0)
        curve = CubicSpline(way[moving], q[moving])
        steps = np.diff(way)
        part = slice(len(steps) // 2 - len(factors) // 2, None)
        part = slice(part.start, part.start + len(factors))
        scaled = steps[part] * factors
        steps[part] = scaled * steps[part].sum() / scaled.sum()
        inside = rows[part]
        return with_q(real, inside, curve(np.cumsum(steps)[part]))

    return change


def in_degrees(*joints: int) -> Change:
    columns = [joint - 1 for joint in joints] or slice(None)
    return lambda real: with_q(real, slice(None), np.degrees(real.stream.q[:, columns]), columns)


def columns_swapped(real: Real) -> JointStream:
    return with_q(real, slice(None), real.stream.q[:, [0, 1, 2, 3, 5, 4, 6]])


def bounds_in(real: Real, tag: str, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Limits (n,) of a kind in a statement of the program `limits`, as its text has them; rad."""
    highest = {"own": 4.0, "switch": 3.0, "clause": 2.0}[tag]
    size = {
        ("position", True): [170.0, 115.0, highest, 145.0, 170.0, 120.0, 175.0],
        ("position", False): [170.0, 115.0, highest, 145.0, 170.0, 120.0, 175.0],
        ("speed", True): [20.0, 20.0, 30.0, 30.0, 40.0, 40.0, 40.0],
        ("speed", False): [15.0] * 4 + [20.0] * 3,
        ("acceleration", True): [60.0, 60.0, 80.0, 80.0, 100.0, 100.0, 100.0],
        ("acceleration", False): [40.0] * 4 + [50.0] * 3,
    }[kind, tag == "own"]
    upper = np.radians(size)
    lower = np.radians([-170.0, -115.0, -170.0, 5.0, -170.0, -120.0, -175.0])
    return (lower if kind == "position" else -upper), upper


def most_used(real: Real, tag: str, kind: str) -> tuple[int, int, float]:
    """Row, joint (from 0) and bound where a statement uses a limit most."""
    values = {"position": real.stream.q, "speed": real.stream.qd, "acceleration": real.stream.qdd}[kind]
    rows = rows_of(real, tag)[:-1]
    lower, upper = bounds_in(real, tag, kind)
    room = np.minimum(values[rows] - lower, upper - values[rows]) / (upper - lower)
    place, joint = np.unravel_index(np.argmin(room), room.shape)
    assert room[place, joint] <= 0.01, f"{tag} leads no joint to its {kind} limit"
    value = values[rows[place], joint]
    bound = upper[joint] if upper[joint] - value < value - lower[joint] else lower[joint]
    return int(rows[place]), int(joint), float(bound)


def passed_limit(tag: str, kind: str, excess: float) -> Change:
    """The joint nearest to its limit of a kind put beyond it, by a share of it."""

    def change(real: Real) -> JointStream:
        row, joint, bound = most_used(real, tag, kind)
        wanted, dt, stream = bound * (1.0 + excess), real.stream.dt, real.stream
        if kind == "position":
            return with_q(real, row, wanted, joint)
        rates, unit = (stream.qd, dt) if kind == "speed" else (stream.qdd, dt**2)
        return with_added(real, row, (wanted - rates[row, joint]) * unit, joint)

    return change


@dataclass(frozen=True)
class Damage:
    """A change and the names of the checks that must fail; no other may, unless the names end in '..'.

    The first of them fails at a statement, or at one of its rows, or at a tick; at a joint. `small`: too
    small for the recorded tool poses to tell.
    """

    title: str
    change: Change
    names: str
    at: str | Place | int | None = None
    joint: int | None = None
    small: bool = False

    def assert_found(self, real: Real, report: Report) -> set[str]:
        """The checks fail, the first one at its place; returns which others fail beside them."""
        names = self.names.removesuffix(", ..").split(", ")
        failed = {check.name for check in report.failed}
        assert set(names) <= failed, str(report)
        first = report[names[0]].first
        if self.at is not None:
            assert first is not None, str(report)
        if isinstance(self.at, str | Place):
            tag = self.at if isinstance(self.at, str) else self.at.tag
            assert first.block == block_of(real, tag), first
            assert names[0] == "ticks" or first.line == LINES[real.name][tag], first
        if isinstance(self.at, Place | int):
            assert first.tick == (self.at if isinstance(self.at, int) else self.at.row(real)), first
        assert self.joint is None or first.joint == f"joint_{self.joint}", first
        return set() if self.names.endswith("..") else failed - set(names)


TURNED, MISSED, DRIFT = "path orientation", "goal position", "reconfiguration"
JOINT_DAMAGES = [
    Damage("2e-6 rad", off(mid("line"), 2e-6, 5), TURNED, mid("line")),
    Damage("2e-6 rad at the base", off(mid("corner"), -2e-6, 1), TURNED, mid("corner")),
    Damage("off a line", tool_off(mid("line"), 2e-6), "path position", mid("line")),
    Damage("off an arc", tool_off(mid("arc"), 2e-6), "path position", mid("arc")),
    Damage("turned on a line", tool_off(mid("last"), 0, 0, 0, 2e-6), TURNED, mid("last")),
    Damage("turned on an arc", tool_off(mid("arc"), 0, 0, 0, 2e-6, 2e-6), TURNED, mid("arc")),
    Damage("slipped in a turn", tool_off(mid("turn"), 0, 0, 2e-6), "path position", mid("turn")),
    Damage("off a PTP", off(mid("ptp"), 2e-6, 6), "PTP straight", mid("ptp")),
    Damage("back in a PTP", exchanged(mid("pose")), "PTP progress, ..", mid("pose", 1)),
    Damage("back on a line", exchanged(mid("line")), "path progress, ..", mid("line", 1)),
    Damage("back and forth on a line", run_backwards, "path progress, ..", "line"),
    Damage("a circle left out", not_run, "path progress, ..", last("round")),
    Damage("a corner cut", corner_cut, "path position, ..", last("line", -8)),
    Damage("a goal missed", end_off("last", 2e-6), "goal position, path position", last("last")),
    Damage("short of a goal", stopped_short, "goal position, path progress", last("last")),
    Damage("a goal turned", end_off("last", 0, 0, 0, 0, 2e-6), f"goal orientation, {TURNED}", last("last")),
    Damage("the goal of a PTP missed", end_off("pose", 0, 2e-6), "goal position, ..", last("pose")),
    Damage("joint values missed", end_off("ptp", 0, 0, 2e-6), "joint goal, ..", last("ptp")),
    Damage("a hold row moved", off(last("line"), 1e-12, 3), "stops", last("line"), 3, small=True),
    Damage("one ulp", one_ulp(mid("frozen"), 3), "frozen joints", mid("frozen"), 3, small=True),
    Damage("-0.0", minus_zero(mid("frozen"), 3), "frozen joints", mid("frozen"), 3, small=True),
    Damage("a path not closed", drifted, "cyclic closure", last("closing"), small=True),
    Damage("drift", tool_off(mid("folding"), 0, 0, 2e-6), "reconfiguration position", mid("folding")),
    Damage("turn", tool_off(mid("folding"), *[0] * 5, 2e-6), "reconfiguration orientation", mid("folding")),
    Damage("above SPEED", other_steps("line", *[1.01] * 6, *[0.99] * 6), "programmed speed", "line"),
    Damage("above SPEED on an arc", other_steps("arc", *[1.01] * 4, *[0.99] * 4), "programmed speed", "arc"),
    Damage("above SPEED_ORI", other_steps("turn", *[1.01] * 3, *[0.99] * 3), "programmed speed", "turn"),
    Damage("above SPEED_PTP", other_steps("ptp", 1.03, 1.03, 0.97, 0.97), "programmed speed", "ptp"),
    Damage("above ACC", other_steps("line", 0.8, 0.8, *[1.0] * 8), "programmed acceleration, ..", "line"),
    Damage("all in degrees", in_degrees(), "start, position limits, speed limits, ..", 0),
    Damage("a column in degrees", in_degrees(6), "start, position limits, ..", 0, 6),
    Damage("two columns swapped", columns_swapped, "path orientation, .."),
]
LIMITS = [
    (kind, tag) for kind in ("position", "speed", "acceleration") for tag in ("own", "switch", "clause")
]


@pytest.mark.parametrize(
    ("damage", "fits"),
    [
        # By default each damage one way; rows as far apart as degrees put them cost seconds.
        pytest.param(
            damage,
            fits,
            id=f"{damage.title}-tool poses {'fit' if fits else 'as before'}",
            marks=pytest.mark.slow if damage.title == "all in degrees" or (number + fits) % 2 else (),
        )
        for number, damage in enumerate(JOINT_DAMAGES)
        for fits in (True, False)
    ],
)
def test_damaged_joint_values(whole: Real, damage: Damage, fits: bool) -> None:
    stream = damage.change(whole)
    assert stream.q.tobytes() != whole.stream.q.tobytes()
    report = whole.verify(fitted(whole, stream) if fits else stream)
    of_tool = {check.name for check in report.failed} & {"tool position", "tool orientation"}
    assert bool(of_tool) == (not fits and not damage.small), str(report)
    assert damage.assert_found(whole, report) <= of_tool, str(report)


@pytest.mark.parametrize("damage", first(1, JOINT_DAMAGES[::24]), ids=lambda damage: damage.title)
def test_portions_make_no_difference(whole: Real, damage: Damage, monkeypatch) -> None:
    portions_make_no_difference(whole, damage, monkeypatch, 37)


@pytest.mark.slow
@pytest.mark.parametrize("damage", JOINT_DAMAGES, ids=lambda damage: damage.title)
def test_portions_make_no_difference_to_any(whole: Real, damage: Damage, monkeypatch) -> None:
    portions_make_no_difference(whole, damage, monkeypatch, 5)


def portions_make_no_difference(whole: Real, damage: Damage, monkeypatch, size: int) -> None:
    """The same findings where rows are looked at a few at a time."""

    def found(report: Report) -> list:
        firsts = [(check, check.first) for check in report.checks]
        return [(check.name, check.status, first and (first.tick, first.joint)) for check, first in firsts]

    stream = damage.change(whole)
    at_once = found(whole.verify(stream))
    monkeypatch.setattr(rows, "PORTION", size)
    assert found(whole.verify(stream)) == at_once


@pytest.mark.req("MOT-20")
@pytest.mark.parametrize(
    ("kind", "tag", "ending"),
    [
        # By default every other one, in formats by turns.
        pytest.param(
            *limit,
            ending,
            id=f"{'-'.join(limit)}-{ending}",
            marks=pytest.mark.slow if number % 2 or (number // 2 + other) % 2 else (),
        )
        for number, limit in enumerate(LIMITS)
        for other, ending in enumerate((".npz", ".irdata"))
    ],
)
def test_limits_passed_by_the_last_digits(reals, kind: str, tag: str, ending: str) -> None:
    """Against the robot's own limits, a switch and a clause: by 1e-8 of the bound, at the row and joint."""
    real = reals["limits"]
    row, joint, bound = most_used(real, tag, kind)
    report = real.verify(fitted(real, passed_limit(tag, kind, 1e-8)(real)), ending)
    check = report[f"{kind} limits"]
    assert check.status == "failed", str(report)
    assert (check.first.tick, check.first.joint) == (row, f"joint_{joint + 1}")
    assert check.first.allowed == pytest.approx(bound, rel=1e-12)
    assert check.first.value == pytest.approx(bound * (1.0 + 1e-8), rel=2e-9)
    assert check.first.line == LINES["limits"][tag]
    # On the bound itself it is fine, as far as this check goes.
    assert real.verify(fitted(real, passed_limit(tag, kind, 0.0)(real)))[f"{kind} limits"].status == "ok"


@pytest.mark.parametrize("tag", ["own", "switch", "clause"])
def test_a_speed_spike(reals, tag: str) -> None:
    """A joint at its limit is 1 % faster for one tick."""
    real = reals["limits"]
    row, joint, _ = most_used(real, tag, "speed")
    report = real.verify(fitted(real, passed_limit(tag, "speed", 0.01)(real)))
    first = report["speed limits"].first
    assert first is not None, str(report)
    assert (first.tick, first.joint) == (row, f"joint_{joint + 1}")
    assert report["path orientation"].status == "failed"


# ---- Damages of rows, records and header


def without_row(place: Place) -> Change:
    """A row less; ticks and block records are counted anew as if it had never been."""

    def change(real: Real) -> JointStream:
        gone, stream = place.row(real), real.stream
        kept = np.delete(np.arange(len(stream.ticks)), gone)
        records = tuple(replace(r, tick=r.tick - (r.tick >= gone)) for r in stream.records)
        return replace(taken(stream, kept, np.arange(len(kept))), records=records)

    return change


def rows_in_order(order: Callable[[np.ndarray, int], np.ndarray], place: Place) -> Change:
    """Rows under their own ticks, in the order that a function makes of their numbers."""
    return lambda real: taken(real.stream, order(np.arange(len(real.stream.ticks)), place.row(real)))


def with_ticks(change: Callable[[np.ndarray], np.ndarray]) -> Change:
    return lambda real: replace(real.stream, ticks=change(real.stream.ticks))


def without_record(tag: str, renumbered: bool) -> Change:
    """The block of an option away, with the ids of those behind it counted anew or not."""

    def change(real: Real) -> JointStream:
        gone, stream = block_of(real, tag), real.stream
        records = tuple(r for r in stream.records if r.block.id != gone)
        if not renumbered:
            return replace(stream, records=records)
        records = tuple(
            replace(r, block=replace(r.block, id=r.block.id - (r.block.id > gone))) for r in records
        )
        return replace(stream, records=records, block=stream.block - (stream.block > gone))

    return change


def edited(tag: str, **parts) -> Change:
    """Parts of the block of a statement changed: values, or functions of the old ones."""

    def change(real: Real) -> JointStream:
        wanted, records = block_of(real, tag), []
        for record in real.stream.records:
            block = record.block
            if block.id == wanted:
                new = {k: part(getattr(block, k)) if callable(part) else part for k, part in parts.items()}
                block = replace(block, **new)
            records.append(replace(record, block=block))
        return replace(real.stream, records=tuple(records))

    return change


def begun_later(real: Real) -> JointStream:
    """The stream from the end of its first move on, as if it had begun there."""
    stream = real.stream
    first = int(np.flatnonzero(stream.block == 1)[-1])
    records = [
        BlockRecord(record.tick - first, replace(record.block, id=record.block.id - 1))
        for record in stream.records[1:]
    ]
    block = np.where(stream.block > 1, stream.block - 1, 0)[first:]
    arrays = {"q": stream.q[first:], "tool": stream.tool[first:], "block": block}
    return replace(stream, ticks=np.arange(len(block)), records=tuple(records), **arrays)


def moved(x: float, y: float, z: float) -> Callable:
    """A target elsewhere, m."""
    return lambda target: replace(target, position=tuple(np.add(target.position, (x, y, z)).tolist()))


def via_moved(x: float, y: float, z: float) -> Callable:
    return lambda course: replace(course, via=moved(x, y, z)(course.via))


def values_plus(amount: float) -> Callable:
    """Joint values of a target with the first one larger, rad."""
    return lambda target: replace(target, values=(target.values[0] + amount, *target.values[1:]))


def scaled(name: str, factor: float) -> Callable:
    """An entry of a part of a block larger or smaller."""
    return lambda part: replace(part, **{name: factor * getattr(part, name)})


def with_time(duration: float) -> Callable:
    """A law that asks for a duration, s."""
    return lambda law: replace(law, duration=duration)


def clause_scaled(factor: float) -> Callable:
    """The range of a move's only clause, wider or narrower."""

    def change(clauses):
        (clause,) = clauses
        sides = (clause.range.lower, clause.range.upper)
        lower, upper = (tuple(factor * value for value in side) for side in sides)
        return (replace(clause, range=JointRange(lower, upper)),)

    return change


def shifted(tool: np.ndarray) -> np.ndarray:
    return np.vstack([tool[:1], tool[:-1]])


def header_with(**parts) -> Change:
    """Entries of the header changed: values, or functions of the old ones."""

    def change(real: Real) -> JointStream:
        header = real.stream.header
        new = {k: part(getattr(header, k)) if callable(part) else part for k, part in parts.items()}
        return replace(real.stream, header=replace(header, **new))

    return change


def limits_scaled(kind: str, factor: float) -> Callable:
    return lambda limits: limits.with_pair(kind, *(factor * side for side in limits.pair(kind)))


def tool_columns(change: Callable[[np.ndarray], np.ndarray]) -> Change:
    return lambda real: replace(real.stream, tool=np.ascontiguousarray(change(real.stream.tool)))


def cut_and_called_complete(real: Real) -> JointStream:
    """Everything behind a move away, records included, the stream still calling itself complete."""
    end = last("arc").row(real)
    records = tuple(r for r in real.stream.records if r.tick < end)
    return replace(taken(real.stream, np.arange(end + 1)), records=records)


def cut_in_motion(real: Real) -> JointStream:
    end = mid("clause").row(real)
    records = tuple(r for r in real.stream.records if r.tick < end)
    return replace(taken(real.stream, np.arange(end + 1)), records=records, complete=True)


OTHER_DAMAGES = [
    Damage("last hold row away", without_row(last("last")), "stops", last("last", -1)),
    Damage("a hold row away in the middle", without_row(last("line")), "stops", last("line", -1)),
    Damage("a row away at a limit", without_row(mid("clause")), "speed limits, ..", mid("clause")),
    Damage("a row away at SPEED", without_row(mid("line")), "programmed speed, ..", mid("line")),
    Damage("not complete", lambda real: replace(real.stream, complete=False), "complete"),
    Damage("cut and called complete", cut_and_called_complete, "program"),
    Damage("cut in motion and called complete", cut_in_motion, "stops, program, ..", mid("clause")),
    Damage("a tick dropped", rows_in_order(np.delete, mid("line")), "ticks", mid("line", 1)),
    Damage("ticks from 1 on", with_ticks(lambda ticks: ticks + 1), "ticks", 1),
    Damage("every other tick", with_ticks(lambda ticks: 2 * ticks), "ticks", 2),
    Damage("half a tick", header_with(tick_ns=5_000_000), "programmed speed, speed limits, ..", "ptp"),
    Damage("a joint's name", header_with(joint_names=lambda names: ("other", *names[1:])), "robot"),
    Damage("joints in another order", header_with(joint_names=lambda names: names[::-1]), "robot"),
    Damage("a unit", header_with(joint_units=lambda units: ("m", *units[1:])), "robot"),
    Damage("the tool frame", header_with(tip="flange"), "robot"),
    Damage("the fingerprint", header_with(robot_fingerprint="0" * 64), "robot"),
    Damage("its last digit", header_with(robot_fingerprint=lambda text: text[:-1] + "x"), "robot"),
    Damage("another robot", header_with(robot_model="rail6", robot_fingerprint="0" * 64), "robot"),
    Damage("wider positions", header_with(limits=limits_scaled("position", 1.0 + 1e-15)), "robot limits"),
    Damage("wider speeds", header_with(limits=limits_scaled("speed", 2.0)), "robot limits"),
    Damage("no accelerations", header_with(limits=limits_scaled("acceleration", np.inf)), "robot limits"),
    Damage("another checksum", header_with(program_sha256="0" * 64), "program"),
    Damage("tool a tick late", tool_columns(shifted), "tool position, tool orientation", 1),
    Damage("tool 2e-9 m off", tool_columns(lambda tool: np.add(tool, [2e-9] + [0] * 6)), "tool position", 0),
    Damage("tool in mm", tool_columns(lambda tool: tool * ([1e3] * 3 + [1.0] * 4)), "tool position", 0),
    Damage("w first", tool_columns(lambda tool: tool[:, [0, 1, 2, 6, 3, 4, 5]]), "tool orientation", 0),
    Damage("begun after its first move", begun_later, "start, program", 0),
    Damage("FREEZESTART away", without_record("freezing", True), "program"),
    Damage("FREEZESTART away, a gap left", without_record("freezing", False), "blocks, .."),
    Damage("CYCLICSTART away", without_record("cyclic", True), "program"),
    Damage("CYCLICSTART away, a gap left", without_record("cyclic", False), "blocks, .."),
    Damage("JOINTLIMIT away", without_record("switch", True), "program"),
    Damage("JOINTLIMIT away, a gap left", without_record("switch", False), "blocks, .."),
    Damage("a move's record away", without_record("corner", False), "blocks, .."),
    Damage(
        "1 mm further", edited("last", target=moved(0, 0, -1e-3)), "path progress, goal position, program, .."
    ),
    Damage(
        "1 mm less", edited("last", target=moved(0, 0, 1e-3)), "goal position, path position, program, .."
    ),
    Damage("1 mm aside", edited("corner", target=moved(1e-3, 0, 0)), "path position, program, ..", "corner"),
    Damage(
        "other joint values", edited("ptp", target=values_plus(2e-9)), "joint goal, program", last("ptp"), 1
    ),
    Damage("SPEED raised", edited("line", law=scaled("speed", 2.0)), "program"),
    Damage(
        "SPEED lowered by 1 %", edited("line", law=scaled("speed", 0.99)), "programmed speed, program", "line"
    ),
    Damage(
        "ACC lowered", edited("line", law=scaled("acc", 0.9)), "programmed acceleration, program, ..", "line"
    ),
    Damage(
        "SPEED_PTP lowered", edited("ptp", law=scaled("speed_ptp", 0.8)), "programmed speed, program", "ptp"
    ),
    Damage("TIME added", edited("line", law=with_time(9.0)), "programmed time, program"),
    Damage("a clause wider", edited("clause", limits=clause_scaled(1.5)), "program"),
    Damage(
        "a clause narrower", edited("clause", limits=clause_scaled(0.95)), "speed limits, program", "clause"
    ),
    Damage("a clause away", edited("clause", limits=()), "program"),
    Damage("LIN called PTP", edited("line", kind=MoveKind.PTP), "PTP straight, program, ..", "line"),
    Damage(
        "ANGLE doubled",
        edited("round", course=scaled("angle", 2.0)),
        "path progress, program, ..",
        last("round"),
    ),
    Damage("another via", edited("arc", course=via_moved(1e-3, 0, 0)), "path position, program, ..", "arc"),
    Damage("another joint frozen", edited("freezing", joints=(4,)), "frozen joints, program", "frozen", 4),
    Damage("another posture", edited("folding", target=values_plus(0.1)), "program"),
]


WATCHED = {
    "a corner cut",
    "back and forth on a line",
    "cut in motion and called complete",
    "two columns swapped",
}
"""Damages that are looked at with links watched as well."""


@pytest.mark.parametrize(
    ("damage", "ending"),
    chequered([pytest.param(damage, id=damage.title) for damage in OTHER_DAMAGES], [".npz", ".irdata"]),
)
def test_damaged_rows_records_and_headers(whole: Real, damage: Damage, ending: str) -> None:
    report = whole.verify(damage.change(whole), ending)
    assert not damage.assert_found(whole, report), str(report)
    assert all(check.text for check in report.failed), str(report)


@pytest.mark.parametrize(
    "damage",
    [one for one in (*JOINT_DAMAGES, *OTHER_DAMAGES) if one.title in WATCHED],
    ids=lambda damage: damage.title,
)
def test_links_that_are_watched_change_no_other_check(whole: Real, damage: Damage) -> None:
    stream = damage.change(whole)
    found, without = whole.verify(stream, watched=True), whole.verify(stream)
    assert found["clearance"].status in ("ok", "failed")
    assert without["clearance"].status == "no case"
    failed, due = ({check.name for check in report.failed} for report in (found, without))
    assert failed - {"clearance"} == due, str(found)


@pytest.mark.parametrize(
    ("order", "later"),
    [
        (lambda rows, row: np.insert(rows, row, row), 1),
        (lambda rows, row: np.concatenate([rows[:row], rows[row : row + 2][::-1], rows[row + 2 :]]), 0),
    ],
    ids=["doubled", "swapped"],
)
def test_ticks_that_do_not_rise(whole: Real, order: Callable, later: int, monkeypatch) -> None:
    """No writer takes such ticks, and NPZ refuses to read them; in memory they are found as well."""
    monkeypatch.setattr(StreamWriter, "_check", lambda *_: None)
    place = mid("line")
    stream = rows_in_order(order, place)(whole)
    found = irlx.verify(replace(whole.run, stream=stream), whole.program, whole.cell)["ticks"]
    assert found.status == "failed"
    assert found.first is not None
    assert found.first.allowed == place.row(whole) + later
    report = whole.verify(stream)
    assert {check.name for check in report.failed} & {"ticks", "file"}, str(report)


def test_not_a_number(whole: Real, monkeypatch) -> None:
    """No writer takes them; a file that holds them all the same is found out."""
    monkeypatch.setattr(StreamWriter, "_check", lambda *_: None)
    report = whole.verify(with_q(whole, 40, np.nan, 5), watched=True)
    first = report["finite values"].first
    assert first is not None, str(report)
    assert (first.tick, first.joint) == (40, "joint_6")
    tool = whole.stream.tool.copy()
    tool[50, 4] = np.inf
    first = whole.verify(replace(whole.stream, tool=tool))["finite values"].first
    assert first is not None
    assert first.tick == 50


def test_motion_before_the_first_block(whole: Real) -> None:
    """Rows that no block asked for, from the start and back to it, under the id 0 of the start posture."""
    stream, count = whole.stream, 80
    share = np.linspace(0.0, 1.0, count)
    bump = 16.0 * (share * (1.0 - share)) ** 2
    astray = stream.q[0] + np.outer(bump, np.radians([2.0, 0.0, 0.0, 2.0, 0.0, 0.0, 2.0]))
    q = np.vstack([stream.q[:1], astray, stream.q])
    added = len(q) - len(stream.q)
    longer = replace(
        stream,
        q=q,
        ticks=np.arange(len(q)),
        block=np.concatenate([np.zeros(added, np.int64), stream.block]),
        tool=np.zeros((len(q), 7)),
        records=tuple(replace(record, tick=record.tick + added) for record in stream.records),
    )
    report = whole.verify(fitted(whole, longer))
    assert {check.name for check in report.failed} & {"blocks", "stops"}, str(report)


@pytest.mark.parametrize("ending", [".npz", ".irdata"])
def test_motion_without_any_block(whole: Real, tmp_path: Path, ending: str) -> None:
    """Records away and ids 0: without its program, too, a moving stream must not pass for one that stands."""
    stream = replace(whole.stream, records=(), block=np.zeros_like(whole.stream.block))
    write_stream(stream, file := tmp_path / f"a{ending}")
    assert "program" in {check.name for check in irlx.verify(file, whole.program, whole.cell).failed}
    report = irlx.verify(file, cell=whole.cell)
    assert {check.name for check in report.failed} & {"blocks", "stops"}, str(report)


# ---- Damages of what the stream is compared with


def test_the_cell_of_another_robot(whole: Real, tmp_path: Path) -> None:
    (tmp_path / "rail.toml").write_text('[robot]\nmodel = "rail6"\n', encoding="utf-8")
    write_stream(whole.stream, file := tmp_path / "a.irdata")
    report = irlx.verify(file, cell=tmp_path / "rail.toml")
    assert [check.name for check in report.failed] == ["robot"] or report["robot"].status == "failed"
    assert report["path position"].status == "not checked"


def test_a_cell_with_other_limits(whole: Real, tmp_path: Path) -> None:
    text = CELLS["whole"].replace("[motion]", f"[robot.limits]\nspeed = [{'100, ' * 7}]\n[motion]")
    (tmp_path / "narrow.toml").write_text(text, encoding="utf-8")
    write_stream(whole.stream, file := tmp_path / "a.irdata")
    report = irlx.verify(file, cell=tmp_path / "narrow.toml")
    assert {check.name for check in report.failed} == {"robot limits"}
    assert "joint_1" in report["robot limits"].text


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("POSITION(0, 0, -60)", "POSITION(0, 0, -61)", "last"),
        ("SPEED_ORI := 60", "SPEED_ORI := 61", "turn"),
        ("FREEZESTART 3", "FREEZESTART 2", "freezing"),
        ("ANGLE := 360", "ANGLE := 361", "round"),
        (" (* pose *)", " HALT;", None),
    ],
)
def test_another_program_under_the_right_checksum(
    whole: Real, tmp_path: Path, old: str, new: str, line: str | None
) -> None:
    """The header claims the text that is given; the blocks tell."""
    text = whole.program.read_text(encoding="utf-8")
    assert text.count(old) == 1
    (tmp_path / "whole.irl").write_text(text.replace(old, new), encoding="utf-8")
    checksum = sha256((tmp_path / "whole.irl").read_bytes()).hexdigest()
    write_stream(header_with(program_sha256=checksum)(whole), file := tmp_path / "a.npz")
    report = irlx.verify(file, tmp_path / "whole.irl", whole.cell)
    assert {check.name for check in report.failed} == {"program"}, str(report)
    assert line is None or f"line {LINES['whole'][line]}" in report["program"].text


def test_another_text_of_the_same_program(whole: Real, tmp_path: Path) -> None:
    text = whole.program.read_text(encoding="utf-8")
    (tmp_path / "whole.irl").write_text(text.replace("(* arc *)", "(* bow *)"), encoding="utf-8")
    write_stream(whole.stream, file := tmp_path / "a.csv")
    report = irlx.verify(file, tmp_path / "whole.irl", whole.cell)
    assert {check.name for check in report.failed} == {"program"}, str(report)


# ---- Damages of files


@pytest.fixture(scope="module")
def saved_arrays(whole: Real, tmp_path_factory) -> dict[str, np.ndarray]:
    """What an NPZ of the stream holds; saved again by NumPy it is as good."""
    folder = tmp_path_factory.mktemp("saved")
    write_stream(whole.stream, folder / "a.npz")
    with np.load(folder / "a.npz") as file:
        arrays = dict(file)
    np.savez(folder / "b.npz", **arrays)
    assert irlx.verify(folder / "b.npz", whole.program, whole.cell).passed
    return arrays


@pytest.mark.parametrize(
    ("key", "change", "name"),
    [
        ("qd", lambda a: a * (1.0 + 1e-6), "written rates"),
        ("qd", lambda a: np.roll(a, 1, axis=0), "written rates"),
        ("qdd", lambda a: np.where(np.arange(len(a))[:, None] == 100, a + 1e-3, a), "written rates"),
        ("t", lambda a: a + 1e-9, "written rates"),
        ("t", lambda a: 2.0 * a, "written rates"),
        ("t", lambda a: a * np.nan, "written rates"),
        ("q", lambda a: np.roll(a, 1, axis=0), "written rates"),
        ("q", lambda a: a.astype(np.float32), "file"),
        ("q", lambda a: a[:-1], "file"),
        ("qd", lambda a: a[:, :-1], "file"),
        ("block", lambda a: a.astype(np.int32), "file"),
        ("block", lambda a: a[::-1].copy(), "blocks"),
        ("joint_names", lambda a: a[::-1].copy(), "file"),
    ],
)
def test_npz_saved_again_with_an_array_changed(
    whole: Real, saved_arrays, tmp_path: Path, key: str, change: Callable, name: str
) -> None:
    np.savez(tmp_path / "b.npz", **{**saved_arrays, key: change(saved_arrays[key])})
    report = irlx.verify(tmp_path / "b.npz", whole.program, whole.cell)
    assert report[name].status == "failed", str(report)
    if name == "written rates":
        assert report[name].first is not None


def test_a_csv_with_other_rates_and_the_right_checksum(whole: Real, tmp_path: Path) -> None:
    write_stream(whole.stream, file := tmp_path / "a.csv")
    *lines, _ = file.read_bytes().splitlines(keepends=True)
    names = next(line for line in lines if not line.startswith(b"#")).decode().strip().split(",")
    column, head = names.index("qd_joint_2"), len(lines) - len(whole.stream.ticks)
    words = lines[head + 60].split(b",")
    words[column] = repr(float(words[column]) + 1e-6).encode()
    lines[head + 60] = b",".join(words)
    body = b"".join(lines)
    end = {"samples": len(whole.stream.ticks), "complete": True, "sha256": sha256(body).hexdigest()}
    file.write_bytes(body + f"# end: {json.dumps(end)}\n".encode())
    report = irlx.verify(file, whole.program, whole.cell)
    assert {check.name for check in report.failed} == {"written rates"}, str(report)
    first = report["written rates"].first
    assert first is not None
    assert (first.tick, first.joint) == (60, "joint_2")


@pytest.mark.parametrize("ending", [".irdata", ".csv"])
def test_a_wrong_checksum(whole: Real, tmp_path: Path, ending: str) -> None:
    write_stream(whole.stream, file := tmp_path / f"a{ending}")
    data = file.read_bytes()
    place = data.rindex(b'"') - 1
    file.write_bytes(data[:place] + (b"0" if data[place : place + 1] != b"0" else b"1") + data[place + 1 :])
    report = irlx.verify(file, whole.program, whole.cell)
    assert {check.name for check in report.failed} == {"file"}, str(report)
    assert "IRL702" in report["file"].text


@pytest.fixture(scope="module")
def small(reals, tmp_path_factory) -> Real:
    """A file of some thirty records, of every kind but that of a LIN."""
    folder = tmp_path_factory.mktemp("small")
    (folder / "small.toml").write_text(
        CELLS["whole"].replace("tick_ms = 10", "tick_ms = 100"), encoding="utf-8"
    )
    body = (
        "  FREEZESTART 3;\n  CYCLICSTART;\n  MOVE PTP a;\n  FREEZEEND;\n"
        "  RECONFIGURATION a;\n  JOINTLIMIT (-170, -115, -170, 5, -170, -120, -175), "
        "(170, 115, 170, 145, 170, 120, 175);\n  JOINTLIMITEND;\n  HALT;\n  CYCLICEND;\n"
    )
    start = "(15, 29, 0, 95, 9, 50, -13)"
    text = f"PROGRAM small;\nVAR MAIN_JOINT: a := {start};\nBEGIN\n{body}ENDPROGRAM;\n"
    (folder / "small.irl").write_text(text, encoding="utf-8")
    run = irlx.run(folder / "small.irl")
    return Real("small", run, reals["whole"].robot, folder)


def kind_of(byte: int) -> str:
    text = chr(byte)
    if text.isdigit():
        return "digit"
    return "letter" if text.isalpha() else text


def places(data: bytes) -> list[int]:
    """A place of every kind of byte in every kind of line."""
    found: dict[tuple[bytes, str], int] = {}
    start = 0
    for line in data.splitlines(keepends=True):
        words = line.split(b",")
        key = words[1] if len(words) > 1 and words[1].strip().isdigit() else words[0][:6]
        for offset in range(len(line)):
            found.setdefault((key, kind_of(line[offset])), start + offset)
        start += len(line)
    return sorted(found.values())


def content(stream: JointStream) -> tuple:
    """All that a stream says, to compare it by."""
    arrays = (stream.ticks, stream.q, stream.block, stream.tool)
    header = str(header_to_plain(stream.header))
    return (*(array.tobytes() for array in arrays), header, stream.records, stream.complete)


BITS = (0, 4, 7)


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("turn", first(1, range(len(BITS))))
@pytest.mark.parametrize("ending", [".irdata", ".csv", ".npz"])
def test_a_bit_of_every_kind_of_byte_flipped(small: Real, tmp_path: Path, ending: str, turn: int) -> None:
    """The file fails, or, in the parts of an NPZ that mean nothing, gives the very same stream.

    Three bits take turns from byte to byte; after three turns each byte has had them all.
    """
    write_stream(small.stream, file := tmp_path / f"a{ending}")
    data = file.read_bytes()
    every = places(data) if ending != ".npz" else list(range(0, len(data), len(data) // 60))
    assert len(every) >= 40
    for number, place in enumerate(every, turn):
        damaged = bytearray(data)
        damaged[place] ^= 1 << BITS[number % len(BITS)]
        file.write_bytes(damaged)
        report = irlx.verify(file, small.program, small.cell)
        if report.passed:
            assert ending == ".npz", (place, bytes(data[place - 20 : place + 20]))
            assert content(read_stream(file)) == content(small.stream), place
        else:
            assert report["file"].status == "failed", (place, str(report))
            assert "IRL70" in report["file"].text


@pytest.mark.req("STR-01")
@pytest.mark.parametrize("ending", [".irdata", ".csv"])
def test_cut_behind_every_record(small: Real, tmp_path: Path, ending: str) -> None:
    write_stream(small.stream, file := tmp_path / f"a{ending}")
    lines = file.read_bytes().splitlines(keepends=True)
    for count in range(len(lines)):
        for half in (b"", lines[count][: len(lines[count]) // 2]):
            file.write_bytes(b"".join(lines[:count]) + half)
            report = irlx.verify(file, small.program, small.cell)
            failed = {check.name for check in report.failed}
            assert failed & {"file", "complete"}, (count, half, str(report))
            assert failed <= {"file", "complete", "ticks"}, (count, half, str(report))


def test_a_record_of_the_file_away(small: Real, tmp_path: Path) -> None:
    """One line less, the rest as it was, and with numbers and checksum made right again."""
    write_stream(small.stream, file := tmp_path / "a.irdata")
    lines = file.read_bytes().splitlines(keepends=True)
    for gone in range(len(lines) - 1):
        kept = lines[:gone] + lines[gone + 1 : -1]
        file.write_bytes(b"".join([*kept, lines[-1]]))
        assert irlx.verify(file, small.program, small.cell)["file"].status == "failed", gone
        body = b"".join(b"%d%b" % (i, line[line.index(b",") :]) for i, line in enumerate(kept, 1))
        samples = sum(line.split(b", ")[1] == b"900" for line in kept)
        end = (
            f'{len(kept) + 1}, 999, samples={samples}, complete=true, sha256="{sha256(body).hexdigest()}" ;\n'
        )
        file.write_bytes(body + end.encode())
        report = irlx.verify(file, small.program, small.cell)
        assert not report.passed, (gone, lines[gone])


def test_no_file(whole: Real, tmp_path: Path) -> None:
    with pytest.raises(irlx.IrlxError, match="IRL001"):
        irlx.verify(tmp_path / "none.irdata", whole.program, whole.cell)


# ---- The command


def test_the_command_names_tick_joint_and_value(whole: Real, tmp_path: Path, capsys) -> None:
    row = mid("ptp").row(whole)
    write_stream(fitted(whole, off(mid("ptp"), 2e-3, 6)(whole)), file := tmp_path / "a.irdata")
    command = ["verify", str(file), "--cell", str(whole.cell), "--program", str(whole.program), "--json"]
    assert main(command) == 1
    report = json.loads(capsys.readouterr().out)
    assert not report["passed"]
    failed = {check["name"]: check for check in report["checks"] if check["status"] == "failed"}
    assert {"PTP straight", "acceleration limits"} <= set(failed)
    assert failed["PTP straight"]["first"]["tick"] == row
    assert failed["PTP straight"]["worst"]["joint"] == "joint_6"
    first = failed["acceleration limits"]["first"]
    assert (first["tick"], first["joint"], first["line"]) == (row, "joint_6", LINES["whole"]["ptp"])
    own = whole.stream.qdd[row, 5] + 2e-3 / whole.stream.dt**2
    assert first["value"] == pytest.approx(own, rel=1e-9)
    write_stream(whole.stream, file)
    assert main(command) == 0
    assert json.loads(capsys.readouterr().out)["passed"]
