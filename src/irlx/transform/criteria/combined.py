"""The posture term of a move with the terms that CRITERION adds."""

from __future__ import annotations

from dataclasses import dataclass
from math import prod

import numpy as np

from irlx.transform.criteria.criterion import Array, Criterion
from irlx.transform.criteria.term import Term
from irlx.transform.metric import times


@dataclass(frozen=True)
class Weighted:
    """A term and its WEIGHT."""

    term: Term
    weight: float


class Combined(Criterion):
    """phi = share * posture term + sum of weight (b' S + 1/2 S' B S) over the terms, see `Term`.

    `share` is the product of what the terms leave of the posture term.
    `elapsed` is what the tick's part of the path takes at the programme's cruising speed, s.
    """

    def __init__(self, base: Criterion, terms: tuple[Weighted, ...], elapsed: float) -> None:
        self.name = " + ".join([base.name, *(entry.term.name for entry in terms)])
        self._base = base
        self._terms = terms
        self._elapsed = elapsed

    def begun(self, q: Array) -> Criterion:
        """The same with b and B of a posture."""
        terms = [entry for entry in self._terms if entry.term.acts(q)]
        if not terms:
            return self._base.begun(q)
        linear = np.zeros(q.size)
        share = prod(entry.term.posture_share(q) for entry in terms)
        hessian = share * self._base.hessian()
        for entry in terms:
            linear = linear + entry.weight * entry.term.linear(q, self._elapsed)
            added = entry.term.quadratic(q)
            if added is not None:
                hessian = _sum(hessian, entry.weight * added)
        return _Begun(self.name, self._base, share, linear, hessian)

    def value(self, q: Array, step: Array) -> float:
        """phi at a step."""
        return self.begun(q).value(q, step)

    def gradient(self, q: Array, step: Array) -> Array:
        """Its derivative by the step."""
        return self.begun(q).gradient(q, step)

    def hessian(self) -> Array:
        """Not known before a tick has begun."""
        raise TypeError("a combined criterion has no Hessian before a tick has begun")


class _Begun(Criterion):
    """A combined criterion at the start of a tick.

    All of it is scaled to the size of the posture term: the minimum is the same, and what weighs the
    criterion against something else, as slowing down does, is not put off by large terms.
    """

    def __init__(self, name: str, base: Criterion, share: float, linear: Array, hessian: Array) -> None:
        self.name = name
        self._base = base
        self._share = share
        own = base.hessian()
        size = float((hessian if hessian.ndim == 1 else hessian.diagonal()).sum())
        self._scale = float(own.sum()) / size
        self._linear = linear
        self._added = _sum(hessian, -share * own)
        self._hessian = self._scale * hessian

    def value(self, q: Array, step: Array) -> float:
        """phi at a step, scaled."""
        added = float(self._linear @ step + 0.5 * step @ times(self._added, step))
        return self._scale * (self._share * self._base.value(q, step) + added)

    def gradient(self, q: Array, step: Array) -> Array:
        """Its derivative by the step."""
        whole = self._share * self._base.gradient(q, step) + self._linear + times(self._added, step)
        return self._scale * whole

    def hessian(self) -> Array:
        """Its second derivative."""
        return self._hessian


def _sum(first: Array, second: Array) -> Array:
    """Sum of two matrices of which either may be given by its diagonal."""
    if first.ndim == second.ndim:
        return first + second
    whole, diagonal = (first, second) if first.ndim == 2 else (second, first)
    added: Array = whole.copy()
    added.flat[:: len(diagonal) + 1] += diagonal
    return added
