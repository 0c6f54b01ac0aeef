"""The comparison with other libraries, without them: its own kinematics, irlx's part, the judge, tables."""

import io
import json
import sys
from pathlib import Path

import numpy as np
import pytest

from irlx.cell.external import external_urdf
from irlx.cell.packaged import packaged_urdf
from irlx.diagnostics import Place
from irlx.robot.kinematics import Kinematics
from irlx.robot.urdf import read_urdf

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import peers
from beside import irlx_side
from beside.bare_urdf import bare_urdf
from beside.forward_kinematics import Chain
from beside.judge import Judge
from beside.line_and_circle import FINGERS, START, TIP
from beside.serving import serve
from beside.tables import markdown, text

DT = 0.01


@pytest.fixture(scope="module")
def panda():
    return external_urdf("panda", Place("panda"))


@pytest.fixture(scope="module")
def judge(panda):
    return Judge(panda, laps=1)


@pytest.fixture(scope="module")
def found(panda, judge, tmp_path_factory):
    """Answers of irlx's part to one request of each kind, with the postures, in coarse ticks."""
    folder = tmp_path_factory.mktemp("peers")
    peers.write_task(folder, panda, judge.speeds, laps=1)
    answer = irlx_side.answers(folder)
    return {
        case: (answer(case, DT, str(folder / "q.npy")), np.load(folder / "q.npy"))
        for case in ("pacer", "run", "record", "cyclic", "slowed")
    }


def assert_same_poses(chain, kinematics):
    size = len(chain.moving)
    q = np.random.default_rng(7).uniform(-2.0, 2.0, (50, size))
    rotations, points = chain.poses(q)
    expected_rotations, expected_points = kinematics.tool_poses(q)
    np.testing.assert_allclose(points, expected_points, atol=1e-12)
    np.testing.assert_allclose(rotations, expected_rotations, atol=1e-12)


@pytest.mark.parametrize(("name", "tip"), [("koch11", "tcp"), ("rail6", "tool"), ("planar4", "tool")])
def test_own_kinematics_of_packaged_robots(name, tip):
    urdf = packaged_urdf(name)
    assert_same_poses(Chain(urdf, tip), Kinematics(read_urdf(urdf, tip)))


@pytest.mark.parametrize("read", [lambda urdf: urdf, lambda urdf: bare_urdf(urdf, FINGERS)])
def test_own_kinematics_of_the_panda(panda, read):
    assert_same_poses(Chain(read(panda), TIP, FINGERS), Kinematics(read_urdf(panda, TIP)))


def test_limits_are_those_of_the_urdf(panda):
    lower, upper, speed = Chain(panda, TIP, FINGERS).limits
    axes = read_urdf(panda, TIP).axes
    assert lower.tolist() == [axis.lower for axis in axes]
    assert upper.tolist() == [axis.upper for axis in axes]
    assert speed.tolist() == [axis.speed for axis in axes]


@pytest.mark.req("BEN-01")
@pytest.mark.parametrize("case", ["pacer", "run", "record", "cyclic"])
def test_irlx_is_where_the_task_says_at_every_tick(found, judge, case):
    told, q = found[case]
    verdict = judge.of_ticks(q, DT)
    assert verdict.position < 1e-9
    assert verdict.orientation < 1e-9
    assert verdict.broken == ""
    assert told["ticks"] == len(q) == 503
    assert told["cpu"] > 0.0
    assert told["solves"] > len(q)


def test_the_slowed_motion_is_slowed_and_on_its_path(found, judge):
    _, q = found["slowed"]
    verdict = judge.of_path(q, DT, peers.slowed(judge.speeds))
    assert len(q) > 503
    assert max(verdict.position, verdict.orientation) < 1e-9
    assert verdict.broken == ""


def test_the_judge_sees_what_is_off(found, judge):
    q = found["pacer"][1].copy()
    q[250, 3] += 1e-5
    assert judge.of_ticks(q, DT).position > peers.PROMISED
    assert judge.of_ticks(q, DT).orientation > peers.PROMISED
    assert judge.of_path(q, DT, judge.speeds).orientation > peers.PROMISED
    assert judge.of_ticks(q[:-1], DT).position == np.inf
    assert "speed" in judge.of_path(q, DT, judge.speeds * 0.1).broken
    q[250, 3] = 0.0
    assert "position" in judge.of_ticks(q, DT).broken


def test_the_first_pose_is_that_of_the_start(judge, panda):
    _, position = Kinematics(read_urdf(panda, TIP)).tool_pose(START)
    np.testing.assert_allclose(judge.start, position, atol=1e-15)
    assert np.linalg.norm(judge.targets(DT)[0] - judge.start) == pytest.approx(0.5 * DT**2)
    np.testing.assert_allclose(judge.targets(DT)[-1], judge.start, atol=1e-15)


def test_a_worker_answers_every_line_and_tells_what_failed():
    def answer(case):
        if case == "bad":
            raise ValueError("no way")
        return {"ticks": 3}

    out = io.StringIO()
    serve(answer, ["numpy"], ['{"case": "good"}\n', '{"case": "bad"}\n', '{"case": "good"}\n'], out)
    told = [json.loads(line) for line in out.getvalue().splitlines()]
    assert told[0]["versions"]["numpy"] == np.__version__
    assert told[1:] == [{"ticks": 3}, {"failed": "ValueError: no way"}, {"ticks": 3}]


class StandsStill:
    """A worker whose robot does not move."""

    def ask(self, into, targets, **request):
        q = np.tile(START, (len(np.load(targets)), 1))
        np.save(into, q)
        return {"cpu": 1.0, "wall": 1.0, "ticks": len(q), "solves": len(q)}


@pytest.mark.req("BEN-01")
def test_who_is_off_ends_the_comparison(judge, tmp_path):
    workers = dict.fromkeys(("irlx", "pink", "mink", "placo"), StandsStill())
    with pytest.raises(SystemExit, match=r"irlx, pacer, 1 ms: off by 0\.4\d* m"):
        peers.Measurement(workers, judge, tmp_path).round(counted=True)


def row(*times):
    errors = {"position_error_m": 1e-9, "orientation_error_rad": 2e-9}
    return {"cpu_us": list(times), "ticks": 3, "solves_per_tick": 1.0, **errors}


def test_the_tables_compare_with_the_faster_form_of_pink():
    rows = {case.label: row(30.0, 50.0, 40.0) for case in peers.CASES}
    rows |= {"Pink, daqp, task": row(60.0, 100.0, 80.0), "Pink, daqp, constraint": row(60.0, 80.0, 70.0)}
    rows["run, slowed"] = row(60.0, 100.0, 80.0)
    found = {"date": "2026-01-01", "machine": "M", "rounds": 3, "simulated_s": 5.0, "versions": {}}
    found["rates"] = {"1 kHz": rows}
    shown = [" ".join(line.split()) for line in text(found).splitlines()]
    assert "irlx, run to CSV 30.0 40.0 0.57 1.00 1.00e-09, 2.00e-09" in shown
    assert "Pink, daqp, task 60.0 80.0 1.14 1.00 1.00e-09, 2.00e-09" in shown
    assert (
        "| slowed, per emitted tick, of the plain run | 80.0 | 40.0 | 2.00 |" in markdown(found).splitlines()
    )
