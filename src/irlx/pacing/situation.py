"""What a motion finds when it begins: the robot, where it stands, and what is in force."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import LimitClause, LinkFrame, Origin
from irlx.diagnostics import Diagnostic, Place
from irlx.pacing.correction.share import planned_limits
from irlx.pacing.demand import DemandModifier
from irlx.pacing.frames import seen_from
from irlx.pacing.freed import Freed
from irlx.pacing.inputs import Inputs
from irlx.pacing.notes import Notes
from irlx.pacing.options import LimitsInForce, Options, limits_in_force
from irlx.pacing.resolution import EVERY_TICK, Resolution
from irlx.pacing.slowdown.model import Model
from irlx.pacing.watch import Watch
from irlx.robot.description import RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.scene.scene import Scene
from irlx.transform.clearance import Clearance
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.tick import TickSolver

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PacingSetup:
    """The robot as a run finds it: model, own limits, weights (n,), start posture (n,), tick in s.

    A move may take `max_slow` times as long as programmed, and a tick; `inputs` are what the world says;
    `resolution` tells how finely motions are worked out; motions are planned with `planned_share`
    of each speed and acceleration limit; `scene` is what stands around;
    `may_free`: moves to come may be WITH TOLERANCE; `watch` is told what is being worked on.
    """

    kinematics: Kinematics
    limits: JointLimits
    weights: Array
    start: Array
    dt: float
    modifiers: Sequence[DemandModifier] = ()
    max_slow: float = inf
    inputs: Inputs = field(default_factory=Inputs)
    resolution: Resolution = EVERY_TICK
    planned_share: float = 1.0
    scene: Scene = field(default_factory=Scene)
    may_free: bool = False
    watch: Watch | None = None


@dataclass(frozen=True)
class Situation:
    """The robot at rest in posture `q` (n,) at a tick, the options in force, and what solves its ticks.

    `warnings` and `notes` collect what is found on the way, also before an error; `clearance` is what is kept
    clear. `programmed`: where the path of a move WITH TOLERANCE ended, rotation (3, 3) and position (3,) m,
    while the tool stands off it; `freed`: the robot where virtual joints stand among its own.
    `asked` (3, 3) is the orientation that was asked for last, None where that is the tool's own: a
    robot whose task leaves turns to the joints goes on from it, or what it makes of them would add up.
    `looked_at` are ids of moves along a PATH whose points have been looked at.
    """

    setup: PacingSetup
    q: Array
    tick: int
    options: Options
    solver: TickSolver
    qp: ProxQpSolver
    locate: Callable[[Origin], Place]
    warnings: list[Diagnostic]
    notes: Notes
    clearance: Clearance | None = None
    programmed: tuple[Array, Array] | None = None
    programmed_in: LinkFrame | None = None
    asked: Array | None = None
    looked_at: set[int] = field(default_factory=set)
    freed: Freed | None = None

    @property
    def kinematics(self) -> Kinematics:
        """The robot's model."""
        return self.setup.kinematics

    @property
    def robot(self) -> RobotDescription:
        """The robot as plain data."""
        return self.setup.kinematics.description

    @property
    def dt(self) -> float:
        """Length of a tick, s."""
        return self.setup.dt

    @property
    def free(self) -> NDArray[np.bool_]:
        """The joints (n,) that are not frozen."""
        return self.options.free_joints(self.q.size)

    @property
    def pose(self) -> tuple[Array, Array]:
        """Rotation (3, 3), or that asked for, and position (3,) m of the tool in the world, or in
        the frame of the situation."""
        rotation, position = self.kinematics.tool_pose(self.q)
        return (rotation if self.asked is None else self.asked), position

    def in_frame(self, frame: LinkFrame | None, place: Place) -> Situation:
        """The same for motions to poses, which are told in a frame that moves with a link or in the world.

        Raises PacingError: IRL515 where the robot has no such link.
        """
        kinematics = seen_from(self.kinematics, frame, place)
        programmed = self.programmed if self.programmed_in == frame else None
        if kinematics is self.kinematics and programmed is self.programmed:
            return self
        setup = replace(self.setup, kinematics=kinematics)
        solver = type(self.solver)(kinematics, self.qp)
        return replace(self, setup=setup, solver=solver, programmed=programmed)

    def in_force(self, clauses: Iterable[LimitClause] = ()) -> LimitsInForce:
        """Joint limits of a motion with its own clauses."""
        found, share = limits_in_force(self.setup.limits, self.options, clauses), self.setup.planned_share
        return found if share == 1.0 else replace(found, limits=planned_limits(found.limits, share))

    def model(self, in_force: LimitsInForce) -> Model:
        """What planning needs to know of the robot."""
        setup = self.setup
        return Model(self.kinematics, in_force.limits, setup.weights, self.free, self.clearance)
