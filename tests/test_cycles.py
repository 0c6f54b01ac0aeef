"""Closed paths run five times: with CYCLICSTART the joints do the same each time, without it they drift."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.blocks import MoveBlock
from irlx.promises import CLOSURE
from long_run import first

pytestmark = pytest.mark.req("TRF-11")

PROGRAMS = Path(__file__).parents[1] / "programs"
SQUARE = """PROGRAM squares;
VAR POSE: p1 := ((11500, 1000, 3500), ORIQUAT(1, 0, 0, 0)), p2 := ((9500, 1000, 3500), ORIQUAT(1, 0, 0, 0)),
  p3 := ((9500, -1000, 3500), ORIVANG((0, 1, 0), -85)), p4 := ((9500, -1000, 3500), ORIVANG((0, 0, 1), 85)),
  p5 := ((11500, -1000, 3500), ORIQUAT(1, 0, 0, 0));
BEGIN
  MOVE LIN p1;
  {start}
  {squares}
  {end}
ENDPROGRAM
"""
MOVES = {"rounds": 1, "triangle": 3, "square": 5}
"""Moves of one cycle."""
DRIFT = {"rounds": 0.02, "triangle": 0.01, "square": 0.01}
"""What the posture drifts in one cycle without the option, at least, rad or m."""


@cache
def packaged(name: str, cyclic: bool) -> irlx.Run:
    return irlx.run(PROGRAMS / "cycles" / f"{name}{'' if cyclic else '_drift'}.irl")


@cache
def squares(cyclic: bool, folder: Path) -> irlx.Run:
    words = {"start": "CYCLICSTART;" if cyclic else "", "end": "CYCLICEND;" if cyclic else ""}
    words["squares"] = "  MOVE LIN p2, p3, p4, p5, p1;\n" * 5
    (folder / "squares.irl").write_text(SQUARE.format(**words), encoding="utf-8")
    return irlx.run(folder / "squares.irl", cell=PROGRAMS / "koch" / "square.toml", tick_ms=50)


@pytest.fixture(scope="module")
def cycles(tmp_path_factory):
    """Rows of the cycles of a run: the posture before each, and the (5, N, n) rows of all."""
    folder = tmp_path_factory.mktemp("squares")

    def rows(name: str, cyclic: bool) -> tuple[np.ndarray, np.ndarray]:
        run = squares(cyclic, folder) if name == "square" else packaged(name, cyclic)
        moves = [record.block.id for record in run.stream.records if isinstance(record.block, MoveBlock)][
            -5 * MOVES[name] :
        ]
        parts = [run.q[np.isin(run.block, moves[k * MOVES[name] : (k + 1) * MOVES[name]])] for k in range(5)]
        start = run.q[np.flatnonzero(run.block == moves[0])[0] - 1]
        return np.array([start, *(part[-1] for part in parts)]), np.array(parts)

    return rows


@pytest.mark.slow
@pytest.mark.parametrize("name", MOVES)
def test_five_cycles_are_one(cycles, name: str) -> None:
    ends, parts = cycles(name, True)
    assert np.max(np.abs(ends - ends[0])) <= CLOSURE
    assert np.max(np.abs(parts - parts[0])) <= CLOSURE
    assert np.max(np.ptp(parts[0], axis=0)) > 0.1


@pytest.mark.parametrize("name", first(2, MOVES))
def test_without_the_option_each_cycle_drifts_on(cycles, name: str) -> None:
    ends, _ = cycles(name, False)
    steps = np.max(np.abs(np.diff(ends, axis=0)), axis=1)
    print(f"{name}: drift of the five cycles {steps} rad or m")
    assert steps[0] > DRIFT[name]
    assert np.max(np.abs(ends[-1] - ends[0])) > DRIFT[name]


@pytest.mark.parametrize("name", first(1, ["rounds", "triangle"]))
def test_the_tool_returns_either_way(name: str) -> None:
    """So that the drift is one of the posture, not of the path."""
    for cyclic in (True, False):
        run = packaged(name, cyclic)
        begin = np.flatnonzero(run.block == run.stream.records[0].block.id)[-1]
        assert np.max(np.abs(run.tool[-1, :3] - run.tool[begin, :3])) <= 1e-9
