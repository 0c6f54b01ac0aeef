"""A cell file or robot model that cannot be used."""

from irlx.diagnostics import IrlxError


class CellError(IrlxError):
    """Everything that is wrong with a cell, each diagnostic with its key path."""
