"""The independent verifier of joint streams.

It shares with the rest of irlx the readers of streams, blocks, plain robot data and the promised numbers,
and no code with what makes streams: forward kinematics, differences and geometry are its own.
"""

from irlx.verifier.checks import CHECKS, verify_scans, verify_stream
from irlx.verifier.findings.finding import Check, Finding
from irlx.verifier.findings.report import Report
from irlx.verifier.judges.provenance import Reference

__all__ = [
    "CHECKS",
    "Check",
    "Finding",
    "Reference",
    "Report",
    "verify_scans",
    "verify_stream",
]
