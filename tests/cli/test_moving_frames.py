"""IN FRAME: moves in a frame that moves with the other hand, from the program to the verified stream."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.cell.packaged import packaged_urdf
from irlx.cli.main import main
from irlx.promises import PATH_POSITION
from irlx.streams import BlockRecord
from irlx.verifier import verify_stream
from irlx.verifier.findings.finding import FAILED

pytestmark = pytest.mark.req("TRF-23", "LANG-50")

CELL = """[robot]
model = "dual14"
self_collision = { active = false }
[motion]
tick_ms = 50
speed = 60
[frames]
table = { xyz = [500, -20, 900], rpy = [0, 0, 30] }
pipe = { link = "left_hand", xyz = [0, 80, 0], rpy = [-90, 0, 0] }
elbow = { link = "left_forearm_1" }
"""
DOWN = "ORIENTATION(0, 1, 0, 0)"


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)

    def write(body: str, declarations: str = "", cell: str = CELL) -> Path:
        Path("p.toml").write_text(cell, encoding="utf-8")
        Path("p.irl").write_text(f"PROGRAM p; {declarations}\nBEGIN\n{body}\nENDPROGRAM\n", encoding="utf-8")
        return Path("p.irl")

    return write


@pytest.fixture
def ran(written):
    def run(body: str, declarations: str = "", cell: str = CELL) -> irlx.Run:
        found = irlx.run(written(body, declarations, cell))
        report = irlx.verify(found, program="p.irl", cell="p.toml")
        assert report.passed, str(report)
        return found

    return run


def seen(q: np.ndarray, link: str = "left_hand") -> tuple[np.ndarray, np.ndarray]:
    """Rotations and positions of the torch in the pipe's frame, or another link's: Pinocchio's reader."""
    model = pin.buildModelFromXML(packaged_urdf("dual14"))
    data = model.createData()
    of_link, torch = (model.getFrameId(name, pin.FrameType.BODY) for name in (link, "torch"))
    inside = pin.SE3(Rotation.from_euler("x", -90, degrees=True).as_matrix(), np.array([0.0, 0.08, 0.0]))
    inside = inside if link == "left_hand" else pin.SE3.Identity()
    found = []
    for row in q:
        pin.framesForwardKinematics(model, data, row)
        pose = (data.oMf[of_link] * inside).actInv(data.oMf[torch])
        found.append((pose.rotation.copy(), pose.translation.copy()))
    rotations, positions = zip(*found, strict=True)
    return np.array(rotations), np.array(positions)


def ends(found: irlx.Run) -> np.ndarray:
    """Postures in the last row of each block that moves."""
    block = found.stream.block
    return found.q[np.append(np.flatnonzero(np.diff(block)), len(block) - 1)][1:]


def test_a_line_is_straight_in_the_frame_and_its_target_a_pose_there(ran):
    there = f"POSE(POSITION(30, 10, 20), {DOWN})"
    found = ran(f"MOVE LIN {there} IN FRAME pipe; MOVE LIN POSITION(-30, 0, 25) IN FRAME Pipe;")
    rotations, positions = seen(found.q)
    assert positions[-1] == pytest.approx([-0.03, 0.0, 0.025], abs=1e-9)
    assert rotations[-1] == pytest.approx(np.diag([1.0, -1.0, -1.0]), abs=1e-9)
    line = positions[found.stream.block == 2]
    way = line[-1] - line[0]
    assert np.linalg.norm(np.cross(line - line[0], way), axis=1).max() <= PATH_POSITION * np.linalg.norm(way)
    # Both hands have moved, and the torch is elsewhere in the world than the line says.
    assert np.ptp(found.q, axis=0)[:7].max() > 0.02
    assert np.ptp(found.q, axis=0)[7:].max() > 0.02


