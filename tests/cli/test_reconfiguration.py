"""RECONFIGURATION from program text to a verified file, on the 11-joint robot."""

from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.blocks import MoveBlock, ReconfigureBlock
from irlx.cli.main import main
from irlx.streams import read_stream

PROGRAMS = Path(__file__).parents[2] / "programs" / "koch"


@pytest.mark.req("LANG-65")
@pytest.mark.req("LANG-69")
@pytest.mark.parametrize("tick", ["50", "7"])
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
