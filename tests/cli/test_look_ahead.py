"""What stands between moves: what is transparent changes nothing, all else happens on the target."""

from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.blocks import InputBlock, SignalBlock
from irlx.job import prepare
from irlx.pipeline import Execution

pytestmark = pytest.mark.req("LANG-54")

CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 20\n[signals.inputs]\ngo = [[0, false], [0.1, true]]\n'
DECLARATIONS = """VAR POSITION: store := (440, 260, 325), next := (440, 200, 325);
INPUT BOOL: go AT 1; OUTPUT BOOL: lamp AT 1; INT: n := 0; BOOL: seen; JOINT: here; REAL: x;
PROCEDURE count(VAR INT: m); BEGIN m := m + 1; ENDPROC;"""
TRANSPARENT = (
    "n := n + 1;",
    "count(n);",
    "IF n > 3 THEN n := 0; ELSE count(n); ENDIF;",
    "FOR n := 1 TO 5 DO CASE n OF WHEN 1, 3: count(n); DEFAULT: x := SQRT(n); ENDCASE; ENDFOR;",
    "GOTO on; n := 7; on:",
)
STOPPING = {
    "seen := go;": "InputBlock",
    "here := R_JOINT_ACT;": None,
    "x := MANIPULABILITY(R_JOINT_ACT);": None,
    "WAIT 0.1 SEC;": "WaitBlock",
    "PAUSE;": "PauseBlock",
    "CYCLICSTART; CYCLICEND;": "CyclicBlock",
    "FREEZESTART 3; FREEZEEND;": "FreezeBlock",
    "lamp := TRUE;": "SignalBlock",
}


@pytest.fixture
def ran(tmp_path: Path):
    """A run of two moves with statements between, verified."""
    return lambda between, **given: moved(tmp_path, between, **given)


@pytest.fixture(scope="module")
def plain(tmp_path_factory) -> irlx.Run:
    """The two moves with nothing between."""
    return moved(tmp_path_factory.mktemp("plain"), "")


def moved(folder: Path, between: str, **given) -> irlx.Run:
    (folder / "p.toml").write_text(CELL, encoding="utf-8")
    text = f"PROGRAM p; {DECLARATIONS}\nBEGIN\nMOVE LIN store;\n{between}\nMOVE LIN next;\nENDPROGRAM"
    (folder / "p.irl").write_text(text, encoding="utf-8")
    found = irlx.run(folder / "p.irl", **given)
    assert irlx.verify(found, folder / "p.irl").passed
    return found


@pytest.mark.parametrize("between", TRANSPARENT)
def test_what_is_transparent_leaves_no_trace(ran, plain, between):
    run = ran(between)
    np.testing.assert_array_equal(run.q, plain.q)
    assert [type(record.block).__name__ for record in run.stream.records] == ["MoveBlock", "MoveBlock"]


@pytest.mark.parametrize("between", STOPPING)
def test_all_else_happens_at_rest_on_the_target(ran, plain, between):
    run = ran(between)
    first, *others, last = run.stream.records
    end = int(np.flatnonzero(run.block == first.block.id)[-1])
    assert {record.tick for record in others} <= {end}
    assert STOPPING[between] in (None, *(type(record.block).__name__ for record in others))
    assert not run.qd[end].any()
    np.testing.assert_array_equal(run.q[: end + 1], plain.q[: end + 1])
    np.testing.assert_array_equal(run.q[last.tick :], plain.q[end:])


@pytest.mark.parametrize(("off", "seen"), [(-0.5, 1.0), (0.0, 1.0), (0.5, 0.0)])
def test_what_is_read_and_set_has_the_time_of_the_target(ran, off, seen):
    """Read is what the input says when the first move has ended; it changes `off` ticks from there."""
    end = ran("lamp := go;").stream.records[1].tick
    assert end > 3
    run = ran("lamp := go;", inputs={"go": [(0, 0), ((end + off) * 0.02, 1)]})
    read, signal = run.stream.records[1:3]
    assert (type(read.block), type(signal.block)) == (InputBlock, SignalBlock)
    assert (read.tick, signal.tick) == (end, end)
    assert (read.block.value, signal.block.value) == (seen, seen)


def test_the_program_is_pulled_and_not_run_through(tmp_path):
    """A fault behind a move is met once that move has been executed, and asked for what comes next."""
    (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
    text = f"PROGRAM p; {DECLARATIONS}\nBEGIN\nMOVE LIN store;\nn := 1 DIV n;\nMOVE LIN next;\nENDPROGRAM"
    (tmp_path / "p.irl").write_text(text, encoding="utf-8")
    source = iter(Execution(prepare(tmp_path / "p.irl")))
    assert len(next(source).rows) > 1
    with pytest.raises(irlx.IrlxError) as caught:
        next(source)
    assert (caught.value.reason.code, caught.value.reason.place.line) == ("IRL502", 6)
