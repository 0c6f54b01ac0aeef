"""A cell and a first program for a robot, tried before anybody sees them: what `irlx new` writes."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice, product
from math import floor, isfinite, log10
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from irlx.cell.bare_robot import BareRobot, bare_robot
from irlx.cell.build import from_si, to_si
from irlx.cell.new_cell_text import CellChoices, new_cell_text
from irlx.cell.new_program_text import FirstMoves, new_program_text
from irlx.diagnostics import Diagnostic, IrlxError, report
from irlx.robot.kinematics import Kinematics
from irlx.running import run
from irlx.solids.shape import Mesh
from irlx.streams.temporary_folder import temporary_folder
from irlx.transform.nearest import nearest_in_bounds
from irlx.transform.open_posture import open_posture
from irlx.verification import verify

Array = NDArray[np.float64]

_SHARE = 0.1
"""Length of the first moves as a share of the arm's."""

_PACE = 2.5
"""Speed of the tool over the length of a move, per s."""

_HALVINGS = 4
_STILL = 1e-9
_NEAR = 0.01
"""How near, as a share of a move and in rad, a search must come to a corner; the trial tells the rest."""

_FARTHER = {False: 12.0, True: 100.0}
"""How far, deg and mm, joints are from the first posture in the second one."""

_TRIED = 2
"""Rectangles of one size that are tried."""
_ASIDE = 5.0
"""How far, deg, the posture of the program is from the start, joints in turn to one side and the other."""

_WORST = 1e-4
"""Measure of `open_posture` below which no moves along a path are tried."""


@dataclass(frozen=True)
class FirstProgram:
    """Texts of cell and program, and what came of trying them.

    `duration` s, `checks` passed by the verifier; `warning` where the program has no moves along a path;
    `watched`: whether links were kept off each other in the trial, if the robot says so itself.
    """

    bare: BareRobot
    cell: str
    program: str
    moves: int
    duration: float
    checks: int
    warning: Diagnostic | None
    watched: bool = False


def first_program(name: str, model: str, tip: str | None, folder: Path) -> FirstProgram:
    """Cell `name`.toml and program `name`.irl in `folder`, for a robot by its name or URDF path.

    The program goes to a posture and, where one is found from which the tool has room, round a rectangle and
    back; it has run, and its stream has passed the verifier. Links are kept off each other where that lets it
    run. Raises CellError for a robot that cannot be used.
    """
    bare = bare_robot(model, tip)
    kinematics = Kinematics(bare.robot)
    q, measure = _start(bare, kinematics)
    start = tuple(_rounded(bare, joint, float(value)) for joint, value in enumerate(q))
    ready = _aside(bare, start)
    shown = model if bare.has_name else _path_from(folder, model)
    begin = None if bare.has_name and bare.start is not None else start
    cause = "no posture from which the tool could go on was found"
    for watched in _watching(bare):
        for edge, moves in _candidates(kinematics, bare, ready) if measure > _WORST else ():
            choices = CellChoices(name, shown, begin, _nice(_PACE * edge), watched)
            found = _tried(bare, choices, new_program_text(name, bare, ready, moves), model)
            if isinstance(found, FirstProgram):
                return found
            cause = found
    choices = CellChoices(name, shown, begin, _nice(_PACE * _nice(_size(bare))), _watching(bare)[-1])
    return _without_moves(bare, choices, ready, cause, model)


def _path_from(folder: Path, model: str) -> str:
    """Path of a URDF from the folder of the cell, in a form that no robot's name has."""
    path = os.path.relpath(model, folder)
    return path if "/" in path or "." in path else f"./{path}"


def _without_moves(
    bare: BareRobot, choices: CellChoices, ready: tuple[float, ...], cause: str, model: str
) -> FirstProgram:
    """A program that only goes to a posture, and says why."""
    text = new_program_text(choices.name, bare, ready, FirstMoves())
    found = _tried(bare, choices, text, model)
    if isinstance(found, FirstProgram):
        return replace(found, warning=report("IRL664", cause=cause))
    cell, warning = new_cell_text(bare, choices), report("IRL664", cause=found)
    return FirstProgram(bare, cell, text, text.count("  MOVE "), 0.0, 0, warning)


