"""RECONFIGURATION from program text to a verified file, on the 11-joint robot."""

import hashlib
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.blocks import MoveBlock, ReconfigureBlock
from irlx.cli.main import main
from irlx.streams import read_stream
from long_run import first

PROGRAMS = Path(__file__).parents[2] / "programs" / "koch"


@pytest.mark.req("LANG-65")
@pytest.mark.req("LANG-69")
@pytest.mark.parametrize("tick", first(1, ["50", "17"]))
def test_the_sample_program(tmp_path, capsys, tick):
    out = tmp_path / "a.irdata"
    arguments = ["run", str(PROGRAMS / "reconfiguration.irl"), "-o", str(out), "--tick", tick]
    assert main(arguments) == 0
    assert main(["verify", str(out), "--cell", str(PROGRAMS / "square.toml")]) == 0
    told = capsys.readouterr()
    assert "IRL349" not in told.err
    stream = read_stream(out)
    motions = [r.block for r in stream.records if isinstance(r.block, MoveBlock | ReconfigureBlock)]
    assert sum(isinstance(block, ReconfigureBlock) for block in motions) == 1
    last = {block.id: stream.q[np.flatnonzero(stream.block == block.id)[-1]] for block in motions}
    drifted, folded, end = last[5], last[6], last[8]
    # The start posture of the cell misses the pose p1 by 2e-9 m: the nearest posture on p1 is not quite it.
    assert np.max(np.abs(folded - stream.q[0])) <= 1e-9
    assert np.max(np.abs(drifted - stream.q[0])) > 0.5
    assert np.max(np.abs(end - drifted)) <= 1e-6


@pytest.mark.req("LANG-65")
def test_a_posture_off_the_pose_warns_with_its_place(folder):
    text = """PROGRAM p;
VAR MAIN_JOINT: folded;
BEGIN
  folded := R_JOINT_ACT.M_JOINT;
  folded.A11 := 0;
  FREEZESTART 2;
  RECONFIGURATION folded;
  FREEZEEND;
ENDPROGRAM
"""
    (folder / "p.irl").write_text(text, encoding="utf-8")
    run = irlx.run(folder / "p.irl")
    warnings = [d for d in run.diagnostics if d.code == "IRL349"]
    assert [d.place.line_and_column for d in warnings] == [(7, 3)]
    assert "joint_11" in warnings[0].message
    assert irlx.verify(run).passed
    assert np.all(run.q[:, 1] == run.q[0, 1])
    assert np.max(np.abs(run.tool[:, :3] - run.tool[0, :3])) < 1e-9
    weights = np.array(run.stream.header.weights)
    konf = run.q[0].copy()
    konf[10] = 0.0
    away = ((run.q - konf) ** 2 * weights).sum(axis=1)
    assert away[-1] < away[0]
    assert np.all(np.diff(away) <= 1e-9)


TICK = 40
"""Of the circles, ms."""
VIA = """PROGRAM p;
VAR POSITION: top := (11400, 1000, 3600), far := (11300, 1000, 3500);
MAIN_JOINT: raised, folded;
MAIN_JOINT_SPEED_MIN: slowest := (-20, -20, -20, -20, -20, -20, -20, -20, -20, -100, -20);
MAIN_JOINT_SPEED_MAX: fastest := (20, 20, 20, 20, 20, 20, 20, 20, 20, 100, 20);
BEGIN
  folded := R_JOINT_ACT.M_JOINT;
  MOVE LIN top;
  raised := R_JOINT_ACT.M_JOINT;
  raised.A8 := raised.A8 - 30;
  raised.A10 := raised.A10 - 200;
  RECONFIGURATION raised;
  raised := R_JOINT_ACT.M_JOINT;
  MOVE PTP folded;
  MOVE CIRCLE top, far {clause};
ENDPROGRAM
"""


@pytest.fixture
def circled(folder, inside):
    """Stream of a circle with clauses, run, written and verified with its program."""

    def run(clause):
        (folder / "p.irl").write_text(VIA.format(clause=clause), encoding="utf-8")
        done = inside("run", "p.irl", "--no-verify", "--tick", str(TICK))
        assert done.returncode == 0, done.stderr
        done = inside("verify", "p.irdata", "--program", "p.irl")
        assert done.returncode == 0, done.stdout
        return read_stream(folder / "p.irdata")

    return run


def arc_of(stream):
    """Block of the circle, and the rows from its start on."""
    record = next(r for r in stream.records if isinstance(r.block, MoveBlock) and r.block.course is not None)
    rows = slice(record.tick, None)
    return record.block, stream.q[rows], stream.tool[rows, :3]


@pytest.mark.req("LANG-62")
@pytest.mark.req("LANG-68")
@pytest.mark.parametrize("limits", first(1, [" WITH JOINTSPEEDLIMIT slowest, fastest", ""]))
def test_a_posture_for_the_via_point(circled, inside, limits):
    plain = arc_of(circled(f"WITH RECONFIGURATION folded{limits}"))
    led = arc_of(circled(f"WITH RECONFIGURATION raised, folded{limits}"))
    assert " WITH RECONFIGURATION via (" in inside("blocks", "p.irl").stdout.splitlines()[-1]
    raised = np.array(led[0].course.via_reconfiguration.values)
    assert plain[0].course.via_reconfiguration is None

    def away(arc):
        """Largest difference of a joint from the posture for the via point, at the row next to that point."""
        row = int(np.argmin(np.linalg.norm(arc[2] - [11.4, 1.0, 3.6], axis=1)))
        return float(np.max(np.abs(arc[1][row] - raised)))

    assert away(plain) > 0.1
    assert away(led) < 0.1 * away(plain)
    # The posture of the end is the same, as far as it is one of the pose there.
    assert np.max(np.abs(led[1][-1] - plain[1][-1])) < 1e-6
    if limits:
        fastest = np.where(np.arange(11) == 9, 0.1, np.radians(20.0))
        for _, q, _ in (plain, led):
            assert np.max(np.abs(np.diff(q, axis=0)) / (1e-3 * TICK) / fastest) <= 1.0 + 1e-6
        assert len(led[1]) > len(plain[1])


@pytest.mark.req("STR-03")
def test_streams_that_know_no_posture_for_via_points_read_as_before(circled, folder):
    stream = circled("WITH RECONFIGURATION folded")
    text = (folder / "p.irdata").read_text(encoding="utf-8")
    assert text.count(", course.via_reconfiguration=none") == 1
    text = text.replace(", course.via_reconfiguration=none", "")
    body, end = text[: text.rindex("\n", 0, -1) + 1], text[text.rindex("\n", 0, -1) + 1 :]
    digest = hashlib.sha256(body.encode()).hexdigest()
    end = f'{end[: end.index("sha256=")]}sha256="{digest}" ;\n'
    (folder / "old.irdata").write_text(body + end, encoding="utf-8")
    assert read_stream(folder / "old.irdata").records == stream.records
