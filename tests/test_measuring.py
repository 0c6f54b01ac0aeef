"""The measuring program: points come from a table, readings go to a log that agrees with the stream."""

import shutil
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.blocks import InputBlock

FOLDER = Path(__file__).parents[1] / "programs" / "measuring"


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A copy of the folder, in which the program has run, and that run."""
    folder = tmp_path_factory.mktemp("measuring") / "measuring"
    shutil.copytree(FOLDER, folder, ignore=shutil.ignore_patterns("readings.txt", "*.irdata"))
    return folder, irlx.run(folder / "measuring.irl")


def test_nothing_to_find():
    assert irlx.check(FOLDER / "measuring.irl") == []


@pytest.mark.req("LANG-42")
def test_the_log_is_what_the_robot_did(place):
    folder, run = place
    header, *lines = (folder / "readings.txt").read_text().splitlines()
    assert header.split() == ["point", "x", "y", "z", "gauge", "freedom"]
    table = np.array([line.split() for line in lines], dtype=float)
    points = np.loadtxt(folder / "points.csv", delimiter=",")
    np.testing.assert_allclose(table[:, 1:4], points, rtol=0.0, atol=0.005)
    readings = [record for record in run.stream.records if isinstance(record.block, InputBlock)]
    np.testing.assert_allclose(table[:, 4], [r.block.value for r in readings], rtol=0.0, atol=5e-4)
    # The tool stands there, in the world, when the gauge is read.
    stood = 1000.0 * run.tool[[record.tick for record in readings], :3]
    np.testing.assert_allclose(stood, points, rtol=0.0, atol=1e-3)
    assert run.output == f"4 points, largest reading {max(table[:, 4]):.3f}\n"


def test_the_verifier_agrees(place):
    folder, run = place
    assert irlx.verify(run, program=folder / "measuring.irl", cell=folder / "measuring.toml").passed
