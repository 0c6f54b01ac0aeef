from math import inf, pi

import pytest

from irlx.blocks import (
    ArcCourse,
    Block,
    CriterionBlock,
    CriterionChoice,
    CriterionClause,
    CriterionParam,
    CyclicBlock,
    FreezeBlock,
    HaltBlock,
    JointRange,
    JointTarget,
    LimitClause,
    LimitKind,
    LimitSwitchBlock,
    MotionLaw,
    MoveBlock,
    MoveKind,
    ObstacleBlock,
    Origin,
    PoseTarget,
    ReconfigureBlock,
)
from irlx.blocks.text import block_text

AT = Origin("a.irl", 0, 1, 20)
LAW = MotionLaw(1.0, 2.0, pi / 2, pi, 0.5, 1.0)
UNITS = ("rad", "m")
RANGE = JointRange((-pi, -inf), (pi / 180, 0.25))

CASES = [
    (
        MoveBlock(
            id=3, origin=AT, kind=MoveKind.LIN, target=PoseTarget((9.5, 1.0, 3.5), (0, 0, 0, 1)), law=LAW
        ),
        "3 MOVE LIN to (9500 1000 3500) (0 0 0 1) in R_BASE speed 1000 mm/s acc 2000 mm/s2 "
        "speed_ori 90 deg/s acc_ori 180 deg/s2 line 20",
    ),
    (
        MoveBlock(
            id=4,
            origin=AT,
            kind=MoveKind.PTP,
            target=JointTarget((-pi / 2, 0.1)),
            law=MotionLaw(1.0, 2.0, 1.0, 1.0, 0.5, 1.0, 2.5),
            limits=(LimitClause(LimitKind.SPEED, RANGE, AT),),
            robot="left",
            process="p2",
        ),
        "4 MOVE PTP to joints (-90 100) speed_ptp 50 % acc_ptp 100 % time 2.5 s "
        "WITH JOINTSPEEDLIMIT (-180 -inf) (1 250) robot left process p2 line 20",
    ),
    (
        MoveBlock(
            id=5, origin=AT, kind=MoveKind.LIN, target=PoseTarget((1.2e-16, -0.0, 1 / 3), None, "f"), law=LAW
        ),
        "5 MOVE LIN to (0 0 333.3333333) kept in f speed 1000 mm/s acc 2000 mm/s2 "
        "speed_ori 90 deg/s acc_ori 180 deg/s2 line 20",
    ),
    (
        MoveBlock(
            id=13,
            origin=AT,
            kind=MoveKind.CIRCLE,
            target=JointTarget((pi, 0.1)),
            law=LAW,
            course=ArcCourse(PoseTarget((1.0, 2.0, 3.0), None), 2 * pi, True),
        ),
        "13 MOVE CIRCLE via (1000 2000 3000) kept in R_BASE to joints (180 100) turning through via "
        "angle 360 deg speed 1000 mm/s acc 2000 mm/s2 speed_ori 90 deg/s acc_ori 180 deg/s2 line 20",
    ),
    (
        LimitSwitchBlock(id=6, origin=AT, kind=LimitKind.POSITION, range=RANGE),
        "6 JOINTLIMIT (-180 -inf) (1 250) line 20",
    ),
    (
        LimitSwitchBlock(id=7, origin=AT, kind=LimitKind.ACCELERATION, range=None),
        "7 JOINTACCELLIMITEND line 20",
    ),
    (FreezeBlock(id=8, origin=AT, joints=(1, 2)), "8 FREEZESTART 1, 2 line 20"),
    (FreezeBlock(id=9, origin=AT, joints=()), "9 FREEZEEND line 20"),
    (CyclicBlock(id=10, origin=AT, active=True), "10 CYCLICSTART line 20"),
    (CyclicBlock(id=11, origin=AT, active=False), "11 CYCLICEND line 20"),
    (HaltBlock(id=12, origin=AT), "12 HALT line 20"),
    (
        ReconfigureBlock(id=13, origin=AT, target=JointTarget((-pi / 2, 0.1)), law=LAW),
        "13 RECONFIGURATION to joints (-90 100) speed 1000 mm/s speed_ori 90 deg/s line 20",
    ),
    (
        MoveBlock(
            id=14,
            origin=AT,
            kind=MoveKind.PTP,
            target=JointTarget((pi, 0.0)),
            law=LAW,
            reconfiguration=JointTarget((pi, 0.002)),
        ),
        "14 MOVE PTP to joints (180 0) speed_ptp 50 % acc_ptp 100 % WITH RECONFIGURATION (180 2) line 20",
    ),
    (
        MoveBlock(
            id=15,
            origin=AT,
            kind=MoveKind.CIRCLE,
            target=JointTarget((pi, 0.0)),
            law=LAW,
            course=ArcCourse(JointTarget((0.0, 0.1)), via_reconfiguration=JointTarget((-pi, 0.002))),
            reconfiguration=JointTarget((pi, 0.003)),
        ),
        "15 MOVE CIRCLE via joints (0 100) to joints (180 0) speed 1000 mm/s acc 2000 mm/s2 "
        "speed_ori 90 deg/s acc_ori 180 deg/s2 WITH RECONFIGURATION via (-180 2) to (180 3) line 20",
    ),
    (
        CriterionBlock(
            id=15,
            origin=AT,
            name="MANIPULABILITY",
            choice=CriterionChoice("MANIPULABILITY", 2.0, (CriterionParam("GAIN", 0.5),)),
        ),
        "15 CRITERION MANIPULABILITY weight 2 gain 0.5 line 20",
    ),
    (ObstacleBlock(id=15, origin=AT, name="Ściana_1", active=True), "15 OBSTACLE Ściana_1 line 20"),
    (ObstacleBlock(id=16, origin=AT, name="Ściana_1", active=False), "16 OBSTACLEEND Ściana_1 line 20"),
    (
        CriterionBlock(id=16, origin=AT, name="MANIPULABILITY", choice=None),
        "16 CRITERIONEND MANIPULABILITY line 20",
    ),
    (
        MoveBlock(
            id=17,
            origin=AT,
            kind=MoveKind.PTP,
            target=JointTarget((pi, 0.0)),
            law=LAW,
            reconfiguration=JointTarget((pi, 0.002)),
            criteria=(
                CriterionClause(CriterionChoice("A", 1 / 3), AT),
                CriterionClause(CriterionChoice("B", 1.0, (CriterionParam("GAIN", -2.0),)), AT),
            ),
        ),
        "17 MOVE PTP to joints (180 0) speed_ptp 50 % acc_ptp 100 % WITH RECONFIGURATION (180 2) "
        "WITH CRITERION A weight 0.3333333333 WITH CRITERION B weight 1 gain -2 line 20",
    ),
]


@pytest.mark.parametrize(("block", "line"), CASES, ids=[line.split()[1] for _, line in CASES])
def test_lines(block: Block, line: str) -> None:
    assert block_text(block, UNITS) == line


def test_unknown_block() -> None:
    with pytest.raises(TypeError, match="Block"):
        block_text(Block(id=1, origin=AT), UNITS)