def _start(bare: BareRobot, kinematics: Kinematics) -> tuple[Array, float]:
    """Posture (n,) that the cell starts in, that of a robot with a name its own, and how open it is."""
    if bare.start is not None:
        return np.array([to_si(bare.robot, joint, value) for joint, value in enumerate(bare.start)]), 1.0
    return open_posture(kinematics, bare.limits)


def _watching(bare: BareRobot) -> tuple[bool | None, ...]:
    """Whether links are to be kept off each other: what is tried, in this order."""
    if bare.has_name:
        return (None,)
    return (True, False) if len(bare.robot.solids) > 1 and not _has_meshes(bare) else (False,)


def _has_meshes(bare: BareRobot) -> bool:
    """Whether links have meshes: between the triangles of large ones a verifier looks for minutes."""
    solids = (solid for solids in bare.robot.solids.values() for solid in solids)
    return any(isinstance(solid.shape, Mesh) for solid in solids)


def _rounded(bare: BareRobot, joint: int, value: float) -> float:
    """A joint value rad | m as whole deg | mm, or as it is where that passes a limit."""
    exact = from_si(bare.robot, joint, value)
    lower, upper = _position_limits(bare, joint)
    whole = float(round(exact))
    return whole if lower <= whole <= upper else exact


def _position_limits(bare: BareRobot, joint: int) -> tuple[float, float]:
    lower, upper = (float(side[joint]) for side in bare.limits.pair("position"))
    return from_si(bare.robot, joint, lower), from_si(bare.robot, joint, upper)


def _aside(bare: BareRobot, start: tuple[float, ...]) -> tuple[float, ...]:
    """A posture near the start: turning joints a little to one side and the other, slides where they are."""
    found = []
    for joint, value in enumerate(start):
        lower, upper = _position_limits(bare, joint)
        aside = 0.0 if bare.robot.axes[joint].is_prismatic else _ASIDE * (-1.0) ** joint
        moved = float(round(value)) + aside
        found.append(moved if lower <= moved <= upper else value)
    return tuple(found)


def _size(bare: BareRobot) -> float:
    """Length of the first moves, mm: a share of the arm, of the shortest stroke where only slides move."""
    axes, chain = bare.robot.axes, bare.robot.chain
    turning = [joint for joint in axes if not joint.is_prismatic and joint in chain]
    arm = 0.0
    if turning:
        arm = sum(float(np.linalg.norm(joint.xyz)) for joint in chain[chain.index(turning[0]) + 1 :])
    if arm == 0.0:
        strokes = [joint.upper - joint.lower for joint in axes if joint.is_prismatic]
        arm = min([stroke for stroke in strokes if isfinite(stroke) and stroke > 0.0], default=1.0)
    return 1e3 * _SHARE * arm


def _nice(length: float) -> float:
    """1, 2 or 5 times a power of ten, not above a length."""
    power = 10.0 ** floor(log10(max(length, 1e-3)))
    return max(factor * power for factor in (1.0, 2.0, 5.0) if factor * power <= length * (1.0 + 1e-9))


def _candidates(
    kinematics: Kinematics, bare: BareRobot, ready: tuple[float, ...]
) -> Iterator[tuple[float, FirstMoves]]:
    """What is tried, the best first, each with the length, mm, of its moves.

    Rectangles, large ones first, then lines to other postures: a robot with few axes may have no rectangle
    whose corners it reaches without turning its tool.
    """
    size = _size(bare)
    for halving in range(_HALVINGS):
        edge = _nice(size * 0.5**halving)
        for moves in islice(_rectangles(kinematics, bare, ready, edge), _TRIED):
            yield edge, moves
    for halving in range(_HALVINGS):
        there = _towards_room(bare, ready, 0.5**halving)
        if there != ready:
            yield _nice(size), FirstMoves(there=there)


