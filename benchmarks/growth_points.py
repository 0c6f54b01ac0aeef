"""One point of the growth curves: python benchmarks/growth_points.py KIND SIZE; prints values as an object.

KIND is joints, lines, routines, seconds or obstacles; see `growth.py`.
"""

from __future__ import annotations

import json
import resource
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import process_time

import irlx
from balls import far, felt
from chains import Walked, arm7, chain, is_planned, slow, there_and_back
from growth_programs import of_lines, of_routines
from irlx.streams import BlockRecord, JointStream, RowBatch, open_writer, scan_stream

TICK = 0.001
CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = {tick}\n'
ENOUGH, MOST = 1.0, 5
"""Time, s, after which nothing is measured once more, and the most rounds."""
CYCLE = """PROGRAM cycle;
VAR POSITION: work := ({work});
BEGIN
  CYCLICSTART;
  MOVE LIN work + POSITION(0, 20, 10);
  MOVE CIRCLE work + POSITION(10, 10, 10), work;
  CYCLICEND;
{rest}ENDPROGRAM;
"""
"""Less than a second of arm7 that ends in the posture it begins with."""
SECOND = 1000
"""Rows of a second at 1 kHz."""


def seconds(work: Callable[[], object]) -> float:
    """Computing time of a piece of work, s, the least of some rounds."""
    found: list[float] = []
    while len(found) < MOST and sum(found) < ENOUGH:
        begin = process_time()
        work()
        found.append(process_time() - begin)
    return min(found)


def of_tick(walk: Callable[[], Walked], planned: bool) -> float:
    """Computing time of a tick, us, the least of some rounds."""
    walks = [walk()]
    if is_planned(walks[0]) is not planned:
        raise SystemExit("this is not the walk to be measured")
    while len(walks) < MOST and sum(walked.time for walked in walks) < 2.0 * ENOUGH:
        walks.append(walk())
    return min(walked.us_per_tick for walked in walks)


def memory() -> float:
    """The most memory that this process ever had, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def joints(count: int) -> dict[str, float]:
    """A tick of lines of an arm with so many joints: free, returning, and with joints that are too slow."""
    arm = chain(count)
    late = slow(arm, TICK)
    cases = {"least motion": (arm, False), "cyclic": (arm, True), "slowed": (late, False)}
    found = {}
    for name, (robot, cyclic) in cases.items():
        found[f"tick, {name}, us"] = of_tick(partial(there_and_back, robot, TICK, cyclic), name == "slowed")
    return found


def lines(count: int) -> dict[str, float]:
    """Programs of so many lines, of which many or none move: checked, tried, and run to a file."""
    found: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        path = warm(Path(folder), tick=10)
        before = memory()
        for name, moves in (("computing", False), ("moving", True)):
            path.write_text(of_lines(count, moves), encoding="utf-8")
            if any(one.is_error for one in irlx.check(path)):
                raise SystemExit("the program has errors")
            if not moves:
                found["check, s"] = seconds(lambda: irlx.check(path))
                found["check, memory, MB"] = memory() - before
            else:
                found["check --motion, s"] = seconds(lambda: irlx.check(path, motion=True))
            found[f"run, {name}, s"] = seconds(lambda: irlx.record(path, path.with_suffix(".irdata")))
        found["run, memory, MB"] = memory() - before
    return found


def routines(count: int) -> dict[str, float]:
    """A program with so many procedures, checked and run."""
    with tempfile.TemporaryDirectory() as folder:
        path = warm(Path(folder), tick=10)
        path.write_text(of_routines(count), encoding="utf-8")
        return {
            "check, s": seconds(lambda: irlx.check(path)),
            "run, s": seconds(lambda: irlx.record(path, path.with_suffix(".irdata"))),
        }


def cycle(rest: str) -> str:
    """The program from where the tool of arm7 stands, with further statements."""
    arm = arm7()
    work = 1e3 * arm.kinematics.tool_pose(arm.start)[1]
    return CYCLE.format(work=", ".join(str(float(c)) for c in work), rest=rest)


def warm(folder: Path, tick: int) -> Path:
    """A program with its cell, checked and run once so that all that comes late is loaded."""
    path = folder / "cycle.irl"
    path.with_suffix(".toml").write_text(CELL.format(tick=tick), encoding="utf-8")
    path.write_text(cycle(""), encoding="utf-8")
    irlx.check(path, motion=True)
    irlx.record(path, path.with_suffix(".irdata"))
    return path


def stream(count: int) -> dict[str, float]:
    """A stream of so many seconds at 1 kHz: written, read and verified."""
    found: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        path = warm(Path(folder), tick=1)
        cell, played = path.with_suffix(".toml"), one_second(path)
        before = memory()
        for ending in (".csv", ".irdata"):
            out = path.with_name(f"long{ending}")

            def read(out: Path = out) -> None:
                if sum(len(item.ticks) for item in scan_stream(out) if isinstance(item, RowBatch)) <= count:
                    raise SystemExit("rows are missing")

            def verify(out: Path = out) -> None:
                if not irlx.verify(out, cell=cell).passed:
                    raise SystemExit(f"{out.name}, {count} s: not verified")

            for what, work in (
                ("write", partial(write, out, played, count)),
                ("read", read),
                ("verify", verify),
            ):
                found[f"{what} {ending}, s"] = seconds(work)
        found["memory, MB"] = memory() - before
    return found


def one_second(path: Path) -> JointStream:
    """The stream of the program, with a WAIT at its end so that it takes a second."""
    rest = SECOND + 1 - len(irlx.run(path).stream.ticks)
    path.write_text(cycle(f"  WAIT {rest / SECOND:.3f} SEC;\n"), encoding="utf-8")
    stream = irlx.run(path).stream
    if len(stream.ticks) != SECOND + 1:
        raise SystemExit("the cycle does not take a second")
    return stream


def write(out: Path, played: JointStream, count: int) -> None:
    """Write a stream that goes through another one so many times, as a run would."""
    blocks = max(record.block.id for record in played.records)
    writer = open_writer(out, played.header)
    writer.samples(played.ticks[:1], played.q[:1], played.block[:1], played.tool[:1])
    # Rows go from where a block begins to where the next one does.
    ends = [*(record.tick + 1 for record in played.records[1:]), SECOND + 1]
    for number in range(count):
        done = 1
        for record, upto in zip(played.records, ends, strict=True):
            block = replace(record.block, id=record.block.id + number * blocks)
            writer.block(BlockRecord(record.tick + number * SECOND, block))
            part = slice(done, upto)
            if upto > done:
                later = played.ticks[part] + number * SECOND, played.block[part] + number * blocks
                writer.samples(later[0], played.q[part], later[1], played.tool[part])
            done = upto
    writer.close()


def obstacles(count: int) -> dict[str, float]:
    """A tick of lines of arm7 beside so many balls: far away, and felt."""
    arm = arm7()
    free = there_and_back(arm, TICK)
    found = {}
    for name, balls in (("far", far(count)), ("felt", felt(arm, free, count))):
        found[f"tick, {name}, us"] = of_tick(
            partial(there_and_back, arm, TICK, obstacles=balls), planned=False
        )
    return found


KINDS = {"joints": joints, "lines": lines, "routines": routines, "seconds": stream, "obstacles": obstacles}


if __name__ == "__main__":
    print(json.dumps(KINDS[sys.argv[1]](int(sys.argv[2]))))
