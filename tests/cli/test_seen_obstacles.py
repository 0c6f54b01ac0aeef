"""Obstacles that Python places tick by tick: the arm makes room within limits and on its path, or tells."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import coal
import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

import irlx
from corrected import PLANNED, carried_out, limits_by_block
from irlx.job import prepare
from irlx.promises import rounding_allowance
from irlx.robot.kinematics import Kinematics
from irlx.scene.collision_shape import collision_shape, pose_of
from irlx.verifier.geometry.forward import forward
from long_run import first

RADIUS, MARGIN = 0.06, 0.01
LINE = """PROGRAM ball;
BEGIN
  OBSTACLE ball;
  MOVE_INC LIN POSITION(0, 160, 0) SPEED := 30;
  WAIT 2 SEC;
  OBSTACLEEND ball;
ENDPROGRAM
"""
CELL = """
[robot]
model = "arm7"
[motion]
tick_ms = {tick}
[[obstacle]]
name = "Ball"
shape = "sphere"
radius = 60
margin = 10
influence = 150
xyz = [149, -600, 660]
[[obstacle]]
name = "post"
shape = "box"
size = [20, 20, 20]
margin = 10
influence = 150
xyz = {post}
[[obstacle]]
name = "both"
shape = "group"
members = ["Ball", "post"]
"""


def files(folder: Path, program: str = LINE, tick: int = 20, post=(5000, 0, 0)) -> Path:
    (folder / "ball.toml").write_text(CELL.format(tick=tick, post=list(post)), encoding="utf-8")
    (folder / "ball.irl").write_text(program, encoding="utf-8")
    return folder / "ball.irl"


def heedless(program: str) -> str:
    """The same without obstacles switched on."""
    return "\n".join(line for line in program.splitlines() if "OBSTACLE" not in line)


def coming(speed: float) -> Callable:
    """A ball past the elbow, at a speed in m/s."""
    return lambda sample: {"ball": (0.149, min(-0.6 + speed * sample.t, 0.4), 0.660)}


def followed(path: Path, where: Callable, **given) -> SimpleNamespace:
    """A stream with the places of the ball that `where` said for each of its samples."""
    said = [np.array([0.149, -0.6, 0.660])]

    def heard(sample):
        answer = where(sample)
        said.append(said[-1] if not answer else np.array(answer["ball"]))
        return answer

    stream = irlx.stream(path, obstacles=heard, **given)
    samples = list(stream)
    q, correction, block = (
        np.array([getattr(one, name) for one in samples]) for name in ("q", "correction", "block")
    )
    job = prepare(path)
    found = SimpleNamespace(stream=stream, samples=samples, q=q, correction=correction, block=block)
    found.job, found.dt, found.ball = job, job.tick_ns / 1e9, np.array(said[: len(samples)])
    keeps_limits(found)
    return found


def keeps_limits(found) -> None:
    """Positions, speeds and accelerations by differences of neighbouring rows, from rest to rest."""
    q, dt = found.q, found.dt
    qd = np.diff(q, axis=0, prepend=q[:1]) / dt
    qdd = np.diff(qd, axis=0, prepend=qd[:1]) / dt
    assert not np.any(qd[-1])
    slack = rounding_allowance(q, dt)
    known = limits_by_block(found.job)
    for block in np.unique(found.block[1:]):
        rows, limits = np.flatnonzero(found.block == block), known[int(block)]
        rows = rows[rows > 0]
        for kind, values, extra in (
            ("position", q, 0.0),
            ("speed", qd, slack[0]),
            ("acceleration", qdd, slack[1]),
        ):
            lower, upper = limits.pair(kind)
            assert np.all(np.maximum(values[rows] - upper, lower - values[rows]) <= extra), kind


def off_path(found) -> float:
    """Most that the tool is off its planned pose · its correction, m or rad, by the verifier's kinematics."""
    executed = carried_out(found.job, PLANNED)
    planned = np.vstack([found.job.cell.start[None], *(one.rows.q for one in executed)])
    held = len(found.q) - len(planned)
    assert held == found.stream.corrections.held_ticks
    planned = np.vstack([planned, np.repeat(planned[-1:], held, axis=0)])
    places, turns = forward(found.job.cell.robot, planned)
    really, turned = forward(found.job.cell.robot, found.q)
    wanted = places + np.einsum("nij,nj->ni", turns, found.correction[:, :3])
    turns = turns @ Rotation.from_rotvec(found.correction[:, 3:]).as_matrix()
    angles = Rotation.from_matrix(np.swapaxes(turns, 1, 2) @ turned).magnitude()
    return max(float(np.max(np.linalg.norm(wanted - really, axis=1))), float(np.max(angles)))


