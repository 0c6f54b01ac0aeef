"""Which test executes which line of a folder, how long each takes, and whether it passes."""

from __future__ import annotations

import gc
import hashlib
import json
import signal
import tempfile
import time
from bisect import bisect_right
from collections.abc import Iterable
from functools import cache
from itertools import accumulate
from pathlib import Path

import pytest
from _pytest.runner import runtestprotocol
from forked import fork, quiet
from mutations import Mutation

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "irlx"
LONGEST = 3.0
"""Tests that take more processor time (s) than this while lines are recorded do not judge."""
LEFT_OUT = ("tests/language/highlight", "tests/language/test_robustness.py")
"""Tests of another folder, and those that measure time or start processes."""
OPTIONS = ["-q", "-s", "-p", "no:cacheprovider", "-p", "no:xdist", "--no-header"]
OPTIONS += ["-W", "ignore::pytest.PytestAssertRewriteWarning"]


class Recorder:
    """Runs each test by itself and keeps which lines it executes, how long it takes and whether it passes."""

    def __init__(self, parts: Iterable[str]) -> None:
        from coverage import Coverage

        include = [str(SOURCE / part) + ("" if part.endswith(".py") else "/*") for part in parts]
        self.coverage = Coverage(data_file=None, include=include, config_file=False)
        self.coverage.start()
        self.seconds: dict[str, float] = {}
        self.failed: list[str] = []

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Caches are emptied before each, since a test needs what it would have to compute were it alone."""
        signal.signal(signal.SIGPROF, _given_up)
        gc.unfreeze()
        caches = [one for one in gc.get_objects() if isinstance(one, _CACHED) and _is_ours(one)]
        for item in session.items:
            for known in caches:
                known.cache_clear()
            self.coverage.switch_context(item.nodeid)
            begin = time.process_time()
            signal.setitimer(signal.ITIMER_PROF, LONGEST)
            reports = runtestprotocol(item, log=False, nextitem=None)
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            self.seconds[item.nodeid] = time.process_time() - begin
            self.coverage.switch_context("")
            if any(report.failed for report in reports):
                self.failed.append(item.nodeid)
        return True

    def result(self) -> dict:
        """Tests by line and file; "" is the import."""
        self.coverage.stop()
        data = self.coverage.get_data()
        lines = {
            Path(path).relative_to(SOURCE).as_posix(): data.contexts_by_lineno(path)
            for path in data.measured_files()
        }
        return {"seconds": self.seconds, "failed": self.failed, "lines": lines}


def _given_up(*_: object) -> None:
    raise TimeoutError("too long to judge")


_CACHED = type(cache(len))


def _is_ours(cached: object) -> bool:
    code = getattr(cached.__wrapped__, "__code__", None)
    return code is not None and code.co_filename.startswith(str(ROOT))


class ExecutedLines:
    """Which test executes which line; kept in the temporary folder, by the contents of what it depends on."""

    def __init__(self, parts: tuple[str, ...], tests: str) -> None:
        self.seconds: dict[str, float] = {}
        self.lines: dict[tuple[str, int], set[str]] = {}
        common = [*sorted(SOURCE.rglob("*.py")), *sorted((ROOT / "tests").rglob("conftest.py"))]
        common += sorted((ROOT / "tests" / "support").glob("*.py"))
        for file in sorted((ROOT / tests).rglob("test_*.py")):
            name = file.relative_to(ROOT).as_posix()
            if not name.startswith(LEFT_OUT):
                self._add(self._recorded(name, parts, _digest([*common, file])))

    def _recorded(self, name: str, parts: Iterable[str], digest: str) -> dict:
        kept = Path(tempfile.gettempdir()) / "irlx-mutants" / f"{digest}.json"
        if not kept.exists():
            kept.parent.mkdir(exist_ok=True)

            def work() -> int:
                quiet()
                recorder = Recorder(parts)
                status = pytest.main([name, *OPTIONS], plugins=[recorder])
                if status not in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
                    return int(status)
                kept.with_suffix(".part").write_text(json.dumps(recorder.result()), encoding="utf-8")
                return 0

            if fork(work) != 0:
                raise SystemExit(f"{name}: its lines could not be recorded")
            kept.with_suffix(".part").replace(kept)
        return json.loads(kept.read_text(encoding="utf-8"))

    def _add(self, recorded: dict) -> None:
        for test, taken in recorded["seconds"].items():
            if taken > 0.95 * LONGEST:
                print(f"left out, takes too long: {test}")
            elif test in recorded["failed"]:
                print(f"left out, fails undamaged: {test}")
            else:
                self.seconds[test] = taken
        for path, lines in recorded["lines"].items():
            for line, tests in lines.items():
                self.lines.setdefault((path, int(line)), set()).update(tests)

    def judges(self, mutation: Mutation, most: float) -> tuple[list[str], bool]:
        """Tests that may notice, quickest first, and whether the damage must be there before the import.

        No more than take `most` seconds of processor time together, but one of them always.
        """
        path = mutation.path.as_posix()
        on_lines = set().union(*(self.lines.get((path, line), set()) for line in mutation.lines))
        early = not mutation.defined_at or "" in on_lines
        judges = sorted(on_lines & self.seconds.keys(), key=self.seconds.__getitem__)
        if early:
            near = {test for (file, _), tests in self.lines.items() if file == path for test in tests}
            judges = sorted(self.seconds, key=lambda test: (test not in near, self.seconds[test]))
        together = list(accumulate(self.seconds[test] for test in judges))
        return judges[: max(bisect_right(together, most), 1)], early


def _digest(paths: Iterable[Path]) -> str:
    known = hashlib.sha256(b"2")
    for path in paths:
        known.update(path.read_bytes())
    return known.hexdigest()[:24]