def _towards_room(bare: BareRobot, ready: tuple[float, ...], share: float) -> tuple[float, ...]:
    """A posture with every joint moved by a share of `_FARTHER` to where it has more room."""
    found = []
    for joint, value in enumerate(ready):
        lower, upper = _position_limits(bare, joint)
        way = share * _FARTHER[bare.robot.axes[joint].is_prismatic]
        moved = value + (way if upper - value >= value - lower else -way)
        found.append(moved if lower <= moved <= upper else value)
    return tuple(found)


def _rectangles(
    kinematics: Kinematics, bare: BareRobot, ready: tuple[float, ...], edge: float
) -> Iterator[FirstMoves]:
    """Rectangles, or lines where the tool has one direction, whose corners can be reached."""
    q = np.array([to_si(bare.robot, joint, value) for joint, value in enumerate(ready)])
    directions, turned = _directions(kinematics, q)
    lower, upper = bare.limits.position_lower, bare.limits.position_upper
    free = np.ones(len(q), dtype=bool)
    rotation, position = kinematics.tool_pose(q)

    def reached(offset: Array) -> bool:
        moved = rotation @ offset if turned else offset
        target = kinematics.target(rotation, position + 1e-3 * moved)
        found = nearest_in_bounds(kinematics, target, q, lower, upper, free)
        return found.distance <= _NEAR * 1e-3 * edge and found.angle <= _NEAR

    able = [step for step in (edge * one for one in directions) if reached(step)]
    pairs = [(u, v) for u, v in product(able, able) if abs(float(u @ v)) < _STILL * edge * edge]
    for u, v in pairs:
        if reached(u + v):
            yield FirstMoves((_vector(u), _vector(u + v), _vector(v)), turned)
    if not pairs:
        yield from (FirstMoves((_vector(u),), turned) for u in able)


def _directions(kinematics: Kinematics, q: Array) -> tuple[list[Array], bool]:
    """Unit vectors (3,) along which the task lets the tool go; True where they are axes of the tool.

    Axes of the root frame where the task leaves them all to the tool, upwards first.
    """
    rotation, _ = kinematics.tool_pose(q)
    of_tool = [row for row in kinematics.task.rows if row < 3]
    span = rotation[:, of_tool]
    world = [np.eye(3)[:, axis] for axis in (2, 0, 1)]
    fit = [axis for axis in world if np.linalg.norm(axis - span @ (span.T @ axis)) < _STILL]
    turned = len(fit) < len(of_tool)
    axes = [np.eye(3)[:, row] for row in of_tool] if turned else fit
    return [side * axis for axis in axes for side in (1.0, -1.0)], turned


def _vector(step: Array) -> tuple[float, float, float]:
    x, y, z = (float(round(part, 6)) + 0.0 for part in step)
    return x, y, z


def _tried(bare: BareRobot, choices: CellChoices, program: str, model: str) -> FirstProgram | str:
    """What came of running and verifying the program, or why it does not run."""
    at = model if bare.has_name else str(Path(model).absolute())
    watched = False if _has_meshes(bare) else choices.watched
    there = replace(choices, model=at, watched=watched)
    with temporary_folder() as folder:
        path = folder / f"{choices.name}.irl"
        path.write_text(program, encoding="utf-8")
        path.with_suffix(".toml").write_text(new_cell_text(bare, there), encoding="utf-8")
        try:
            done = run(path)
            judged = verify(done, path, path.with_suffix(".toml"))
        except IrlxError as error:
            return next(one.message for one in error.diagnostics if one.is_error)
    if not judged.passed:
        return f"{judged.failed[0].name}: {judged.failed[0].text}"
    cell = new_cell_text(bare, choices)
    duration, moves = done.summary.duration, program.count("  MOVE ")
    return FirstProgram(bare, cell, program, moves, duration, len(judged.made), None, watched is not False)
