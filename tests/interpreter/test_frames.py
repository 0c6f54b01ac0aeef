"""R_BASE and R_TOOL: targets and answers in the frame of the program, blocks in the root of the robot."""

import random
from math import radians, sqrt

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import AskNearestPosture, AskPose, AskPosture, AskPostureOf, MoveBlock, Question, ToolBlock

BASE = "R_BASE := POSE(POSITION(100, 20, 3), ORIXYZ(0, 0, 90));"
PLACES = """VAR POSITION: p := (10, 0, 0); POSE: f := ((10, 0, 0), ORIXYZ(0, 0, 0)), g, here;
ROBTARGET: t := ROBTARGET(f); MAIN_JOINT: j := (1, 2, 3, 4, 5, 6, 7);"""
HALF = sqrt(0.5)


def pose_of(target):
    return (*target.position, *(target.orientation or ()))


@pytest.mark.req("LANG-50")
@pytest.mark.req("MOT-07")
@pytest.mark.parametrize(
    ("move", "expected"),
    [
        ("MOVE LIN p;", (0.1, 0.03, 0.003)),
        ("MOVE LIN f;", (0.1, 0.03, 0.003, 0.0, 0.0, HALF, HALF)),
        ("MOVE LIN t;", (0.1, 0.03, 0.003, 0.0, 0.0, HALF, HALF)),
        ("MOVE PTP f;", (0.1, 0.03, 0.003, 0.0, 0.0, HALF, HALF)),
        ("MOVE_INC LIN p;", (0.0, 0.01, 0.0)),
        # On the side of the tool nothing counts from the base.
        ("MOVE_INC LIN f;", (0.01, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)),
    ],
)
def test_targets_count_in_the_base(blocks, move, expected):
    (block,) = blocks(PLACES, BASE + move)
    assert pose_of(block.target) == pytest.approx(expected, abs=1e-15)


@pytest.mark.req("LANG-50")
def test_via_points_and_points_of_a_path_as_well(blocks):
    circle, path = blocks(PLACES, BASE + "MOVE CIRCLE p, f; MOVE LIN PATH (p, f);")
    for inner in (circle.course.via, path.course.points[0]):
        assert pose_of(inner) == pytest.approx((0.1, 0.03, 0.003), abs=1e-15)


@pytest.mark.req("LANG-50")
def test_joint_values_know_no_frame(blocks):
    plain, moved = blocks(PLACES, f"MOVE LIN j; {BASE} MOVE LIN j;")
    assert plain.target == moved.target


@pytest.mark.req("LANG-50")
def test_the_base_moves_nothing(blocks):
    assert blocks(PLACES, BASE + "R_BASE.POS.X := 5; g := R_BASE;") == []


@pytest.mark.req("LANG-50")
def test_digits_stay_where_the_base_is_the_root(blocks):
    body = "MOVE LIN POSE(POSITION(1 / 3, 0.1, 7), ORIZYX(10, 20, 30));"
    plain, same = blocks("", body + "R_BASE := POSE(POSITION(0, 0, 0), ORIQUAT(1, 0, 0, 0));" + body)
    assert plain.target == same.target


