"""What a code is."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Severity(Enum):
    """How much a finding matters."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


@dataclass(frozen=True)
class Code:
    """Entry of the catalogue; `message` and `help` are format strings over the diagnostic's data."""

    id: str
    severity: Severity
    message: str
    help: str = ""


def error(id: str, message: str, help: str = "") -> Code:
    """Entry for a finding that makes the input unusable."""
    return Code(id, Severity.ERROR, message, help)


def warning(id: str, message: str, help: str = "") -> Code:
    """Entry for a finding that a user should look at."""
    return Code(id, Severity.WARNING, message, help)


def info(id: str, message: str, help: str = "") -> Code:
    """Entry for a fact worth knowing."""
    return Code(id, Severity.INFO, message, help)