def test_a_frame_of_another_link_has_its_own_joints(ran):
    found = ran("MOVE_INC LIN POSITION(0, 0, 40) IN FRAME elbow;")
    _, positions = seen(found.q, "left_forearm_1")
    assert positions[-1] - positions[0] == pytest.approx([0.0, 0.0, 0.04], abs=1e-9)
    assert np.ptp(found.q[:, 4:7]) == pytest.approx(np.ptp(found.q[0, 4:7]), abs=1e-12)


def test_increments_paths_circles_and_joints_count_in_the_frame(ran):
    found = ran(
        f"""start := R_JOINT_ACT;
        MOVE LIN POSE(POSITION(20, 0, 30), {DOWN}) IN FRAME pipe;
        MOVE_INC LIN POSITION(0, 10, 5) IN FRAME pipe;
        MOVE_INC LIN POSE(POSITION(0, 0, 5), ORIENTATION(1, 0, 0, 0)) IN FRAME pipe;
        MOVE LIN PATH (POSITION(20, 0, 30), POSITION(0, 20, 30), POSITION(-20, 0, 30))
          IN FRAME pipe C_CP := 4;
        MOVE SPLINE PATH (POSITION(0, -20, 30), POSITION(20, 0, 30)) IN FRAME pipe;
        MOVE CIRCLE POSITION(0, 20, 30), POSITION(-20, 0, 30) IN FRAME pipe ANGLE := 360;
        MOVE PTP POSE(POSITION(20, 0, 50), {DOWN}) IN FRAME pipe;
        MOVE LIN start IN FRAME pipe;""",
        "VAR JOINT: start;",
    )
    at = seen(ends(found))[1]
    assert at[1] == pytest.approx([0.02, 0.01, 0.035], abs=1e-9)
    assert at[2] == pytest.approx([0.02, 0.01, 0.03], abs=1e-9)
    assert at[4] == pytest.approx([0.02, 0.0, 0.03], abs=1e-9)
    assert at[5] == pytest.approx(at[4], abs=1e-9)
    assert at[6] == pytest.approx([0.02, 0.0, 0.05], abs=1e-7)
    assert found.q[-1] == pytest.approx(found.q[0], abs=1e-6)


def test_a_frame_that_stands_still_is_a_base_for_one_move(ran):
    with_frame = ran(
        f"""R_BASE := POSE(POSITION(0, 0, 7), ORIENTATION(1, 0, 0, 0));
        MOVE LIN POSE(POSITION(0, 0, 30), {DOWN}) IN FRAME table;
        MOVE_INC LIN POSITION(20, 0, 0) IN FRAME table;"""
    )
    with_base = ran(
        f"R_BASE := table; MOVE LIN POSE(POSITION(0, 0, 30), {DOWN}); MOVE_INC LIN POSITION(20, 0, 0);"
    )
    assert (with_frame.q == with_base.q).all()
    assert {one.block.frame for one in with_frame.stream.records} == {None}


def test_where_the_robot_is_stays_told_in_the_world(ran):
    found = ran(
        f"""MOVE LIN POSE(POSITION(30, 0, 20), {DOWN}) IN FRAME pipe;
        here := R_ROBTARGET_ACT.PSE;
        way := R_DISTANCE_FORW;
        MOVE LIN here;""",
        "VAR POSE: here; REAL: way;",
    )
    # Where it stands already there is nothing to do.
    assert len(ends(found)) == 1
    assert found.stream.tool[-1, :3] == pytest.approx(pin_world(found.q[-1]), abs=1e-12)


def pin_world(q: np.ndarray) -> np.ndarray:
    model = pin.buildModelFromXML(packaged_urdf("dual14"))
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    return data.oMf[model.getFrameId("torch", pin.FrameType.BODY)].translation


def test_tools_change_between_moves_in_the_frame(ran):
    found = ran(
        f"""MOVE LIN POSE(POSITION(30, 0, 20), {DOWN}) IN FRAME pipe;
        R_TOOL := POSE(POSITION(0, 0, 15), ORIENTATION(1, 0, 0, 0));
        MOVE LIN POSITION(0, 0, 20) IN FRAME pipe;
        MOVE LIN POSITION(500, 0, 900);"""
    )
    at = seen(ends(found)[1:2])[1][0]
    assert at == pytest.approx([0.0, 0.0, 0.035], abs=1e-9)


