"""The monograph's experiments 6.1 to 6.6: runs the variants of each, prints their facts, draws their joints.

python programs/koch/experiments.py 6.1                          facts and a picture at a tick of 50 ms
python programs/koch/experiments.py all --tick 20 25 50 --facts  facts of all, a column for each tick

The pictures need matplotlib (pip install matplotlib), the facts do not.
"""

from __future__ import annotations

import argparse
import re
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from experiment_facts import EXPERIMENTS, Experiment, Facts, Variant

import irlx

HERE = Path(__file__).resolve().parent


def main() -> int:
    """Run what the command line asks for; 0, or 1 where a program ended in an error or nothing could draw."""
    asked = arguments()
    draw = None if asked.facts else drawing()
    if not asked.facts and draw is None:
        print("no pictures: matplotlib is missing; pip install matplotlib", file=sys.stderr)
    names = list(EXPERIMENTS) if asked.experiment == "all" else [asked.experiment]
    with TemporaryDirectory() as folder:
        for name in names:
            experiment = adapted(EXPERIMENTS[name], asked, Path(folder))
            try:
                runs = [runs_of(experiment, tick) for tick in asked.tick]
            except irlx.IrlxError as error:
                print(error, file=sys.stderr)
                return 1
            print_facts(name, experiment, asked.tick, [experiment.facts(*run) for run in runs])
            if draw is not None:
                picture = asked.out / f"experiment_{name.replace('.', '_')}.{asked.format}"
                draw(name, experiment, runs[0], asked.joints, asked.window, picture)
                print(f"written  {picture}\n")
    return 0 if asked.facts or draw is not None else 1


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description="Experiments 6.1 to 6.6 of the monograph.")
    parser.add_argument("experiment", choices=[*EXPERIMENTS, "all"])
    parser.add_argument(
        "--tick", type=float, nargs="+", default=[50.0], metavar="MS", help="ticks; the first one is drawn"
    )
    parser.add_argument("--out", type=Path, default=Path(), metavar="FOLDER", help="folder of the pictures")
    parser.add_argument(
        "--joints", type=int, nargs="+", default=list(range(1, 12)), choices=range(1, 12), metavar="N"
    )
    parser.add_argument(
        "--window", type=float, nargs=2, metavar=("FROM", "TO"), help="draw these seconds only"
    )
    parser.add_argument("--format", choices=["png", "svg"], default="png")
    parser.add_argument("--weight", type=float, metavar="W", help="weight of joint 10, per m² (else 5)")
    parser.add_argument(
        "--acceleration", type=float, metavar="A", help="limit of experiment 6.3, deg/s² (else 350)"
    )
    parser.add_argument("--facts", action="store_true", help="print facts only")
    asked = parser.parse_args()
    if not asked.facts:
        asked.out.mkdir(parents=True, exist_ok=True)
    return asked


def drawing():
    """The function that draws an experiment, None without matplotlib."""
    try:
        from experiment_figures import draw_experiment
    except ModuleNotFoundError as missing:
        if (missing.name or "").partition(".")[0] != "matplotlib":
            raise
        return None
    return draw_experiment


def adapted(experiment: Experiment, asked: argparse.Namespace, folder: Path) -> Experiment:
    """The experiment with the weight and the acceleration limit asked for, in copies of its files."""
    variants = experiment.variants
    if asked.weight is not None:
        variants = tuple(reweighted(variant, asked.weight, folder) for variant in variants)
    if asked.acceleration is not None:
        variants = tuple(relimited(variant, asked.acceleration, folder) for variant in variants)
    return replace(experiment, variants=variants)


def reweighted(variant: Variant, weight: float, folder: Path) -> Variant:
    """The variant with `weight` for joint 10, per m²; four times that where its cell has the fourfold one."""
    text = (HERE / variant.cell).read_text(encoding="utf-8")
    if "\nweights" in text:
        new = text.replace(" 20, 1]", f" {4.0 * weight}, 1]")
    else:
        weights = [11, 10, 9, 8, 7, 6, 5, 4, 3, weight, 1]
        new = text.replace('model = "koch11"\n', f'model = "koch11"\nweights = {weights}\n')
    (folder / variant.cell).write_text(new, encoding="utf-8")
    return replace(variant, cell=str(folder / variant.cell))


def relimited(variant: Variant, acceleration: float, folder: Path) -> Variant:
    """The variant with `acceleration` for 350 deg/s²; one without acceleration limits as it is."""
    if variant.acceleration is None:
        return variant
    text = (HERE / variant.program).read_text(encoding="utf-8")
    (folder / variant.program).write_text(re.sub(r"\b350\b", f"{acceleration:g}", text), encoding="utf-8")
    ranges = ((-acceleration, acceleration),) * 9
    ranges = (*ranges, variant.acceleration[9], (-acceleration, acceleration))
    return replace(variant, program=str(folder / variant.program), acceleration=ranges)


def runs_of(experiment: Experiment, tick: float) -> list[irlx.Run]:
    """Runs of the variants of an experiment at a tick, ms."""
    return [run_of(variant.program, variant.cell, tick) for variant in experiment.variants]


@cache
def run_of(program: str, cell: str, tick: float) -> irlx.Run:
    """The run of a program, which several experiments may look at: it is made once."""
    return irlx.run(HERE / program, cell=HERE / cell, tick_ms=tick)


def print_facts(name: str, experiment: Experiment, ticks: list[float], columns: list[Facts]) -> None:
    """The facts, one line each, a column for each tick."""
    print(f"{name}  {experiment.title}")
    heads = [f"{tick:g} ms" for tick in ticks]
    told = max(len(label) for label in columns[0])
    widths = [max(len(head), *map(len, facts.values())) for head, facts in zip(heads, columns, strict=True)]
    lines = [("", heads), *((label, [facts[label] for facts in columns]) for label in columns[0])]
    for label, cells in lines:
        line = "   ".join(f"{cell:<{width}}" for cell, width in zip(cells, widths, strict=True))
        print(f"  {label:<{told}}   {line}".rstrip())
    print()


if __name__ == "__main__":
    sys.exit(main())
