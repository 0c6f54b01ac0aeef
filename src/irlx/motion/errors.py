"""A move that cannot be planned, found before any of it is executed."""

from irlx.diagnostics import IrlxError


class MotionError(IrlxError):
    """The geometry or the time law of a move is impossible; the diagnostic names the move."""
