"""One case carried out and judged: verified, the same a second time, read back, cut short; or refused."""

from __future__ import annotations

import itertools
import signal
import traceback
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import irlx
from irlx.blocks import FreezeBlock, MoveBlock, ReconfigureBlock, SignalBlock
from irlx.cell.load import load_cell
from irlx.streams.formats import read_stream

REFUSALS = frozenset(
    [
        "IRL343",
        "IRL345",
        "IRL347",
        "IRL351",
        "IRL421",
        "IRL422",
        "IRL423",
        "IRL424",
        "IRL425",
        "IRL426",
        "IRL427",
        "IRL428",
        "IRL429",
        "IRL430",
        "IRL434",
        "IRL435",
        "IRL437",
        "IRL441",
        "IRL520",
        "IRL521",
        "IRL522",
        "IRL523",
        "IRL524",
        "IRL560",
        "IRL561",
        "IRL562",
    ]
)
"""Codes with which a valid program may end: what depends on where the robot stands and what it can do."""

FORMATS = ("irdata", "npz", "jsonl", "csv")
BUDGET = 120.0
"""Processor time that a program may take, s."""


class Hang(BaseException):
    """A program has taken more than its budget."""


@contextmanager
def budget(seconds: float) -> Iterator[None]:
    """Raise Hang after so much processor time."""

    def late(*_: object) -> None:
        raise Hang

    before = signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


@dataclass
class Verdict:
    """What became of a program: motions executed, code of its refusal, what is wrong, '' for nothing.

    `finding` begins with a word for the kind of mistake, which a smaller program must show as well.
    """

    motions: int = 0
    rows: int = 0
    code: str = ""
    line: int = 0
    message: str = ""
    finding: str = ""
    planned: int = 0
    executed: Counter[str] = field(default_factory=Counter)


class Found(Exception):
    """Something that must not be."""


def judged(folder: Path, seed: int, full: bool = True) -> Verdict:
    """Carry out program.irl of a folder in its cell.toml; `seed` decides how it is cut and kept.

    Without `full` the parts that take longest are left to a share of the seeds.
    """
    verdict = Verdict()
    try:
        with budget(BUDGET):
            _Judge(folder, np.random.default_rng([17, seed]), verdict).all(full)
    except Found as found:
        verdict.finding = str(found)
    except Hang:
        verdict.finding = f"hang: more than {BUDGET:.0f} s of processor time"
    except Exception:
        verdict.finding = f"traceback: {traceback.format_exc()}"
    return verdict


