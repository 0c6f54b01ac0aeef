"""How far a tool may stand off the pose that is asked for: bands of its coordinates in that pose."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi
from typing import Protocol

import numpy as np

from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.rotations import about_axis, rotation_vectors
from irlx.verifier.geometry.task_turns import turned_from, turned_off, turns_asked

ROUNDS = 50
"""Most steps by which the place on a way is sought off which a shifted tool stands."""

SETTLED = 1e-13
"""A step that is this short, m, is the last one."""

MET = 1e-10
"""What may be left beyond the bands, m or rad, before a place is sought with more care .."""

GRID, HOLLOWS, SECTIONS, GOLDEN = 512, 3, 70, 0.5 * (5.0**0.5 - 1.0)
""".. among so many places, from so many of them on, by so many golden sections."""

TOGETHER = 20_000
"""Places times rows at which that is looked at in one go."""

ASIDE = 1e-8
"""Way, m, or turn, rad, by which the change of what is beyond the bands is told."""

STRAIGHT = 1e-6
"""Part of the largest change below which a turn changes nothing of what is asked for."""


class Way(Protocol):
    """A way of the tool."""

    @property
    def by_angle(self) -> bool:
        """Whether it goes by the angle of its turn, rad, and not by its length, m."""

    @property
    def reach(self) -> float:
        """Length of the way, m or rad."""

    def nearest(self, positions: Floats) -> Floats:
        """Way (R,) m to the points nearest to positions (R, 3)."""

    def at(self, way: Floats) -> tuple[Floats, Floats]:
        """Positions (R, 3) and orientations (R, 3, 3) after ways (R,) m."""


@dataclass(frozen=True)
class Allowance:
    """Bands (6,): m along x, y, z, then rad about x, y, z, in the frame of the pose asked for.

    A tool at Trans(x, y, z) Rz(c) Ry(b) Rx(a) in that frame is within them where |x| <= dx and so on; turns
    of half a turn and more are free. Where the frame `follows` it is turned against the pose asked for by the
    turns that do not count (attitudes of nine rows): the tool's own are those that leave nothing of the turns
    asked for, found by steps of Gauss and Newton.
    """

    bands: tuple[float, float, float, float, float, float]
    follows: bool = False

    @property
    def shifts(self) -> bool:
        """Whether a displacement is allowed."""
        return any(band > 0.0 for band in self.bands[:3])

    @property
    def farthest(self) -> float:
        """Farthest that a tool may stand from where it is asked for, m."""
        return float(np.linalg.norm(self.bands[:3]))

    @property
    def turns(self) -> bool:
        """Whether a turn is allowed."""
        return any(band > 0.0 for band in self.bands[3:])

    def turned_off(self, attitudes: Floats, asked: Floats) -> Floats:
        """Angle (R,) rad of attitudes (R, ..) off rotations (R, 3, 3), once the bands are used."""
        if not self.turns:
            return turned_off(attitudes, asked)
        return turned_off(attitudes, asked @ self._kept(self._stood_off(attitudes, asked)))

    def turned_from(self, attitudes: Floats, start: Floats, turned: Floats) -> Floats:
        """The same off `turned` (R, 3, 3) behind a rotation `start` (3, 3), in its axes."""
        if not self.turns:
            return turned_from(attitudes, start, turned)
        return self.turned_off(attitudes, start @ turned)

    def shifted_off(self, offsets: Floats) -> Floats:
        """What is left (R, 3) m of displacements in the frame of the pose asked for."""
        most = np.array(self.bands[:3])
        return np.asarray(offsets - np.clip(offsets, -most, most))

    def frames(self, attitudes: Floats, asked: Floats) -> Floats:
        """Rotations (R, 3, 3) of the frames in which the bands lie about rotations asked for (R, 3, 3)."""
        if not self._follows(attitudes):
            return asked
        kept = self._kept(self._stood_off(attitudes, asked))
        return np.asarray(attitudes[:, :3] @ np.swapaxes(kept, 1, 2))

    def asked(self, way: Way, positions: Floats, attitudes: Floats) -> tuple[Floats, Floats]:
        """Poses (R, 3), (R, 3, 3) of a way off which tools at positions (R, 3), attitudes (R, ..) stand.

        Displacements along the way leave the place open: from the point nearest to the tool it is sought by
        steps of Gauss and Newton where least is beyond the bands, 1 rad counting like 1 m.
        """
        along = way.nearest(positions)
        sought = self.hides(way)
        for _ in range(ROUNDS if sought else 0):
            left = self._left(way, along, positions, attitudes)
            aside = np.where(along + ASIDE <= way.reach, along + ASIDE, along - ASIDE)
            slope = (self._left(way, aside, positions, attitudes) - left) / (aside - along)[:, None]
            size = np.sum(slope**2, axis=1)
            step = -np.sum(slope * left, axis=1) / np.where(size > 0.0, size, 1.0)
            moved = np.clip(along + step, 0.0, way.reach)
            if np.max(np.abs(moved - along), initial=0.0) <= SETTLED:
                break
            along = moved
        if sought:
            off = np.linalg.norm(self._left(way, along, positions, attitudes), axis=1)
            rest = np.flatnonzero(off > MET)
            if rest.size:
                along[rest] = self._searched(way, along[rest], positions[rest], attitudes[rest])
        return way.at(along)

    def hides(self, way: Way) -> bool:
        """Whether the bands hide how far along a way the tool is: what else tells it they leave open."""
        return self.shifts or (self.turns and way.by_angle)

    def _searched(self, way: Way, along: Floats, positions: Floats, attitudes: Floats) -> Floats:
        """The places (R,) of `asked` by golden sections: where bands end, steps by slopes may get stuck.

        They are sought about a few of places all over the way, those where least is beyond.
        """

        def off(places: Floats) -> Floats:
            """Sizes of what is left, (..), at places (.., R): many at once cost hardly more than one."""
            row = np.broadcast_to(np.arange(len(along)), places.shape).reshape(-1)
            left = self._left(way, places.reshape(-1), positions[row], attitudes[row])
            return np.asarray(np.linalg.norm(left, axis=1).reshape(places.shape))

        grid = np.linspace(0.0, way.reach, GRID + 1)
        parts = np.array_split(grid, min(GRID, 1 + GRID * len(along) // TOGETHER))
        found = [off(np.repeat(part[:, None], len(along), axis=1)) for part in parts]
        values = np.pad(np.concatenate(found), ((1, 1), (0, 0)), constant_values=inf)
        hollow = (values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:])
        order = np.argsort(np.where(hollow, values[1:-1], inf), axis=0)[:HOLLOWS]
        low, high = (np.clip(grid[order] + side / GRID * way.reach, 0.0, way.reach) for side in (-1.0, 1.0))
        for _ in range(SECTIONS):
            inner = np.stack([high - GOLDEN * (high - low), low + GOLDEN * (high - low)])
            before = np.less(*off(inner))
            low, high = np.where(before, low, inner[0]), np.where(before, inner[1], high)
        best, least = along, off(along)
        middles = 0.5 * (low + high)
        for place, value in zip(middles, off(middles), strict=True):
            best, least = np.where(value < least, place, best), np.minimum(value, least)
        return np.asarray(best)

    def _left(self, way: Way, along: Floats, positions: Floats, attitudes: Floats) -> Floats:
        """What is beyond the bands (R, 6), m and rad, at ways (R,)."""
        points, asked = way.at(along)
        kept = self._kept(self._stood_off(attitudes, asked))
        if not self._follows(attitudes):
            frames, between = asked, np.swapaxes(asked, 1, 2) @ attitudes[:, :3]
            turned = rotation_vectors(np.swapaxes(kept, 1, 2) @ between)
        else:
            frames = attitudes[:, :3] @ np.swapaxes(kept, 1, 2)
            turned = turns_asked(attitudes, asked @ kept)
        return np.hstack([self.shifted_off(np.einsum("rji,rj->ri", frames, positions - points)), turned])

    def excess(self, position: Floats, attitudes: Floats, asked: tuple[Floats, Floats]) -> Floats:
        """How far (R,) the coordinates that have a band pass it, m or rad: of all the largest.

        `position` (R, 3) and `attitudes` (R, ..) are of the tool, `asked` of the poses asked for.
        """
        frames, turns = self.frames(attitudes, asked[1]), self._stood_off(attitudes, asked[1])
        values = np.hstack([np.einsum("rji,rj->ri", frames, position - asked[0]), turns])
        banded = np.array(self.bands) > 0.0
        passed = np.abs(values) - self._most
        return np.asarray(np.max(np.where(banded, passed, -inf), axis=1, initial=-inf))

    def _follows(self, attitudes: Floats) -> bool:
        return self.follows and attitudes.shape[-2] > 3

    def _stood_off(self, attitudes: Floats, asked: Floats) -> Floats:
        """Turns (R, 3) about x, y, z by which tools of attitudes (R, ..) stand off rotations (R, 3, 3)."""
        turns = self._turned(attitudes[:, :3], asked)
        if not (self._follows(attitudes) and self.turns):
            return turns
        open_turns = np.flatnonzero(np.array(self.bands[3:]) > 0.0)
        found = np.zeros_like(turns)
        found[:, open_turns] = turns[:, open_turns]
        for _ in range(ROUNDS):
            left = turns_asked(attitudes, asked @ _from_turns(found))
            slopes = np.empty((*left.shape, len(open_turns)))
            for column, number in enumerate(open_turns):
                aside = found + ASIDE * np.eye(3)[number]
                slopes[:, :, column] = (turns_asked(attitudes, asked @ _from_turns(aside)) - left) / ASIDE
            step = -np.einsum("rij,rj->ri", np.linalg.pinv(slopes, rcond=STRAIGHT), left)
            found[:, open_turns] += step
            if np.max(np.abs(step), initial=0.0) <= SETTLED:
                break
        return found

    def _kept(self, turns: Floats) -> Floats:
        """Rotations (R, 3, 3) by turns (R, 3) about x, y, z, as far as the bands let them."""
        most = self._most[3:]
        return _from_turns(np.clip(turns, -most, most))

    @property
    def _most(self) -> Floats:
        most = np.array(self.bands)
        most[3:][most[3:] >= pi] = inf
        return most

    def _turned(self, actual: Floats, asked: Floats) -> Floats:
        """Turns (R, 3) about x, y, z that lead from rotations asked for (R, 3, 3) to others.

        R = Rz(c) Ry(b) Rx(a) has two triples of angles; that counts which passes the bands by less.
        """
        between = np.swapaxes(asked, -1, -2) @ actual
        a = np.arctan2(between[..., 2, 1], between[..., 2, 2])
        across = np.hypot(between[..., 2, 1], between[..., 2, 2])
        b = np.arctan2(-between[..., 2, 0], across)
        c = np.arctan2(between[..., 1, 0], between[..., 0, 0])
        ways = np.stack([np.stack([a, b, c], axis=-1), _whole(np.stack([a, -b, c], axis=-1))])
        beyond = np.max(np.abs(ways) - self._most[3:], axis=-1)
        return np.asarray(np.where((beyond[1] < beyond[0])[..., None], ways[1], ways[0]))


EXACT = Allowance((0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
"""The tool stands at the pose that is asked for."""


def _whole(angles: Floats) -> Floats:
    """Half a turn further, between half a turn back and forward."""
    return np.asarray(np.mod(angles + 2.0 * pi, 2.0 * pi) - pi)


def _from_turns(turns: Floats) -> Floats:
    """Rz(c) Ry(b) Rx(a), (R, 3, 3), of angles (R, 3) about x, y, z."""
    flat = turns.reshape(-1, 3)
    x, y, z = (about_axis(axis, flat[:, number]) for number, axis in enumerate(np.eye(3)))
    return np.asarray((z @ y @ x).reshape(*turns.shape[:-1], 3, 3))
