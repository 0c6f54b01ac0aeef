"""Joint streams: the samples and blocks of a run, their file formats, and the independent verifier."""

from irlx.streams.error import StreamError
from irlx.streams.formats import KNOWN_ENDINGS, read_stream, write_stream
from irlx.streams.irdata import IrdataWriter, read_irdata
from irlx.streams.joint_stream import FORMAT_VERSION, BlockRecord, JointStream, StreamHeader

__all__ = [
    "FORMAT_VERSION",
    "KNOWN_ENDINGS",
    "BlockRecord",
    "IrdataWriter",
    "JointStream",
    "StreamError",
    "StreamHeader",
    "read_irdata",
    "read_stream",
    "write_stream",
]
