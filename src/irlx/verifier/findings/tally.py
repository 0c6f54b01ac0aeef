"""Keeps the worst value and the first offence of one check while rows are looked at in portions."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.findings.finding import FAILED, NO_CASE, NOT_CHECKED, OK, Check, Finding
from irlx.verifier.outline import Outline


class Tally:
    """One check in the making: values of rows (R,) or of rows and joints (R, n) are added in any portions."""

    def __init__(self, name: str, unit: str, outline: Outline) -> None:
        self.name = name
        self.unit = unit
        self.detail = ""
        self._outline = outline
        self._empty = True
        self._worst: Finding | None = None
        self._worst_rank = -np.inf
        self._first: Finding | None = None

    def add(
        self,
        rows: Integers,
        value: Floats,
        allowed: ArrayLike,
        offends: NDArray[np.bool_] | None = None,
        rank: Floats | None = None,
        unit: str = "",
        pair: str | None = None,
        constraint: str | None = None,
    ) -> None:
        """Add the values of `rows` (indices into the stream), in one `unit` where the check has several;
        all of one `pair` of bodies where they are distances, or of one `constraint`.

        By default a value offends where it is not <= `allowed` (so that nan does), and the worst is
        the largest. `rank` orders values otherwise; rank -inf never becomes the worst.
        """
        if value.size == 0:
            return
        self._empty = False
        allowed = np.broadcast_to(np.asarray(allowed, dtype=np.float64), value.shape)
        offends = ~(value <= allowed) if offends is None else offends
        rank = value if rank is None else rank
        of: dict[str, Any] = {"pair": pair, "constraint": constraint}
        top = int(np.argmax(rank))
        if rank.flat[top] > self._worst_rank:
            self._worst_rank = float(rank.flat[top])
            self._worst = replace(self._finding(rows, value, allowed, top, unit), **of)
        if offends.any():
            found = replace(self._finding(rows, value, allowed, _first(offends, rank), unit), **of)
            if self._first is None or found.tick < self._first.tick:
                self._first = found

    def add_other(self, rows: Integers, value: Floats, allowed: float, usual: float) -> None:
        """Add values of which more is `allowed` than is `usual` for those of `add`."""
        self.add(rows, value, allowed, rank=value / allowed * usual)

    def _finding(self, rows: Integers, value: Floats, allowed: Floats, flat: int, unit: str) -> Finding:
        row = int(rows[flat if value.ndim == 1 else flat // value.shape[1]])
        names = self._outline.header.joint_names
        joint = None if value.ndim == 1 else names[flat % value.shape[1]]
        block = self._outline.block_at(row)
        line = self._outline.lines.get(block)
        unit = unit or self._unit_of(joint)
        found = float(value.flat[flat]), float(allowed.flat[flat])
        return Finding(*found, row, joint, block, line, unit)

    def _unit_of(self, joint: str | None) -> str:
        """The check's unit; of units for joints that turn and slide ('rad/s|m/s') the joint's own."""
        if joint is None or "|" not in self.unit:
            return self.unit
        header = self._outline.header
        turns = header.joint_units[header.joint_names.index(joint)] == "rad"
        return next(unit for unit in self.unit.split("|") if unit.startswith("rad") is turns)

    @property
    def worst_rank(self) -> float:
        """Rank of the worst value so far, -inf before there is any."""
        return self._worst_rank

    @property
    def worst(self) -> Finding | None:
        """The worst value so far."""
        return self._worst

    @property
    def first(self) -> Finding | None:
        """The first offence so far."""
        return self._first

    def check(self, not_judged: str = "") -> Check:
        """The finished check. Where no value was added it was not made for the reason `not_judged`, or, that
        being '', had no case."""
        if self._empty and not_judged:
            return Check(self.name, NOT_CHECKED, self.unit, detail=not_judged)
        if self._empty:
            return Check(self.name, NO_CASE, self.unit, detail=self.detail)
        status = OK if self._first is None else FAILED
        worst = self._worst if self._worst is not None else self._first
        return Check(self.name, status, self.unit, worst, self._first, self.detail)


def _first(offends: NDArray[np.bool_], rank: Floats) -> int:
    """Flat index of the first row's worst offence."""
    first = int(np.argmax(offends))
    if offends.ndim == 1:
        return first
    row, width = first // offends.shape[1], offends.shape[1]
    worst = np.where(offends[row], rank[row], -np.inf)
    return row * width + int(np.argmax(worst)) if np.isfinite(worst).any() else first