@pytest.mark.req("MOT-07")
def test_any_base_against_rotation_matrices(blocks):
    """Random bases and targets, also at 0 and at half a turn, by another library."""
    chance = random.Random(5)

    def pose():
        at = [chance.choice([0.0, -1e6, chance.uniform(-900, 900)]) for _ in range(3)]
        axis = np.array([chance.choice([0.0, 1.0, chance.uniform(-1, 1)]) for _ in range(3)])
        axis = axis / np.linalg.norm(axis) if axis.any() else np.array([0.0, 0.0, 1.0])
        return at, axis, chance.choice([0.0, 180.0, chance.uniform(-360, 360)])

    def written(at, axis, angle):
        shown = [f"POSITION({', '.join(map(repr, map(float, v)))})" for v in (at, axis)]
        return f"POSE({shown[0]}, ORIVANG({shown[1]}, {angle!r}))"

    def matrix(at, axis, angle):
        found = np.eye(4)
        found[:3, :3] = Rotation.from_rotvec(axis * radians(angle)).as_matrix()
        found[:3, 3] = np.array(at) / 1000
        return found

    for _ in range(60):
        base, target = pose(), pose()
        body = f"R_BASE := {written(*base)}; MOVE LIN {written(*target)};"
        move, increment = blocks("", f"{body} MOVE_INC LIN POSITION(1000, 2000, -500);")
        expected = matrix(*base) @ matrix(*target)
        assert move.target.position == pytest.approx(expected[:3, 3], abs=1e-9)
        turned = Rotation.from_quat(move.target.orientation).as_matrix()
        assert turned == pytest.approx(expected[:3, :3], abs=1e-12)
        shift = matrix(*base)[:3, :3] @ (1.0, 2.0, -0.5)
        assert increment.target.position == pytest.approx(shift, abs=1e-12)


@pytest.mark.req("LANG-52")
def test_poses_of_the_cell_are_numbers_like_all_others(blocks):
    """As base they are the frame of the cell; as a target they count in the base."""
    poses = {"fixture": ((100.0, 20.0, 3.0), (HALF, 0.0, 0.0, HALF))}
    body = """R_BASE := fixture; MOVE LIN POSITION(10, 0, 0); MOVE LIN fixture;
    MOVE LIN INV(R_BASE) @ fixture;"""
    first, second, third = blocks("", body, poses=poses)
    assert pose_of(first.target) == pytest.approx((0.1, 0.03, 0.003), abs=1e-15)
    assert second.target.position == pytest.approx((0.08, 0.12, 0.006), abs=1e-15)
    assert third.target.position == pytest.approx((0.1, 0.02, 0.003), abs=1e-15)


def driven(source, answers):
    """Blocks and questions of a program whose questions are answered by kind."""
    reply, items = None, []
    while True:
        try:
            item = source.send(reply)
        except StopIteration:
            return items
        items.append(item)
        reply = answers[type(item)] if isinstance(item, Question) else None


@pytest.mark.req("LANG-52")
@pytest.mark.parametrize("asked", ["R_ROBTARGET_ACT", "R_ROBTARGET_ACT.PSE", "FK(R_JOINT_ACT)"])
def test_poses_that_come_back_are_in_the_base(generator, asked):
    text = f"PROGRAM t; {PLACES} BEGIN {BASE} MOVE LIN {asked}; ENDPROGRAM"
    at = (0.1, 0.03, 0.003, 0.0, 0.0, HALF, HALF)
    items = driven(generator(text), {AskPosture: (0.0,) * 7, AskPose: at})
    (move,) = (item for item in items if isinstance(item, MoveBlock))
    assert pose_of(move.target) == pytest.approx(at, abs=1e-15)
    declared = (
        f"PROGRAM t; VAR POSE: g; BEGIN {BASE} g := FK(R_JOINT_ACT); R_BASE := g; MOVE LIN g; ENDPROGRAM"
    )
    items = driven(generator(declared), {AskPosture: (0.0,) * 7, AskPose: at})
    # In the base the tool stands at x 10 mm, not turned: its own frame as base puts the target 10 mm farther.
    assert pose_of(items[-1].target) == pytest.approx((0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), abs=1e-15)


@pytest.mark.req("LANG-34")
def test_poses_that_are_asked_about_are_in_the_base(generator):
    text = f"PROGRAM t; {PLACES} BEGIN {BASE} j := POSTURE(f); j := IK(p, j); ENDPROGRAM"
    of, nearest = driven(generator(text), {AskPostureOf: (0.0,) * 7, AskNearestPosture: (0.0,) * 7})
    assert (*of.position, *of.orientation) == pytest.approx((0.1, 0.03, 0.003, 0, 0, HALF, HALF), abs=1e-15)
    assert nearest.position == pytest.approx((0.1, 0.03, 0.003), abs=1e-15)
    assert nearest.orientation is None


