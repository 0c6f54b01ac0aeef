"""A program that the robot cannot carry out, found while its motion is paced."""

from irlx.diagnostics import IrlxError


class PacingError(IrlxError):
    """A move or switch that cannot be executed; the rows paced before it stay valid."""