def distances(found, solid=None, places=None) -> np.ndarray:
    """Distance (N,) of the arm from the ball in each sample: each pair by itself, nothing remembered."""
    kinematics = Kinematics(found.job.cell.robot)
    solids = [
        (kinematics.body_of(link), pose_of(one.placement), collision_shape(one.shape))
        for link, own in kinematics.description.solids.items()
        if kinematics.body_of(link)[0] > 0
        for one in own
    ]
    solid = coal.Sphere(RADIUS) if solid is None else solid
    least = np.full(len(found.q), np.inf)
    for row, (q, place) in enumerate(zip(found.q, found.ball if places is None else places, strict=True)):
        data = kinematics.model.createData()
        pin.forwardKinematics(kinematics.model, data, q)
        for (joint, frame), within, shape in solids:
            pose = data.oMi[joint] * frame * within
            result = coal.DistanceResult()
            there = coal.Transform3s(pose.rotation, pose.translation)
            ball = coal.Transform3s(np.eye(3), place)
            least[row] = min(
                least[row], coal.distance(shape, there, solid, ball, coal.DistanceRequest(), result)
            )
    return least


@pytest.mark.req("TRF-13")
@pytest.mark.parametrize("tick", [pytest.param(5, marks=pytest.mark.slow), 20])
def test_the_elbow_makes_room_for_a_ball_that_is_seen_coming(tmp_path, tick):
    path = files(tmp_path, tick=tick)
    found = followed(path, coming(0.15))
    assert off_path(found) < 1e-6
    assert not np.any(found.correction[: len(found.q) - found.stream.corrections.held_ticks])
    apart = distances(found)
    assert np.min(apart) >= MARGIN - 1e-6
    # It came near indeed, and what was told is so.
    assert np.min(apart) < MARGIN + 0.02
    told = np.array([one.nearest.distance if one.nearest else np.inf for one in found.samples])
    near = np.isfinite(told)
    assert np.any(near)
    np.testing.assert_allclose(told[near], apart[near], rtol=0, atol=1e-6)
    assert np.all(apart[1:][~near[1:]] > 0.14)
    report = found.stream.obstacles
    assert (report.near_ticks, report.nearest) == (0, ())
    assert report.ticks == report.placements == len(found.q) - (report.ticks < len(found.q))
    assert not [one for one in found.stream.warnings if one.code == "IRL587"]
    # Without OBSTACLE the ball would run into the arm.
    plain = followed(files(tmp_path, heedless(LINE), 2 * tick), coming(0.15))
    assert np.min(distances(plain)) < -0.05


def test_a_ball_that_jumps_into_the_arm_is_left_and_told(tmp_path):
    # The plan stands: nothing but the reaction leads the arm out.
    path = files(tmp_path, LINE.replace("MOVE_INC LIN POSITION(0, 160, 0) SPEED := 30", "WAIT 1 SEC"))

    def jumping(sample):
        return {"BALL": (0.149, 0.01, 0.660), "post": None} if sample.t > 1.0 else None

    found = followed(path, lambda s: {"ball": v["BALL"]} if (v := jumping(s)) else None)
    assert off_path(found) < 1e-6
    assert np.max(np.abs(found.correction)) < 1e-9
    apart = distances(found)
    inside = np.flatnonzero(apart < MARGIN - 1e-6)
    assert inside.size > 3
    worst = int(np.argmin(apart))
    report = found.stream.obstacles
    assert report.near_ticks == inside.size
    deepest = min(report.nearest, key=lambda one: one.distance)
    assert deepest.other == "Ball"
    assert deepest.distance == pytest.approx(apart[worst], abs=1e-6)
    assert deepest.tick == worst
    told = [one for one in found.stream.warnings if one.code == "IRL587"]
    assert len(told) == len(report.nearest)
    warning = next(one for one in told if one.data["tick"] == worst)
    depth = f"{deepest.distance * 1e3:.4g}"
    assert f"link '{deepest.link}' and obstacle 'Ball' came within {depth} mm" in str(warning)
    assert warning.place.line == deepest.line == 5
    # It leaves the margin as long as it has not, and stays out of it.
    assert inside[-1] - inside[0] + 1 == inside.size
    assert np.all(np.diff(apart[inside[5:]]) > -1e-6)
    assert apart[-1] >= MARGIN - 1e-6


