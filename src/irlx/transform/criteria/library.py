"""Criteria by name: those of the library and those that users register."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.criteria.term import EnergyIncrement, KineticEnergy, MeasureTerm, Term, VelocityRatio
from irlx.transform.measures.dynamic_manipulability import DynamicManipulability
from irlx.transform.measures.gravity_torque import GravityTorque
from irlx.transform.measures.joint_centring import JointCentring
from irlx.transform.measures.manipulability import Manipulability
from irlx.transform.measures.measure import Measure
from irlx.transform.measures.smallest_singular_value import SmallestSingularValue

Array = NDArray[np.float64]

STANDARD_GRAVITY = 9.80665


@dataclass(frozen=True)
class TermSetting:
    """What a criterion may know of the move it acts in.

    The robot's kinematics, the limits in force, the weights (n,) of least motion, the posture (n,) in which
    the move starts, and the speed of the tool at the programme's cruise, sqrt(v' Wx v): m/s, turns in rad/s
    times the robot's reach.
    """

    kinematics: Kinematics
    limits: JointLimits
    weights: Array
    start: Array
    tool_speed: float


@dataclass(frozen=True)
class Entry:
    """How a criterion is made from its parameters; `gain` is the default of GAIN, None where it has none.

    `needs_masses`: it means nothing for a robot whose links have no mass.
    """

    make: Callable[[TermSetting, float], Term]
    gain: float | None = 10.0
    needs_masses: bool = False


MeasureMaker = Callable[[Kinematics, JointLimits], Measure]


def _measured(make: MeasureMaker, scale: Callable[[TermSetting], float] = lambda _: 1.0) -> Callable:  # type: ignore[type-arg]
    """Maker of a term that goes down a measure times a constant of the robot."""

    def term(setting: TermSetting, gain: float) -> Term:
        measure = make(setting.kinematics, setting.limits)
        return MeasureTerm(measure, gain * scale(setting), setting.start)

    return term


def _joints(setting: TermSetting) -> float:
    """The mean over the joints becomes the sum: what one joint is asked for does not depend on the others."""
    return float(setting.start.size)


def _weight_of_the_arm(setting: TermSetting) -> float:
    """1 / (m g reach)^2: gravity torques as shares of that of the whole arm stretched out."""
    mass = sum(inertial.mass for inertial in setting.kinematics.description.inertials.values())
    torque = mass * STANDARD_GRAVITY * setting.kinematics.description.reach
    return 1.0 / max(torque, 1e-12) ** 2


LIBRARY: Mapping[str, Entry] = {
    "VELOCITY_RATIO": Entry(lambda setting, _: VelocityRatio(setting.weights, setting.tool_speed), None),
    "KINETIC_ENERGY": Entry(lambda setting, _: KineticEnergy(setting.kinematics), None, True),
    "ENERGY_INCREMENT": Entry(lambda setting, _: EnergyIncrement(setting.kinematics), None, True),
    "GRAVITY_TORQUE": Entry(
        _measured(lambda kinematics, _: GravityTorque(kinematics), _weight_of_the_arm), 300.0, True
    ),
    "JOINT_CENTRING": Entry(_measured(lambda _, limits: JointCentring(limits, "square"), _joints)),
    "JOINT_BARRIER": Entry(_measured(lambda _, limits: JointCentring(limits, "barrier"), _joints)),
    "MANIPULABILITY": Entry(_measured(lambda kinematics, _: Manipulability(kinematics))),
    "SMALLEST_SINGULAR_VALUE": Entry(_measured(lambda kinematics, _: SmallestSingularValue(kinematics))),
    "DYNAMIC_MANIPULABILITY": Entry(
        _measured(lambda kinematics, _: DynamicManipulability(kinematics)), needs_masses=True
    ),
}
"""The criteria that every robot knows."""

_registered: dict[str, Entry] = {}


def register(criterion: type[Measure]) -> type[Measure]:
    """Make a criterion of your own known under its `name`; may be used as a decorator.

    The class is made once for every move that uses it, from the robot's `Kinematics` and the `JointLimits` in
    force. Programs call it by its name in upper case, with GAIN and WEIGHT. A name that is registered
    again is replaced; raises ValueError for a name of the library or one that no program could write.
    """
    name = criterion.name.upper()
    if name in LIBRARY:
        raise ValueError(f"{name} is a criterion of the library")
    if not name.isidentifier():
        raise ValueError(f"{criterion.name!r} is no name that a program could write")
    _registered[name] = Entry(_measured(criterion))
    return criterion


def known() -> dict[str, Entry]:
    """Every criterion by its name in upper case."""
    return {**LIBRARY, **_registered}
