"""MOVE_INC, R_BASE, R_TOOL, R_WEIGHTS and R_MOVE_TIME in whole runs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx

CELL = """[robot]
model = "arm7"
[motion]
tick_ms = 20
[frames]
fixture = { xyz = [30, -40, 50], rpy = [0, 0, 90] }
"""
HOME = "MOVE PTP (0, -30, 0, 90, 0, 60, 0);"


@pytest.fixture
def ran(tmp_path):
    def run(body, declarations=""):
        program, cell = tmp_path / "p.irl", tmp_path / "p.toml"
        program.write_text(f"PROGRAM p;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM\n", encoding="utf-8")
        cell.write_text(CELL, encoding="utf-8")
        return irlx.run(program)

    return run


SHIFT = np.array([0.02, -0.03, 0.025])


@pytest.mark.req("LANG-50")
@pytest.mark.req("MOT-07")
def test_a_shift_of_the_base_shifts_the_stream(ran):
    """The same program text in another base: the tool runs along the shifted and turned path."""
    body = """MOVE PTP POSE(POSITION(400, 0, 300), ORIXYZ(0, 180, 0));
    MOVE LIN (400, 60, 300); MOVE_INC LIN POSITION(0, -30, 40); MOVE CIRCLE (400, 0, 360), (400, -20, 340);
    MOVE_INC LIN POSE(POSITION(0, 0, 10), ORIXYZ(0, 0, 30)); MOVE LIN R_ROBTARGET_ACT;"""
    plain = ran(body)
    base = "R_BASE := POSE(POSITION(20, -30, 25), ORIXYZ(0, 0, 20));"
    moved = ran(base + body)
    turn = Rotation.from_euler("z", 20, degrees=True)
    # The first move is a PTP, whose way is its own; from its end on all is rigid.
    rows = [run.stream.tool[run.stream.block > 1] for run in (plain, moved)]
    assert len(rows[0]) == len(rows[1]) > 100
    assert rows[1][:, :3] == pytest.approx(turn.apply(rows[0][:, :3]) + SHIFT, abs=1e-6)
    apart = Rotation.from_quat(rows[1][:, 3:]).inv() * turn * Rotation.from_quat(rows[0][:, 3:])
    assert apart.magnitude().max() < 1e-6


@pytest.mark.req("LANG-52")
@pytest.mark.parametrize(
    "frames",
    ["", "R_BASE := fixture;", "R_TOOL := POSE(POSITION(10, 0, 90), ORIXYZ(0, 30, 0));"],
)
def test_a_move_to_where_the_robot_stands_moves_nothing(ran, frames):
    run = ran(f"{HOME} {frames} MOVE LIN R_ROBTARGET_ACT; MOVE LIN R_ROBTARGET_ACT.PSE.POS;")
    assert run.summary.moves == 3
    assert set(run.stream.block.tolist()) <= {0, 1}


@pytest.mark.req("LANG-50")
def test_a_tool_moves_nothing_and_its_own_point_goes_to_the_target(ran):
    body = (
        f"{HOME} R_TOOL := POSE(POSITION(0, 0, 100), ORIQUAT(1, 0, 0, 0)); MOVE_INC LIN POSITION(0, 0, 50);"
    )
    plain, run = ran(f"{HOME} MOVE_INC LIN POSITION(0, 0, 50);"), ran(body)
    assert run.stream.q == pytest.approx(plain.stream.q, abs=1e-6)
    last = plain.stream.tool[-1]
    expected = last[:3] + Rotation.from_quat(last[3:]).apply((0.0, 0.0, 0.1))
    assert run.stream.tool[-1, :3] == pytest.approx(expected, abs=1e-6)


@pytest.mark.req("LANG-52")
def test_times_and_ways_are_those_of_the_stream(ran):
    declarations = "VAR REAL: t, way;"
    body = f"""{HOME} MOVE_INC LIN POSITION(0, 0, 40), POSITION(30, 40, 0); t := R_MOVE_TIME;
    way := R_DISTANCE_BACK;    IF ABS(way - 50) > 1E-6 OR R_DISTANCE_FORW <> 0 THEN HALT; ENDIF;
    IF t < 0.2 OR t > 2 THEN HALT; ENDIF; MOVE_INC LIN POSITION(0, 0, -t * 10);"""
    run = ran(body, declarations)
    assert run.summary.moves == 4
    rows = [int(np.sum(run.stream.block == number)) for number in (3, 4)]
    shift = run.stream.tool[-1, :3] - run.stream.tool[-1 - rows[1], :3]
    assert shift[2] == pytest.approx(-(rows[0] - 1) * 0.02 * 0.01, abs=1e-7)


@pytest.mark.req("LANG-52")
def test_weights_hold_from_where_they_stand(ran):
    heavy = "R_WEIGHTS := (1, 1, 1E6, 1, 1, 1, 1);"
    run = ran(
        f"{HOME} {heavy} MOVE_INC LIN POSITION(0, 80, 0); R_WEIGHTS[3] := 1; MOVE_INC LIN POSITION(0, 80, 0);"
    )
    joint = run.stream.q[:, 2]
    ends = [joint[run.stream.block == number] for number in (3, 5)]
    held, free = (np.ptp(values) for values in ends)
    assert held < 1e-4
    assert free > 1e-2


@pytest.mark.req("LANG-50")
def test_a_tool_that_a_planar_arm_cannot_have(tmp_path):
    (tmp_path / "p.toml").write_text('[robot]\nmodel = "planar3"\n')
    program = tmp_path / "p.irl"
    program.write_text("PROGRAM p; BEGIN R_TOOL := POSE(POSITION(0, 0, 0), ORIXYZ(90, 0, 0)); ENDPROGRAM\n")
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(program)
    (found,) = (d for d in caught.value.diagnostics if d.is_error)
    assert found.code == "IRL571"
    assert found.place.span.start == program.read_text().index("R_TOOL")
