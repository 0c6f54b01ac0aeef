"""What the checks of one stream share: its outline, the robot, the moves, and the limits in force."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from irlx.blocks import MoveKind
from irlx.robot.description import RobotDescription
from irlx.robot.relation import Relation
from irlx.scene.scene import Scene
from irlx.streams.joint_stream import Floats
from irlx.verifier.chain_legs import end_reach
from irlx.verifier.demands import Demand, Placer, demands_of
from irlx.verifier.findings.tally import Tally
from irlx.verifier.frames import frames_of
from irlx.verifier.limits import LimitsInForce, limits_in_force
from irlx.verifier.moves import MoveRows, moves_of
from irlx.verifier.outline import Outline
from irlx.verifier.tools import tools_of


@dataclass(frozen=True)
class Evidence:
    """The outline of a stream with what follows from it, computed on first use.

    `robot` is None where none is known or where it is not the stream's robot; nothing is asked for by blocks
    that do not fit the rows (`blocks_fit`); `start` (n,) is the posture in
    which its cell has it begin, None where no cell is given; `relations` between joints are its cell's,
    as is the `scene` around the robot, None where no cell is given.
    """

    outline: Outline
    robot: RobotDescription | None
    start: Floats | None = None
    relations: tuple[Relation, ...] = ()
    blocks_fit: bool = True
    scene: Scene | None = None

    @cached_property
    def moves(self) -> list[MoveRows]:
        """The recorded moves in order."""
        return moves_of(self.outline)

    @cached_property
    def limits(self) -> LimitsInForce:
        """The limits in force at each row."""
        return limits_in_force(self.outline, self.moves)

    def posture(self, row: int) -> Floats:
        """Joint values (n,) of a row in which a block ends."""
        return np.array(self.outline.posture(row))

    @cached_property
    def placer(self) -> Placer:
        """Finds where targets are, with the tools that the stream's blocks set and the frames they name."""
        records = self.outline.records
        return Placer(self.robot, tools_of(records), frames_of(records, self.robot))

    @cached_property
    def demands(self) -> dict[int, Demand]:
        """What each move asks for, by its id."""
        found = demands_of(self.outline, self.moves, self.placer) if self.blocks_fit else []
        return {demand.move.block.id: demand for demand in found}

    @cached_property
    def chains(self) -> list[tuple[Demand, ...]]:
        """Moves of the tool that run into each other, or along a PATH: from stop to stop."""
        found, chain = [], list[Demand]()
        for demand in self.demands.values():
            chain.append(demand)
            if not demand.passes or demand.crosses[1]:
                block = demand.move.block
                broken_off = block.blend is not None and not demand.move.finished
                crosses = chain[0].crosses[0] or demand.crosses[1]
                if block.kind is not MoveKind.PTP and (
                    len(chain) > 1 or block.path is not None or broken_off or crosses
                ):
                    found.append(tuple(chain))
                chain = []
        return found

    @cached_property
    def chained(self) -> frozenset[int]:
        """Ids of the moves in `chains`."""
        return frozenset(demand.move.block.id for chain in self.chains for demand in chain)

    @cached_property
    def reaches(self) -> dict[int, float]:
        """How far corners between a PTP and a move of the tool may reach, m: of a PTP by its id before it,
        by its negative id behind it, as far as it has been found out."""
        found = {}
        for demand, following in pairwise(self.demands.values()):
            if demand.crosses[1] and following.move.block.kind is MoveKind.PTP:
                found[following.move.block.id] = end_reach(demand)
        return found

    @cached_property
    def joint_rates(self) -> tuple[Tally, Tally]:
        """Tallies of programmed speeds and accelerations, which several judges add to."""
        return (
            self.tally("programmed speed", "m/s|rad/s"),
            self.tally("programmed acceleration", "m/s2|rad/s2"),
        )

    def tally(self, name: str, unit: str) -> Tally:
        """An empty tally for a check of this stream."""
        return Tally(name, unit, self.outline)
