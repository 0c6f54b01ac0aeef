"""Corners between a PTP and moves along paths are passed (MOT-06), and what is promised of them."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.promises import rounding_allowance
from irlx.verification import verify
from kept_runs import kept_report, kept_run
from long_run import chequered, first

pytestmark = pytest.mark.req("MOT-06")

ROBOTS = {"arm7": (80.0, 8.0), "planar4": (80.0, 8.0), "koch11": (300.0, 5.0)}
"""Ways of the tool, mm, and of the joints, deg, that suit each robot."""
UNWATCHED = "[robot.self_collision]\nactive = false\n"
"""Distances of links are watched in one test alone."""

KOCH = (
    "[robot.limits]\nspeed = [60, 60, 60, 60, 60, 60, 60, 60, 60, 600, 60]\n"
    "acceleration = [350, 350, 350, 350, 350, 350, 350, 350, 350, 3500, 350]\n"
)


class Bench:
    """Runs programs of one robot about its start."""

    def __init__(self, folder: Path, robot: str, tick: float = 4.0, watched: bool = False) -> None:
        self.program, self.cell = folder / "p.irl", folder / "p.toml"
        own = ("" if watched else UNWATCHED) + (KOCH if robot == "koch11" else "")
        self.cell.write_text(f'[robot]\nmodel = "{robot}"\n{own}[motion]\ntick_ms = {tick}\n')
        self.way, self.turn = ROBOTS[robot]
        start = self.run("")
        self.at, self.q = start.tool[0, :3] * 1e3, start.q[0]
        self.turns = np.array([unit == "rad" for unit in start.stream.header.joint_units])

    def run(self, body: str) -> irlx.Run:
        self.program.write_text(f"PROGRAM p;\nVAR OUTPUT BOOL: lamp AT 1;\nBEGIN\n{body}\nENDPROGRAM;\n")
        return kept_run(self.program, self.cell)

    def point(self, x: float, y: float) -> str:
        values = self.at + self.way * np.array([x, y, 0.0])
        return "POSITION(" + ", ".join(f"{value:.6f}" for value in values) + ")"

    def posture(self, *ways: float) -> str:
        values = np.where(self.turns, np.degrees(self.q), self.q * 1e3)
        values[: len(ways)] += np.array(ways) * self.turn
        return "MAIN_JOINT(" + ", ".join(f"{value:.9f}" for value in values) + ")"

    def verified(self, run: irlx.Run) -> None:
        """The run of the program as it stands, or one that says the same."""
        kept = kept_run(self.program, self.cell) is run
        report = (kept_report if kept else partial(verify, run))(program=self.program, cell=self.cell)
        assert report.passed, str(report)

    def tour(self, cp: str = "", ptp: str = "") -> str:
        """LIN, PTP, LIN, CIRCLE."""
        return (
            f"MOVE LIN {self.point(0, 1)} {cp};\nlamp := TRUE;\nMOVE PTP {self.posture(1, -1, 1)} {ptp};\n"
            f"MOVE LIN {self.point(0.5, 0)} {cp};\n"
            f"MOVE CIRCLE {self.point(0.7, 0.4)}, {self.point(0, 0.6)} {cp};\n"
            f"MOVE PTP {self.posture()};"
        )


SOME = first(2, ROBOTS)
"""Robots for tests that others repeat with the third one."""


@pytest.fixture(params=ROBOTS)
def bench(request, tmp_path) -> Bench:
    return Bench(tmp_path, request.param)


@pytest.fixture
def arm(tmp_path) -> Bench:
    return Bench(tmp_path, "arm7")


def codes(run: irlx.Run) -> list[str]:
    return [found.code for found in run.diagnostics if found.code.startswith("IRL43")]


def reasons(run: irlx.Run) -> list[str]:
    return [found.message for found in run.diagnostics if found.code == "IRL432"]


def rests(run: irlx.Run) -> int:
    """Rows that repeat the one before, bit by bit."""
    return int((run.q[1:] == run.q[:-1]).all(axis=1).sum())


def of_stop(run: irlx.Run, stopping: irlx.Run) -> np.ndarray:
    """Which rows of a run are rows of another one, bit by bit."""
    known = {row.tobytes() for row in stopping.q}
    return np.array([row.tobytes() in known for row in run.q])


@pytest.mark.parametrize("bench", SOME, indirect=True)
def test_a_tour_is_faster_and_does_not_stop(bench) -> None:
    stopping = bench.run(bench.tour())
    bench.verified(stopping)
    passing = bench.run(bench.tour("C_CP := 20", "C_PTP := 50"))
    assert codes(passing).count("IRL436") == 3, passing.diagnostics
    assert rests(stopping) == 5
    assert rests(passing) == 1
    assert len(passing.q) < len(stopping.q) - 15
    bench.verified(passing)


@pytest.mark.parametrize("bench", first(1, ROBOTS), indirect=True)
def test_rows_outside_the_corners_are_those_of_the_stop(bench) -> None:
    """Compared bit by bit; what differs of a LIN lies within C_CP of its target."""
    body = bench.tour("C_CP := 20", "C_PTP := 50").replace("MOVE CIRCLE", "WAIT 0.02 SEC; MOVE CIRCLE")
    passing, stopping = bench.run(body), bench.run(body.replace("C_CP := 20", "").replace("C_PTP := 50", ""))
    own = of_stop(passing, stopping)
    assert 0 < (~own).sum() < len(own) // 2
    corners = [stopping.tool[np.flatnonzero(stopping.block == block)[-1], :3] for block in (1, 3)]
    lin = (passing.block == 1) & ~own
    assert np.linalg.norm(passing.tool[lin, :3] - corners[0], axis=1).max() <= 0.02
    # Every block's own rows are one stretch, in the order of the stop.
    for block in np.unique(passing.block[1:]):
        there = np.flatnonzero(own & (passing.block == block))
        assert len(there) > 3
        assert np.array_equal(np.diff(there), np.ones(len(there) - 1))


@pytest.mark.parametrize("bench", first(1, ["koch11", "arm7", "planar4"]), indirect=True)
def test_every_limit_holds_by_differences(bench) -> None:
    run = bench.run(bench.tour("C_PASS := TRUE", "C_PASS := TRUE"))
    assert "IRL436" in codes(run)
    limits, dt = run.stream.header.limits, run.stream.header.dt
    held = np.vstack([run.q[:1], run.q[:1], run.q])
    qd = np.diff(held, axis=0) / dt
    allowance = rounding_allowance(run.q, dt)
    for values, kind, extra in (
        (run.q, "position", 0.0),
        (qd, "speed", allowance[0]),
        (np.diff(qd, axis=0) / dt, "acceleration", allowance[1]),
    ):
        lower, upper = limits.pair(kind)
        assert np.all(values <= upper * (1 + 1e-9 * (kind != "position")) + extra), kind
        assert np.all(values >= lower * (1 + 1e-9 * (kind != "position")) - extra), kind


@pytest.mark.parametrize("bench", SOME, indirect=True)
def test_the_output_is_set_at_the_row_nearest_to_the_corner(bench) -> None:
    run = bench.run(bench.tour("C_CP := 20", "C_PTP := 50"))
    signal = next(record for record in run.stream.records if record.block.id == 2)
    corner = (bench.at + bench.way * np.array([0.0, 1.0, 0.0])) * 1e-3
    away = np.linalg.norm(run.tool[:, :3] - corner, axis=1)
    assert signal.tick == int(np.argmin(away))
    assert run.block[signal.tick] == 1
    assert run.block[signal.tick + 1] == 3


def test_the_note_tells_the_real_distances(arm) -> None:
    run = arm.run(arm.tour("C_CP := 20"))
    (note,) = [found for found in run.diagnostics if found.code == "IRL436"][:1]
    corner = (arm.at + arm.way * np.array([0.0, 1.0, 0.0])) * 1e-3
    miss = np.linalg.norm(run.tool[:, :3] - corner, axis=1).min() * 1e3
    assert f"passes its target by {miss:.4g} mm" in note.message
    assert note.place.line == 4
    assert note.related[0].place.line == 6


def test_a_distance_beyond_half_of_the_way_is_cut(arm) -> None:
    run = arm.run(arm.tour("C_CP := 500"))
    assert "IRL433" in codes(run)
    (cut, *_) = [found for found in run.diagnostics if found.code == "IRL433"]
    assert "cut to 40 mm" in cut.message
    arm.verified(run)


LOST = {
    "a PTP without length": ("MOVE LIN {p} C_CP := 10;\nMOVE PTP {p};", "the next move has no length"),
    "a LIN without length": ("MOVE PTP {j} C_PTP := 10;\nMOVE_INC LIN POSITION(0,0,0);", "has no length"),
    "TIME": ("MOVE LIN {p} C_CP := 10 TIME := 2;\nMOVE PTP {j};", "TIME counts from stop to stop"),
    "a clause": ("MOVE LIN {p} C_CP := 10;\nMOVE PTP {j} WITH JOINTSPEEDLIMIT {a}, {b};", "WITH clause"),
    "back": ("MOVE_INC LIN POSITION(0, 2, 0) C_CP := 1;\nMOVE PTP {s};", "turns back on itself"),
    "next to nothing": ("MOVE LIN {p} C_CP := 0.0001;\nMOVE PTP {j};", "next to nothing"),
    "a turn on the spot": (
        "MOVE_INC LIN (POSITION(0, 0, 0), ORIZYX(10, 0, 0)) C_CP := 5;\nMOVE PTP {j};",
        "turns the tool on the spot",
    ),
    "a tiny LIN": ("MOVE_INC LIN POSITION(0, 0.001, 0) C_CP := 5;\nMOVE PTP {j};", ""),
    "a wait": ("MOVE LIN {p} C_CP := 10;\nWAIT 0.02 SEC;\nMOVE PTP {j};", "robot has to stand"),
}


@pytest.mark.parametrize("name", LOST)
def test_a_lost_blend_is_told_with_both_places(arm, name) -> None:
    body, reason = LOST[name]
    low, high = ("(" + ", ".join([f"{sign}50"] * 7) + ")" for sign in ("-", ""))
    parts = {"p": arm.point(0, 1), "j": arm.posture(1, -1, 1), "s": arm.posture(), "a": low, "b": high}
    run = arm.run(body.format(**parts))
    (note,) = [found for found in run.diagnostics if found.code == "IRL432"]
    assert reason in note.message, note.message
    assert (note.place.line, note.related[0].place.line) == (4, 5)
    assert codes(run) == ["IRL432"]
    plain = arm.run(body.format(**parts).replace("C_CP", "C_PTP"))
    np.testing.assert_array_equal(run.q, plain.q)
    arm.verified(plain)


def test_a_move_that_cannot_be_done_behind_one_that_passes(arm) -> None:
    with pytest.raises(irlx.RunError) as caught:
        arm.run(f"MOVE LIN {arm.point(0, 1)} C_CP := 10;\nMOVE PTP POSITION(9000, 0, 0);")
    assert caught.value.reason.place.line == 5
    np.testing.assert_allclose(
        caught.value.run.tool[-1, :3] * 1e3, arm.at + np.array([0.0, arm.way, 0.0]), atol=1e-6
    )


def test_behind_joined_ptps_of_which_the_last_is_short(tmp_path) -> None:
    """Of the last PTP one row is left, the one in which it ends: there is nothing to be passed."""
    arm = Bench(tmp_path, "arm7", 50.0)
    first, there = (
        f"MAIN_JOINT({values})" for values in ("10, 30, 0, 60, 0, 60, 0", "16, 36, 6, 66, 6, 66, 6")
    )
    further = "MAIN_JOINT(16, 36, 6, 66, 6, 66, 6.1)"
    joined = f"MOVE PTP {first}; MOVE PTP {there} C_PTP := 100; MOVE PTP {further} C_PTP := 100;"
    run = arm.run(f"{joined} MOVE_INC LIN (0, 0, -20);")
    assert any("too short for their ticks" in reason for reason in reasons(run))
    arm.verified(run)


def test_s_curves_are_joined(tmp_path) -> None:
    arm = Bench(tmp_path, "arm7", watched=True)
    tour = arm.tour("C_CP := 20 PROFILE := 'S_CURVE'", "C_PTP := 50 PROFILE := 'S_CURVE'")
    run = arm.run(tour)
    assert codes(run).count("IRL436") == 3
    arm.verified(run)


def test_frozen_joints_keep_their_bits(arm) -> None:
    posture = arm.posture(1, -1, 0, 1)
    body = f"FREEZESTART 3;\nMOVE LIN {arm.point(0, 0.5)} C_CP := 15;\nMOVE PTP {posture} C_PTP := 60;"
    run = arm.run(f"{body}\nMOVE LIN {arm.point(0.3, 0)};\nFREEZEEND;")
    assert codes(run).count("IRL436") == 2
    assert (run.q[:, 2].view(np.int64) == run.q[:1, 2].view(np.int64)).all()
    arm.verified(run)


def test_a_return_under_cyclicstart_closes(arm) -> None:
    body = f"CYCLICSTART;\nMOVE LIN {arm.point(0, 1)} C_CP := 20;\nMOVE PTP {arm.point(0.7, 1)} C_PTP := 60;"
    run = arm.run(f"{body}\nMOVE LIN {arm.point(0, 0)};\nCYCLICEND;")
    assert codes(run).count("IRL436") == 2
    assert np.abs(run.q[-1] - run.q[0]).max() < 1e-6
    arm.verified(run)


def test_time_and_way_of_the_last_move_are_those_of_its_rows(arm) -> None:
    body = f"MOVE LIN {arm.point(0, 1)} C_CP := 20;\nMOVE PTP {arm.posture(1, -1, 1)};\nWAIT R_MOVE_TIME SEC;"
    run = arm.run(body)
    ptp, wait = (np.count_nonzero(run.block == record.block.id) for record in run.stream.records[1:])
    assert wait == ptp - 1
    assert codes(run) == ["IRL436"]


def test_a_stream_gives_the_same_rows(arm) -> None:
    run = arm.run(arm.tour("C_CP := 20", "C_PTP := 50"))
    samples = list(irlx.stream(arm.program, arm.cell))
    np.testing.assert_array_equal(np.array([sample.q for sample in samples]), run.q)
    np.testing.assert_array_equal(np.array([sample.qdd for sample in samples]), run.qdd)


@pytest.mark.req("STR-06")
def test_a_stream_that_breaks_off_in_a_corner_of_two_ptps_is_judged_as_far_as_it_goes(arm) -> None:
    """Where a PTP passes its target nobody knows whither, the stream ending before the next move."""
    body = f"MOVE PTP {arm.posture(1, -1, 1)} C_PTP := 80;\nMOVE PTP {arm.posture(-1, 0.5, 1)};"
    run = arm.run(body)
    stream, rows = run.stream, run.stream.records[1].tick + 1
    part = {name: getattr(stream, name)[:rows] for name in ("ticks", "q", "block", "tool")}
    cut = replace(stream, records=stream.records[:1], complete=False, **part)
    report = irlx.verify(replace(run, stream=cut), cell=arm.cell)
    assert [check.name for check in report.failed] == ["complete"], str(report)


def test_corrections_of_nothing_change_nothing_of_joined_moves(arm) -> None:
    arm.run(arm.tour("C_CP := 20", "C_PTP := 50"))
    samples = list(irlx.stream(arm.program, arm.cell, correct=lambda _: np.zeros(6)))
    q = np.array([sample.q for sample in samples])
    assert int((q[1:] == q[:-1]).all(axis=1).sum()) == 1


def test_an_explained_row_of_a_corner_says_so(arm) -> None:
    run = arm.run(arm.tour("C_CP := 20", "C_PTP := 50"))
    tick = next(record.tick for record in run.stream.records if record.block.id == 2)
    explained = irlx.run(arm.program, arm.cell, explain_tick=tick).explanation
    assert explained.way_of_pacing.startswith("row of a corner")
    assert explained.path is None


def test_a_dry_run_takes_them_as_stops(arm) -> None:
    arm.run(arm.tour("C_CP := 20", "C_PTP := 50"))
    found = irlx.check(arm.program, arm.cell, motion=True)
    assert [one.code for one in found if one.code in ("IRL432", "IRL436")] == []


@pytest.mark.parametrize(
    ("behind", "tick"),
    chequered(
        [
            pytest.param("MOVE_INC SPLINE PATH ({0}, {1}, {2});", id="a spline"),
            pytest.param("MOVE_INC LIN {0};\nMOVE_INC LIN {1};", id="lines"),
        ],
        [20.0, 10.0],
    ),
)
def test_a_line_that_is_all_corner_is_judged(tmp_path, tick: float, behind: str) -> None:
    """Half of it belongs to the corner to the PTP, half to the blend behind it: hardly a row is on it."""
    bench = Bench(tmp_path, "arm7", tick)
    points = ("POSITION(0, 60, 0)", "POSITION(0, 60, 60)", "POSITION(0, 0, 60)")
    body = f"MOVE PTP {bench.posture(1, 0.6, 0, -0.6, 0.6, 0.6)} C_PTP := 50;\n"
    body += "MOVE_INC LIN POSITION(0, 0, 30) C_CP := 15;\n" + behind.format(*points)
    run = bench.run(body)
    assert "IRL436" in codes(run)
    bench.verified(run)
    PREPARED[:] = [bench.program, bench.cell]
    q = run.q.copy()
    # A row of the blend behind it.
    q[np.flatnonzero(run.block == 3)[3], 0] += 3e-4
    report = irlx.verify(replace(run, stream=with_q(run, q)), cell=bench.cell)
    assert "path position" in {check.name for check in report.failed}, str(report)


# ---- Sabotage


def with_q(run: irlx.Run, q: np.ndarray):
    from irlx.job import kinematics_of, prepare

    stream = run.stream
    kinematics = kinematics_of(prepare(*PREPARED).cell)
    rotation, position = kinematics.tool_poses(q)
    return replace(stream, q=q, tool=np.hstack([position, Rotation.from_matrix(rotation).as_quat()]))


PREPARED: list[Path] = []


def bump(count: int) -> np.ndarray:
    return np.sin(np.linspace(0.0, np.pi, count)) ** 2


SABOTAGE = {
    "the path is left too early": (1, slice(-60, -40), 3e-5, {"path position", "path orientation"}),
    "the path is joined too late": (4, slice(60, 80), 3e-5, {"path position", "path orientation"}),
    "a PTP is bent": (3, slice(30, 40), 1e-6, {"PTP straight"}),
    "a corner goes astray": (3, slice(1, 4), 0.05, {"PTP straight"}),
    "a corner goes astray on the LIN": (1, slice(-4, -1), 0.05, {"path position", "programmed speed"}),
}


CIRCLES = {
    "behind a blend": """
        MOVE LIN {0.0 0.5} C_CP := 100;
        MOVE CIRCLE {0.025 0.525}, {0.0 0.55} ANGLE := -400 C_CP := 100 SPEED := 120;
        MOVE PTP <1 -1 1>;""",
    "between two PTPs": """
        R_SPEED := 800;
        R_ACC := 500;
        MOVE PTP <0.427 0.2762 0.3777 0.0886> C_PASS := TRUE;
        MOVE CIRCLE {0.0771 0.3662}, {-0.2097 0.6531} ANGLE := -400 C_PASS := TRUE;
        MOVE PTP <0.8616 0.5543 -0.0842 0.8174>;""",
    "on both sides of a PTP": """
        R_SPEED := 800;
        R_ACC := 4000;
        MOVE CIRCLE POSITION(430.629752, 286.094250, 324.692357),
          POSITION(425.924230, 290.799773, 324.692357);
        MOVE CIRCLE POSITION(473.868860, 282.459034, 324.692357), POSITION(449.927917, 306.399977, 324.692357)
          ANGLE := -585.0983722306498 C_CP := 100;
        MOVE PTP MAIN_JOINT(45.790334277, 34.078687193, -13.115699944, 96.116039868, 9, 48, -13)
          C_PASS := TRUE;
        MOVE CIRCLE POSITION(455.432867, 279.415788, 324.692357),
          POSITION(454.677574, 280.171082, 324.692357);""",
}
"""Circles of more than a turn: {x y} points and <a b ..> postures of the bench."""


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("name", CIRCLES)
def test_corners_of_circles_of_more_than_a_turn(tmp_path, name) -> None:
    """Rows in a corner do not tell by their angles how far round they have come; a PTP that is all corners
    but for three rows is left and reached no farther off than it leads."""
    arm = Bench(tmp_path, "arm7", 20.0 if "between" in name else 1.0)
    body = CIRCLES[name]
    for signs, made in (("{}", arm.point), ("<>", arm.posture)):
        pattern = re.escape(signs[0]) + "(.*?)" + re.escape(signs[1])
        body = re.sub(pattern, lambda found, made=made: made(*map(float, found[1].split())), body)
    arm.verified(arm.run(body))


@pytest.mark.parametrize("name", SABOTAGE)
def test_what_is_off_is_found(arm, name) -> None:
    block, part, amount, checks = SABOTAGE[name]
    run = arm.run(arm.tour("C_CP := 20", "C_PTP := 50"))
    PREPARED[:] = [arm.program, arm.cell]
    arm.verified(run)
    q = run.q.copy()
    rows = np.flatnonzero(run.block == block)[part]
    q[rows, 0] += amount * bump(len(rows) + 2)[1:-1]
    report = irlx.verify(replace(run, stream=with_q(run, q)), cell=arm.cell)
    assert {check.name for check in report.failed} & checks, str(report)


def test_a_stop_is_judged_as_one(arm) -> None:
    """The rows of the stop with blends asked for are as good; without the hold tick they are not."""
    stopping = arm.run(arm.tour())
    blends = arm.run(arm.tour("C_CP := 20", "C_PTP := 50"))
    asked = {record.block.id: record.block for record in blends.stream.records}
    records = tuple(replace(record, block=asked[record.block.id]) for record in stopping.stream.records)
    assert irlx.verify(
        replace(stopping, stream=replace(stopping.stream, records=records)), cell=arm.cell
    ).passed


@pytest.mark.parametrize("turns", [(-20.0,), (0.0, -12.0)])
def test_corners_of_ptps_that_only_turn_some_joints_alike(arm, turns) -> None:
    """A whole turn farther on its line the tool is in the corner once more, which counts for nothing."""
    body = f"MOVE PTP {arm.posture(*turns)} C_PTP := 40;\nMOVE_INC LIN POSITION(0, 0, -20);"
    run = arm.run(body)
    assert rests(run) == 1  # in the end
    arm.verified(run)