def test_a_reconfiguration_keeps_the_tool_in_the_frame_that_it_names(ran):
    bent = "(10, 75, 35, 90, 60, -45, 115, 20, 85, -10, 78, 108, -80, 20)"
    for clause, place in (
        (" IN FRAME pipe", lambda q: seen(q)[1]),
        ("", lambda q: np.array([pin_world(row) for row in q])),
    ):
        found = irlx_run_with_warning(ran, f"RECONFIGURATION MAIN_JOINT{bent}{clause};")
        positions = place(found.q)
        assert np.abs(positions - positions[0]).max() <= PATH_POSITION
        assert np.abs(found.q[-1] - found.q[0]).max() > 0.02


def irlx_run_with_warning(ran, body: str) -> irlx.Run:
    found = ran(body)
    assert {one.code for one in found.diagnostics} <= {"IRL349"}
    return found


def test_blends_are_lost_where_the_frame_changes(ran):
    pose = f"POSE(POSITION(%s), {DOWN})"
    first, second, third = (pose % at for at in ("30, 0, 20", "30, 30, 20", "0, 30, 20"))
    body = f"""MOVE LIN {first}, {second}, {third} IN FRAME pipe C_CP := 8;
        MOVE LIN POSITION(500, 0, 950) C_CP := 8;
        MOVE PTP {first} IN FRAME pipe C_PTP := 20;
        MOVE LIN POSITION(0, 0, 60) IN FRAME pipe;"""
    found = ran(body)
    positions = seen(found.q)[1]
    corner = np.abs(positions - [0.03, 0.03, 0.02]).max(axis=1).min()
    assert corner > 1e-3
    # Where the frame changes it stops on the target.
    assert np.linalg.norm(positions - [0.0, 0.03, 0.02], axis=1).min() <= 1e-9
    told = " ".join(str(one) for one in found.diagnostics)
    assert "the two moves lead the tool in different frames" in told
    assert "beside a PTP a move in a frame that moves with a link starts and ends at rest" in told


def test_replays_reproductions_and_dry_runs(written, capsys):
    written(
        f"""MOVE LIN POSE(POSITION(30, 0, 20), {DOWN}) IN FRAME pipe;
        RECONFIGURATION R_JOINT_ACT IN FRAME pipe;
        MOVE LIN POSITION(500, 0, 950);"""
    )
    assert irlx.check("p.irl", motion=True) == []
    assert main(["run", "p.irl", "--quiet"]) == 0
    assert main(["run", "p.irdata", "--cell", "p.toml", "--quiet"]) == 0
    assert main(["verify", "p.replay.irdata"]) == 0
    assert irlx.reproduce("p.irdata").same_bytes
    assert main(["run", "p.irl", "--explain-tick", "20", "--quiet", "-o", "x.irdata"]) == 0
    assert "right_7" in capsys.readouterr().out


def test_a_robot_without_the_link_is_told(written, tmp_path):
    written(f"MOVE LIN POSE(POSITION(30, 0, 20), {DOWN}) IN FRAME pipe;")
    assert main(["run", "p.irl", "--quiet"]) == 0
    urdf = packaged_urdf("dual14").replace('"left_hand"', '"left_grip_point"')
    Path("twins.urdf").write_text(urdf, encoding="utf-8")
    start = CELL[: CELL.index("[frames]")].replace(
        '"dual14"', '"twins.urdf"\ntip = "torch"\nhands = ["left_grip_point"]'
    )
    start = start.replace(
        "self_collision",
        "start = [16, 79, 30, 85, 66, -40, 122, 18, 90, -12, 73, 110, -84, 25]\nself_collision",
    )
    Path("twins.toml").write_text(start, encoding="utf-8")
    with pytest.raises(irlx.IrlxError) as caught:
        irlx.run("p.irdata", cell="twins.toml")
    assert [one.code for one in caught.value.diagnostics if one.is_error] == ["IRL515"]


