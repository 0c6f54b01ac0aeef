"""A campaign: portions of inputs, each in a process of its own, until there are enough.

A portion is made of its seed and number alone: the same ones come again wherever it is repeated. Within a
portion inputs that show something new (a code, a wording, codes together) are damaged further.
"""

from __future__ import annotations

import json
import mmap
import os
import struct
import time
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Protocol

from fuzzing.case import Case, Fault, Outcome
from fuzzing.limits import bound_process, bounded, peak
from fuzzing.minimise import smallest
from fuzzing.tally import Tally

_LARGEST_KEPT = 1 << 22
_POOL = 400
_OWN_FAULT = 70
_HEAD = struct.Struct("<QQ")


class Judge(Protocol):
    """What is fuzzed: draws cases, and looks whether promises hold for them."""

    area: str
    endings: dict[str, str]
    promises: str
    expected_codes: tuple[str, ...]

    def beginnings(self) -> Sequence[Callable[[], Case]]:
        """What makes the cases that come first: those without damage, and damage that is gone through."""

    def draw(self, chance: Random, pool: Sequence[Case]) -> Case:
        """The next case."""

    def patience(self, kind: str) -> float:
        """How many times the usual time a case of this kind may take."""

    def judge(self, case: Case, thorough: bool | None = None) -> Outcome:
        """What came of it. Raises Fault; whatever else it raises is a fault as well."""


def judged(judge: Judge, case: Case, thorough: bool | None = None) -> Outcome:
    """Judge a case within bounds of time and memory. Raises Fault alone."""
    with bounded(len(case.content), judge.patience(case.kind)):
        return judge.judge(case, thorough)


def key_of(judge: Judge, case: Case, thorough: bool | None = None) -> str:
    """Key of the fault that a case shows, '' for none."""
    try:
        judged(judge, case, thorough)
    except Fault as fault:
        return fault.key
    return ""


@dataclass(frozen=True)
class Portion:
    """Some inputs of a campaign."""

    seed: int
    number: int
    size: int

    def cases(self, judge: Judge, pool: Sequence[Case]) -> Iterator[Case]:
        """Its cases; what damage begins with is spread over the first portions."""
        chance = Random(f"{self.seed} {self.number}")
        start = self.number * self.size
        first = judge.beginnings()[start : start + self.size]
        for make in first:
            yield make()
        for _ in range(self.size - len(first)):
            yield judge.draw(chance, pool)

    def run(self, judge: Judge, last: LastCase, skipped: Collection[int] = ()) -> Tally:
        """Look at its inputs; those of the numbers `skipped` are drawn and passed over."""
        pool: list[Case] = []
        seen: set[object] = set()
        tally = Tally(self.seed, 1)
        for index, case in enumerate(self.cases(judge, pool)):
            last.put(index, case)
            tally.inputs += 1
            tally.kinds[case.kind] += 1
            if index in skipped:
                continue
            start = time.process_time()
            try:
                outcome = judged(judge, case)
            except Fault as fault:
                tally.crashed += 1
                if fault.key not in tally.crashes:
                    tally.crashes[fault.key] = {"detail": fault.detail, **_plain(case)}
                continue
            finally:
                taken = time.process_time() - start
                tally.seconds += taken
                if taken > tally.slowest:
                    tally.slowest, tally.slowest_case = taken, f"{case.kind}, {len(case.content)} bytes"
            tally.accepted += outcome.accepted
            tally.codes.update(outcome.codes)
            if not outcome.features <= seen:
                seen |= outcome.features
                pool.append(case)
                del pool[:-_POOL]
        tally.memory = peak()
        return tally


class LastCase:
    """The case that is looked at, in memory that is shared: it is known even of a process that was killed."""

    def __init__(self) -> None:
        self._memory = mmap.mmap(-1, _LARGEST_KEPT)

    def put(self, index: int, case: Case) -> None:
        """Keep a case; of a very large one the beginning."""
        words = f"{case.kind}\n".encode() + case.content
        words = words[: _LARGEST_KEPT - _HEAD.size]
        self._memory[: _HEAD.size + len(words)] = _HEAD.pack(index, len(words)) + words

    def get(self) -> tuple[int, Case]:
        """The case that was put last, and its number."""
        index, size = _HEAD.unpack(self._memory[: _HEAD.size])
        kind, _, content = self._memory[_HEAD.size : _HEAD.size + size].partition(b"\n")
        return index, Case(kind.decode(), content)


