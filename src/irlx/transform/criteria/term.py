"""Terms: what CRITERION adds to the posture term of a move."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics

if TYPE_CHECKING:
    from irlx.transform.measures.measure import Measure

Array = NDArray[np.float64]

_SLOWEST = 1e-3
_LEAST_SHARE = 0.1
_LEAST_VALUE = 1e-300

REFERENCE_TICK = 0.01
"""Tick, s, at which energies are counted as such beside the posture term, whatever the tick is: a kinetic
energy 1/2 S' M S / dt^2 would outweigh it the more the shorter the tick."""


class Term(ABC):
    """An addition  b' S + 1/2 S' B S  to the criterion of a tick, S (n,) the step since its start.

    `q` (n,) is the posture at that start, `elapsed` the time in s that the tick's part of the path takes at
    the cruising speed of the programme: on ramps and where the tool is slowed less than the tick, at rest
    nothing. So what a term does depends on the path and not on its clock.
    """

    name: str

    @abstractmethod
    def linear(self, q: Array, elapsed: float) -> Array:
        """b, shape (n,)."""

    def quadratic(self, q: Array) -> Array | None:
        """B, symmetric and positive semidefinite: a diagonal (n,), or whole (n, n), or None for none."""
        return None

    def acts(self, q: Array) -> bool:
        """Whether there is anything of it in a tick that begins at posture q (n,)."""
        return True

    def posture_share(self, q: Array) -> float:
        """Part of the posture term that counts beside this one."""
        return 1.0


class MeasureTerm(Term):
    """Goes down (up, where large values are good) the gradient of a measure: b = sense gain elapsed dc/dq.

    `gain` in 1/s. With the posture term 1/2 S' W S alone that is a speed of -gain W^-1 dc/dq inside the null
    space. Of measures that are to be large the logarithm counts, dc/dq / c, so that their unit does not
    matter; c counts as a tenth of its value at the posture `start` (n,) of the move, at least.
    """

    def __init__(self, measure: Measure, gain: float, start: Array) -> None:
        self.name = measure.name
        self._measure = measure
        self._gain = measure.sense * gain
        self._least = 0.0
        if measure.sense < 0:
            self._least = max(_LEAST_SHARE * measure.value(start), _LEAST_VALUE)

    def linear(self, q: Array, elapsed: float) -> Array:
        """sense * gain * elapsed * gradient."""
        slope = self._gain * elapsed * self._measure.gradient(q)
        return slope / max(self._measure.value(q), self._least) if self._least else slope


class KineticEnergy(Term):
    """1/2 v' M(q) v of the whole robot: B = M / `REFERENCE_TICK`^2, M the mass matrix at the tick's start."""

    name = "kinetic energy"

    def __init__(self, kinematics: Kinematics) -> None:
        self._kinematics = kinematics

    def linear(self, q: Array, elapsed: float) -> Array:
        """Nothing."""
        return np.zeros(q.size)

    def quadratic(self, q: Array) -> Array:
        """M(q) / `REFERENCE_TICK`^2, shape (n, n)."""
        from irlx.transform.measures.inertia import inertia_matrix

        return inertia_matrix(self._kinematics, q) / REFERENCE_TICK**2


class EnergyIncrement(KineticEnergy):
    """What a tick adds to the robot's energy: kinetic energy, and b = tau_g(q) elapsed / `REFERENCE_TICK`."""

    name = "energy increment"

    def linear(self, q: Array, elapsed: float) -> Array:
        """Work against gravity."""
        from irlx.transform.measures.gravity_torque import gravity_torque

        return np.asarray(gravity_torque(self._kinematics, q) * (elapsed / REFERENCE_TICK))


class VelocityRatio(Term):
    """Speed of the joints against that of the tool: 1/2 S' W S / (v' Wx v), v the programmed twist.

    Alone it asks for the same as least motion; beside other terms it weighs the posture term.
    """

    name = "velocity ratio"

    def __init__(self, weights: Array, tool_speed: float) -> None:
        """`tool_speed` sqrt(v' Wx v): m/s, turns in rad/s times the robot's reach."""
        self._weights = weights / max(tool_speed, _SLOWEST) ** 2

    def linear(self, q: Array, elapsed: float) -> Array:
        """Nothing."""
        return np.zeros(q.size)

    def quadratic(self, q: Array) -> Array:
        """W / (v' Wx v), shape (n,)."""
        return self._weights
