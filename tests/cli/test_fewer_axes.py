"""Robots with fewer axes than a pose has coordinates, or asked for fewer: the whole language."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irb6_by_hand import pose, posture, wrist_axes
from irlx.blocks import FreezeBlock, MoveBlock, ReconfigureBlock
from irlx.cell.load import load_cell
from irlx.promises import CLOSURE, FOLLOWED_TURN
from irlx.robot.kinematics import Kinematics
from irlx.verifier import verify_stream
from long_run import first

pytestmark = pytest.mark.req("TRF-21")

IRB6 = 'model = "irb6"\n'
ANYHOW = 'model = "arm7"\ntask = ["x", "y", "z"]\nfree = ["rx", "ry", "rz"]\n'


def written(folder: Path, body: str, robot: str = IRB6, declarations: str = "") -> Path:
    cell = f"[robot]\n{robot}\n[motion]\ntick_ms = 40\nspeed = 300\nacc = 1500\n"
    (folder / "p.toml").write_text(cell, encoding="utf-8")
    text = f"PROGRAM p;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM\n"
    (folder / "p.irl").write_text(text, encoding="utf-8")
    return folder / "p.irl"


def ran(folder: Path, body: str, robot: str = IRB6, declarations: str = "", dry: bool = False) -> irlx.Run:
    """The verified run of a program; `dry` of one that a dry run shall go through as well."""
    program = written(folder, body, robot, declarations)
    run = irlx.run(program)
    report = irlx.verify(run, program=program, cell=folder / "p.toml")
    assert report.passed, str(report)
    assert run.summary.path_position_error < 1e-9
    assert run.summary.path_orientation_error < 1e-9
    # A dry run, which looks at few rows, has nothing else to say.
    assert not dry or [d for d in irlx.check(program, motion=True) if d.is_error] == []
    return run


def refused(folder: Path, body: str, robot: str = IRB6, declarations: str = "") -> irlx.Diagnostic:
    program = written(folder, body, robot, declarations)
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(program)
    (found,) = (d for d in caught.value.diagnostics if d.is_error)
    told = [d.code for d in irlx.check(program, motion=True) if d.is_error]
    assert told == [found.code]
    return found


def aimed(distance: float, angle: float, height: float, down: float, roll: float) -> str:
    """A pose that the arm can meet: it leans to no side of the plane that the base turns to."""
    x, y = distance * np.cos(np.radians(angle)), distance * np.sin(np.radians(angle))
    return f"(({x:.12g}, {y:.12g}, {height}), ORIZYX({angle}, {down}, {roll}))"


def end_of(run: irlx.Run, move: int) -> np.ndarray:
    """Posture in which a move ends."""
    moves = [r for r in run.stream.records if isinstance(r.block, MoveBlock)]
    behind = [r.tick for r in run.stream.records if r.tick > moves[move].tick]
    return run.q[min(behind, default=len(run.q) - 1)]


def test_lines_circles_and_curves_end_where_the_inverse_on_paper_says(tmp_path) -> None:
    body = f"""
      MOVE LIN {aimed(700, 20, 900, 45, 20)};
      MOVE CIRCLE {aimed(720, 0, 950, 40, 0)}, {aimed(700, -20, 900, 45, -20)} CIRC_ORI := 'VIA';
      MOVE SPLINE PATH ({aimed(650, -10, 850, 50, 10)}, {aimed(690, 10, 900, 30, 30)});
      MOVE PTP {aimed(600, -30, 1000, -20, 100)};
      MOVE LIN PATH ({aimed(620, -20, 1000, 0, 90)}, {aimed(640, 0, 1000, 10, 80)}) C_CP := 10;"""
    run = ran(tmp_path, body, dry=True)
    for move, told in [
        (0, (700, 20, 900, 45, 20)),
        (1, (700, -20, 900, 45, -20)),
        (2, (690, 10, 900, 30, 30)),
    ]:
        distance, angle, height, down, roll = told
        q = end_of(run, move)
        np.testing.assert_allclose(np.degrees(q[[0, 3, 4]]), [angle, down, roll], atol=1e-9)
        rotation, position = pose(q)
        np.testing.assert_allclose(np.hypot(*position[:2]), distance / 1e3, atol=1e-12)
        np.testing.assert_allclose(position[2], height / 1e3, atol=1e-12)
        np.testing.assert_allclose(q, posture(rotation, position), atol=1e-12)


def test_along_a_line_only_the_missing_turn_is_off(tmp_path) -> None:
    """Between two poses that the arm can meet it leans aside by whole degrees, and by none at either end."""
    run = ran(
        tmp_path, f"  MOVE PTP {aimed(750, -30, 900, 10, 0)};\n  MOVE LIN {aimed(750, 30, 900, 10, 0)};"
    )
    start = min(r.tick for r in run.stream.records if r.block.id == 2)
    (first, _), (last, _) = pose(run.q[start]), pose(run.q[-1])
    rows = [pose(q) for q in run.q[start:]]
    assert np.max([abs(p[2] - 0.9) for _, p in rows]) < 1e-12
    middle, _ = rows[int(np.argmin([abs(p[1]) for _, p in rows]))]
    # The demand turns about one axis from the first to the last: by symmetry it is level in the middle.
    half = Rotation.from_matrix(first.T @ last).as_rotvec() / 2
    wanted = first @ Rotation.from_rotvec(half).as_matrix()
    lean = np.degrees(Rotation.from_matrix(middle.T @ wanted).magnitude())
    assert 0.0 < lean < 10.0
    assert np.degrees(np.max(np.abs(run.q[-1] - run.q[start])[3:])) < 1e-9


def test_a_target_without_an_orientation_keeps_pitch_and_roll(tmp_path) -> None:
    body = """
      MOVE LIN (700, 0, 900);
      MOVE LIN (600, 300, 900);
      MOVE PTP (650, -200, 950), (600, -300, 850);
      MOVE_INC LIN (0, 0, 50);
      MOVE LIN PATH ((650, -100, 900), (700, 0, 900));"""
    run = ran(tmp_path, body, dry=True)
    first, far, last = end_of(run, 0), end_of(run, 1), run.q[-1]
    # Asked for is always the same orientation: what is made of it does not add up.
    np.testing.assert_allclose(last, first, atol=1e-9)
    np.testing.assert_allclose(np.degrees(first[3:]), [30.0, 0.0], atol=1e-9)
    # What is left of it turns about n, and about nothing else.
    left = Rotation.from_matrix(pose(first)[0] @ pose(far)[0].T).as_rotvec()
    np.testing.assert_allclose(np.cross(left, wrist_axes(far)[:, 2]), 0.0, atol=1e-9)
    assert np.degrees(np.linalg.norm(left)) > 20.0


OFF = "((700, 100, 900), ORIZYX(0, 45, 20))"


@pytest.mark.parametrize(
    "move",
    first(
        5,
        [
            "MOVE LIN {off};",
            "MOVE PTP {off};",
            "MOVE CIRCLE {off}, (650, 200, 900) CIRC_ORI := 'VIA';",
            "MOVE SPLINE PATH ((690, 50, 900), {off}, (650, 0, 900));",
            "q := POSTURE({off});",
            "MOVE CIRCLE (710, 50, 900), {off};",
            "MOVE LIN PATH ((690, 50, 900), {off}, (650, 0, 900));",
            "MOVE LIN {off} C_CP := 10;\n  MOVE LIN (650, 0, 950);",
        ],
    ),
)
def test_what_five_axes_do_not_meet_is_refused_with_what_is_missing(tmp_path, move: str) -> None:
    declarations = "VAR MAIN_JOINT: q;"
    before = "  MOVE LIN (700, 0, 900);\n"
    found = refused(tmp_path, before + "  " + move.format(off=OFF), declarations=declarations)
    assert (found.code, found.place.line_and_column[0]) == ("IRL437", 5)
    words = re.search(
        r"off it by a turn of (\S+) deg about z, in the frame of the link 'wrist'", found.message
    )
    # The base stands at atan(1/7) to the side, and w n = dt1 cos t4: to first order that is the lean.
    assert float(words[1]) == pytest.approx(-np.degrees(np.arctan(1 / 7) * np.cos(np.pi / 4)), rel=0.05)
    nearest = re.search(r"can meet is (.*) \(mm", found.help)[1]
    ran(tmp_path, before + "  " + move.format(off=nearest), declarations=declarations)


def test_out_of_reach_is_what_only_a_leaning_tool_would_reach(tmp_path) -> None:
    """The pitch ends at 90 deg; past it the arm could only lean aside, which is not counted as reached."""
    found = refused(tmp_path, "  MOVE LIN ((700, 0, 900), ORIZYX(0, -120, 0));")
    assert found.code == "IRL520"
    assert "the target itself is out of reach" in found.message
    assert "leaves 0 mm and 30 deg" in found.message


def test_nothing_of_a_refused_move_is_carried_out(tmp_path) -> None:
    program = written(tmp_path, f"  MOVE LIN (700, 0, 900);\n  MOVE LIN {OFF};")
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(program)
    np.testing.assert_allclose(pose(caught.value.run.q[-1])[1], [0.7, 0.0, 0.9], atol=1e-12)


def test_nor_of_a_path_that_stops_at_its_points(tmp_path) -> None:
    """Its second point is none for this arm: the way to its first one is not begun."""
    program = written(tmp_path, f"  MOVE LIN (700, 0, 900);\n  MOVE LIN PATH ((690, 50, 900), {OFF});")
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(program)
    assert caught.value.reason.code == "IRL437"
    np.testing.assert_allclose(pose(caught.value.run.q[-1])[1], [0.7, 0.0, 0.9], atol=1e-12)


@pytest.mark.parametrize(("lean", "allowed"), [(0.9, True), (1.1, False)])
def test_targets_typed_by_hand_are_met_to_1e_4_rad(tmp_path, lean: float, allowed: bool) -> None:
    """A lean of the tool about the third axis of the wrist, level, by this much of the tolerance."""
    move = f"  MOVE LIN ((750, 0, 900), ORIZYX({np.degrees(lean * FOLLOWED_TURN):.9g}, 0, 0));"
    if allowed:
        ran(tmp_path, move, dry=True)
    else:
        assert refused(tmp_path, move).code == "IRL437"


@pytest.mark.parametrize("way", ["0, 0, 0", "0, 0, 10"])
@pytest.mark.parametrize(("aside", "allowed"), [(150, False), (0, True)])
def test_an_orientation_is_asked_for_again_though_the_tool_stays(tmp_path, aside, allowed, way) -> None:
    """A position alone was asked for, and the tool leans; then the orientation is to be kept."""
    again = f"MOVE_INC LIN POSE(POSITION({way}), ORIENTATION(1, 0, 0, 0));"
    body = f"  MOVE LIN (700, 0, 900);\n  MOVE LIN (700, {aside}, 900);\n  {again}"
    if allowed:
        ran(tmp_path, body, dry=True)
    else:
        found = refused(tmp_path, body)
        assert (found.code, found.place.line_and_column[0]) == ("IRL437", 6)


def test_on_its_side_a_circle_about_the_base_turns_joint_1_alone(tmp_path) -> None:
    body = f"""
      MOVE PTP {aimed(720, -60, 1000, 30, 90)};
      MOVE CIRCLE {aimed(720, 0, 1000, 30, 90)}, {aimed(720, 60, 1000, 30, 90)};"""
    run = ran(tmp_path, body)
    start = min(r.tick for r in run.stream.records if r.block.id == 2)
    rows = run.q[start:]
    assert np.max(np.abs(rows[:, 1:] - rows[0, 1:])) < 1e-12
    assert np.degrees(rows[-1, 0] - rows[0, 0]) == pytest.approx(120.0, abs=1e-9)
    steps = np.linalg.norm(np.diff([pose(q)[1] for q in rows], axis=0), axis=1)
    chords = 2.0 * 0.72 * np.sin(np.diff(rows[:, 0]) / 2.0)
    np.testing.assert_allclose(steps, chords, atol=1e-14)


def test_another_tool(tmp_path) -> None:
    """A bent tool on the flange: the roll moves its tip, and the task is still that of the wrist."""
    body = """
      R_TOOL := ((50, 0, 80), ORIZYX(0, 30, 15));
      MOVE LIN (650, 200, 900);
      MOVE_INC LIN (0, 0, 40);
      MOVE PTP (600, 100, 950);"""
    run = ran(tmp_path, body)
    np.testing.assert_allclose(run.tool[-1, :3], [0.6, 0.1, 0.95], atol=1e-12)


@pytest.mark.parametrize("passing", ["", " C_CP := 5"], ids=["alone", "joined"])
def test_a_verifier_of_its_own_finds_what_is_off(tmp_path, passing) -> None:
    """Pitch, roll, and at the end the turn that follows: each in the check that is its own."""
    body = f"  MOVE LIN {aimed(700, 20, 900, 45, 20)}{passing};\n  MOVE LIN {aimed(700, -20, 900, 45, -20)};"
    run = ran(tmp_path, body)
    end = next(r.tick for r in run.stream.records if r.block.id == 2)
    for joint in (3, 4):
        q = run.stream.q.copy()
        # Within the joints' steps, and back again.
        q[end + 5 : end + 26, joint] += 1e-4 * np.sin(np.linspace(0.0, np.pi, 21)) ** 2
        report = verify_stream(replace(run.stream, q=q), load_cell(tmp_path / "p.toml").robot)
        assert "path orientation" in {check.name for check in report.checks if check.status == "failed"}
    records = list(run.stream.records)
    number = next(i for i, r in enumerate(records) if r.block.id == 2)
    leaning = records[number].block
    x, y, z, w = leaning.target.orientation
    wrist = Kinematics(load_cell(tmp_path / "p.toml").robot)
    axis = wrist.task_frames(run.q[-1:])[0][:, 2]
    told = (Rotation.from_rotvec(5e-4 * axis) * Rotation.from_quat([x, y, z, w])).as_quat()
    records[number] = replace(
        records[number],
        block=replace(leaning, target=replace(leaning.target, orientation=tuple(told.tolist()))),
    )
    report = verify_stream(replace(run.stream, records=tuple(records)), wrist.description)
    (found,) = (check for check in report.checks if check.name == "goal orientation")
    assert found.status == "failed"
    assert found.worst.value == pytest.approx(5e-4, rel=1e-3)


def test_position_only(tmp_path) -> None:
    """Seven joints for three coordinates: frozen ones stand, the posture comes back with the tool."""
    body = """
      MOVE LIN (450, 200, 500);
      FREEZESTART 5, 6, 7;
      MOVE CIRCLE (500, 100, 550), (450, 0, 500);
      FREEZEEND;
      CYCLICSTART;
      MOVE LIN (500, -150, 450), ((400, 150, 600), ORIZYX(10, 20, 30)), (450, 0, 500);
      CYCLICEND;
      RECONFIGURATION (40, 20, -13, 95, 9, 48, -13);
      MOVE LIN (450, 50, 500);"""
    run = ran(tmp_path, body, ANYHOW, dry=True)
    assert run.summary.returns[-1].largest < CLOSURE
    frozen = [r.tick for r in run.stream.records if isinstance(r.block, FreezeBlock)]
    rows = run.q[frozen[0] + 1 : frozen[1], 4:]
    assert np.array_equal(rows, np.broadcast_to(rows[0], rows.shape))
    np.testing.assert_allclose(run.tool[-1, :3], [0.45, 0.05, 0.5], atol=1e-12)
    still = next(r.tick for r in run.stream.records if isinstance(r.block, ReconfigureBlock))
    assert np.linalg.norm(run.q[-1] - run.q[still]) > 0.1


def test_five_axes_asked_for_positions(tmp_path) -> None:
    """With pitch and roll free nobody can ask for the lean, which follows from the position."""
    robot = IRB6 + 'task = ["x", "y", "z"]\nfree = ["rx", "ry"]\n'
    assert load_cell(written(tmp_path, "  HALT;", robot).with_suffix(".toml")).robot.free == (
        "rx",
        "ry",
        "rz",
    )
    body = """
      MOVE LIN ((600, 300, 900), ORIZYX(0, 30, 40));
      CYCLICSTART;
      MOVE LIN (700, 0, 900), (600, 300, 900);"""
    run = ran(tmp_path, body, robot)
    np.testing.assert_allclose(run.tool[-1, :3], [0.6, 0.3, 0.9], atol=1e-12)
    assert run.summary.returns[-1].largest < CLOSURE


def test_a_turn_on_the_spot_that_nobody_asks_for_moves_nothing(tmp_path) -> None:
    run = ran(tmp_path, "  MOVE_INC LIN ((0, 0, 0), ORIZYX(0, 0, 40));\n  MOVE_INC LIN (0, 50, 0);", ANYHOW)
    first = next(r.tick for r in run.stream.records if r.block.id == 2)
    assert np.max(np.abs(run.q[:first] - run.q[0])) < 1e-15


def test_a_turn_about_the_tools_own_axis_is_free(tmp_path) -> None:
    """A drill: six joints on a rail, five coordinates. The spindle may stand as it likes."""
    body = """
      MOVE LIN (750, 300, 500);
      MOVE_INC LIN ((0, 0, 0), ORIZYX(0, 0, 90));
      MOVE LIN (700, -100, 600);"""
    whole = ran(tmp_path, body, 'model = "rail6"')
    free = ran(tmp_path, body, 'model = "rail6"\nfree = ["rx"]\n')
    # The spindle's axis is where it is asked for; what it turns about it is another way for the joints.
    spindles = [Rotation.from_quat(run.tool[-1, 3:]).as_matrix()[:, 0] for run in (whole, free)]
    np.testing.assert_allclose(spindles[1], spindles[0], atol=1e-9)
    np.testing.assert_allclose(free.tool[-1, :3], [0.7, -0.1, 0.6], atol=1e-9)
    assert np.degrees(np.max(np.abs(free.q[-1] - whole.q[-1])[1:])) > 20.0


@pytest.mark.req("STR-06")
def test_behind_a_line_to_joint_values_moves_go_on_from_the_orientation_of_these(tmp_path) -> None:
    """The free turn is elsewhere then: what follows keeps the turn asked for, not the one that came out."""
    body = """
      MOVE PTP MAIN_JOINT(0, 10, -40, 60, 20, 30, 10);
      MOVE LIN MAIN_JOINT(40, 12, -42, 60, 25, 33, 80)
        WITH RECONFIGURATION MAIN_JOINT(40, 12, -42, 60, 25, 33, 20);
      MOVE_INC LIN ((0, 60, 0), ORIZYX(20, 30, 0));"""
    run = ran(tmp_path, body, 'model = "rail6"\nfree = ["rx"]\n')
    line, following = run.stream.records[1:]
    off = run.q[following.tick] - np.array(line.block.target.values)
    assert np.max(np.abs(off)) > 0.05


@pytest.mark.req("STR-06")
def test_behind_joint_values_and_a_reconfiguration_moves_begin_where_the_tool_stands(tmp_path) -> None:
    """The reconfiguration turns the spindle, and what follows goes on from there."""
    body = """
      MOVE PTP MAIN_JOINT(0, 10, -40, 60, 20, 30, 10);
      RECONFIGURATION MAIN_JOINT(300, 10, -40, 60, 90, 60, -60);
      MOVE_INC LIN ((0, 60, 0), ORIZYX(20, 30, 0));"""
    run = ran(tmp_path, body, 'model = "rail6"\nfree = ["rx"]\n', dry=True)
    turned = [Rotation.from_quat(run.tool[record.tick, 3:]) for record in run.stream.records]
    assert np.degrees((turned[1].inv() * turned[2]).magnitude()) > 5.0


def test_a_planar_arm_that_may_turn(tmp_path) -> None:
    run = ran(
        tmp_path,
        "  MOVE LIN (400, 700, 0);\n  MOVE LIN (500, 600, 0);",
        'model = "planar4"\ntask = ["x", "y"]\nfree = ["rz"]\n',
    )
    np.testing.assert_allclose(run.tool[-1, :3], [0.5, 0.6, 0.0], atol=1e-12)
    found = refused(
        tmp_path, "  MOVE LIN (400, 700, 1);", 'model = "planar4"\ntask = ["x", "y"]\nfree = ["rz"]\n'
    )
    assert found.code == "IRL430"


def test_a_palletizer_has_four(tmp_path) -> None:
    """With its hand held straight down no joint tilts the tool: what is left is where it is and its turn."""
    robot = IRB6 + 'task = ["x", "y", "z", "rx"]\nlocked = { joint_4 = 90 }\n'
    body = (
        "  MOVE LIN ((600, 200, 700), ORIZYX(30, 90, 0));\n  MOVE PTP ((550, -300, 750), ORIZYX(-60, 90, 0));"
    )
    run = ran(tmp_path, body, robot, dry=True)
    assert run.q.shape[1] == 4
    rotation, position = pose(np.array([*run.q[-1][:3], np.pi / 2, run.q[-1][3]]))
    np.testing.assert_allclose(position, [0.55, -0.3, 0.75], atol=1e-12)
    # Down along x, and turned about the vertical so that y points by -60 deg from its place.
    np.testing.assert_allclose(rotation[:, 0], [0, 0, -1], atol=1e-12)
    np.testing.assert_allclose(rotation[:2, 1], [np.sin(np.pi / 3), 0.5], atol=1e-12)
    found = refused(tmp_path, "  MOVE LIN ((600, 200, 600), ORIZYX(30, 80, 0));", robot)
    assert found.code == "IRL430"
    assert "in the frame of the link 'wrist'" in found.message


TELESCOPE = """<robot name="telescope">
  <link name="base"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="mast"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1"/></joint>
  <link name="mast"/>
  <joint name="second" type="prismatic"><parent link="mast"/><child link="inner"/><origin xyz="0.3 0 0"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.4" velocity="1"/>
    <mimic joint="first" multiplier="2" offset="0.05"/></joint>
  <link name="inner"><collision><geometry><box size="0.2 0.05 0.05"/></geometry></collision></link>
  <joint name="first" type="prismatic"><parent link="inner"/><child link="outer"/><origin xyz="0.1 0 0"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.3" velocity="1"/></joint>
  <link name="outer"><collision><geometry><box size="0.1 0.04 0.04"/></geometry></collision></link>
  <joint name="wrist" type="revolute"><parent link="outer"/><child link="tool"/><origin xyz="0.1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1"/></joint>
  <link name="tool"/>
