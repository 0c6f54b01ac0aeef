"""IRDATA-like text records: the joint stream as one record a line; see docs/reference/irdata.md."""

from irlx.streams.irdata.reader import read_irdata, scan_irdata
from irlx.streams.irdata.writer import IrdataWriter

__all__ = ["IrdataWriter", "read_irdata", "scan_irdata"]