def test_corrections_are_refused(written):
    written(f"MOVE LIN POSITION(500, 0, 950); MOVE LIN POSE(POSITION(30, 0, 20), {DOWN}) IN FRAME pipe;")
    with pytest.raises(irlx.IrlxError) as caught:
        list(irlx.stream("p.irl", correct=lambda _: np.zeros(6)))
    assert "IRL440" in {one.code for one in caught.value.diagnostics}


def test_a_task_that_leaves_turns_out_is_refused(written):
    written(f"MOVE LIN POSE(POSITION(30, 0, 20), {DOWN}) IN FRAME pipe;")
    cell = Path("p.toml").read_text(encoding="utf-8")
    task = 'model = "dual14"\ntask = ["x", "y", "z", "rx", "ry"]\nfree = ["rz"]'
    Path("p.toml").write_text(cell.replace('model = "dual14"', task), encoding="utf-8")
    with pytest.raises(irlx.IrlxError) as caught:
        irlx.run("p.irl")
    assert [one.code for one in caught.value.diagnostics if one.is_error] == ["IRL442"]
    assert "leaves out rz" in str(caught.value.reason)


def test_returns_in_the_frame_are_told(ran):
    there = f"MOVE LIN POSE(POSITION(30, 0, 20), {DOWN}) IN FRAME pipe;"
    away = "MOVE LIN POSITION(-30, 20, 30), POSITION(30, 0, 20) IN FRAME pipe;"
    (found,) = ran(f"{there} CYCLICSTART; {away} CYCLICEND;").summary.returns
    assert found.closed
    # With a joint frozen elsewhere both hands end elsewhere in the world, the tool where it was in the frame.
    bent = "MAIN_JOINT(20, 60, 50, 90, 40, -60, 100, 30, 70, -30, 60, 130, -60, 60)"
    elsewhere = f"RECONFIGURATION {bent} IN FRAME pipe; FREEZESTART 1;"
    led_away = ran(f"{there} CYCLICSTART; {elsewhere} {away} FREEZEEND; CYCLICEND;")
    (found,) = led_away.summary.returns
    assert (found.closed, found.held) == (False, "joint 1 frozen")
    first, last = ends(led_away)[[0, -1]]
    assert seen([first])[1] == pytest.approx(seen([last])[1], abs=1e-9)
    assert np.linalg.norm(pin_world(first) - pin_world(last)) > 0.01


def test_a_return_behind_a_move_in_another_frame_takes_the_time_that_it_needs(ran):
    """What a move in the frame left free is not free in the world: there the posture comes after."""
    there = "home := R_ROBTARGET_ACT.PSE; CYCLICSTART; MOVE_INC LIN POSITION(8, 0, 0) IN FRAME pipe;"
    back = "MOVE LIN home SPEED := 400; MOVE_INC LIN POSITION(0, 0, 90); MOVE LIN home;"
    first, second = ran(f"{there} {back} CYCLICEND;", "VAR POSE: home;").summary.returns
    assert (first.closed, second.closed) == (False, True)


def altered(found: irlx.Run, change) -> object:
    """The stream with other frames in its blocks."""
    records = tuple(
        BlockRecord(one.tick, change(one.block)) if getattr(one.block, "frame", None) is not None else one
        for one in found.stream.records
    )
    return replace(found.stream, records=records)


