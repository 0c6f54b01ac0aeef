"""The independent verifier of joint streams; shares no code with what makes them."""

from irlx.streams.verify.checks import CHECKS, verify_stream
from irlx.streams.verify.report import Check, Finding, VerifyReport
from irlx.streams.verify.table import render_table, to_plain

__all__ = ["CHECKS", "Check", "Finding", "VerifyReport", "render_table", "to_plain", "verify_stream"]
