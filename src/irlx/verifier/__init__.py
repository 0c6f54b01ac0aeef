"""The independent verifier of joint streams; shares no code with what makes them."""

from irlx.verifier.checks import CHECKS, verify_stream
from irlx.verifier.report import Check, Finding, Report
from irlx.verifier.table import render_table, to_plain

__all__ = ["CHECKS", "Check", "Finding", "Report", "render_table", "to_plain", "verify_stream"]