@pytest.mark.req("LANG-50")
def test_a_tool_is_a_block(blocks):
    body = """R_TOOL := POSE(POSITION(0, 0, 100), ORIXYZ(0, 0, 90)); R_TOOL.POS.X := 50;
    R_TOOL.ORI := ORIQUAT(1, 0, 0, 0); MOVE LIN R_TOOL @ p;"""
    first, second, third, move = blocks(PLACES, body)
    assert all(isinstance(block, ToolBlock) for block in (first, second, third))
    assert [block.id for block in (first, second, third, move)] == [1, 2, 3, 4]
    assert (first.position, first.orientation) == (
        (0.0, 0.0, 0.1),
        pytest.approx((0, 0, HALF, HALF), abs=1e-15),
    )
    assert (second.position, second.orientation) == ((0.05, 0.0, 0.1), first.orientation)
    assert (third.position, third.orientation) == ((0.05, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0))
    assert move.target.position == pytest.approx((0.06, 0.0, 0.1), abs=1e-15)


@pytest.mark.req("LANG-50")
def test_the_same_tool_again_is_no_change(blocks):
    body = """R_TOOL := POSE(POSITION(0, 0, 0), ORIQUAT(1, 0, 0, 0)); FOR i := 1 TO 3 DO
    R_TOOL.POS.Z := 4; ENDFOR;
    R_TOOL := R_TOOL; R_TOOL.POS.Z := 8;"""
    assert [block.position[2] for block in blocks("VAR INT: i;", body)] == [0.004, 0.008]


@pytest.mark.req("LANG-50")
def test_the_value_of_a_tool_may_come_from_a_routine(blocks):
    declarations = """PROCEDURE take(POSE: gripper); BEGIN R_TOOL := gripper; ENDPROC;
    FUNCTION longer(REAL: by): POSE; BEGIN R_TOOL.POS.Z := by; RETURN R_TOOL @ R_TOOL; ENDFCT;"""
    body = "take(POSE(POSITION(1, 0, 0), ORIQUAT(1, 0, 0, 0))); R_TOOL := longer(3);"
    found = [block.position for block in blocks(declarations, body)]
    assert found == [(0.001, 0.0, 0.0), (0.001, 0.0, 0.003), (0.002, 0.0, 0.006)]


@pytest.mark.req("LANG-52")
@pytest.mark.parametrize("frame", ["R_TOOL", "R_BASE"])
def test_a_frame_without_an_orientation(run_error, frame):
    code, message, marked = run_error(PLACES, f"{frame}.ORI.Q1 := 0; MOVE LIN p;")
    assert (code, message) == ("IRL570", f"{frame} has no orientation: the length of its quaternion is 0")
    assert marked == ("R_TOOL.ORI.Q1 := 0" if frame == "R_TOOL" else "MOVE LIN p")


@pytest.mark.req("LANG-52")
@pytest.mark.parametrize(
    "body",
    ["grow(R_TOOL);", "grow(R_TOOL.POS.X);", "FOR R_TOOL.POS.X := 1 TO 2 DO ENDFOR;", "up(R_WEIGHTS[2]);"],
)
def test_only_assignments_set_what_the_robot_follows(run_error, body):
    declarations = """PROCEDURE grow(VAR POSE: f); BEGIN ENDPROC; PROCEDURE up(VAR REAL: x); BEGIN ENDPROC;"""
    code, message, _ = run_error(declarations, body)
    assert code == "IRL249"
    assert message.endswith("needs a variable, found a system variable that the robot follows")


@pytest.mark.req("LANG-52")
def test_modules_and_routines_share_the_base(blocks):
    declarations = "VAR POSITION: p := (10, 0, 0); PROCEDURE shift; BEGIN R_BASE.POS.Z := 5; ENDPROC;"
    first, second = blocks(declarations, "MOVE LIN p; shift; MOVE LIN p;")
    assert (first.target.position[2], second.target.position[2]) == (0.0, 0.005)
