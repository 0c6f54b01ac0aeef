"""A criterion that is held back where a tick does not settle on its minimum."""

from __future__ import annotations

from irlx.transform.criteria.criterion import Array, Criterion


class Restrained(Criterion):
    """phi + restraint/2 S' D S, with D the diagonal of the Hessian H of phi and S the whole step of the tick.

    Newton's steps of a tick know the curvature of phi but not that of the path. In directions in which phi
    hardly grows the path may bend more, and they lead to and fro for ever; D bounds how far these go from
    below (the scaling is Marquardt's, SIAM J. Appl. Math. 11, 1963).
    """

    def __init__(self, criterion: Criterion, restraint: float) -> None:
        """`criterion` is that of a tick that has begun."""
        self._criterion = criterion
        self._restraint = restraint
        hessian = criterion.hessian()
        self._held: Array = restraint * (hessian if hessian.ndim == 1 else hessian.diagonal())
        self._hessian: Array = hessian.copy()
        if hessian.ndim == 1:
            self._hessian += self._held
        else:
            self._hessian.flat[:: len(hessian) + 1] += self._held

    @property
    def name(self) -> str:  # type: ignore[override]
        """That of the criterion."""
        return self._criterion.name

    def asking_at_most(self, size: float) -> Criterion:
        """The same of a criterion that asks for no more."""
        less = self._criterion.asking_at_most(size)
        return self if less is self._criterion else Restrained(less, self._restraint)

    def value(self, q: Array, step: Array) -> float:
        """phi and the restraint at a step."""
        return self._criterion.value(q, step) + 0.5 * float(step @ (self._held * step))

    def gradient(self, q: Array, step: Array) -> Array:
        """Its derivative by the step."""
        return self._criterion.gradient(q, step) + self._held * step

    def hessian(self) -> Array:
        """Its second derivative."""
        return self._hessian


class HeldBack(Criterion):
    """A criterion that is `Restrained` in every tick, once the tick has begun."""

    def __init__(self, criterion: Criterion, restraint: float) -> None:
        self._criterion = criterion
        self._restraint = restraint

    @property
    def name(self) -> str:  # type: ignore[override]
        """That of the criterion."""
        return self._criterion.name

    def begun(self, q: Array) -> Criterion:
        """The criterion of a tick that begins at posture q (n,), held back."""
        return Restrained(self._criterion.begun(q), self._restraint)

    def value(self, q: Array, step: Array) -> float:
        """phi and the restraint at a step."""
        return self.begun(q).value(q, step)

    def gradient(self, q: Array, step: Array) -> Array:
        """Its derivative by the step."""
        return self.begun(q).gradient(q, step)

    def hessian(self) -> Array:
        """Not known before a tick has begun."""
        raise TypeError("a criterion that is held back has no Hessian before a tick has begun")
