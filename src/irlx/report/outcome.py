"""What a run has come to, whatever became of its rows."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from irlx.diagnostics import Diagnostic
from irlx.pacing.explanation import TickExplanation
from irlx.report.events import LimitActive, Slowed
from irlx.report.summary import Summary
from irlx.streams.joint_stream import StreamHeader


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Outcome:
    """Header of its stream, events, summary and warnings of one execution; `print` shows its summary.

    `explanation` is that of the tick asked for with `explain_tick`, None where no motion has it; `output` is
    what the program wrote to STANDARD_OUT; `files` the streams written while it ran, `page` the page.
    """

    header: StreamHeader
    summary: Summary
    events: tuple[LimitActive | Slowed, ...]
    diagnostics: tuple[Diagnostic, ...]
    explanation: TickExplanation | None = None
    output: str = ""
    files: tuple[Path, ...] = ()
    page: Path | None = None

    def __str__(self) -> str:
        return str(self.summary)

    def __repr__(self) -> str:
        # Imported here: few ask.
        from irlx.report.terminal import headline

        size = f"{self.summary.samples} samples of {len(self.joint_names)} joints"
        return f"<{type(self).__name__} of {headline(self.summary).words}; {size}>"

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints in the order of the columns."""
        return self.header.joint_names

    @property
    def complete(self) -> bool:
        """Whether the program came to its end."""
        return self.summary.complete
