"""Constraints of a cell as what ticks are solved with, checked against the robot's model and the start."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx.cell.cell import Cell, RegisteredConstraint
from irlx.cell.errors import CellError
from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.promises import CONDITION
from irlx.robot.axis_constraint import AxisConstraint
from irlx.robot.axis_direction import AxisDirection
from irlx.robot.equality import Constraint, LinearConstraint
from irlx.robot.kinematics import Kinematics
from irlx.robot.link_constraint import LinkConstraint
from irlx.robot.link_path import LinkPath
from irlx.robot.path_constraint import PathConstraint
from irlx.robot.registered_constraints import registered_constraints
from irlx.robot.relation import JointRelation
from irlx.transform.nearest import scaled_singular_values

Array = NDArray[np.float64]

_POSTURES, _STEPS, _SEED = 3, 60, 5
_FLAT = 1e-3
_ROUNDING = 1e-9


@dataclass(frozen=True)
class _Made:
    """A constraint, its name in the cell and its place there."""

    constraint: Constraint
    name: str
    place: Place


def constrained(plain: Kinematics, cell: Cell) -> Kinematics:
    """The kinematics of a cell's robot with the cell's constraints.

    Raises CellError: IRL616, IRL619 for a constraint that the start breaks, IRL617 for one that nobody
    registered, IRL624 for one that holds what joints cannot move, or what the tool's pose holds already.
    """
    if not (cell.relations or cell.registered):
        return plain
    made = [
        *_of_links_and_joints(cell, plain),
        *(_registered(asked, cell, plain) for asked in cell.registered),
    ]
    # Poses in a frame that moves may leave what poses in the world do not.
    views = [plain, *(plain.relative_to(frame) for frame in cell.link_frames.values())]
    faults = [_dependent(made, view, cell) for view in views]
    if None not in faults:
        raise CellError([fault for fault in faults[:1] if fault is not None])
    return plain.constrained([one.constraint for one in made])


def _of_links_and_joints(cell: Cell, plain: Kinematics) -> Iterator[_Made]:
    for relation in cell.relations:
        place = Place(cell.file, key=relation.key)
        if isinstance(relation, JointRelation):
            yield _Made(LinearConstraint(relation, cell.robot.joint_names), relation.name, place)
            continue
        constraint = _of_link(relation, plain)
        if not _broken(constraint, cell) <= CONDITION:
            off = constraint.in_words(cell.start)
            raise CellError(report("IRL619", place, name=relation.name, off=off))
        yield _Made(constraint, relation.name, place)


def _of_link(relation: AxisDirection | LinkPath, plain: Kinematics) -> LinkConstraint:
    if isinstance(relation, AxisDirection):
        return AxisConstraint(relation, plain)
    return PathConstraint(relation, plain)


def _registered(asked: RegisteredConstraint, cell: Cell, plain: Kinematics) -> _Made:
    makers = registered_constraints()
    maker = makers.get(asked.use)
    if maker is None:
        known = ", ".join(sorted(makers)) or "none"
        near = near_matches(asked.use, sorted(makers))
        raise CellError(report("IRL617", asked.place, use=asked.use, near=near, known=known))
    constraint = maker(plain)
    broken = _broken(constraint, cell)
    if not broken <= CONDITION:
        told: dict[str, Any] = {"name": asked.name, "found": f"{broken:.6g}", "due": "0"}
        raise CellError(report("IRL616", asked.place, **told))
    return _Made(constraint, asked.name, asked.place)


def _broken(constraint: Constraint, cell: Cell) -> float:
    return float(np.linalg.norm(constraint.residual(cell.start)))


def _dependent(made: list[_Made], plain: Kinematics, cell: Cell) -> Diagnostic | None:
    """The first constraint whose rows say nothing new beside the task and the constraints before it."""
    postures = _kept(plain.constrained([one.constraint for one in made]), plain.task.size, cell.start)
    before = _rank(plain, postures)
    for count, one in enumerate(made, start=1):
        size = len(one.constraint.residual(cell.start))
        rank = _rank(plain.constrained([other.constraint for other in made[:count]]), postures)
        if rank < before + size:
            return report("IRL624", one.place, name=one.name, rows=size, left=rank - before)
        before = rank
    return None


def _rank(kinematics: Kinematics, postures: list[Array]) -> int:
    """Rank of the rows of a tick, the most of all postures: less than that is a property of a posture."""
    values = [scaled_singular_values(kinematics.here(q)[1], kinematics.row_scale) for q in postures]
    return max(int(np.count_nonzero(found > _ROUNDING * max(found[0], 1.0))) for found in values)


def _kept(kinematics: Kinematics, tool_rows: int, start: Array) -> list[Array]:
    """The start, and postures drawn at random, the same in every run, and led to where constraints hold.

    What a constraint leaves of the rows shows only there: an axis that its joints tilt one way alone is
    vertical by one coordinate, though off the vertical it has two.
    """
    reach = kinematics.description.reach
    wide = np.array([reach if axis.is_prismatic else 1.0 for axis in kinematics.description.axes])
    rng = np.random.default_rng(_SEED)
    found = [start]
    for _ in range(_POSTURES):
        q = start + wide * rng.uniform(-1.0, 1.0, start.size)
        for _ in range(_STEPS):
            left, matrix = (part[tool_rows:] for part in kinematics.here(q))
            if np.linalg.norm(left) <= _ROUNDING:
                found.append(q)
                break
            q = q + np.linalg.pinv(matrix, rcond=_FLAT) @ left
    return found
