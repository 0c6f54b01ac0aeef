"""The command line of a campaign."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from fuzzing.campaign import Campaign, Judge, judged
from fuzzing.case import Case, Fault
from fuzzing.tally import Tally

ROOT = Path(__file__).resolve().parents[3]
CORPUS = ROOT / "tests" / "corpus"


def main(name: str, about: str, make_judge: Callable[[Path], Judge], inputs: int, size: int) -> int:
    """Run a campaign; 1 where it has found faults."""
    options = _options(name, about, inputs, size)
    if options.case:
        return _look(make_judge, options.case)
    tell = partial(print, flush=True)
    state: Path = options.state
    tally = Tally(seed=options.seed)
    if state.is_file() and not options.anew:
        tally = Tally.load(state)
        print(f"going on with {state}: {tally.inputs:,} inputs of seed {tally.seed}")
    if options.portion is not None:
        tally.portions, tally.inputs, options.inputs = options.portion, 0, size
        state = state.with_suffix(".portion.json")
    try:
        Campaign(make_judge, CORPUS, tell).run(tally, state, options.inputs, size, options.seconds)
    except KeyboardInterrupt:
        print("interrupted; the portion that was begun does not count")
    with TemporaryDirectory() as folder:
        judge = make_judge(Path(folder))
    print(f"seed        {tally.seed}, {tally.portions} portions of {size}")
    print("\n".join(tally.lines(judge.expected_codes, judge.promises)))
    return int(bool(tally.crashes))


def _options(name: str, about: str, inputs: int, size: int) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=about, formatter_class=argparse.RawDescriptionHelpFormatter, prog=f"{name}.py"
    )
    parser.add_argument("--inputs", type=int, default=inputs, help=f"how many in all (default {inputs:,})")
    parser.add_argument(
        "--seconds", type=float, default=float("inf"), help="stop after so long (default never)"
    )
    parser.add_argument("--seed", type=int, default=1, help="of a new campaign (default 1)")
    parser.add_argument("--anew", action="store_true", help="begin again instead of going on")
    parser.add_argument("--portion", type=int, metavar="N", help=f"repeat one portion of {size} inputs")
    parser.add_argument(
        "--case", nargs="+", type=Path, metavar="FILE", help="look at saved cases, nothing else"
    )
    parser.add_argument(
        "--state",
        type=Path,
        default=ROOT / "build" / "campaigns" / f"{name}.json",
        metavar="FILE",
        help="what is kept of the campaign (default build/campaigns)",
    )
    return parser.parse_args()


def _look(make_judge: Callable[[Path], Judge], paths: list[Path]) -> int:
    """Judge saved cases; the folder of each says its kind."""
    faults = 0
    for path in paths:
        with TemporaryDirectory() as folder:
            judge = make_judge(Path(folder))
            try:
                outcome = judged(judge, Case(path.parent.name, path.read_bytes()), True)
            except Fault as fault:
                faults += 1
                print(f"{path}: {fault.key}\n{fault.detail}")
            else:
                words = " ".join(sorted(outcome.codes)) or "no finding"
                print(f"{path}: {'accepted' if outcome.accepted else 'refused'}, {words}")
    return int(bool(faults))


__all__ = ["CORPUS", "main", "sys"]
