"""Streams that a sensor corrects: every row keeps the limits, the pose, and says what was delayed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from corrected import ARM, PLANNED, Corrected, Tools, carried_out, corrected, files
from irlx.job import prepare
from long_run import first

DECLARED = """VAR
  POSITION: store := (440, 260, 325), next := (440, 200, 325), third := (500, 200, 325);
  MAIN_JOINT: k := (40, 29, -13, 95, 9, 48, -13), near := (45, 25, -10, 90, 5, 50, -10);
  MAIN_JOINT_SPEED_MIN: slow := (-20, -20, -20, -20, -20, -20, -20);
  MAIN_JOINT_SPEED_MAX: fast := (20, 20, 20, 20, 20, 20, 20);
  MAIN_JOINT_SPEED_MIN: no_back := (-20, -20, -20, -20, 0, -20, -20);
  MAIN_JOINT_SPEED_MAX: no_forth := (20, 20, 20, 20, 0, 20, 20);
  MAIN_JOINT_MIN: low := (-180, -180, -180, 0, 8, -180, -180);
  MAIN_JOINT_MAX: high := (180, 180, 180, 95.5, 9.5, 180, 180);"""
MOVES = "MOVE LIN store SPEED := 100.;\nMOVE LIN next;\nMOVE PTP k;"
PROGRAMS = {
    "frozen": "MOVE LIN store SPEED := 200.; FREEZESTART 3; MOVE LIN next; WAIT 0.3 SEC; MOVE LIN store; "
    "FREEZEEND; MOVE LIN third;",
    "blends": "MOVE LIN store SPEED := 100. C_CP := 5; MOVE LIN next C_CP := 10; MOVE LIN third C_CP := 5; "
    "MOVE LIN store; MOVE PTP k C_PTP := 50; MOVE PTP near;",
    "moves": MOVES,
    "speeds": "MOVE LIN store; JOINTSPEEDLIMIT slow, fast; MOVE LIN next; JOINTSPEEDLIMITEND; MOVE PTP k; "
    "JOINTSPEEDLIMIT no_back, no_forth; MOVE LIN next; JOINTSPEEDLIMITEND; MOVE LIN store;",
    "positions": "MOVE LIN store SPEED := 150.; MOVE PTP k; JOINTLIMIT low, high; MOVE LIN (500, 240, 325); "
    "WAIT 0.2 SEC; MOVE PTP k; JOINTLIMITEND; MOVE LIN store;",
    "tools": "MOVE LIN store; R_TOOL := POSE(POSITION(0, 0, 120), ORIXYZ(0, 20, 0)); MOVE LIN next; "
    "MOVE PTP k; R_WEIGHTS := (7., 6., 5., 4., 3., 2., 10.); MOVE LIN store; "
    "R_TOOL := POSE(POSITION(0, 0, 0), ORIXYZ(0, 0, 0)); MOVE PTP k;",
    "postures": "WAIT 0.2 SEC; MOVE PTP near; RECONFIGURATION k; PAUSE; MOVE LIN store "
    "WITH RECONFIGURATION near;",
    "cycle": "CYCLICSTART; MOVE LIN next; MOVE LIN store; MOVE PTP k; CYCLICEND; "
    "MOVE LIN third WITH JOINTSPEEDLIMIT slow, fast;",
}
FLANGE = (np.array([0.0, 0.0, 0.12]), Rotation.from_euler("xyz", [0.0, 20.0, 0.0], degrees=True))
TOOLS: dict[str, Tools] = {"tools": {3: FLANGE, 4: FLANGE, 6: FLANGE}}
SQUARE = """CONST ORIENTATION: level := ORIZYX(0, 0, 0), tilted := ORIZYX(0, -85, 0);
VAR MAIN_JOINT: folded; POSE: p1 := ((11500, 1000, 3500), level), p2 := ((10500, 1000, 3500), level),
  p3 := ((10500, 500, 3500), tilted);"""
LONG_ARM = """[robot]
model = "koch11"
[robot.limits]
acceleration = [100, 100, 100, 100, 100, 100, 100, 200, 200, 2000, 200]
[motion]
tick_ms = {tick}
speed = 1000
acc = 2000
speed_ori = 57.1
acc_ori = 114.5
"""


def white(seed: int = 3):
    """Noise of 1 mm and half a degree."""
    rng = np.random.default_rng(seed)
    return lambda _: np.concatenate([rng.normal(0, 1e-3, 3), rng.normal(0, np.radians(0.5), 3)])


def constant(*correction):
    return lambda _: correction


def step(sample):
    return (0.02, 0, 0, 0, 0, 0) if sample.t > 0.1 else None


def turned_step(sample):
    return (0, 0.02, -0.02, 0.1, 0, -0.2) if sample.t > 0.1 else None


def ramp(sample):
    """Half a metre a second: more than the joints can do."""
    return (0.5 * sample.t, 0, 0, 0, 0, 0)


def out_of_reach(sample):
    return (0.5 * sample.t, 50 * sample.t, 0, 1, 2, 1.0)


def flipping(sample):
    return (0.1 * (-1) ** (sample.tick // 7), 0, 0, 0, 1.5 * (-1) ** (sample.tick // 11), 0)


def sine(sample):
    return (0, 0.005 * np.sin(6 * sample.t), 0, 0, 0, 0)


def there_and_back(sample):
    return (0, 0.005, 0, 0.02, 0, 0) if sample.t < 0.3 else np.zeros(6)


SENSORS = {
    "constant": constant(0.001, 0.0005, 0, 0, 0, 0.002),
    "step": step,
    "turned step": turned_step,
    "ramp": ramp,
    "out of reach": out_of_reach,
    "flipping": flipping,
    "sine": sine,
    "there and back": there_and_back,
}


@pytest.fixture
def run(tmp_path: Path):
    def make(name: str, sensor, tick: int = 20) -> Corrected:
        path = files(tmp_path, PROGRAMS[name].replace("; ", ";\n"), ARM.format(tick=tick), DECLARED)
        return corrected(path, sensor, TOOLS.get(name))

    return make


@pytest.mark.parametrize(
    ("name", "sensor"),
    [
        # Each program under one sensor by default, each sensor with a quarter of the programs.
        pytest.param(name, sensor, marks=pytest.mark.slow if (row + column) % 4 else ())
        for row, name in enumerate(PROGRAMS)
        for column, sensor in enumerate(["white", "turned step", "out of reach", "there and back"])
    ],
)
def test_every_row_keeps_limits_and_pose(run, name, sensor):
    found = run(name, SENSORS.get(sensor) or white())
    assert found.report.ticks + found.report.held_ticks == len(found.q) - 1
    if sensor == "there and back":
        assert not np.any(found.offset[-1])
        assert not np.any(found.correction[-1])
    if name == "frozen":
        # Whatever the sensor says.
        frozen = found.q[np.isin(found.block, [3, 4, 5]), 2]
        assert len(frozen) > 20
        assert np.all(np.isin(frozen[1:] - frozen[0], [0.0]))


@pytest.mark.slow
@pytest.mark.parametrize("tick", [1, 4, 20])
@pytest.mark.parametrize("sensor", ["white", *SENSORS])
@pytest.mark.parametrize("name", PROGRAMS)
def test_campaign(run, name, sensor, tick):
    for seed in range(4) if sensor == "white" else (0,):
        run(name, SENSORS.get(sensor) or white(seed), tick)


def square(folder: Path, tick: int) -> Path:
    body = (
        "folded := R_JOINT_ACT.M_JOINT;\nMOVE LIN p2 C_CP := 100;\nMOVE LIN p3;\nMOVE LIN p1;\n"
        "RECONFIGURATION folded;"
    )
    return files(folder, body, LONG_ARM.format(tick=tick), SQUARE)


@pytest.mark.parametrize("sensor", first(1, [ramp, turned_step]))
def test_koch11(tmp_path, sensor):
    assert corrected(square(tmp_path, 50), sensor).report.delayed_ticks > 0


@pytest.mark.slow
@pytest.mark.parametrize("sensor", ["white", *SENSORS])
def test_koch11_campaign(tmp_path, sensor):
    corrected(square(tmp_path, 10), SENSORS.get(sensor) or white())


@pytest.mark.parametrize("tick", first(1, [10, 2, 1]))
def test_a_small_correction_is_reached_exactly(run, tick):
    found = run("moves", SENSORS["constant"], tick)
    reached = np.all(found.correction == [0.001, 0.0005, 0, 0, 0, 0.002], axis=1)
    assert np.all(reached[found.report.delayed_ticks + 2 :])
    assert np.sum(reached) > 0.8 * len(reached)
    assert found.report.held_ticks == 0
    assert found.report.position_lag.value < 1.2e-3


def test_a_step_is_delayed_and_the_report_says_by_what(run):
    found = run("moves", step)
    report = found.report
    assert 0 < report.delayed_ticks < report.ticks
    lag = report.position_lag
    assert lag.value == pytest.approx(0.02, abs=2e-4)
    missing = np.linalg.norm(found.correction[lag.tick, :3] - [0.02, 0, 0])
    assert missing == pytest.approx(lag.value, abs=1e-12)
    assert (lag.joint, lag.bound) == ("joint_4", "acceleration")
    assert lag.line == 12
    assert report.orientation_lag is None
    np.testing.assert_array_equal(found.correction[-1], [0.02, 0, 0, 0, 0, 0])


def test_a_ramp_beyond_the_joints_uses_what_they_keep_for_it(tmp_path):
    path = files(tmp_path, MOVES, ARM.format(tick=10), DECLARED)
    found = corrected(path, ramp)
    report, limits = found.report, prepare(path).cell.limits.speed_upper
    assert report.requests == report.ticks
    assert report.delayed_ticks == len(found.q) - 2
    assert report.position_lag.value > 0.2
    assert report.position_lag.bound == "speed"
    assert 0.05 < found.correction[-1, 0] < 0.15
    speeds = np.abs(np.diff(found.offset, axis=0)) / found.dt
    assert np.all(speeds <= 0.25 * limits * (1 + 1e-9) + 1e-12)
    assert np.max(speeds / limits) > 0.1


@pytest.mark.parametrize(
    "change",
    [
        "FREEZESTART 3;\nMOVE LIN store;\nWAIT 0.5 SEC;\nFREEZEEND;",
        "R_WEIGHTS := (9., 1., 9., 1., 1., 9., 1.);",
    ],
)
def test_another_nearest_posture_is_gone_to_without_ringing(tmp_path, change):
    body = f"MOVE LIN next;\nWAIT 0.5 SEC;\n{change}\nWAIT 1 SEC;"
    path = files(tmp_path, body, ARM.format(tick=10), DECLARED)
    found = corrected(path, constant(0, 0.04, -0.04, 0, 0, 0))
    freed = found.offset[found.block == found.block[-1]]
    assert abs(freed[-1, 2] - freed[0, 2]) > 1e-3
    moved = np.diff(freed[:, 2])
    moved = moved[np.abs(moved) > 1e-12]
    assert np.all(np.sign(moved) == np.sign(moved[0]))
    assert not np.any(np.diff(freed[-10:], axis=0))


def test_another_tool_begins_with_the_correction_that_the_posture_gives_it(tmp_path):
    body = (
        "MOVE LIN store;\nWAIT 0.5 SEC;\nR_TOOL := POSE(POSITION(0, 0, 120), ORIXYZ(0, 20, 0));\n"
        "WAIT 0.1 SEC;\nMOVE LIN next;"
    )
    path = files(tmp_path, body, ARM.format(tick=10), DECLARED)
    found = corrected(path, constant(0.001, 0, 0, 0, 0, 0), {4: FLANGE, 5: FLANGE})
    first = int(np.argmax(found.block == 4))
    np.testing.assert_array_equal(found.correction[first - 1], [0.001, 0, 0, 0, 0, 0])
    seen_from_the_new = FLANGE[1].inv().apply([0.001, 0, 0])
    np.testing.assert_allclose(found.correction[first, :3], seen_from_the_new, rtol=0, atol=1e-4)
    assert found.report.refused_ticks == 0


def test_a_correction_into_a_position_limit_stops_there(run):
    found = run("positions", step)
    rows = np.isin(found.block, [4, 5, 6])
    limit = np.radians(9.5)
    assert np.all(found.q[rows, 4] <= limit)
    assert np.max(found.q[rows, 4]) > limit - np.radians(0.02)
    assert found.report.refused_ticks > 0


def test_a_sensor_that_says_nothing_changes_nothing(tmp_path):
    path = files(tmp_path, MOVES, ARM.format(tick=10), DECLARED)
    found = corrected(path, lambda _: None)
    rows = [one.rows.q for one in carried_out(prepare(path), PLANNED)]
    np.testing.assert_array_equal(found.q[1:], np.concatenate(rows))
    assert (found.report.requests, found.report.delayed_ticks, found.report.held_ticks) == (0, 0, 0)


def test_the_sensor_sees_the_sample_before_the_one_that_it_corrects(tmp_path):
    path = files(tmp_path, MOVES, ARM.format(tick=10), DECLARED)
    seen: list[irlx.Sample] = []
    stream = irlx.stream(path, correct=seen.append)
    for k, sample in enumerate(stream):
        assert len(seen) == k
        if k:
            assert seen[-1].tick == k - 1
        assert sample.tick == k
        assert sample.correction is not None
        assert stream.corrections.ticks == k


def test_a_stream_without_a_sensor_has_no_corrections(tmp_path):
    path = files(tmp_path, MOVES, ARM.format(tick=10), DECLARED)
    stream, run = irlx.stream(path), irlx.run(path)
    samples = list(stream)
    assert stream.corrections is None
    assert {sample.correction for sample in samples} == {None}
    np.testing.assert_array_equal([sample.q for sample in samples], run.q)


def test_what_the_sensor_raises_comes_out_unchanged(tmp_path):
    path = files(tmp_path, MOVES, ARM.format(tick=10), DECLARED)
    broken = OSError("the camera is unplugged")

    def sensor(sample):
        if sample.tick == 5:
            raise broken

    stream = irlx.stream(path, correct=sensor)
    with pytest.raises(OSError, match="unplugged") as caught:
        list(stream)
    assert caught.value is broken
    assert stream.corrections.ticks == 5


def test_what_is_no_function_is_no_sensor(tmp_path):
    path = files(tmp_path, MOVES, ARM.format(tick=10), DECLARED)
    with pytest.raises(irlx.IrlxError, match=r"IRL006.*correct=.*\[0, 0, 0, 0, 0, 0\]"):
        irlx.stream(path, correct=[0, 0, 0, 0, 0, 0])


@pytest.mark.parametrize(
    ("answer", "code", "found"),
    [
        ((0.0, 0.0, 0.0), "IRL580", "tuple of 3"),
        (np.zeros((6, 1)), "IRL580", r"ndarray of \(6, 1\)"),
        (0.001, "IRL580", "float"),
        ("abcdef", "IRL580", "str of 6"),
        ([True] * 6, "IRL580", "list of 6"),
        ([0, 0, 0, 0, 0, None], "IRL580", "list of 6"),
        ([0, 0, 0, 0, 0, 1j], "IRL580", "list of 6"),
        ([[0], 0, 0, 0, 0, 0], "IRL580", "list of 6"),
        ([0, 0, float("nan"), 0, 0, 0], "IRL581", "nan"),
        ([float("-inf"), 0, 0, 0, 0, 0], "IRL581", "-inf"),
        ([0, 0, 0, 0, 0, 3.2], "IRL582", "3.2 rad"),
        ([1e3, 1, 0, 0, 0, 0], "IRL582", "1000 m"),
        ([1e308, 1e308, 0, 0, 0, 0], "IRL582", r"1.41421e\+308 m"),
    ],
)
def test_answers_that_are_no_corrections(tmp_path, answer, code, found):
    path = files(tmp_path, MOVES, ARM.format(tick=10), DECLARED)
    stream = irlx.stream(path, correct=lambda sample: answer if sample.tick == 3 else None)
    seen = []
    with pytest.raises(irlx.IrlxError, match=f"{code}.*tick 4.*{found}") as caught:
        seen.extend(stream)
    assert caught.value.diagnostics[0].place.line == 11
    assert caught.value.diagnostics[0].place.file.endswith("p.irl")
    with pytest.raises(StopIteration):
        next(stream)


def test_an_error_of_the_program_leaves_the_robot_at_rest(tmp_path):
    body = "MOVE LIN store SPEED := 100.;\nMOVE LIN POSITION(1 / (R_ACC - R_ACC), 0, 0);"
    path = files(tmp_path, body, ARM.format(tick=10), DECLARED)
    samples: list[irlx.Sample] = []
    with pytest.raises(irlx.IrlxError, match="IRL502"):
        samples.extend(irlx.stream(path, correct=ramp))
    assert np.any(samples[-3].qd)
    assert not np.any(samples[-1].qd)


def test_pauses_come_after_all_samples_before_them(tmp_path):
    path = files(tmp_path, "MOVE LIN store;\nPAUSE;\nMOVE LIN next;", ARM.format(tick=10), DECLARED)
    seen, asked = [], []
    for sample in irlx.stream(path, correct=white(), on_pause=lambda place: asked.append(len(seen))):
        seen.append(sample.block)
    assert asked == [seen.index(3) if 3 in seen else seen.index(2)]


def test_a_stream_can_be_closed_and_goes_no_further(tmp_path):
    path = files(tmp_path, MOVES, ARM.format(tick=10), DECLARED)
    asked = []
    stream = irlx.stream(path, correct=lambda sample: asked.append(sample.tick))
    assert [next(stream).tick for _ in range(4)] == [0, 1, 2, 3]
    stream.close()
    assert list(stream) == []
    assert asked == [0, 1, 2]


def test_the_example_of_the_reference(monkeypatch, capsys):
    root = Path(__file__).parents[2]
    text = (root / "docs" / "reference" / "interface.md").read_text(encoding="utf-8")
    code = text.split("### Corrections", 1)[1].split("```python\n", 1)[1].split("```", 1)[0]
    monkeypatch.chdir(root)
    found: dict = {}
    exec(code, found)
    assert capsys.readouterr().out.split()[0] == str(found["report"].ticks)
    assert found["report"].requests == found["report"].ticks > 200
    assert abs(found["sample"].correction[1] - found["seam"](found["sample"])[1]) < 1e-3
