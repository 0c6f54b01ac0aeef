"""The posture term of a move with the terms that CRITERION adds."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from irlx.transform.criteria.criterion import Array, Criterion
from irlx.transform.criteria.term import Term
from irlx.transform.metric import inverse, times


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
        self._base = base
        self._terms = terms
        self._elapsed = elapsed

    @property
    def name(self) -> str:  # type: ignore[override]
        """Names of all terms."""
        return " + ".join([self._base.name, *(entry.term.name for entry in self._terms)])

    def begun(self, q: Array) -> Criterion:
        """The same with b and B of a posture."""
        for entry in self._terms:
            if entry.term.acts(q):
                return self._begun(q)
        return self._base.begun(q)

    def _begun(self, q: Array) -> _Begun:
        linear, share = np.zeros(q.size), 1.0
        added: Array | None = None
        for entry in self._terms:
            term, weight = entry.term, entry.weight
            if not term.acts(q):
                continue
            share *= term.posture_share(q)
            linear += weight * term.linear(q, self._elapsed)
            more = term.quadratic(q)
            if more is not None:
                added = weight * more if added is None else _sum(added, weight * more)
        return _Begun(self, self._base, share, linear, np.zeros(q.size) if added is None else added)

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

    def __init__(self, whole: Combined, base: Criterion, share: float, linear: Array, added: Array) -> None:
        self._whole = whole
        self._base = base
        self._parts = share, linear, added
        own = base.hessian()
        hessian = _sum(share * own, added)
        size = float((hessian if hessian.ndim == 1 else hessian.diagonal()).sum())
        scale = float(own.sum()) / size
        self._share = scale * share
        self._linear = scale * linear
        self._added = scale * added
        self._hessian = scale * hessian
        self._inverse: Array | None = None

    @property
    def name(self) -> str:  # type: ignore[override]
        """Names of all terms."""
        return self._whole.name

    def asking_at_most(self, size: float) -> Criterion:
        """The same, b so small that its way |H^-1 b|, weighed by H, is no longer than `size`."""
        asked = sqrt(float(self._linear @ times(self.inverse_hessian(), self._linear)))
        if asked <= size:
            return self
        share, linear, added = self._parts
        return _Begun(self._whole, self._base, share, linear * (size / asked), added)

    def value(self, q: Array, step: Array) -> float:
        """phi at a step, scaled."""
        added = float(self._linear @ step + 0.5 * step @ times(self._added, step))
        return self._share * self._base.value(q, step) + added

    def gradient(self, q: Array, step: Array) -> Array:
        """Its derivative by the step."""
        return self._share * self._base.gradient(q, step) + self._linear + times(self._added, step)

    def hessian(self) -> Array:
        """Its second derivative."""
        return self._hessian

    def pull(self, q: Array, step: Array) -> Array:
        """-H^-1 g."""
        return -times(self.inverse_hessian(), self.gradient(q, step))

    def inverse_hessian(self) -> Array:
        """H^-1, computed once."""
        if self._inverse is None:
            self._inverse = inverse(self._hessian)
        return self._inverse


def _sum(first: Array, second: Array) -> Array:
    """Sum of two matrices of which either may be given by its diagonal."""
    if first.ndim == second.ndim:
        return first + second
    whole, diagonal = (first, second) if first.ndim == 2 else (second, first)
    added: Array = whole.copy()
    added.flat[:: len(diagonal) + 1] += diagonal
    return added
