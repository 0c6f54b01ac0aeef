"""Blocks that add criteria to what decides the posture, and the clauses by which moves do."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.blocks.block import Block, Origin

LIBRARY = (
    "VELOCITY_RATIO",
    "KINETIC_ENERGY",
    "ENERGY_INCREMENT",
    "GRAVITY_TORQUE",
    "JOINT_CENTRING",
    "JOINT_BARRIER",
    "MANIPULABILITY",
    "SMALLEST_SINGULAR_VALUE",
    "DYNAMIC_MANIPULABILITY",
)
"""Criteria that every machine knows; users may register others."""


@dataclass(frozen=True)
class CriterionParam:
    """A parameter of a criterion beside WEIGHT: its name in upper case, and its value."""

    name: str
    value: float


@dataclass(frozen=True)
class CriterionChoice:
    """A criterion by its name in upper case, its weight beside the posture term, and its parameters."""

    name: str
    weight: float
    params: tuple[CriterionParam, ...] = ()


@dataclass(frozen=True)
class CriterionClause:
    """A criterion that is added for one move, in place of the switched one of its name; with its place."""

    choice: CriterionChoice
    origin: Origin


@dataclass(frozen=True, kw_only=True)
class CriterionBlock(Block):
    """From here on the criterion of this name is added, in place of an earlier one; `choice` None ends it."""

    name: str
    choice: CriterionChoice | None
