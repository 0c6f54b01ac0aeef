"""KRL: points that are passed with C_PTP, in the time that the axes need."""

from __future__ import annotations

from irlx.exporters.point_writer import PointWriter
from irlx.exporters.profile import Profile
from irlx.exporters.program_name import NameRule

_WORDS = """
    and anin anout b_and b_exor b_not b_or bas bool brake case ccdstat_rec channel char circ circ_rel
    confirm const continue decl def default deffct default delay digin do else end enddat endfct endfold
    endfor endif endloop endswitch endwhile enum exit exor ext extfct false for frame global goto halt
    if import int interrupt is lin lin_rel loop maximum minimum not off on or pos private ptp ptp_rel
    public pulse real repeat resume return scirc sec seqlin signal slin spl spline sptp step struc swith
    switch sync then to trigger true type until wait when while with axis e6axis e6pos home
"""
_LOST = (
    "Time is not kept: each move takes as long as the axes need at VEL_PTP, percent of their own speed.",
    "C_PTP passes near the points, not through them.",
)
_ARM = 6


class KrlWriter(PointWriter):
    """Writes a program of `PTP` with axis values: A1 to A6 the first six turning joints, E1 to E6 the rest.

    Turning joints in deg, slides in mm. `C_PTP` at every point but the first, the last, and those where the
    robot stands still; there `WAIT SEC` follows. See `ProgramWriter`.
    """

    profile = Profile(
        title="KRL",
        turning=(1, 12),
        slides=(0, 6),
        most_joints=12,
        angle="deg",
        digits=8,
        tick_ns=None,
        shortest_tick_ns=None,
        every_tick=False,
        most_points=20_000,
        ends_at_rest=True,
        names=NameRule(24, frozenset(_WORDS.split()), any_case=True),
        comment=";",
        line_end="\r\n",
    )

    def _head(self) -> list[str]:
        where = [f"{axis} is {joint}" for axis, joint in zip(self._axis_names, self.axes.names, strict=True)]
        return [
            "&ACCESS RVP",
            "&REL 1",
            f"DEF {self.name}()",
            *self._provenance(),
            *(self._comment(text) for text in where),
            *(self._comment(text) for text in _LOST),
            "BAS(#INITMOV,0)",
            "BAS(#VEL_PTP,10)",
            "$ADVANCE=3",
            "$APO.CPTP=50",
        ]

    def _fronts(self) -> list[str]:
        first, *others = self._axis_names
        return [f"PTP {{{first} ", *(f", {axis} " for axis in others)]

    def _end_of_line(self, step: int, hold: int, passes: bool, first: bool) -> str:
        end = self.profile.line_end
        wait = f"WAIT SEC {self._seconds(hold)}{end}" if hold else ""
        return ("} C_PTP" if passes else "}") + end + wait

    def _foot(self) -> list[str]:
        return ["END"]

    @property
    def _axis_names(self) -> list[str]:
        arm = min(self.axes.turning, _ARM)
        return [f"A{k + 1}" for k in range(arm)] + [f"E{k + 1}" for k in range(self.header.joints - arm)]
