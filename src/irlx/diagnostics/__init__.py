"""Coded messages with a place: the one model that every stage reports through."""

from irlx.diagnostics.codes import CATALOGUE, Code
from irlx.diagnostics.diagnostic import Diagnostic, Related, Severity, report
from irlx.diagnostics.digits import told_apart
from irlx.diagnostics.error import IrlxError
from irlx.diagnostics.place import Place, SourceText, Span

__all__ = [
    "CATALOGUE",
    "Code",
    "Diagnostic",
    "IrlxError",
    "Place",
    "Related",
    "Severity",
    "SourceText",
    "Span",
    "report",
    "told_apart",
]
