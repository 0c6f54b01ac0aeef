"""Writer of IRDATA-like files."""

from __future__ import annotations

import os

from irlx.streams.irdata.block import block_operands
from irlx.streams.irdata.codes import END
from irlx.streams.irdata.header import header_records
from irlx.streams.irdata.record import Value, record_text
from irlx.streams.irdata.samples import samples_text
from irlx.streams.joint_stream import BlockRecord, StreamHeader
from irlx.streams.scan import RowBatch
from irlx.streams.text_writer import TextWriter


class IrdataWriter(TextWriter):
    """Writes one stream as IRDATA-like records, see `StreamWriter`."""

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        super().__init__(path, header)
        self._number = 1
        for code, operands in header_records(header):
            self._record(code, operands)

    def _put_block(self, record: BlockRecord) -> None:
        try:
            code, operands = block_operands(record)
        except KeyError as cause:
            raise self.refusal(f"it has no record for {cause.args[0]}") from cause
        self._record(code, operands)

    def _put_rows(self, batch: RowBatch) -> None:
        self._write(samples_text(self._number, batch))
        self._number += len(batch.ticks)

    def _put_end(self, complete: bool) -> None:
        checksum = self._digest.hexdigest()
        self._record(END, {"samples": self.rows, "complete": complete, "sha256": checksum})

    def _record(self, code: int, operands: dict[str, Value]) -> None:
        self._write(record_text(self._number, code, operands))
        self._number += 1
