"""Programs for the controllers of others: a joint stream as text that they play, or why they cannot."""

from irlx.exporters.program_writer import ProgramWriter
from irlx.exporters.targets import TARGETS, Target, target_of_ending

__all__ = ["TARGETS", "ProgramWriter", "Target", "target_of_ending"]
