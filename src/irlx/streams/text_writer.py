"""Writers of formats that are text: bytes to one file, with a digest of all that stands before the end."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import numpy as np

from irlx.streams.atomic import AtomicFile
from irlx.streams.joint_stream import StreamHeader
from irlx.streams.rates import Rates
from irlx.streams.scan import RowBatch, StatedRates
from irlx.streams.writer import StreamWriter


class TextWriter(StreamWriter):
    """A writer whose file grows by what is put, one whole line after another."""

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        super().__init__(path, header)
        self._file = AtomicFile(path)
        self._digest = hashlib.sha256()
        self._rates = Rates(header)

    def _rates_of(self, batch: RowBatch) -> StatedRates:
        """Times and rates of the next rows, for formats that state them; refuses what is not finite."""
        rates = self._rates.of(batch.ticks, batch.q)
        if not (np.isfinite(rates.qd).all() and np.isfinite(rates.qdd).all()):
            raise self.refusal("rates are not finite")
        return rates

    def _write(self, data: bytes) -> None:
        self._digest.update(data)
        self._file.write(data)

    def _commit(self, name: Path | None) -> None:
        self._file.commit(name)

    def _discard(self) -> None:
        self._file.discard()
