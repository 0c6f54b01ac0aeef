"""The program of the tutorial: what it computes, when it waits and grips, and what it leaves behind."""

import shutil
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.blocks import InputBlock, MoveBlock, SignalBlock, WaitBlock

FOLDER = Path(__file__).parents[1] / "programs" / "sorting"


@pytest.fixture(scope="module")
def run():
    return irlx.run(FOLDER / "sorting.irl")


def of_kind(run, kind):
    return [record for record in run.stream.records if isinstance(record.block, kind)]


def test_nothing_to_find():
    for name in ("sorting.irl", "hovering.irl", "places.dat"):
        assert irlx.check(FOLDER / name) == []


def test_heights_come_sorted(run):
    heights = [record.block.target.position[2] for record in of_kind(run, MoveBlock)[1:]]
    np.testing.assert_allclose(heights, [0.52, 0.54, 0.56], rtol=0.0, atol=1e-12)


def test_the_gripper_closes_when_the_part_is_there(run):
    """The sensor says so after 2.5 s, when the arm has long stood; the tick is 10 ms."""
    read = [(record.tick, record.block.value) for record in of_kind(run, InputBlock)]
    assert read == [(101, 0.0), (250, 1.0), (250, 1.0)]
    closed, opened = of_kind(run, SignalBlock)
    assert (closed.tick, closed.block.value) == (250, 1.0)
    assert (opened.tick, opened.block.value) == (len(run.q) - 1, 0.0)
    waits = of_kind(run, WaitBlock)
    assert sum(record.block.duration for record in waits) == pytest.approx(1.49 + 0.2)
    still = run.q[waits[0].tick : waits[-1].tick + 20]
    assert np.array_equal(still, np.broadcast_to(still[0], still.shape))


def test_the_verifier_agrees(run):
    report = irlx.verify(run, program=FOLDER / "sorting.irl", cell=FOLDER / "sorting.toml")
    assert report.passed, str(report)


def test_visits_are_counted_in_the_data_list(tmp_path):
    folder = tmp_path / "sorting"
    shutil.copytree(FOLDER, folder)
    for visits in (1, 2):
        irlx.run(folder / "sorting.irl", write_data=True)
        assert f"INT: visits := {visits};" in (folder / "places.dat").read_text(encoding="utf-8")


def test_without_a_part_it_halts_after_the_time_limit():
    run = irlx.run(FOLDER / "sorting.irl", inputs={"present": [(0.0, 0.0)]})
    assert (run.summary.complete, run.summary.moves) == (True, 1)
    assert run.summary.duration == pytest.approx(1.01 + 5.0)
    assert of_kind(run, SignalBlock) == []
