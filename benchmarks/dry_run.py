"""Time of `irlx check --motion` against that of the run of the same program, both with all they do.

    python benchmarks/dry_run.py [--rounds N] [--ticks 1,4,10,50] [--only NAME] [--long] [--csv] [--profile]

A run is what `irlx run` does: the program is read, carried out, written (IRDATA, `--csv`: CSV) and what
was written is verified. A check is what `irlx check --motion` does: findings on the text, then the dry run.
Both in one process that is warm, in turns within a round; the table has medians of processor time in ms, and
the ratio.
"""

from __future__ import annotations

import argparse
import cProfile
import json
import pstats
import re
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import geometric_mean, median
from time import process_time

import numpy as np

import irlx

PROGRAMS = Path(__file__).parent.parent / "programs"
SEED = 7
MOVES = 50
LONG = ("square_slow", "ptp_poses")
ARM7 = '[robot]\nmodel = "arm7"\n'
WORK = np.array([441.0, 200.0, 324.0])
"""Where the tool of arm7 is about to work, mm."""


def main() -> None:
    """Measure all cases and print them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--ticks", default="1,4,10,50", help="ticks in ms")
    parser.add_argument("--only", help="programs whose name has this in it")
    parser.add_argument(
        "--long", action="store_true", help="also those that take minutes: " + ", ".join(LONG)
    )
    parser.add_argument("--csv", action="store_true", help="the run writes CSV instead of IRDATA")
    parser.add_argument("--profile", action="store_true", help="profile the checks instead")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of a table")
    asked = parser.parse_args()
    ticks = [float(tick) for tick in asked.ticks.split(",")]
    with tempfile.TemporaryDirectory() as folder:
        texts = [
            text
            for text in written(Path(folder))
            if (asked.only or "") in text.stem
            and (asked.long or asked.only == text.stem or text.stem not in LONG)
        ]
        if asked.profile:
            profile(texts, ticks)
            return
        ending = ".csv" if asked.csv else ".irdata"
        rows = {}
        if not asked.json:
            print(f"{'program, tick':28}{'motion':>9}{'whole run':>11}{'check':>9}{'ratio':>7}")
        for text in texts:
            for tick in ticks:
                name = f"{text.stem}, {tick:g} ms"
                rows[name] = motion, whole, check = measured(text, tick, ending, asked.rounds)
                if not asked.json:
                    print(
                        f"{name:28}{motion:>9.1f}{whole:>11.1f}{check:>9.1f}{whole / check:>7.1f}", flush=True
                    )
    if asked.json:
        print(json.dumps({"unit": "ms", "rounds": asked.rounds, "cases": rows}, indent=2))
        return
    for tick in ticks:
        ratios = [row[1] / row[2] for name, row in rows.items() if name.endswith(f" {tick:g} ms")]
        print(f"{tick:g} ms: least {min(ratios):.1f}, geometric mean {geometric_mean(ratios):.1f}")


def measured(program: Path, tick: float, ending: str, rounds: int) -> tuple[float, float, float]:
    """Medians in ms: the run without writing, all of it, and the check."""
    with_tick(program, tick)
    out = program.with_suffix(ending)
    found = []
    for _ in range(rounds + 1):
        begin = process_time()
        run = irlx.run(program)
        moved = process_time()
        run.save(out)
        if not irlx.verify(out, program, program.with_suffix(".toml")).passed:
            raise SystemExit(f"{program.stem}: the stream is not verified")
        end = process_time()
        irlx.check(program, motion=True)
        found.append((moved - begin, end - begin, process_time() - end))
    # The first round warms up.
    return tuple(1e3 * median(times) for times in zip(*found[1:], strict=True))  # type: ignore[return-value]


def profile(programs: list[Path], ticks: list[float]) -> None:
    """Where the checks spend their time."""
    profiler = cProfile.Profile()
    for program in programs:
        for tick in ticks:
            with_tick(program, tick)
            irlx.check(program, motion=True)
            profiler.enable()
            irlx.check(program, motion=True)
            profiler.disable()
    stats = pstats.Stats(profiler)
    stats.sort_stats("cumulative").print_stats(70)
    stats.sort_stats("tottime").print_stats(45)


def with_tick(program: Path, tick: float) -> None:
    """Give the cell of a program a tick, ms."""
    path = program.with_suffix(".toml")
    text = re.sub(r"(?m)^tick_ms.*$\n", "", path.read_text())
    if "[motion]" not in text:
        text += "\n[motion]\n"
    path.write_text(text.replace("[motion]\n", f"[motion]\ntick_ms = {tick:g}\n"))


def written(folder: Path) -> Iterator[Path]:
    """Programs to measure in a folder, each with a cell of its own beside it."""
    for source in sorted((PROGRAMS / "koch").glob("*.irl")):
        yield copied(source, folder / "koch")
    yield copied(PROGRAMS / "combined" / "combined.irl", folder / "combined")
    for name, body in drawn().items():
        path = folder / f"{name}.irl"
        path.with_suffix(".toml").write_text(ARM7)
        path.write_text(f"PROGRAM {name};\nBEGIN\n{body}\nENDPROGRAM;\n")
        yield path


def copied(program: Path, folder: Path) -> Path:
    """A program in a folder, with a cell of its own and its data lists beside it."""
    folder.mkdir(exist_ok=True)
    for beside in program.parent.glob("*.dat"):
        shutil.copy(beside, folder)
    text = program.read_text()
    named = re.search(r"SYSTEM SPECIFICATION (\w+);", text)
    cell = program.with_suffix(".toml") if named is None else program.with_name(f"{named[1]}.toml")
    shutil.copy(cell, folder / f"{program.stem}.toml")
    there = folder / program.name
    # The cell that a program names would come first.
    there.write_text(text if named is None else text.replace(named[0], "", 1))
    return there


def drawn() -> dict[str, str]:
    """Bodies of programs for arm7, of `MOVES` moves between drawn points each."""
    rng = np.random.default_rng(SEED)
    points = [WORK + rng.uniform(-60.0, 60.0, 3) for _ in range(MOVES)]
    texts = ["({:.3f}, {:.3f}, {:.3f})".format(*point) for point in points]
    near = ["({:.3f}, {:.3f}, {:.3f})".format(*(WORK + 0.2 * (point - WORK))) for point in points]
    start = np.array([40.0, 29.0, -13.0, 95.0, 9.0, 48.0, -13.0])
    joints = [start + rng.uniform(-15.0, 15.0, 7) for _ in range(MOVES)]
    return {
        "lines": "\n".join(f"MOVE LIN {text};" for text in texts),
        "short": "\n".join(f"MOVE LIN {text};" for text in near),
        "blended": "\n".join(f"MOVE LIN {text} C_CP := 20;" for text in texts),
        "ptp_joints": "\n".join(
            f"MOVE PTP MAIN_JOINT({', '.join(f'{angle:.3f}' for angle in joint)});" for joint in joints
        ),
        "ptp_poses": "\n".join(f"MOVE PTP {text};" for text in texts[: MOVES // 2]),
        "slowed": "\n".join(f"MOVE LIN {text} SPEED := 1500 ACC := 9000;" for text in texts),
    }


if __name__ == "__main__":
    main()
