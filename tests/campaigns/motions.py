"""Random motions: valid programs with random robots, carried out and judged.

    python tests/campaigns/motions.py --motions 100000 --seed 0 --processes 2
    python tests/campaigns/motions.py --from-seed 4711 --motions 5000   # on from where another one stopped
    python tests/campaigns/motions.py --only 4711                      # one program, everything said of it
    python tests/campaigns/motions.py --only 4711 --keep NAME        # a finding, made smaller, to the corpus

A program is drawn from its seed alone: one of many kinds of robot with 3 to 12 joints in a cell, and a
program that uses the language and the options of redundancy in any order, with zeros, residues of rounding
and states on limits mixed in. Each is either carried out, and everything about it verified, or refused with a
code at its place. Anything else is a finding.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
import warnings
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from itertools import count, islice
from pathlib import Path
from tempfile import TemporaryDirectory
from traceback import format_exc

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from drawn.judging import Verdict, judged
from drawn.minimise import kept_case
from drawn.program import Case, drawn_case

CORPUS = Path(__file__).resolve().parents[1] / "corpus" / "motions"


@dataclass
class Outcome:
    """What became of the program of a seed."""

    seed: int
    robot: str
    verdict: Verdict
    noted: Counter[str]
    time: float
    statement: str = ""


@dataclass
class Tally:
    """Figures of a campaign."""

    programs: int = 0
    motions: int = 0
    rows: int = 0
    planned: int = 0
    time: float = 0.0
    refused: Counter[str] = field(default_factory=Counter)
    noted: Counter[str] = field(default_factory=Counter)
    executed: Counter[str] = field(default_factory=Counter)
    findings: list[Outcome] = field(default_factory=list)

    def add(self, outcome: Outcome) -> None:
        verdict = outcome.verdict
        self.programs += 1
        self.motions += verdict.motions
        self.rows += verdict.rows
        self.planned += verdict.planned
        self.time += outcome.time
        self.refused.update([verdict.code] if verdict.code else [])
        self.noted.update(outcome.noted)
        self.executed.update(verdict.executed)
        if verdict.finding:
            self.findings.append(outcome)

    def line(self) -> str:
        each = 1e3 * self.time / max(self.motions, 1)
        return (
            f"{self.programs} programs, {self.motions} motions, {self.refused.total()} refused, "
            f"{len(self.findings)} findings, {self.time:.0f} s of processor time, {each:.0f} ms a motion"
        )

    def figures(self) -> str:
        refused = ", ".join(f"{code} {n}" for code, n in self.refused.most_common())
        share = 100.0 * self.refused.total() / max(self.programs, 1)
        found = Counter(outcome.verdict.finding.split(":")[0] for outcome in self.findings)
        seeds = [
            f"  seed {o.seed} ({o.robot}): {o.verdict.finding.splitlines()[0][:160]}" for o in self.findings
        ]
        return "\n".join(
            [
                self.line(),
                f"{self.rows} rows, {self.planned} motions planned as a whole",
                f"refused {share:.1f} %: {refused or 'none'}",
                f"findings: {dict(found) or 'none'}",
                *seeds,
            ]
        )

    def table(self) -> str:
        """How often everything was written and executed."""
        parts = (("written", self.noted), ("executed", self.executed))
        return "\n".join(
            f"{head:9} {n:8}  {word}" for head, words in parts for word, n in sorted(words.items())
        )


def outcome_of(seed: int, full: bool = False, kind: str | None = None) -> Outcome:
    """Draw, carry out and judge the program of a seed."""
    warnings.simplefilter("ignore")
    begin = time.process_time()
    try:
        case = drawn_case(seed, kind)
        with TemporaryDirectory() as folder:
            case.write(Path(folder))
            verdict = judged(Path(folder), seed, full)
    except Exception as error:
        # A fault of the campaign itself is told as a finding: other programs go on.
        verdict = Verdict(finding=f"campaign: {error!r}\n{format_exc()}")
        return Outcome(seed, kind or "not drawn", verdict, Counter(), time.process_time() - begin)
    spent = time.process_time() - begin
    robot = next(word for word in case.noted if word.startswith("robot "))
    return Outcome(seed, robot, verdict, case.noted, spent, statement_at(case, verdict.line))


def statement_at(case: Case, line: int) -> str:
    lines = case.files["program.irl"].splitlines()
    return lines[line - 1].strip() if 0 < line <= len(lines) else ""


def outcomes(first: int, processes: int) -> Iterator[Outcome]:
    """Outcomes of all seeds from the first one on, in their order."""
    if processes == 1:
        yield from map(outcome_of, count(first))
        return
    with ProcessPoolExecutor(processes) as pool:
        seeds, waiting = count(first), []
        try:
            while True:
                waiting += [
                    pool.submit(outcome_of, seed) for seed in islice(seeds, 4 * processes - len(waiting))
                ]
                yield waiting.pop(0).result()
        finally:
            pool.shutdown(cancel_futures=True)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--motions", type=int, default=100_000, help="executed motions to come to (100000)")
    parser.add_argument(
        "--seed", type=int, default=0, help="the campaign: programs begin at 1,000,000 times it"
    )
    parser.add_argument("--from-seed", type=int, help="the first program instead, to go on with a campaign")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--only", type=int, metavar="SEED", help="one program, judged in full")
    parser.add_argument("--keep", metavar="NAME", help="with --only: make a finding smaller and keep it")
    parser.add_argument("--write", metavar="DIR", help="with --only: write its files there")
    parser.add_argument("--table", action="store_true", help="how often each statement and option occurred")
    parser.add_argument("--refusals", action="store_true", help="tell every refusal")
    return parser.parse_args()


def one_program(given: argparse.Namespace) -> int:
    outcome = outcome_of(given.only, full=True)
    verdict = outcome.verdict
    print(f"seed {given.only}, {outcome.robot}: {verdict.motions} motions, {verdict.code or 'complete'}")
    if verdict.code:
        print(f"line {verdict.line}: {verdict.message}\n  {outcome.statement}")
    print(verdict.finding or "no finding")
    if given.write:
        Path(given.write).mkdir(parents=True, exist_ok=True)
        drawn_case(given.only).write(Path(given.write))
    if given.keep and verdict.finding:
        print("kept in", kept_case(drawn_case(given.only), verdict.finding, CORPUS / given.keep))
    return bool(verdict.finding)


def main() -> int:
    given = arguments()
    if given.only is not None:
        return one_program(given)
    first = 1_000_000 * given.seed if given.from_seed is None else given.from_seed
    print(f"programs from seed {first}", flush=True)
    tally, shown = Tally(), 0.0
    running = outcomes(first, given.processes)
    for outcome in running:
        tally.add(outcome)
        verdict = outcome.verdict
        if given.refusals and verdict.code:
            told = f"{verdict.code} seed {outcome.seed} {outcome.robot}: {verdict.message}"
            print(f"{told}\n   {outcome.statement[:300]}", flush=True)
        if verdict.finding:
            print(
                f"FINDING seed {outcome.seed} ({outcome.robot}) {verdict.code}: {verdict.finding[:2000]}",
                flush=True,
            )
        if tally.time - shown > 60.0:
            shown = tally.time
            print(f"until seed {outcome.seed}: {tally.line()}", flush=True)
        if tally.motions >= given.motions:
            running.close()
            break
    if given.table:
        print(tally.table())
    print(tally.figures())
    return bool(tally.findings)


if __name__ == "__main__":
    sys.exit(main())
