"""What a run tells whoever watches: each motion, each tick of it, and that one is planned."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.blocks import Block
from irlx.job import prepare
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.pipeline import Execution
from irlx.robot.kinematics import Kinematics
from irlx.running import execute

CELL = '[robot]\nmodel = "arm7"\n'
PROGRAM = """PROGRAM p;
VAR MAIN_JOINT_SPEED_MIN: down := (-9, -9, -9, -9, -9, -9, -9);
    MAIN_JOINT_SPEED_MAX: up := (9, 9, 9, 9, 9, 9, 9); MAIN_JOINT: here;
BEGIN
  here := R_JOINT_ACT.M_JOINT;
  MOVE_INC LIN POSITION(0, 0, -20);
  JOINTSPEEDLIMIT down, up;
  MOVE_INC LIN POSITION(0, 0, 20);
  RECONFIGURATION here;
  JOINTSPEEDLIMITEND;
  MOVE_INC LIN POSITION(0, 5, 0) C_CP := 2;
  MOVE_INC LIN POSITION(0, 5, 5);
ENDPROGRAM;
"""


class Kept:
    """Keeps what it is told."""

    def __init__(self) -> None:
        self.told: list[tuple[str, int]] = []

    def begins(self, block: Block, tick: int) -> None:
        self.told.append((f"line {block.origin.line}", tick))

    def ticked(self, tick: int) -> None:
        self.told.append(("tick", tick))

    def plans(self) -> None:
        self.told.append(("plans", 0))


@pytest.mark.req("REP-01")
def test_it_is_told_of_motions_ticks_and_plans(tmp_path) -> None:
    (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
    (tmp_path / "p.irl").write_text(PROGRAM, encoding="utf-8")
    kept, job = Kept(), prepare(tmp_path / "p.irl")
    run = execute(Execution(job, watch=kept))
    begun = [words for words in kept.told if words[0].startswith("line")]
    # Joined moves are one motion.
    assert [words for words, _ in begun] == ["line 6", "line 8", "line 9", "line 11"]
    assert begun[0][1] == 0
    first, second, third, last = (kept.told.index(words) for words in begun)
    ticks = [tick for words, tick in kept.told[first:second] if words == "tick"]
    moved = next(record.tick for record in run.stream.records if record.block.origin.line == 8)
    # Of ticks that are solved together the first one is told; the last row, a hold, is solved by nobody.
    assert ticks[0] == 1
    assert ticks == sorted(set(ticks))
    assert ticks[-1] < moved
    assert 3 <= len(ticks) < moved
    assert ("plans", 0) not in kept.told[first:second]
    assert ("plans", 0) in kept.told[second:third]
    assert ("plans", 0) in kept.told[third:last]
    assert execute(Execution(job)).q.tobytes() == run.q.tobytes()


@pytest.mark.req("REP-01")
def test_each_motion_is_told_when_it_begins(kit) -> None:
    """A move of the joints, one along a path, one of no length: with the tick whose row stands then."""
    shop, kept = kit.shop(), Kept()
    setup = PacingSetup(Kinematics(kit.gantry()), shop.limits, np.ones(7), kit.start, shop.dt, watch=kept)
    shop.pacer = Pacer(setup, shop.pacer.locate)
    lengths = [
        0 if rows is None else len(rows)
        for rows in (
            shop.to(kit.moved(0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0), duration=0.3),
            shop.line(kit.beyond(0.0, 0.1, 0.1)),
            shop.line(kit.beyond(0.0, 0.1, 0.1)),
        )
    ]
    begun = [words for words in kept.told if words[0].startswith("line")]
    assert begun == [("line 1", 0), ("line 2", lengths[0]), ("line 3", lengths[0] + lengths[1])]
    assert lengths[2] == 0
