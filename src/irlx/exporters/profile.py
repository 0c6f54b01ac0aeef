"""What a target takes: rate, units, joints, length, names."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.exporters.program_name import NameRule

LARGEST_VALUE = 1e6
"""Largest size of a value in the target's unit; RAPID has 9E9 for an axis that is not there."""


@dataclass(frozen=True)
class Profile:
    """One target; what a stream has beyond it is refused.

    `turning` and `slides` are the fewest and the most joints of each kind; `angle` the unit of turning
    joints, 'rad' or 'deg', slides being in mm; values have `digits` digits behind the point.
    `tick_ns` is the only duration of a tick that it plays, `shortest_tick_ns` the shortest, None where any
    will do; `every_tick` whether ticks may have no gap. `most_points` bounds a program, None where nothing
    does. `ends_at_rest`: what still moves at its end is refused. Programs have names by `names`, None where
    they have none. Lines end with `line_end`; a comment begins with `comment`.
    """

    title: str
    turning: tuple[int, int]
    slides: tuple[int, int]
    most_joints: int
    angle: str
    digits: int
    tick_ns: int | None
    shortest_tick_ns: int | None
    every_tick: bool
    most_points: int | None
    ends_at_rest: bool
    names: NameRule | None
    comment: str
    line_end: str

    @property
    def joints_wanted(self) -> str:
        """The joints that it moves, in words: ``6 turning joints``, ``1 to 12 joints``."""
        fewest, most = self.turning
        turning = str(most) if fewest == most else f"{fewest} to {most}"
        if not self.slides[1]:
            return f"{turning} turning joints"
        return f"{turning} turning joints and up to {self.slides[1]} slides, {self.most_joints} in all"

    @property
    def points_wanted(self) -> str:
        """How many points a program holds, in words."""
        return "at least 1" if self.most_points is None else f"1 to {self.most_points}"
