"""RAPID: `MoveAbsJ`, each with the time that it is to take."""

from __future__ import annotations

from pathlib import Path

from irlx.exporters.axes import Axes
from irlx.exporters.point_writer import PointWriter
from irlx.exporters.profile import Profile
from irlx.exporters.program_name import NameRule
from irlx.streams.joint_stream import StreamHeader

_WORDS = """
    alias and backward case connect const default div do else elseif endfor endfunc endif endmodule
    endproc endrecord endtest endtrap endwhile error exit false for from func goto if inout local mod
    module nostepin not noview or pers proc raise readonly record retry return step sysmodule test then
    to trap true trynext undo var viewonly while with xor moveabsj waittime tool0
"""
_LOST = (
    "T is the time of the stream; what the controller cannot do in it takes longer.",
    "z0 passes near the points, not through them.",
)
_ARM = 6
_EXTERNAL = 6
_MODULE = "_Mod"
_NAME = 32


class RapidWriter(PointWriter):
    """Writes a module with one procedure of `MoveAbsJ`: six turning joints, or seven, and slides.

    Turning joints in deg in `robax`; slides in mm in `extax` from eax_a on. Of seven turning joints the third
    one is in eax_a, as in arms of ABB with seven axes, whose axis 7 lies between axes 2 and 3; slides follow
    from eax_b on. Zone z0, `fine` at the first point, the last, and where the robot stands still; there
    `WaitTime` follows. See `ProgramWriter`.
    """

    profile = Profile(
        title="RAPID",
        turning=(6, 7),
        slides=(0, 6),
        most_joints=12,
        angle="deg",
        digits=8,
        tick_ns=None,
        shortest_tick_ns=10_000_000,
        every_tick=False,
        most_points=20_000,
        ends_at_rest=True,
        names=NameRule(_NAME - len(_MODULE), frozenset(_WORDS.split()), any_case=True),
        comment="!",
        line_end="\r\n",
    )
    _indent = "    "

    def _axes(self, path: Path, header: StreamHeader) -> Axes:
        axes = super()._axes(path, header)
        if axes.turning == _ARM:
            return axes
        return axes.reordered((0, 1, 3, 4, 5, 6, 2, *range(7, header.joints)))

    def _head(self) -> list[str]:
        names = [f"rax_{k + 1}" for k in range(_ARM)] + [f"eax_{letter}" for letter in "abcdef"]
        where = [f"{axis} is {joint}" for axis, joint in zip(names, self.axes.names, strict=False)]
        return [
            f"MODULE {self.name}{_MODULE}",
            *(f"  {line}" for line in self._provenance()),
            *(f"  {self._comment(text)}" for text in where),
            *(f"  {self._comment(text)}" for text in _LOST),
            f"  PROC {self.name}()",
        ]

    def _fronts(self) -> list[str]:
        robot = [f"{self._indent}MoveAbsJ [[", *[","] * (_ARM - 1)]
        return [*robot, *["],[", *[","] * (_EXTERNAL - 1)][: self.header.joints - _ARM]]

    def _end_of_line(self, step: int, hold: int, passes: bool, first: bool) -> str:
        end = self.profile.line_end
        external = self.header.joints - _ARM
        rest = ",".join(["9E9"] * (_EXTERNAL - external))
        close = f"],[{rest}" if not external else "," * bool(rest) + rest
        speed = "v100" if first else rf"v1000\T:={self._seconds(step)}"
        zone = "z0" if passes else "fine"
        wait = f"{self._indent}WaitTime {self._seconds(hold)};{end}" if hold else ""
        return rf"{close}]]\NoEOffs, {speed}, {zone}, tool0;{end}{wait}"

    def _foot(self) -> list[str]:
        return ["  ENDPROC", "ENDMODULE"]
