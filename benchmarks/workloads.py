"""Fixed pieces of work whose instructions `instructions.py` counts: python benchmarks/workloads.py GROUP.

A piece is made ready, carried out once so that everything late is loaded, and carried out again between marks
that Valgrind understands. Nothing in it depends on the clock, and what is drawn is the same every time.
"""

from __future__ import annotations

import gc
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "support"))

from callgrind_marks import Marks

Work = Callable[[], object]
TICK = 0.001
CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 1\n'
PROGRAM = """PROGRAM short;
VAR POSITION: work := (441, 200, 324);
BEGIN
  MOVE LIN work + POSITION(0, 60, 20) SPEED := 250;
  MOVE CIRCLE work + POSITION(20, 40, 40), work;
  WAIT 0.1 SEC;
ENDPROGRAM;
"""
"""About 700 rows of arm7, whose tool stands at `work` in the beginning."""


def short_program(folder: Path) -> Path:
    """The short program in a folder, its cell beside it."""
    path = folder / "short.irl"
    path.with_suffix(".toml").write_text(CELL, encoding="utf-8")
    path.write_text(PROGRAM, encoding="utf-8")
    return path


def check(folder: Path) -> Work:
    """What `irlx check` does with 1,000 lines."""
    import irlx
    from long_programs import long_program

    path = folder / "long.irl"
    path.write_text(long_program(1000), encoding="utf-8")
    return lambda: irlx.check(path)


def ticks(_: Path, joints: int = 7, cyclic: bool = False) -> Work:
    """Lines there and back at 1 kHz, no joint at a bound: 2,152 ticks."""
    from chains import chain, there_and_back

    return partial(there_and_back, chain(joints), TICK, cyclic)


def slowed(_: Path) -> Work:
    """The same lines with joints that are too slow for them, planned as a whole."""
    from chains import chain, slow, there_and_back

    return partial(there_and_back, slow(chain(7), TICK), TICK)


def beside_obstacles(_: Path) -> Work:
    """Lines of arm7 there and back in ticks of 4 ms beside ten balls that it feels: 540 ticks."""
    from balls import felt
    from chains import arm7, there_and_back

    arm = arm7()
    balls = felt(arm, there_and_back(arm, TICK), 10)
    return partial(there_and_back, arm, 4.0 * TICK, obstacles=balls)


def writing(folder: Path, ending: str) -> Work:
    """The rows of the short program written to a file."""
    import irlx

    run = irlx.run(short_program(folder))
    return lambda: run.save(folder / f"short{ending}")


def reading(folder: Path, ending: str) -> Work:
    """That file read."""
    from irlx.streams import read_stream

    writing(folder, ending)()
    return lambda: read_stream(folder / f"short{ending}")


def verifying(folder: Path, ending: str) -> Work:
    """That file verified against its program and cell."""
    import irlx

    writing(folder, ending)()
    path, program = folder / f"short{ending}", folder / "short.irl"

    def work() -> None:
        if not irlx.verify(path, program, program.with_suffix(".toml")).passed:
            raise SystemExit("the stream is not verified")

    return work


def dry_run(folder: Path) -> Work:
    """What `irlx check --motion` does with the short program."""
    import irlx

    path = short_program(folder)
    return lambda: irlx.check(path, motion=True)


STREAMS = {
    f"{name} {ending}": partial(make, ending=ending)
    for ending in (".csv", ".irdata")
    for name, make in (("write", writing), ("read", reading), ("verify", verifying))
}
GROUPS: dict[str, dict[str, Callable[[Path], Work]]] = {
    "text": {"check 1,000 lines": check},
    "ticks": {
        "ticks": ticks,
        "ticks, 11 joints": partial(ticks, joints=11),
        "ticks, cyclic": partial(ticks, cyclic=True),
        "ticks, slowed": slowed,
        "ticks beside obstacles": beside_obstacles,
    },
    "streams": {**STREAMS, "check --motion": dry_run},
}
"""Pieces of work by the name of the count; those of a group share a process, whose start takes longest."""


def main() -> None:
    """Carry out the pieces of one group."""
    marks = Marks()
    with tempfile.TemporaryDirectory(prefix="irlx") as folder:
        for name, make in GROUPS[sys.argv[1]].items():
            work = make(Path(folder))
            work()
            # What is left over would be collected at some moment of the second time.
            gc.collect()
            with marks.counted(name):
                work()


if __name__ == "__main__":
    main()
