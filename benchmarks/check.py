"""Speed of a check without a cell, on a program as long as asked for.

    python benchmarks/check.py [--lines N] [--rounds N]

Prints lines a second of parsing alone, of the analysis, and of the analysis with lints: the best of the
rounds, in time of the processor. The program mixes declarations, moves, expressions, control flow, calls
and redundancy options, and has no finding but lints.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from time import process_time

from irlx.language.analysis import analyse
from irlx.language.parser import parse
from irlx.language.source import source_text

HEAD = """PROGRAM stations;
VAR REAL: x := 1, y := 2, lift := 50; POSE: p; INT: count := 0, i; BOOL: done := FALSE;
  ARRAY [1..5] OF POSE: rack; ARRAY [1..10, 1..5] OF REAL: grid;
  MAIN_JOINT: folded := (1, 2, 3, 4, 5, 6, 7);
  MAIN_JOINT_SPEED_MIN: slowest := (-1, -1, -1, -1, -1, -1, -1);
  MAIN_JOINT_SPEED_MAX: fastest := (1, 1, 1, 1, 1, 1, 1);
PROCEDURE pick(IN POSE: at; REAL: height; VAR INT: n);
VAR POSE: up;
BEGIN
  up := at + POSITION(0, 0, height); MOVE LIN up; n := n + 1;
ENDPROC;
FUNCTION above(POSE: q; REAL: h): POSE;
BEGIN
  RETURN q + POSITION(0, 0, h);
ENDFCT;
BEGIN
"""
STATION = """  { station %(station)d }
  count := count + 1;
  x := y * 2 + %(station)d.5;
  p := ((600, %(station)d, 400.5), ORIZYX(0, 180, %(station)d MOD 90));
  rack[%(place)d] := p @ POSE(POSITION(0, 0, lift), ORIQUAT(1, 0, 0, 0));
  MOVE PTP p SPEED_PTP := 50;
  MOVE LIN rack[%(place)d], p + POSITION(0, 0, 50) SPEED := 200., ACC := 500;
  IF x > 3 AND y < 2 OR NOT done THEN
    pick(p, lift / 2, count);
  ELSE
    p := above(p, 50);
    p.pos.z := p.pos.z + SIN(x) * SQRT(ABS(y));
  ENDIF;
  FOR i := 1 TO 10 DO
    grid[i, %(place)d] := x / i + y - 1;
  ENDFOR;
  JOINTSPEEDLIMIT slowest, fastest;
  MOVE LIN p WITH RECONFIGURATION folded;
  JOINTSPEEDLIMITEND;
  WHILE NOT done DO x := x + 1.5; done := x >= 100; ENDWHILE;
  CASE count OF
    WHEN 1, 3..5: x := 1;
    WHEN 7: x := 2;
    DEFAULT: x := 3;
  ENDCASE;
"""


def program(lines: int) -> str:
    """A program of about that many lines."""
    stations = max((lines - HEAD.count("\n")) // STATION.count("\n"), 1)
    parts = [STATION % {"station": number, "place": number % 5 + 1} for number in range(stations)]
    return f"{HEAD}{''.join(parts)}ENDPROGRAM\n"


def seconds(work: Callable[[], object], rounds: int) -> float:
    """Least time of some work over the rounds."""
    times = []
    for _ in range(rounds):
        start = process_time()
        work()
        times.append(process_time() - start)
    return min(times)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--lines", type=int, default=10_000)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    source = source_text("stations.irl", program(options.lines))
    assert not [finding for finding in analyse(source, lints=True).diagnostics if finding.is_error]
    for name, work in (
        ("parsing", lambda: parse(source)),
        ("analysis", lambda: analyse(source)),
        ("with lints", lambda: analyse(source, lints=True)),
    ):
        took = seconds(work, options.rounds)
        print(f"{name:12}{source.line_count:8d} lines {took:8.3f} s {source.line_count / took:8.0f} lines/s")


if __name__ == "__main__":
    main()
