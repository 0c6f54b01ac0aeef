"""Random scenes: a robot that keeps clear of what is switched on, or says why it cannot.

Every scene ends in one of two ways. Each motion keeps its path, its limits and every margin, by measures
that share nothing with what made it; or it is refused by a code of the diagnostics, and nothing is emitted.

- Distances by the verifier's own search, between its own bodies, at every row. What was inside its margin at
  the start of a motion stays as near as it was.
- The tool on its straight line, by the verifier's forward kinematics.
- Limits and jumps by differences of the rows, from rest to rest.
- No oscillation: see `turns` and `flicker`.

A failing scene is repeated by its seed, which is in its message.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drawn_scenes import DrawnScene, drawn_scene
from irlx.blocks import FreezeBlock, MoveBlock, MoveKind, ObstacleBlock
from irlx.diagnostics import Diagnostic, IrlxError, Place, SourceText, Span
from irlx.pacing.pacer import Pacer
from irlx.pacing.rows import MotionRows
from irlx.scene.obstacle import Obstacle
from irlx.verifier.clearance.pairs import Bodies, Places, meetings, obstacle_pairs
from irlx.verifier.clearance.search import capped_distances
from irlx.verifier.geometry.forward import forward
from long_run import first

pytestmark = [pytest.mark.req("TRF-13"), pytest.mark.req("TRF-14")]

QUICK = (0, 1, 4, 7, 10, 13, 15, 17, 18, 19, 32, 33, 37, 40, 152, 153, 157, 166, 179)
"""Seeds of scenes of all kinds that take little time."""

SWINGING = (1409, 1197)
"""Seeds of scenes in which pushes make joints swing: beside a cube; a link that goes with the tool."""

LONG = 500
MOST_TURNS, MOST_FLICKER = 12, 4
REFUSALS = {
    "IRL343",
    "IRL345",
    "IRL346",
    "IRL347",
    "IRL424",
    "IRL520",
    "IRL521",
    "IRL522",
    "IRL523",
    "IRL524",
    "IRL560",
    "IRL561",
}
"""Codes with which motions may be refused; IRL562 is none, since no scene begins in a collision."""

MARGIN_TOLERANCE, PATH_TOLERANCE, LIMIT_TOLERANCE = 1e-6, 1e-6, 1e-9
TEXT = SourceText("drawn.irl", "-\n")


def sides(q: np.ndarray, dt: float, limits) -> np.ndarray:
    """Which way each joint is accelerated in each row (N, n): 1, -1, or 0 for hardly at all.

    Rows q (N, n) from rest to rest. An acceleration counts where it exceeds a tenth of the largest of its
    joint in the motion, and what takes that joint to its full speed in 20 s: the rest is noise.
    """
    v = np.diff(np.vstack([q[:1], q, q[-1:]]), axis=0) / dt
    a = np.diff(v, axis=0) / dt
    band = np.maximum(0.1 * np.max(np.abs(a), axis=0), 0.05 * limits.speed_upper)
    return np.where(a > band, 1, np.where(a < -band, -1, 0))


def turns(side: np.ndarray) -> int:
    """Times that the joint which does so most turns its acceleration round.

    A joint that starts, gives way, comes back and stops does so a few times, whatever the tick; one that
    oscillates does it over and over.
    """
    most = 0
    for column in side.T:
        held = column[column != 0]
        most = max(most, int(np.count_nonzero(np.diff(held))))
    return most


def flicker(side: np.ndarray) -> int:
    """The longest row of ticks in which a joint is accelerated one way and the other in turn."""
    most = 0
    for column in (side[1:] * side[:-1] < 0).T:
        ends = np.flatnonzero(np.diff(np.concatenate([[False], column, [False]]).astype(int)))
        most = max(most, int(np.max(ends[1::2] - ends[::2], initial=0)))
    return most


@dataclass
class Judged:
    """What became of a scene."""

    ended: str = "done"
    motions: int = 0
    planned: int = 0
    near: int = 0
    turns: int = 0
    flicker: int = 0


def pacer_of(scene: DrawnScene) -> Pacer:
    return Pacer(scene.setup, lambda origin: Place.in_text(TEXT, Span(0, 1)))


def executed(pacer: Pacer, block) -> tuple[MotionRows | None, list[Diagnostic]]:
    """The rows of a block, or why there are none."""
    try:
        return pacer.execute(block), []
    except IrlxError as error:
        return None, list(error.diagnostics)


def run(scene: DrawnScene, judged: Judged, where: str) -> None:
    pacer, on, frozen = pacer_of(scene), set(), ()
    members = {**{name: (name,) for name in scene.setup.scene.obstacles}, **scene.setup.scene.groups}
    for block in scene.blocks:
        before, tick = pacer.q.copy(), pacer.tick
        rows, refused = executed(pacer, block)
        if refused:
            codes = {found.code for found in refused if found.is_error}
            assert codes <= REFUSALS, f"{where}: {', '.join(map(str, refused))}"
            assert all(map(tells_the_truth, refused)), f"{where}: {', '.join(map(str, refused))}"
            assert np.array_equal(pacer.q, before), f"{where}: a refusal moved the robot"
            assert pacer.tick == tick, f"{where}: a refusal took time"
            judged.ended = min(codes)
            return
        if isinstance(block, ObstacleBlock):
            on = on | {block.name} if block.active else on - {block.name}
        if isinstance(block, FreezeBlock):
            frozen = block.joints
        if rows is not None:
            kept = {member for name in on for member in members[name]}
            obstacles = [scene.setup.scene.obstacles[name] for name in sorted(kept)]
            judge(scene, block, rows, np.vstack([before, rows.q]), obstacles, judged, where)
            fixed = [joint - 1 for joint in frozen]
            assert np.all(rows.q[:, fixed] == before[fixed]), f"{where}: a frozen joint moved"


def tells_the_truth(found: Diagnostic) -> bool:
    """Whether what is told to come too near is nearer than what is told to be kept."""
    if found.code not in {"IRL560", "IRL561"}:
        return True
    if str(found.data["distance"]) == f"less than {found.data['floor']}":
        return True
    distance, floor = (float(str(found.data[word]).split()[0]) for word in ("distance", "floor"))
    return distance < floor


def judge(scene, block, rows: MotionRows, q: np.ndarray, obstacles: list[Obstacle], judged: Judged, where):
    setup = scene.setup
    judged.motions += 1
    judged.planned += bool(rows.path is not None and rows.path.planned)
    assert_limits(q, setup.limits, setup.dt, where)
    if isinstance(block, MoveBlock) and block.kind is MoveKind.LIN:
        assert_line(setup.kinematics.description, block, q, where)
    room, near = least_room(setup.kinematics.description, obstacles, q)
    assert room >= -MARGIN_TOLERANCE, f"{where}: {-room:.3g} m too near"
    judged.near += near
    side = sides(q, setup.dt, setup.limits)
    judged.turns, judged.flicker = max(judged.turns, turns(side)), max(judged.flicker, flicker(side))
    assert turns(side) <= MOST_TURNS, f"{where}: accelerations turn round {turns(side)} times"
    assert flicker(side) <= MOST_FLICKER, (
        f"{where}: accelerations turn round in {flicker(side)} ticks in turn"
    )


def assert_limits(q: np.ndarray, limits, dt: float, where: str) -> None:
    assert np.all((q >= limits.position_lower) & (q <= limits.position_upper)), f"{where}: position"
    rest = np.vstack([q[:1], q, q[-1:]])
    v = np.diff(rest, axis=0) / dt
    a = np.diff(v, axis=0) / dt
    unit = np.spacing(np.max(np.abs(q)))
    for values, (lower, upper), slack, word in (
        (v, limits.pair("speed"), 2 * unit / dt, "speed"),
        (a, limits.pair("acceleration"), 4 * unit / dt**2, "acceleration"),
    ):
        over = np.maximum(values - upper * (1 + LIMIT_TOLERANCE), lower * (1 + LIMIT_TOLERANCE) - values)
        assert np.max(over - slack) <= 0.0, f"{where}: {word} by {np.max(over):.3g}"


def assert_line(robot, block: MoveBlock, q: np.ndarray, where: str) -> None:
    position, rotation = forward(robot, q)
    goal = np.array(block.target.position)
    way = goal - position[0]
    length = np.linalg.norm(way)
    along = way / length if length > 0.0 else way
    off = position - position[0]
    beside = off - np.outer(off @ along, along)
    planar = block.target.orientation is None
    assert np.max(np.linalg.norm(beside, axis=1)) <= PATH_TOLERANCE, f"{where}: off the line"
    assert np.linalg.norm(position[-1] - goal) <= PATH_TOLERANCE, f"{where}: not at the target"
    first = Rotation.from_matrix(rotation[0])
    turned = (Rotation.from_matrix(rotation) * first.inv()).as_rotvec()
    whole = (
        np.zeros(3) if planar else (Rotation.from_quat(block.target.orientation) * first.inv()).as_rotvec()
    )
    angle = np.linalg.norm(whole)
    axis = whole / angle if angle > 1e-12 else 0.0 * whole
    off_axis = turned - np.outer(turned @ axis, axis)
    assert np.max(np.linalg.norm(off_axis, axis=1)) <= PATH_TOLERANCE, f"{where}: turned off the way"
    assert np.linalg.norm(turned[-1] - whole) <= PATH_TOLERANCE, f"{where}: not turned to the target"


def least_room(robot, obstacles: list[Obstacle], q: np.ndarray) -> tuple[float, int]:
    """Least distance above what had to be kept (m, at most 10 mm) over all rows, the first that of the start;
    and the rows that were within 10 mm of it."""
    cap, bodies, least, near = 0.01, Bodies(), 0.01, np.zeros(len(q), dtype=bool)
    places = Places(robot, q, np.zeros(len(q)))
    every = np.arange(len(q))
    for obstacle in obstacles:
        for pair in obstacle_pairs(robot, obstacle, bodies):
            for meeting in meetings(pair, places):
                margin = obstacle.margin
                start = capped_distances(meeting, every[:1], np.array([margin]))[0]
                found = capped_distances(meeting, every, np.full(len(q), start + cap)) - start
                least = min(least, float(found.min()))
                near |= found < cap
    return least, int(np.count_nonzero(near))


def one_scene(seed: int) -> Judged:
    scene, judged = drawn_scene(seed), Judged()
    where = f"seed {seed}, {scene.name}, {1e3 * scene.setup.dt:g} ms, {', '.join(scene.told)}"
    run(scene, judged, where)
    return judged


def test_the_measures_tell_an_oscillation():
    class Limits:
        speed_upper = np.array([2.0])

    time = np.linspace(0.0, 1.0, 101)[:, None]
    smooth = 0.5 * time**3 * (10.0 - 15.0 * time + 6.0 * time**2)
    side = sides(smooth, 0.01, Limits)
    assert (turns(side), flicker(side)) == (1, 0)
    # A posture that alternates by a hundredth of a degree, and one that swings ten times a second.
    noise = 1.7e-4 * (np.arange(101)[:, None] % 2) * (np.abs(time - 0.5) < 0.3)
    assert flicker(sides(smooth + noise, 0.01, Limits)) > 30
    swing = 2e-3 * np.sin(20.0 * np.pi * time)
    side = sides(smooth + swing, 0.01, Limits)
    assert turns(side) > MOST_TURNS
    assert flicker(side) <= 1
    # What rounding leaves is no oscillation.
    rounded = smooth + 1e-9 * (np.arange(101)[:, None] % 2)
    assert flicker(sides(rounded, 0.01, Limits)) == 0


def in_turn(seeds) -> list[Judged]:
    """Judge scenes; what they came to is printed."""
    found = []
    for seed in seeds:
        judged = one_scene(seed)
        print(seed, judged)
        found.append(judged)
    return found


def assert_telling(found: list[Judged]) -> None:
    """A campaign whose scenes are all refused, or all far from everything, tells nothing."""
    done = [judged for judged in found if judged.ended == "done"]
    assert len(done) > 0.4 * len(found)
    assert sum(judged.near > 0 for judged in found) > 0.3 * len(found)
    assert any(judged.ended in {"IRL560", "IRL561"} for judged in found)
    assert any(judged.planned for judged in found)


def test_drawn_scenes():
    assert_telling(in_turn(QUICK))


@pytest.mark.parametrize("seed", first(1, SWINGING))
def test_a_calmer_criterion_ends_swinging(seed, monkeypatch):
    assert one_scene(seed).ended == "done"
    monkeypatch.setattr("irlx.pacing.path_motion.swings", lambda *_: False)
    with pytest.raises(AssertionError, match="accelerations turn round"):
        one_scene(seed)


@pytest.mark.slow
@pytest.mark.parametrize("part", range(10))
def test_many_drawn_scenes(part):
    size = LONG // 10
    assert_telling(in_turn(range(1000 + part * size, 1000 + (part + 1) * size)))
