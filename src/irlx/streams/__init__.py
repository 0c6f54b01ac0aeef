"""Joint streams: the samples and blocks of a run, and their file formats."""

from irlx.streams.error import StreamError
from irlx.streams.formats import KNOWN_ENDINGS, open_writer, read_stream, scan_stream, write_stream
from irlx.streams.irdata import IrdataWriter, read_irdata, scan_irdata
from irlx.streams.joint_stream import FORMAT_VERSION, BlockRecord, JointStream, StreamHeader
from irlx.streams.scan import RowBatch, ScanItem, StatedRates, StreamEnd, collect, scan_of
from irlx.streams.writer import StreamWriter

__all__ = [
    "FORMAT_VERSION",
    "KNOWN_ENDINGS",
    "BlockRecord",
    "IrdataWriter",
    "JointStream",
    "RowBatch",
    "ScanItem",
    "StatedRates",
    "StreamEnd",
    "StreamError",
    "StreamHeader",
    "StreamWriter",
    "collect",
    "open_writer",
    "read_irdata",
    "read_stream",
    "scan_irdata",
    "scan_of",
    "scan_stream",
    "write_stream",
]
