"""What `irlx.stream` returns: samples, and what became of a sensor's corrections."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator

from irlx.pacing.correction.report import CorrectionReport
from irlx.streams.sample import Sample


class SampleStream(Iterator[Sample]):
    """Samples of a run, one after another; iteration may stop at any of them."""

    def __init__(
        self,
        samples: Generator[Sample, None, None],
        corrections: Callable[[], CorrectionReport] | None = None,
    ) -> None:
        self._samples = samples
        self._corrections = corrections

    def __next__(self) -> Sample:
        return next(self._samples)

    def close(self) -> None:
        """End the run: no more samples come."""
        self._samples.close()

    @property
    def corrections(self) -> CorrectionReport | None:
        """What became of corrections until now, None where no sensor corrects."""
        return None if self._corrections is None else self._corrections()