class _Judge:
    """Judges one program."""

    def __init__(self, folder: Path, rng: np.random.Generator, verdict: Verdict) -> None:
        self.folder, self.rng, self.verdict = folder, rng, verdict
        self.path, self.cell_path = folder / "program.irl", folder / "cell.toml"
        given = folder / "input.txt"
        self.input = given.read_text(encoding="utf-8") if given.exists() else ""

    def all(self, full: bool) -> None:
        self.loaded()
        if full or self.rng.random() < 0.1:
            self.checked()
        run = self.ran()
        self.verified(run, "memory")
        self.by_differences(run)
        chosen = self.rng.random()
        if full or chosen < 0.25:
            self.written_again(run)
        if full or 0.25 <= chosen < 0.45:
            self.streamed(run)
        if full or 0.45 <= chosen < 0.65:
            self.interrupted(run)

    def loaded(self) -> None:
        """A valid program has no errors before it runs."""
        try:
            self.cell = load_cell(self.cell_path)
            self.program = irlx.load(self.path, self.cell_path)
        except irlx.IrlxError as error:
            raise Found(f"check: {error.diagnostics[0].code} {error}") from None

    def checked(self) -> None:
        """`irlx check` has nothing but warnings either."""
        errors = [found for found in irlx.check(self.path, cell=self.cell_path) if found.is_error]
        if errors:
            raise Found(f"check: {errors[0].code} {errors[0]}")

    def ran(self) -> irlx.Run:
        """The run, whole or until its refusal, which must be one that can be, with a place."""
        verdict = self.verdict
        try:
            run = irlx.run(self.program, self.cell_path, input=self.input)
        except irlx.RunError as error:
            run, reason = error.run, error.reason
            verdict.code, verdict.message = reason.code, reason.message
            verdict.line = (reason.place.line if reason.place else 0) or 0
            if reason.code not in REFUSALS:
                raise Found(f"refusal: {reason.code} {error}") from None
            if not verdict.line:
                raise Found(f"place: {reason.code} {error}") from None
        blocks = [record.block for record in run.stream.records]
        verdict.motions = sum(isinstance(block, MoveBlock | ReconfigureBlock) for block in blocks)
        verdict.rows, verdict.planned = len(run.q), run.summary.planned
        for block in blocks:
            verdict.executed.update(words_of(block))
        if np.any(run.qd[-1] != 0.0):
            raise Found("rest: the stream does not end at rest")
        return run

    def verified(self, what, where: str, complete: bool | None = None) -> None:
        """The verifier, which shares no code with what made the stream, has nothing against it."""
        report = irlx.verify(what, program=self.program, cell=self.cell)
        complete = not self.verdict.code if complete is None else complete
        failed = [check for check in report.failed if complete or check.name != "complete"]
        if failed:
            raise Found(f"verifier {failed[0].name}: ({where}) {failed[0].text}\n{report}")

    def by_differences(self, run: irlx.Run) -> None:
        """Bounds and frozen joints once more, by differences of rows and the blocks alone."""
        stream, limits = run.stream, run.stream.header.limits
        if np.any(run.q < limits.position_lower) or np.any(run.q > limits.position_upper):
            raise Found("bounds: a row is outside its position limits")
        unit = float(np.spacing(np.max(np.abs(run.q))))
        for kind, values, rounding in (
            ("speed", run.qd, 2.0 * unit / stream.dt),
            ("acceleration", run.qdd, 4.0 * unit / stream.dt**2),
        ):
            lower, upper = limits.pair(kind)
            if np.any(values > upper * (1 + 1e-9) + rounding) or np.any(
                values < lower * (1 + 1e-9) - rounding
            ):
                raise Found(f"bounds: the {kind} limits of the robot are passed")
        if np.any(np.diff(stream.ticks) != 1):
            raise Found("clock: ticks do not rise by one")
        records = [*((record.tick, record.block) for record in stream.records), (len(run.q) - 1, None)]
        held: tuple[int, ...] = ()
        for (tick, block), (end, _) in itertools.pairwise(records):
            if isinstance(block, FreezeBlock):
                held = block.joints
            columns = [joint - 1 for joint in held]
            if np.any(run.q[tick : end + 1, columns] != run.q[tick, columns]):
                raise Found(f"frozen: joints {held} move after tick {tick}")

    def written_again(self, run: irlx.Run) -> None:
        """A second run writes the same bytes as the first one, and what is read back is the same."""
        ending = str(self.rng.choice(FORMATS))
        first, second = self.folder / f"first.{ending}", self.folder / f"second.{ending}"
        run.save(first)
        try:
            irlx.record(self.program, second, self.cell_path, input=self.input)
        except irlx.RunError as error:
            if error.reason.code != self.verdict.code:
                raise Found(f"again: refused with {error.reason.code}, first {self.verdict.code}") from None
            if not error.run.files:
                return
            second = error.run.files[0]
        if ending != "npz" and first.read_bytes() != second.read_bytes():
            raise Found(f"again: other bytes in {ending}")
        self.verified(second, ending)
        back = read_stream(second)
        for name in ("ticks", "q", "block", "tool"):
            if not np.array_equal(getattr(back, name), getattr(run.stream, name)):
                raise Found(f"read back: {name} differs in {ending}")

    def streamed(self, run: irlx.Run) -> None:
        """`irlx.stream` gives the samples of `irlx.run`, to the end or to where it is broken off."""
        last = len(run.q) if self.rng.random() < 0.4 else int(self.rng.integers(1, len(run.q) + 1))
        count = 0
        samples = irlx.stream(self.program, self.cell_path, input=self.input)
        try:
            for k, sample in enumerate(samples):
                if k >= last:
                    break
                if k >= len(run.q) or not (
                    np.array_equal(sample.q, run.q[k])
                    and np.array_equal(sample.tool, run.tool[k])
                    and sample.block == run.block[k]
                    and sample.tick == k
                ):
                    raise Found(f"stream: sample {k} differs from the row of the run")
                count += 1
        except irlx.IrlxError as error:
            code = error.diagnostics[0].code
            if code != self.verdict.code or last < len(run.q):
                raise Found(
                    f"stream: ended with {code}, the run with {self.verdict.code or 'nothing'}"
                ) from None
        samples.close()
        if count != last:
            raise Found(f"stream: {count} samples, the run has {last} until there")

    def interrupted(self, run: irlx.Run) -> None:
        """Ctrl-C or too many statements leave a valid stream, which begins like the whole one."""
        if self.rng.random() < 0.5:
            stop, steps = int(self.rng.integers(1, len(run.stream.records) + 2)), None
        else:
            stop, steps = 0, int(self.rng.integers(1, 60))
        done = 0

        def progress(*_: object) -> None:
            nonlocal done
            done += 1
            if done == stop:
                raise KeyboardInterrupt

        try:
            part = irlx.run(
                self.program, self.cell_path, input=self.input, progress=progress, max_steps=steps
            )
        except irlx.RunInterrupted as error:
            part = error.run
        except irlx.RunError as error:
            part = error.run
            if error.reason.code not in {"IRL510", self.verdict.code}:
                raise Found(f"cut: refused with {error.reason.code}, whole {self.verdict.code}") from None
        rows = rows_in_common(part)
        if not np.array_equal(part.q[:rows], run.q[:rows]):
            raise Found("cut: the rows are not the first ones of the whole run")
        report = irlx.verify(part, cell=self.cell)
        failed = [check for check in report.failed if check.name != "complete"]
        if failed:
            raise Found(f"cut {failed[0].name}: {failed[0].text}\n{report}")


