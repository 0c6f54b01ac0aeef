"""The side of a process that is measured: one JSON object a line comes in, one goes out."""

from __future__ import annotations

import gc
import json
import os
import sys
from collections.abc import Callable, Iterable, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from time import perf_counter, process_time
from typing import IO, Any

Answer = dict[str, Any]


def versions(packages: Sequence[str]) -> dict[str, str]:
    """Versions of what is measured here, and of the Python that runs it."""
    found = {package: version(package) for package in packages}
    return {**found, "python": ".".join(str(part) for part in sys.version_info[:3])}


class Stopwatch:
    """Counts the time of what runs `with` it: `cpu` is the processor's, `wall` the clock's, both in s."""

    def __init__(self) -> None:
        self.cpu = self.wall = 0.0

    def __enter__(self) -> Stopwatch:
        self._wall, self._cpu = perf_counter(), process_time()
        return self

    def __exit__(self, *_: object) -> None:
        self.cpu += process_time() - self._cpu
        self.wall += perf_counter() - self._wall


def serve(
    answer: Callable[..., Answer], packages: Sequence[str], requests: Iterable[str], out: IO[str]
) -> None:
    """Tell the versions, then answer `requests`, lines of JSON; what an answer raises is told as `failed`."""
    print(json.dumps({"versions": versions(packages)}), file=out, flush=True)
    for line in requests:
        gc.collect()  # What a round leaves behind is not paid for by the next one.
        try:
            told = answer(**json.loads(line))
        except Exception as error:
            told = {"failed": f"{type(error).__name__}: {error}"}
        print(json.dumps(told), file=out, flush=True)


@contextmanager
def own_output() -> Any:
    """Standard output for answers alone: what libraries print goes where errors go."""
    with os.fdopen(os.dup(1), "w", encoding="utf-8") as out:
        os.dup2(2, 1)
        yield out


def serve_standard_input(make: Callable[[Path], Callable[..., Answer]], packages: Sequence[str]) -> None:
    """Serve what `make` makes of the folder named on the command line, until the input ends."""
    with own_output() as out:
        serve(make(Path(sys.argv[1])), packages, sys.stdin, out)
