"""Parquet: a column for every value, row groups of one size, everything else as JSON in the metadata."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from irlx.streams.atomic import AtomicFile
from irlx.streams.error import cannot_write
from irlx.streams.header_plain import header_to_plain, record_to_plain
from irlx.streams.joint_stream import BlockRecord, StreamHeader
from irlx.streams.parquet.table import END, HEADER, RECORDS, Digest, bits_of, schema_of, table_of
from irlx.streams.rates import Rates
from irlx.streams.row_portions import RowPortions
from irlx.streams.scan import RowBatch
from irlx.streams.writer import StreamWriter

ROWS_OF_A_GROUP = 1 << 15


class ParquetWriter(StreamWriter):
    """Writes one stream as Parquet; the same stream gives the same bytes.

    Row groups have `ROWS_OF_A_GROUP` rows, the last one fewer, whatever the batches were. Block records are
    kept until the end, where the metadata stands. See `StreamWriter`.
    """

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        super().__init__(path, header)
        self._records: list[dict[str, Any]] = []
        self._rates = Rates(header)
        self._portions = RowPortions(header.joints, ROWS_OF_A_GROUP)
        self._digest = Digest()
        self._schema = schema_of(header)
        self._file = AtomicFile(path)
        with self._writing():
            # Numbers hardly repeat, ids of blocks do.
            self._columns = pq.ParquetWriter(
                self._file.handle,
                self._schema,
                compression="zstd",
                use_dictionary=["block"],
                store_schema=False,
                write_page_checksum=True,
            )

    def _put_block(self, record: BlockRecord) -> None:
        self._records.append(record_to_plain(record))

    def _put_rows(self, batch: RowBatch) -> None:
        for portion in self._portions.put(batch):
            self._put_group(portion)

    def _put_group(self, rows: RowBatch) -> None:
        bits = bits_of(rows, self._rates.of(rows.ticks, rows.q))
        self._digest.rows(bits)
        with self._writing():
            self._columns.write_table(table_of(bits, self._schema))

    def _put_end(self, complete: bool) -> None:
        rest = self._portions.rest()
        if len(rest.ticks):
            self._put_group(rest)
        header = json.dumps(header_to_plain(self.header), allow_nan=False).encode()
        records = json.dumps(self._records, allow_nan=False).encode()
        digest = self._digest.end(header, records, self.rows, complete)
        end = {"samples": self.rows, "complete": complete, "sha256": digest}
        with self._writing():
            self._columns.add_key_value_metadata(
                {HEADER: header, RECORDS: records, END: json.dumps(end).encode()}
            )
            self._columns.close()

    def _commit(self, name: Path | None) -> None:
        self._file.commit(name)

    def _discard(self) -> None:
        # It ends its file when it is closed, which goes wrong again on a full disk.
        with suppress(Exception):
            self._columns.close()
        self._file.discard()

    @contextmanager
    def _writing(self) -> Iterator[None]:
        try:
            yield
        except OSError as cause:
            self.abort()
            raise cannot_write(self.path, cause) from cause
