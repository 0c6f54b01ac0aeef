"""The one posture term of a move: a posture asked for, else cyclic return, else least motion; and what
CRITERION adds to it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.governed_return import governed_reference
from irlx.pacing.return_way import return_way
from irlx.pacing.slowdown.model import Model
from irlx.transform.criteria.combined import Combined, Weighted
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture
from irlx.transform.qp.solver import QpSolver

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PostureTerm:
    """Criterion of a move: `at(s, advance)` of a tick that ends at path parameter s, `advance` behind the one
    before.

    `draws` tells that it draws the joints to a posture, `otherwise` is the term for a motion that it makes
    impossible.
    """

    at: Callable[[float, float], Criterion]
    draws: bool
    otherwise: PostureTerm | None = None

    def with_terms(self, terms: tuple[Weighted, ...], law: Trapezoid) -> PostureTerm:
        """The same with added terms, which act by the time that the way takes at the law's cruising speed."""
        if not terms:
            return self
        base = self.at
        return PostureTerm(
            lambda s, advance: Combined(base(s, advance), terms, advance / law.speed),
            self.draws,
            None if self.otherwise is None else self.otherwise.with_terms(terms, law),
        )


def posture_term(
    model: Model, start: Array, law: Trapezoid, asked: Array | None, cyclic: Array | None, qp: QpSolver
) -> PostureTerm:
    """Posture term of a move that starts at posture `start` (n,) and follows `law`.

    `asked` (n,) is the posture the move is to end in: its reference runs there from the start in step
    with the path parameter, so that both ends are reached together. Else `cyclic` (n,), the posture of
    CYCLICSTART, draws every row, governed while the robot stands away from the best one for it.
    """
    weights = model.weights
    if asked is not None:
        way = asked - start
        return PostureTerm(lambda s, _: Posture(weights, start + (s / law.length) * way), True)
    if cyclic is not None:
        # Far off its pose the stored posture may have no best one near by on some piece of the path: then the
        # posture stays as far as the tool lets it, and the next moves lead on from where it is.
        here = Posture(weights, start)
        staying = PostureTerm(lambda s, _: here, True)
        away = return_way(model, start, cyclic, qp)
        if away is None:
            drawn = Posture(weights, cyclic)
            return PostureTerm(lambda s, _: drawn, True, staying)
        reference = governed_reference(away, law, model.limits)
        return PostureTerm(lambda s, _: Posture(weights, reference(s)), True, staying)
    fixed = LeastMotion(weights)
    return PostureTerm(lambda s, _: fixed, False)
