"""What `irlx.stream` returns: samples, and what became of what sensors said."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator

from irlx.diagnostics import Diagnostic
from irlx.pacing.correction.nearness import ObstacleReport
from irlx.pacing.correction.report import CorrectionReport
from irlx.streams.sample import Sample


class SampleStream(Iterator[Sample]):
    """Samples of a run, one after another; iteration may stop at any of them."""

    def __init__(
        self,
        samples: Generator[Sample, None, None],
        warnings: Callable[[], tuple[Diagnostic, ...]] = tuple,
        corrections: Callable[[], CorrectionReport] | None = None,
        obstacles: Callable[[], ObstacleReport] | None = None,
    ) -> None:
        self._samples = samples
        self._warnings = warnings
        self._corrections = corrections
        self._obstacles = obstacles

    def __next__(self) -> Sample:
        return next(self._samples)

    def close(self) -> None:
        """End the run: no more samples come."""
        self._samples.close()

    @property
    def corrections(self) -> CorrectionReport | None:
        """What became of corrections until now, None where rows are not followed tick by tick."""
        return None if self._corrections is None else self._corrections()

    @property
    def obstacles(self) -> ObstacleReport | None:
        """What came too near until now, None where rows are not followed tick by tick."""
        return None if self._obstacles is None else self._obstacles()

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """Warnings until now, those of program and cell first."""
        return self._warnings()
