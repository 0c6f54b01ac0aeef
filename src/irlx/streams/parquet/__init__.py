"""Parquet, by pyarrow, which is imported only when such a file is written or read."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from irlx.streams.atomic import check_writable
from irlx.streams.extra import require
from irlx.streams.joint_stream import StreamHeader
from irlx.streams.scan import ScanItem
from irlx.streams.writer import StreamWriter

__all__ = ["check_parquet", "parquet_writer", "scan_parquet"]


def parquet_writer(path: Path, header: StreamHeader) -> StreamWriter:
    """A writer of Parquet. Raises StreamError: IRL720 without pyarrow, IRL003 where no file can be put."""
    _require(path)
    from irlx.streams.parquet.writer import ParquetWriter

    return ParquetWriter(path, header)


def scan_parquet(path: str | os.PathLike[str]) -> Iterator[ScanItem]:
    """Scan of a Parquet file; see `irlx.streams.parquet.reader`.

    Raises StreamError IRL720 without pyarrow, at once.
    """
    _require(Path(path))
    from irlx.streams.parquet.reader import scan

    return scan(Path(path))


def check_parquet(path: Path) -> None:
    """Raise StreamError where no file can be written: IRL720 without pyarrow, IRL003."""
    _require(path)
    check_writable(path)


def _require(path: Path) -> None:
    require("pyarrow.parquet", "parquet", path, "Parquet")
