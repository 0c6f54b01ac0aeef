"""The one posture term of a move: a posture asked for, else cyclic return, else least motion; and what
CRITERION adds to it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from irlx.motion.time_law import TimeLaw
from irlx.pacing.governed_return import governed_reference
from irlx.pacing.return_way import return_way
from irlx.pacing.slowdown.model import Model
from irlx.transform.criteria.combined import Combined, Weighted
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture
from irlx.transform.criteria.restrained import HeldBack
from irlx.transform.qp.solver import QpSolver

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PostureTerm:
    """Criterion of a move: `at(s, advance)` of a tick that ends at path parameter s, `advance` behind the one
    before.

    `draws` tells that it draws the joints to a posture, and `through` at which path parameters on the way
    others are asked for; `otherwise` is the term for a motion that it makes impossible, `calmer` that for one
    that it makes swing.
    """

    at: Callable[[float, float], Criterion]
    draws: bool
    through: tuple[float, ...] = ()
    otherwise: PostureTerm | None = None
    calmer: PostureTerm | None = None

    def with_terms(self, terms: tuple[Weighted, ...], law: TimeLaw) -> PostureTerm:
        """The same with added terms, which act by the time that the way takes at the law's cruising speed."""
        if not terms:
            return self
        base = self.at
        otherwise = None if self.otherwise is None else self.otherwise.with_terms(terms, law)
        return replace(
            self,
            at=lambda s, advance: Combined(base(s, advance), terms, advance / law.speed),
            otherwise=otherwise,
        )

    def held_back(self, restraint: float) -> PostureTerm:
        """The same held back in every tick, see `irlx.transform.criteria.restrained`."""
        base = self.at
        return replace(self, at=lambda s, advance: HeldBack(base(s, advance), restraint), otherwise=None)


@dataclass(frozen=True)
class Asked:
    """Postures that a move is drawn to: `end` (n,), to be reached with its target.

    `on_the_way` are shares of the way, rising inside 0..1, each with the posture (n,) to be reached there.
    """

    end: Array
    on_the_way: tuple[tuple[float, Array], ...] = ()

    def reference(self, start: Array) -> Callable[[float], Array]:
        """Posture (n,) at a share of the way, from `start` (n,) to the end.

        In step with the share, or through the postures on the way without a jump of its rate and, of every
        joint, without a value beyond the two postures that it is between: a cubic between each two, by
        Fritsch and Butland.
        """
        if not self.on_the_way:
            way = self.end - start
            return lambda share: np.asarray(start + share * way)
        shares, postures = zip(*self.on_the_way, strict=True)
        from scipy.interpolate import PchipInterpolator

        curve = PchipInterpolator([0.0, *shares, 1.0], np.array([start, *postures, self.end]))
        return lambda share: np.asarray(curve(share))


def posture_term(
    model: Model, start: Array, law: TimeLaw, asked: Asked | None, cyclic: Array | None, qp: QpSolver
) -> PostureTerm:
    """Posture term of a move that starts at posture `start` (n,) and follows `law`.

    `asked` are the postures that it is drawn to, by a reference that runs with the path parameter, so that
    they are reached together with their places on the path. Else `cyclic` (n,), the posture of
    CYCLICSTART, draws every row, governed while the robot stands away from the best one for it.
    """
    weights = model.weights
    here = Posture(weights, start)
    if asked is not None:
        reference_at = asked.reference(start)
        through = tuple(share * law.length for share, _ in asked.on_the_way)
        return PostureTerm(lambda s, _: here.towards(reference_at(s / law.length)), True, through)
    if cyclic is not None:
        # Far off its pose the stored posture may have no best one near by on some piece of the path: then the
        # posture stays as far as the tool lets it, and the next moves lead on from where it is.
        staying = PostureTerm(lambda s, _: here, True)
        away = return_way(model, start, cyclic, qp)
        if away is None:
            drawn = Posture(weights, cyclic)
            return PostureTerm(lambda s, _: drawn, True, otherwise=staying)
        reference = governed_reference(away, law, model.limits)
        return PostureTerm(lambda s, _: here.towards(reference(s)), True, otherwise=staying)
    fixed = LeastMotion(weights)
    return PostureTerm(lambda s, _: fixed, False)