def test_an_obstacle_that_rests_changes_nothing(tmp_path):
    """In whatever words it is said, by turns."""
    path = files(tmp_path)
    answers = [None, {}, {"ball": None}, {"ball": (0.149, -0.6, 0.660)}]
    found = list(irlx.stream(path, obstacles=lambda sample: answers[sample.tick // 7 % len(answers)]))
    rows = [one.rows.q for one in carried_out(prepare(path), PLANNED)]
    np.testing.assert_array_equal([one.q for one in found[1:]], np.concatenate(rows))


def test_the_arm_goes_back_to_the_plan_once_the_ball_has_gone(tmp_path):
    path = files(tmp_path, LINE.replace("2 SEC", "3 SEC"), tick=20)

    def there_and_back(sample):
        return {"ball": (0.149, 0.0 - 0.15 * abs(sample.t - 3.5), 0.660)}

    found = followed(path, there_and_back)
    rows = [one.rows.q for one in carried_out(prepare(path), PLANNED)]
    planned = np.vstack([found.q[:1], *rows])
    away = np.max(np.abs(found.q - planned), axis=1)
    assert np.max(away) > 0.05
    np.testing.assert_array_equal(found.q[-10:], planned[-10:])
    assert np.min(distances(found)) >= MARGIN - 1e-6
    assert off_path(found) < 1e-6


def test_the_same_ball_gives_the_same_bits(tmp_path):
    path = files(tmp_path, LINE.replace("2 SEC", "0.5 SEC").replace("SPEED := 30", "SPEED := 60"), tick=40)
    first, second = (irlx.stream(path, obstacles=coming(0.2)) for _ in range(2))
    rows = [[one.q.tobytes() for one in stream] for stream in (first, second)]
    assert rows[0] == rows[1]
    assert first.obstacles == second.obstacles


def test_ball_and_noise_together(tmp_path):
    path = files(tmp_path, LINE.replace("2 SEC", "0.2 SEC"), tick=20)
    rng = np.random.default_rng(5)

    def noise(_):
        return np.concatenate([rng.normal(0, 1e-3, 3), rng.normal(0, np.radians(0.5), 3)])

    def jittering(sample):
        return {"ball": np.array([0.149, min(-0.6 + 0.12 * sample.t, 0.0), 0.660]) + rng.normal(0, 2e-4, 3)}

    found = followed(path, jittering, correct=noise)
    assert off_path(found) < 1e-6
    apart = distances(found)
    assert np.sum(apart < MARGIN - 1e-6) == found.stream.obstacles.near_ticks
    assert np.min(apart) > MARGIN - 2e-3
    assert found.stream.corrections.requests > 250


@pytest.mark.slow
def test_a_correction_goes_as_far_as_an_obstacle_lets_it(tmp_path):
    robot = prepare(files(tmp_path)).cell
    turn, place = Kinematics(robot.robot).tool_pose(robot.start)
    below = place - [0.0, 0.0, 0.15]
    wanted = np.concatenate([turn.T @ [0.0, 0.0, -0.25], np.zeros(3)])
    program = "PROGRAM down;\nBEGIN\n  OBSTACLE post;\n  WAIT 3 SEC;\n  OBSTACLEEND post;\nENDPROGRAM\n"
    post = (below * 1e3).round(3).tolist()

    def down(text):
        path = files(tmp_path, text, tick=20, post=post)
        return followed(path, lambda _: None, correct=lambda _: wanted)

    found, free = down(program), down(heedless(program))
    assert off_path(found) < 1e-6
    places = np.repeat(np.array([post]) / 1e3, len(found.q), axis=0)
    apart = distances(found, coal.Box(0.02, 0.02, 0.02), places)
    assert np.min(apart) >= MARGIN - 1e-6
    assert apart[-1] < MARGIN + 0.002
    assert np.min(distances(free, coal.Box(0.02, 0.02, 0.02), places[: len(free.q)])) < 0.0
    report = found.stream.corrections
    assert report.refused_ticks > 25
    assert report.delayed_ticks == report.ticks
    assert found.stream.obstacles.near_ticks == 0


@pytest.mark.parametrize(
    ("answer", "code", "found"),
    [
        ((0.0, 0.0, 0.0), "IRL585", "tuple"),
        ("ball", "IRL585", "str"),
        ({3: (0, 0, 0)}, "IRL585", "the name 3"),
        ({"ball": (0, 0)}, "IRL585", "tuple of 2 for 'ball'"),
        ({"ball": 1.0}, "IRL585", "float for 'ball'"),
        ({"ball": "abc"}, "IRL585", "str of 3 for 'ball'"),
        ({"ball": [True] * 3}, "IRL585", "list of 3"),
        ({"ball": [[0], 0, 0]}, "IRL585", "list of 3"),
        ({"ball": (0, 0, float("nan"))}, "IRL585", "0, 0, nan for 'ball'"),
        ({"ball": (149, -600, 1060)}, "IRL585", "1060 m away"),
        ({"ball": (0, 0, 1, 0, 0, 90)}, "IRL585", "90 rad"),
        ({"ball": (9, 9, 9), "Ball": (9, 9, 9)}, "IRL585", "'Ball' twice"),
        ({"bal": (0, 0, 0)}, "IRL586", "'bal'.*did you mean 'Ball'"),
        ({"both": (0, 0, 0)}, "IRL586", "'both'"),
    ],
)
def test_answers_that_place_no_obstacle(tmp_path, answer, code, found):
    path = files(tmp_path)
    stream = irlx.stream(path, obstacles=lambda sample: answer if sample.tick == 3 else None)
    seen = []
    with pytest.raises(irlx.IrlxError, match=f"{code}.*tick 4.*{found}") as caught:
        seen.extend(stream)
    assert caught.value.diagnostics[0].place.line == 4
    assert len(seen) == 4
    with pytest.raises(StopIteration):
        next(stream)


def test_what_is_no_function_sees_no_obstacles(tmp_path):
    with pytest.raises(irlx.IrlxError, match=r"IRL006.*obstacles=.*ball"):
        irlx.stream(files(tmp_path), obstacles={"ball": (0, 0, 0)})


def test_each_sample_is_asked_after(tmp_path):
    seen: list[irlx.Sample] = []
    stream = irlx.stream(files(tmp_path), obstacles=seen.append)
    for k, sample in enumerate(stream):
        assert [one.tick for one in seen] == list(range(k))
        assert sample.tick == k
        assert stream.obstacles.ticks == k


def test_what_is_said_at_first_counts_before_the_first_motion(tmp_path):
    path = files(tmp_path)
    stream = irlx.stream(path, obstacles=lambda _: {"ball": (0.149, 0.05, 0.660)})
    next(stream)
    with pytest.raises(irlx.IrlxError, match=r"IRL562.*'Ball' overlap"):
        next(stream)


def test_what_the_watcher_raises_comes_out_unchanged(tmp_path):
    broken = OSError("the camera is unplugged")

    def where(sample):
        if sample.tick == 5:
            raise broken

    stream = irlx.stream(files(tmp_path), obstacles=where)
    with pytest.raises(OSError, match="unplugged") as caught:
        list(stream)
    assert caught.value is broken


def test_the_example_of_the_reference(tmp_path, monkeypatch, capsys):
    files(tmp_path)
    for ending in ("irl", "toml"):
        (tmp_path / f"ball.{ending}").rename(tmp_path / f"demo.{ending}")
    text = (Path(__file__).parents[2] / "docs" / "reference" / "interface.md").read_text(encoding="utf-8")
    code = text.split("### Obstacles that are seen", 1)[1].split("```python\n", 1)[1].split("```", 1)[0]
    monkeypatch.chdir(tmp_path)
    found: dict = {}
    exec(code, found)
    assert "near_ticks=0" in capsys.readouterr().out
    assert found["sample"].nearest.other == "Ball"
    assert found["sample"].nearest.distance > MARGIN


@pytest.mark.parametrize("seed", first(1, range(3)))
@pytest.mark.parametrize("robot", first(3, ["arm7", "koch11", "planar4", "rail6"]))
def test_balls_at_random_cost_no_limit_and_no_path(tmp_path, robot, seed):
    rng = np.random.default_rng(seed)
    print("seed", seed)
    cell = CELL.format(tick=20, post=[5000, 0, 0]).replace("arm7", robot)
    if robot == "koch11":
        cell += "[robot.limits]\nacceleration = [100, 100, 100, 100, 100, 100, 100, 200, 200, 2000, 200]\n"
    cell = cell.replace("xyz = [149, -600, 660]", "xyz = [0, 0, -9000]")
    (tmp_path / "ball.toml").write_text(cell, encoding="utf-8")
    program = LINE.replace("MOVE_INC LIN POSITION(0, 160, 0) SPEED := 30", "WAIT 1.5 SEC")
    (tmp_path / "ball.irl").write_text(program, encoding="utf-8")
    job = prepare(tmp_path / "ball.irl")
    at, _ = forward(job.cell.robot, job.cell.start[None])
    place, step = at[0] + rng.normal(0.0, 0.3, 3), rng.normal(0.0, 0.004, 3)

    def where(sample):
        nonlocal place
        place = place + step if rng.random() > 0.02 else at[0] + rng.normal(0.0, 0.3, 3)
        return {"ball": place} if sample.tick > 3 else None

    found = followed(tmp_path / "ball.irl", where)
    assert off_path(found) < 1e-6
    # What is said of the tick before that the arm has been off its path by itself, it has not been.
    assert found.stream.corrections.delayed_ticks == 0
    inside = distances(found)[1:] < MARGIN - 1e-6
    assert found.stream.obstacles.near_ticks == np.sum(inside & (np.abs(found.ball[1:, 2]) < 8.0))
