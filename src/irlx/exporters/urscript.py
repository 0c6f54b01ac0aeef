"""URScript for e-Series: one `servoj` each 2 ms."""

from __future__ import annotations

from irlx.exporters.profile import Profile
from irlx.exporters.program_name import NameRule
from irlx.exporters.program_writer import ProgramWriter
from irlx.streams.joint_stream import Floats
from irlx.streams.scan import RowBatch

_WORDS = """
    and break continue def elif else end enum False for from global goto halt if import in local loop
    mod movec movej movel movep not or pass return run sec servoj stopj struct switch thread True until
    while xor
"""
_APPROACH = "a=0.5, v=0.25"
_SERVO = "t=0.002, lookahead_time=0.1, gain=300"


class UrScriptWriter(ProgramWriter):
    """Writes a program of one function: `movej` to the first posture, `servoj` to each other one.

    `servoj` follows its targets with a delay, so that `movej` to the last posture ends it. Joints in rad.
    See `ProgramWriter`.
    """

    profile = Profile(
        title="URScript",
        turning=(6, 6),
        slides=(0, 0),
        most_joints=6,
        angle="rad",
        digits=12,
        tick_ns=2_000_000,
        shortest_tick_ns=None,
        every_tick=True,
        most_points=100_000,
        ends_at_rest=True,
        names=NameRule(60, frozenset(_WORDS.split()), any_case=False),
        comment="#",
        line_end="\n",
    )
    _indent = "  "

    def _head(self) -> list[str]:
        joints = ", ".join(self.axes.names)
        told = [*self._provenance(), self._comment(f"joints {joints}")]
        # Behind `def`: what is sent to a controller as it is has to begin with it.
        return [f"def {self.name}():", *(self._indent + line for line in told)]

    def _put_rows(self, batch: RowBatch) -> None:
        served = batch.q
        if not self._points:
            self._put_lines([self._indent + self._comment("slowly to where the stream begins")])
            self._put_call("movej", batch.q[:1], _APPROACH)
            served = batch.q[1:]
        self._count(len(batch.q))
        self._put_call("servoj", served, _SERVO)

    def _tail(self) -> None:
        why = self._comment("servoj is behind its target: end in the last posture")
        self._put_lines([f"{self._indent}stopj(2.0)", self._indent + why])
        self._put_call("movej", self._last_rows[-1:], _APPROACH)

    def _foot(self) -> list[str]:
        return ["end"]

    def _put_call(self, function: str, q: Floats, parameters: str) -> None:
        """A call for each posture."""
        fronts = [f"{self._indent}{function}([", *[", "] * (self.header.joints - 1)]
        self._put_values(fronts, q, [f"], {parameters})\n".encode()] * len(q))
