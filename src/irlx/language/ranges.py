"""What values of the language may hold: one place for what checks a program and for what runs it."""

from __future__ import annotations

__all__ = ["INT_LIMIT", "INT_RANGE", "MOST_ELEMENTS", "REAL_RANGE", "UNIT_LENGTH"]

INT_LIMIT = 2**63
"""INT holds whole numbers from minus this to below this."""

INT_RANGE = "INT holds the whole numbers from -2^63 to 2^63 - 1"
"""The same for messages."""

REAL_RANGE = "REAL holds numbers up to 1.8E308"
"""What REAL holds, for messages."""

UNIT_LENGTH = 1e-6
"""Largest difference from 1 of the length of a quaternion that a program gives."""

MOST_ELEMENTS = 10_000_000
"""Elements of the largest array."""
