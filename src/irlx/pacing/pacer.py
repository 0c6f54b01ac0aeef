"""Executes blocks one after another on one robot: the owner of posture, tick and options."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import takewhile

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import (
    AskAvoidingPosture,
    AskClearance,
    AskInput,
    AskInputChange,
    AskJointBounds,
    AskLastMove,
    AskManipulability,
    AskNearestPosture,
    AskPose,
    AskPosture,
    Block,
    CriterionBlock,
    FreezeBlock,
    LimitSwitchBlock,
    LinkFrame,
    MachineQuestion,
    MoveBlock,
    MoveKind,
    ObstacleBlock,
    Origin,
    PauseBlock,
    PoseTarget,
    ReconfigureBlock,
    ToolBlock,
    WaitBlock,
    WeightsBlock,
)
from irlx.diagnostics import Diagnostic, Place
from irlx.pacing.answers import answer_of_bounds, answer_of_last_move, answer_of_posture, way_of
from irlx.pacing.avoiding_posture import avoiding_posture
from irlx.pacing.beyond import posture_beyond, ticks_beyond
from irlx.pacing.carried import Carried, are_of_one_kind, crossed, passes
from irlx.pacing.clearance_answers import Clearances, pairs_of
from irlx.pacing.executed import Executed
from irlx.pacing.frames import seen_from
from irlx.pacing.inputs import answer_of_inputs
from irlx.pacing.joint_moves import move_joints
from irlx.pacing.kept_clear import KeptClear
from irlx.pacing.motion import Motion
from irlx.pacing.moved_constraints import moved_constraints
from irlx.pacing.nearest_rows import nearest_rows
from irlx.pacing.notes import Notes
from irlx.pacing.options import LimitsInForce, Options, SwitchBlock
from irlx.pacing.path_moves import move_along_path
from irlx.pacing.posed import Pose
from irlx.pacing.posture_left import posture_left, why_left
from irlx.pacing.postures import asked_posture, posture_of_pose
from irlx.pacing.reconfigure import reconfigured
from irlx.pacing.refitting import refitted
from irlx.pacing.resolution import RowTicks
from irlx.pacing.rows import MotionRows
from irlx.pacing.situation import PacingSetup, Situation
from irlx.pacing.snap import snapped
from irlx.pacing.spare import check_spare
from irlx.pacing.switches import check_frozen, check_inside, check_limit
from irlx.pacing.tolerance import lets_turn
from irlx.pacing.too_near import check_rows, passed_by, standing
from irlx.pacing.waiting import waited
from irlx.transform.clearance import Clearance
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.rough_tick import RoughTickSolver
from irlx.transform.tick import TickSolver

Array = NDArray[np.float64]


class Pacer:
    """Carries a robot through blocks. Each move runs from rest to rest and ends with a hold tick."""

    def __init__(self, setup: PacingSetup, locate: Callable[[Origin], Place]) -> None:
        self._setup = setup
        self._robot = setup.kinematics.description
        self.locate = locate
        self.qp = ProxQpSolver()
        self._solver = self._new_solver()
        self.q = setup.start
        self.tick = 0
        self.options = Options()
        self.warnings: list[Diagnostic] = []
        self.notes = Notes(self.warnings)
        self._last_way = (0.0, 0.0)
        self._distances = Clearances(setup.kinematics, setup.scene)
        self._links_checked = False
        self._kept = KeptClear(setup.kinematics, setup.scene, self.options)
        self._rest: MoveBlock | None = None
        self._constraints = setup.kinematics.constraints
        self._programmed_in: LinkFrame | None = None
        self._programmed: Pose | None = None
        """Where the path of the last move ended in its frame, if it was one WITH TOLERANCE."""
        self._asked: Array | None = None
        self._looked_at = set[int]()

    def _new_solver(self) -> TickSolver:
        """What solves the ticks: roughly in a dry run."""
        solver = RoughTickSolver if self._setup.resolution.is_coarse else TickSolver
        return solver(self._setup.kinematics, self.qp)

    def answer(self, question: MachineQuestion) -> tuple[float, ...]:
        """Answer to a question of the interpreter, all blocks before it executed.

        Raises PacingError: IRL522 for the posture of a pose that none reaches; IRL573, IRL574 where there is
        no distance to tell.
        """
        if isinstance(question, AskPosture):
            return tuple(float(value) for value in self.q)
        if isinstance(question, AskInput | AskInputChange):
            setup = self.setup
            return answer_of_inputs(question, setup.inputs, self.tick * setup.dt, setup.dt, self.locate)
        if isinstance(question, AskPose | AskManipulability):
            return answer_of_posture(question, self.setup.kinematics)
        if isinstance(question, AskClearance):
            time = self.tick * self.setup.dt
            return self._distances.answer(question, time, self.locate(question.origin))
        if isinstance(question, AskAvoidingPosture):
            place = self.locate(question.origin)
            return avoiding_posture(question, self._situation.in_frame(None, place))
        if isinstance(question, AskLastMove):
            return answer_of_last_move(*self._last_way)
        if isinstance(question, AskJointBounds):
            return answer_of_bounds(self._situation.in_force().limits)
        target, place = PoseTarget(question.position, question.orientation), self.locate(question.origin)
        situation = self._situation.in_frame(None, place)
        near = np.array(question.near) if isinstance(question, AskNearestPosture) else None
        return tuple(posture_of_pose(target, near, situation, situation.in_force(), place).tolist())

    @property
    def clearance(self) -> Clearance | None:
        """What is kept clear as the switches stand, None where nothing is."""
        return self._kept.clearance

    @property
    def _clear_from_now(self) -> Clearance | None:
        """What is kept clear in a motion that begins now."""
        return self._from_now(self.clearance)

    def _from_now(self, clearance: Clearance | None) -> Clearance | None:
        return None if clearance is None else clearance.beginning(self.tick * self.setup.dt)

    @property
    def _situation(self) -> Situation:
        """What the next motion finds."""
        return Situation(
            self.setup,
            self.q,
            self.tick,
            self.options,
            self._solver,
            self.qp,
            self.locate,
            self.warnings,
            self.notes,
            self._clear_from_now,
            self._programmed,
            self._programmed_in,
            self._asked,
            self._looked_at,
        )

    @property
    def setup(self) -> PacingSetup:
        """The robot as it is now: with the tool and weights that the program has given it."""
        return self._setup

    def settled(self, block: Block) -> Block:
        """The block as it is executed here: bounds that mean the present posture lie exactly on it."""
        return snapped(block, self.q)

    def carry_out(self, group: Sequence[Block]) -> Iterator[Executed]:
        """Execute a group of `Lookahead`, block after block.

        Raises PacingError or MotionError with the place of the block; the state stays where it is then.
        """
        if len(group) == 1 and not isinstance(group[0], MoveBlock):
            block, tick = self.settled(group[0]), self.tick
            yield Executed(block, tick, self.execute(block))
            return
        waiting = [self.settled(block) for block in group]
        stood = self._situation.pose[1]
        for carried in self._joined(waiting):
            for executed in carried.parts:
                stood = self._note_way(executed, stood)
                yield executed

    def _joined(self, waiting: list[Block]) -> Iterator[Carried]:
        """What becomes of moves with signals between them: motions, joined where joint space meets a path.

        A motion that may be joined to the next one comes when that is known.
        """
        held: Carried | None = None
        while waiting:
            try:
                carried = self._carried(waiting)
            except Exception:
                if held is not None:
                    yield held
                raise
            if held is not None:
                held, carried = self._crossed(held, carried)
                yield held
            held = carried if self._may_cross(carried, waiting) else None
            if held is None:
                yield carried

    def _carried(self, waiting: list[Block]) -> Carried:
        """The first motion that blocks become, taken out of them, with the signals before and inside it."""
        parts: list[Executed] = []
        moves = [block for block in waiting if isinstance(block, MoveBlock)]
        if not moves:
            parts = [Executed(block, self.tick, None) for block in waiting]
            waiting.clear()
            return Carried(tuple(parts))
        motion = self._motion(_of_one_kind(moves))
        begins = waiting[0] is not self._rest
        for found in motion.rows:
            block = waiting.pop(0)
            while not isinstance(block, MoveBlock):
                parts.append(Executed(block, self.tick, None))
                block = waiting.pop(0)
            tick = self.tick
            parts.append(Executed(block, tick, self._moved(found, motion.in_force), begins))
            begins = True
        self._rest = motion.rest
        self._note_asked(motion)
        if motion.rest is not None:
            waiting.insert(0, motion.rest)
        return Carried(tuple(parts), motion.rooms)

    def _may_cross(self, carried: Carried, waiting: Sequence[Block]) -> bool:
        """Whether a motion may be joined to the next one, of the other kind, by overlapping it."""
        last = carried.last
        following = next((block for block in waiting if isinstance(block, MoveBlock)), None)
        if last is None or following is None or not passes(last.block):
            return False
        # A dry run has no ticks to overlap; what modifies a demand counts on its tick, and an obstacle that
        # moves is where it is at that.
        able = not (self._setup.resolution.is_coarse or self._setup.modifiers or self._setup.scene.moves)
        return able and self._rest is None and not are_of_one_kind(last.block, following)

    def _crossed(self, held: Carried, carried: Carried) -> tuple[Carried, Carried]:
        """Two motions as they are joined, or as they were; a note says what became of the corner."""
        limits = self._situation.in_force().limits
        done = crossed(
            held, carried, self._setup.kinematics, limits, self._setup.dt, self.locate, self.clearance
        )
        for note in done.notes:
            self.notes.add(note)
        self.tick -= done.saved
        return done.motions

    def stand_beyond(self, move: MoveBlock) -> None:
        """Put the robot where it would stand behind a move that it cannot do, and the time with it.

        For a dry run alone. Raises PacingError or MotionError where no posture is there; it stays then.
        """
        place = self.locate(move.origin)
        situation = self._situation.in_frame(move.frame, place)
        end = posture_beyond(situation, move, situation.in_force(move.limits), place)
        self.tick += ticks_beyond(situation, move, place)
        self.q, self._programmed, self._asked = end, None, None

    def execute(self, block: Block) -> MotionRows | None:
        """Execute one block; returns the rows of a move (None for a switch or a move of no length).

        Raises PacingError or MotionError with the place of the block; the state stays at its start.
        """
        if isinstance(block, MoveBlock):
            motion, start = self._motion([block]), self._situation.pose[1]
            rows = self._moved(motion.rows[0], motion.in_force)
            self._note_asked(motion)
            self._last_way = way_of(rows, start, self._setup.dt)
            return rows
        if isinstance(block, ReconfigureBlock):
            return self._reconfigure(block)
        place = self.locate(block.origin)
        if isinstance(block, WaitBlock | PauseBlock):
            return self._wait(block, place)
        self._check_switch(block, place)
        if isinstance(block, ToolBlock | WeightsBlock):
            self._setup = refitted(self._setup, block, place)
            self._asked = None if isinstance(block, ToolBlock) else self._asked
            self._solver = self._new_solver()
        if isinstance(block, ToolBlock):
            self._programmed = None
        if isinstance(block, SwitchBlock):
            self.options = self.options.after(block, self.q)
        if isinstance(block, ToolBlock | ObstacleBlock):
            self._kept = KeptClear(self._setup.kinematics, self._setup.scene, self.options)
        if isinstance(block, ObstacleBlock) and block.active:
            members = self._setup.scene.members(block.name)
            names = [obstacle.name for obstacle in members]
            alone = self._from_now(self._kept.clearance_from(members))
            self.warnings += standing(alone, self.q, names, place)
        return None

    def _check_switch(self, block: Block, place: Place) -> None:
        """Raise PacingError for a switch that the robot cannot have; warns of what it has otherwise."""
        if isinstance(block, LimitSwitchBlock):
            self.warnings += check_limit(block, self._robot, self.setup.limits, self.q, place)
        if isinstance(block, FreezeBlock):
            self._freeze(block, place)
        if isinstance(block, CriterionBlock) and block.choice is not None:
            from irlx.pacing.criteria import check_criterion

            check_criterion(block.choice, self._robot, place)
        if isinstance(block, ObstacleBlock):
            pairs_of(block.name, self.setup.kinematics, self.setup.scene, place)

    def _freeze(self, block: FreezeBlock, place: Place) -> None:
        """From now on ticks meet only what the other joints can break.

        Raises PacingError: IRL346 for a joint that the robot does not have, IRL347 for too many.
        """
        check_frozen(block, self._robot, place)
        free = np.ones(self.q.size, dtype=bool)
        free[[number - 1 for number in block.joints]] = False
        kinematics = self.setup.kinematics
        constraints = moved_constraints(self._constraints, self._robot, self.q, free)
        if constraints != kinematics.constraints:
            kinematics = kinematics.constrained(constraints)
        if not self.setup.may_free:
            check_spare(self.options.after(block, self.q), kinematics.of_pose, None, self.locate)
        if kinematics is not self.setup.kinematics:
            self._setup = replace(self._setup, kinematics=kinematics)
            self._solver = self._new_solver()
            self._kept = KeptClear(kinematics, self._setup.scene, self.options)

    def _motion(self, moves: list[MoveBlock]) -> Motion:
        """The first motion from stop to stop that moves become."""
        block = moves[0]
        self._tell_begin(block)
        self._check_links(self.locate(block.origin))
        for clause in block.limits:
            place = self.locate(clause.origin)
            self.warnings += check_limit(clause, self._robot, self.setup.limits, self.q, place)
        situation, place = self._situation, self.locate(block.origin)
        in_force = situation.in_force(block.limits)
        # A clause may have let a joint out of the switch that holds again now.
        check_inside(self.q, self._robot, in_force.limits, place)
        if block.kind is MoveKind.PTP:
            motion = move_joints(situation, moves, in_force)
        else:
            kinematics = seen_from(self.setup.kinematics, block.frame, place)
            check_spare(situation.options, kinematics, block.tolerance, self.locate)
            motion = move_along_path(situation, moves, in_force)
        self._programmed, self._programmed_in = motion.programmed, block.frame
        # Turned within bands, the tool is not as it was asked to be: what follows begins where it stands.
        return replace(motion, asked=None) if lets_turn(block.tolerance, situation.kinematics) else motion

    def _tell_begin(self, block: Block) -> None:
        if self._setup.watch is not None:
            self._setup.watch.begins(block, self.tick)

    def _note_asked(self, motion: Motion) -> None:
        """Where joints turn the tool in ways that nobody asks for, keep what was asked for last."""
        self._asked = motion.asked if self._setup.kinematics.leaves_turns else None

    def _check_links(self, place: Place) -> None:
        """Before the first motion: whether the robot stands clear of itself."""
        if not self._links_checked:
            self._links_checked = True
            self.warnings += standing(self._clear_from_now, self.q, self._robot.solids, place)

    def _note_way(self, executed: Executed, start: Array) -> Array:
        """Keep duration and way of the last move, which starts with the tool at a position (3,) m, and give
        back where it ends; a further part of a move that had to stop on its way is added to it."""
        rows = executed.rows
        if isinstance(executed.block, MoveBlock):
            way = way_of(rows, start, self._setup.dt)
            before = (0.0, 0.0) if executed.begins else self._last_way
            self._last_way = (before[0] + way[0], before[1] + way[1])
        return start if rows is None else rows.tool_position[-1]

    def _moved(self, rows: MotionRows | None, in_force: LimitsInForce) -> MotionRows | None:
        """The rows of a motion with its limits, the robot now standing at their end."""
        if rows is None:
            return None
        setup = self.setup
        ticking = RowTicks(rows.first_tick, setup.dt, rows.ticks / len(rows))
        clear = self._clear_from_now
        # Nobody is told of the rows of a dry run.
        if setup.resolution.is_coarse:
            nearest = None
        else:
            dt = setup.dt * rows.ticks / len(rows)
            nearest = nearest_rows(clear, rows.q, dt) if rows.nearest is None else rows.nearest
        place = self.locate(rows.block.origin)
        if rows.stops:
            self.warnings += passed_by(clear, rows.q, ticking, place)
        self.q = rows.q[-1]
        self.tick += rows.ticks
        return replace(rows, limits=in_force.limits, nearest=nearest)

    def _wait(self, block: WaitBlock | PauseBlock, place: Place) -> MotionRows | None:
        setup = self.setup
        rows = waited(block, self.q, setup.dt, self.tick + 1, setup.kinematics, place, setup.resolution)
        if rows is not None and setup.scene.moves:
            ticking = RowTicks(self.tick + 1, setup.dt, rows.ticks / len(rows))
            check_rows(self._clear_from_now, rows.q, self.q, ticking, "while it waits something", place)
        return self._moved(rows, self._situation.in_force())

    def _reconfigure(self, block: ReconfigureBlock) -> MotionRows | None:
        place = self.locate(block.origin)
        self._tell_begin(block)
        if self._setup.watch is not None:
            self._setup.watch.plans()
        situation = self._situation.in_frame(block.frame, place)
        check_spare(situation.options, situation.kinematics, None, self.locate)
        in_force = situation.in_force()
        check_inside(self.q, self._robot, in_force.limits, place)
        konf = asked_posture(block.target, situation, in_force, place)
        setup, model = self.setup, situation.model(in_force)
        first, fine = self.tick + 1, setup.resolution
        found = reconfigured(model, block, self.q, konf, setup.dt, first, place, self.qp, fine)
        left = found.flow.remaining
        why = why_left(found.flow.end, left, found.held, self._robot)
        self.warnings += posture_left(left, why, self._robot, place)
        return self._moved(found.rows, in_force)


def _of_one_kind(moves: Sequence[MoveBlock]) -> list[MoveBlock]:
    """The first moves that are all of the joints, or all along paths."""
    return list(takewhile(lambda move: are_of_one_kind(moves[0], move), moves))