</robot>"""


def test_a_telescope_whose_second_slide_follows_the_first(tmp_path) -> None:
    """The follower is before its leader, twice as fast, and its limit is the one that counts."""
    (tmp_path / "t.urdf").write_text(TELESCOPE, encoding="utf-8")
    robot = """model = "t.urdf"
task = ["x", "y", "rz"]
start = [0, 100, 0]
limits = { acceleration = [200, 1000, 200] }
[[obstacle]]
name = "stone"
shape = "sphere"
radius = 30
xyz = [900, -400, 0]"""
    body = """
      OBSTACLE stone;
      MOVE LIN ((700, 300, 0), ORIZYX(20, 0, 0));
      MOVE PTP ((850, 0, 0), ORIZYX(0, 0, 0));"""
    run = ran(tmp_path, body, robot, dry=True)
    assert run.joint_names == ("turn", "first", "wrist")
    turn, first, _ = run.q.T
    length = 0.3 + (2.0 * first + 0.05) + 0.1 + first + 0.1
    along = np.stack([length * np.cos(turn), length * np.sin(turn)], axis=1)
    np.testing.assert_allclose(run.tool[:, :2], along, atol=1e-14)
    assert first[-1] == pytest.approx(0.1)
    assert run.summary.limit_use[0].kind == "position"
    assert load_cell(tmp_path / "p.toml").limits.position_upper[1] == pytest.approx(0.175)
    assert load_cell(tmp_path / "p.toml").limits.speed_upper[1] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("cell", "code", "words"),
    [
        (IRB6 + 'task_frame = "finger"', "IRL622", "'finger'"),
        (IRB6 + 'task = ["x", "y", "z", "rx", "ry", "rz"]', "IRL613", "6 coordinates"),
        (IRB6 + 'task = ["x", "y", "z"]', "IRL615", "out rx, ry,"),
        ('model = "planar3"\ntask = ["x", "y", "z"]', "IRL623", "only 2 of them"),
        ('model = "arm7"\ntask = ["x", "y"]\nfree = ["rx", "ry", "rz"]', "IRL615", "out z"),
        (IRB6 + 'free = ["rx"]', "IRL615", "out rz,"),
        (IRB6 + 'free = ["x"]', "IRL603", "free"),
        (IRB6 + "origins = { joint_22 = { xyz = [0, 0, 1] } }", "IRL606", "did you mean 'joint_2'"),
        (IRB6 + "origins = { joint_2 = { xzy = [0, 0, 1] } }", "IRL602", "did you mean 'xyz'"),
    ],
)
def test_tasks_that_are_none(tmp_path, cell: str, code: str, words: str) -> None:
    program = written(tmp_path, "  MOVE LIN POSITION(600, 0, 900);", cell)
    with pytest.raises(irlx.IrlxError) as caught:
        irlx.run(program)
    (found,) = (d for d in caught.value.diagnostics if d.is_error)
    assert found.code == code
    assert words in str(found)