class Campaign:
    """Runs portions in processes of their own, and saves the smallest case of each fault under `corpus`."""

    def __init__(
        self, make_judge: Callable[[Path], Judge], corpus: Path, tell: Callable[[str], None]
    ) -> None:
        self._make_judge = make_judge
        self._corpus = corpus
        self._tell = tell
        self._last = LastCase()

    def run(self, tally: Tally, state: Path, inputs: int, size: int, seconds: float) -> None:
        """Go on until there are so many inputs, or the clock's time is over; `state` holds what there is."""
        end = time.monotonic() + seconds
        while tally.inputs < inputs and time.monotonic() < end:
            portion = Portion(tally.seed, tally.portions, min(size, inputs - tally.inputs))
            known = set(tally.crashes)
            tally.add(self.portion(portion, known))
            tally.save(state)
            self._tell(
                f"portion {portion.number} of seed {tally.seed}: {tally.inputs:,} inputs, "
                f"{tally.crashed} crashes, {tally.inputs / max(tally.seconds, 1e-9):,.0f}/s"
            )

    def portion(self, portion: Portion, known: set[str]) -> Tally:
        """One portion; inputs that end its process are left out when it begins again."""
        skipped: set[int] = set()
        ended: dict[str, dict[str, str]] = {}
        crashed = 0
        while True:
            found = self._in_process(lambda judge: portion.run(judge, self._last, skipped).plain())
            if isinstance(found, dict):
                break
            index, case = self._last.get()
            skipped.add(index)
            crashed += 1
            ended.setdefault(f"process ended by {found}", {"detail": "", **_plain(case)})
        tally = Tally.of(found)
        tally.crashed += crashed
        tally.crashes |= ended
        new = {key: found for key, found in tally.crashes.items() if key not in known}
        tally.crashes = {key: self._saved(key, found) for key, found in new.items()}
        return tally

    def _saved(self, key: str, found: dict[str, str]) -> dict[str, str]:
        """Make a case smaller and save it; what is to be told of it."""
        case = Case(found["kind"], bytes.fromhex(found["content"]))
        self._tell(f"CRASH {key}\n{found['detail']}")
        reduced = self._in_process(lambda judge: _plain(_smaller(judge, case, key)))
        if isinstance(reduced, dict):
            case = Case(reduced["kind"], bytes.fromhex(reduced["content"]))
        with TemporaryDirectory() as folder:
            judge = self._make_judge(Path(folder))
        path = self._corpus / judge.area / case.kind / f"{case.digest}{judge.endings[case.kind]}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(case.content)
        self._tell(f"saved {len(case.content)} bytes: {path}")
        return {"case": str(path), "detail": found["detail"]}

    def _in_process(self, work: Callable[[Judge], dict[str, object]]) -> dict | str:  # type: ignore[type-arg]
        """What `work` gives in a process of its own, or what ended it."""
        with TemporaryDirectory(dir=_quick_folder()) as folder:
            result = Path(folder) / "result.json"
            inside = Path(folder) / "work"
            inside.mkdir()
            child = os.fork()
            if child == 0:
                try:
                    bound_process()
                    os.chdir(inside)
                    result.write_text(json.dumps(work(self._make_judge(inside))), encoding="utf-8")
                    os._exit(0)
                except KeyboardInterrupt:
                    os._exit(130)
                except BaseException:
                    import traceback

                    traceback.print_exc()
                    os._exit(_OWN_FAULT)
            _, status = os.waitpid(child, 0)
            code = os.waitstatus_to_exitcode(status)
            if code == 130:
                raise KeyboardInterrupt
            if code == 0 and result.is_file():
                return json.loads(result.read_text(encoding="utf-8"))  # type: ignore[no-any-return]
            if code == _OWN_FAULT:
                raise RuntimeError("the campaign itself is at fault, see above")
            return f"signal {-code}" if code < 0 else f"exit code {code}"


def _smaller(judge: Judge, case: Case, key: str) -> Case:
    thorough = key_of(judge, case) != key
    return smallest(case, lambda one: key_of(judge, one, thorough or None) == key)


def _plain(case: Case) -> dict[str, str]:
    return {"kind": case.kind, "content": case.content.hex()}


def _quick_folder() -> str | None:
    """A folder in memory, where there is one."""
    shared = Path("/dev/shm")
    return str(shared) if shared.is_dir() and os.access(shared, os.W_OK) else None