def test_the_verifier_judges_in_the_frame_that_the_block_names(ran):
    found = ran(f"MOVE LIN POSE(POSITION(30, 0, 20), {DOWN}), POSITION(-30, 0, 20) IN FRAME pipe;")
    robot = irlx_cell().robot
    good = verify_stream(found.stream, robot)
    assert good.passed

    def failing(stream) -> set[str]:
        return {check.name for check in verify_stream(stream, robot).checks if check.status == FAILED}

    # Another pose of the frame, another link, no frame at all: none of them fits the rows.
    def shifted(block):
        return replace(block, frame=replace(block.frame, position=(0.0, 0.0801, 0.0)))

    assert "goal position" in failing(altered(found, shifted))
    assert failing(
        altered(found, lambda block: replace(block, frame=replace(block.frame, link="left_wrist")))
    )
    assert failing(altered(found, lambda block: replace(block, frame=replace(block.frame, link="nowhere"))))
    turned = altered(
        found, lambda block: replace(block, frame=replace(block.frame, orientation=(0.0, 0.0, 0.0, 2.0)))
    )
    assert failing(turned) == {"blocks"}
    # The other hand a little elsewhere, the torch where it was: only the frame can tell.
    q = found.stream.q.copy()
    q[1:-1, 5] += 1e-4 * np.sin(np.linspace(0.0, np.pi, len(q) - 2)) ** 2
    bent = failing(replace(found.stream, q=q))
    assert {"path position", "path orientation"} & bent


def irlx_cell():
    from irlx.cell.load import load_cell

    return load_cell(Path("p.toml"))


def test_poses_that_break_a_constraint_they_imply(written):
    upright = '[[constraint]]\nname = "upright"\nlink = "torch"\naxis = [0, 0, 1]\ndirection = [0, 0, -1]\n'
    written("MOVE LIN POSE(POSITION(500, -20, 950), ORIENTATION(0.1, 0.7, 0.7, 0.1));", cell=CELL + upright)
    with pytest.raises(irlx.IrlxError) as caught:
        irlx.run("p.irl")
    assert [one.code for one in caught.value.diagnostics if one.is_error] == ["IRL441"]
    found = irlx.check("p.irl", motion=True)
    assert [one.code for one in found if one.is_error] == ["IRL441"]


def test_tolerances_are_bands_in_the_frame(ran):
    pose = f"POSE(POSITION(%s), {DOWN})"
    body = f"""MOVE LIN {pose % "30, 0, 20"} IN FRAME pipe;
        MOVE LIN {pose % "-30, 0, 20"} IN FRAME pipe WITH TOLERANCE (0, 0, 0, 0, 0, 360);
        MOVE LIN {pose % "0, 0, 40"} IN FRAME pipe WITH TOLERANCE (0, 0, 5, 10, 10, 360);
        MOVE LIN POSITION(500, 0, 950) WITH TOLERANCE (0, 0, 0, 0, 0, 360);"""
    found = ran(body)
    rotations, positions = seen(ends(found)[:3])
    assert positions[1] == pytest.approx([-0.03, 0.0, 0.02], abs=1e-9)
    assert rotations[1][:, 2] == pytest.approx([0.0, 0.0, -1.0], abs=1e-9)
    assert np.abs(rotations[1] - rotations[0]).max() > 1e-3
    assert np.abs(positions[2] - [0.0, 0.0, 0.04]).max() <= 0.005 + 1e-9


def test_a_band_leaves_room_for_a_constraint_that_the_pose_would_imply(ran):
    upright = '[[constraint]]\nname = "upright"\nlink = "torch"\naxis = [0, 0, 1]\ndirection = [0, 0, -1]\n'
    # Told to lean by 5 degrees, it may stand off by 10: the constraint decides.
    leaning = """POSE(POSITION(500, 0, 950), ORIENTATION(0, 0.70710678, 0.70710678, 0))
      @ POSE(POSITION(0, 0, 0), ORIENTATION(COS(2.5), SIN(2.5), 0, 0))"""
    with_room = f"MOVE LIN {leaning} WITH TOLERANCE (0, 0, 0, 10, 10, 0);"
    found = ran(with_room, cell=CELL + upright)
    assert found.stream.tool[-1, :3] == pytest.approx([0.5, 0.0, 0.95], abs=1e-9)
