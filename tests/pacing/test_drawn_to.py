"""What a motion beside an obstacle is drawn to, and what is tried where that makes it swing."""

from __future__ import annotations

import numpy as np

from drawn_scenes import cell_of
from irlx.blocks import MotionLaw, MoveBlock, MoveKind, ObstacleBlock, Origin, PoseTarget
from irlx.diagnostics import Place
from irlx.motion.plan_chain import Leg, plan_chain
from irlx.pacing.drawn_to import term_of
from irlx.pacing.pacer import Pacer
from irlx.pacing.posture_term import PostureTerm
from irlx.pacing.situation import PacingSetup
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere
from irlx.transform.criteria.combined import Combined

PLACE, ORIGIN = Place("t.irl"), Origin("t.irl", 0, 1, 1)


def term_beside(*names: str) -> PostureTerm:
    """The term of a line beside a ball, with what `names` switch on."""
    cell, kinematics = cell_of("arm7")
    ball = Obstacle("ball", (Solid(Sphere(0.05)),), Placement((1.0, 0.45, 0.75)), 0.01, 0.31)
    scene = Scene({"ball": ball})
    setup = PacingSetup(kinematics, cell.limits, np.ones(7), cell.start, 0.01, scene=scene)
    pacer = Pacer(setup, lambda origin: PLACE)
    for name in names:
        pacer.execute(ObstacleBlock(id=1, origin=ORIGIN, name=name, active=True))
    x, y, z = kinematics.tool_pose(cell.start)[1].tolist()
    law = MotionLaw(speed=0.5, acc=2.0, speed_ori=1.0, acc_ori=4.0)
    target = PoseTarget((x, y - 0.1, z), None)
    block = MoveBlock(id=2, origin=ORIGIN, kind=MoveKind.LIN, target=target, law=law)
    situation = pacer._situation
    in_force = situation.in_force()
    plan = plan_chain([Leg(block, PLACE)], *situation.pose, situation.dt)
    return term_of(situation, block, plan, situation.model(in_force), None, in_force.limits)


def test_beside_an_obstacle_there_are_two_calmer_terms_the_last_without_a_push() -> None:
    """What pushes may make the motion swing: first it pushes more calmly, then not at all."""
    term: PostureTerm | None = term_beside("ball")
    pushes = []
    while term is not None:
        pushes.append(isinstance(term.at(0.05, 0.01), Combined))
        term = term.calmer
    assert pushes == [True, True, False]


def test_without_one_there_is_nothing_to_calm() -> None:
    term = term_beside()
    assert not isinstance(term.at(0.05, 0.01), Combined)
    assert term.calmer is None