def rows_in_common(part: irlx.Run) -> int:
    """How many rows of a run that was cut off are those of the whole one.

    A move that was to pass its target stops there where the next one does not come any more, and with it all
    moves joined to it are planned anew: then the rows up to the stop before them.
    """
    rows = len(part.q)
    for record in reversed(part.stream.records):
        block = record.block
        if isinstance(block, SignalBlock):
            continue
        if not isinstance(block, MoveBlock) or block.blend is None:
            break
        rows = record.tick + 1
    return rows


def words_of(block) -> list[str]:
    """What an executed block is, for the table of what occurred."""
    if isinstance(block, ReconfigureBlock):
        return ["RECONFIGURATION"]
    if not isinstance(block, MoveBlock):
        return [type(block).__name__.removesuffix("Block")]
    words = [f"{block.kind.value} to {type(block.target).__name__}"]
    words += [f"{block.kind.value} PATH"] * (block.path is not None)
    words += [f"{block.kind.value} WITH {clause.kind.value}" for clause in block.limits]
    words += [f"{block.kind.value} WITH CRITERION"] * bool(block.criteria)
    words += [f"{block.kind.value} WITH TOLERANCE"] * (block.tolerance is not None)
    words += [f"{block.kind.value} WITH RECONFIGURATION"] * (block.reconfiguration is not None)
    words += [f"{block.kind.value} IN FRAME"] * (block.frame is not None)
    words += [f"{block.kind.value} passing"] * (block.blend is not None)
    words += [f"{block.kind.value} TIME"] * (block.law.duration is not None)
    words += [f"profile {block.law.profile.value}"]
    return words
