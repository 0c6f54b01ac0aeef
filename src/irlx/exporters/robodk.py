"""CSV for RoboDK: joints and time, as its macros record and play them."""

from __future__ import annotations

from irlx.exporters.profile import Profile
from irlx.exporters.program_writer import ProgramWriter
from irlx.streams.scan import RowBatch


class RoboDkWriter(ProgramWriter):
    """Writes a line a tick: turning joints in deg, slides behind them in mm, the time in s.

    No column names and no comments: what plays such a file takes every line for joints. See `ProgramWriter`.
    """

    profile = Profile(
        title="RoboDK CSV",
        turning=(0, 12),
        slides=(0, 12),
        most_joints=12,
        angle="deg",
        digits=8,
        tick_ns=None,
        shortest_tick_ns=None,
        every_tick=False,
        most_points=None,
        ends_at_rest=False,
        names=None,
        comment="",
        line_end="\n",
    )

    def _head(self) -> list[str]:
        return []

    def _put_rows(self, batch: RowBatch) -> None:
        times = (batch.ticks * self.header.tick_ns / 1e9).tolist()
        fronts = ["", *[", "] * (self.header.joints - 1)]
        self._put_values(fronts, batch.q, [b", %a\n" % time for time in times])

    def _tail(self) -> None:
        """Every row is written at once."""
