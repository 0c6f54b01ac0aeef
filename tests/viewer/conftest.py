"""A program beside a ball, and what it comes to."""

import pytest

import irlx
from irlx.cell.load import load_cell
from irlx.viewer.shown import shown_run

CELL = """\
[robot]
model = "arm7"

[motion]
tick_ms = 40
speed = 150
acc = 600

[frames]
bench = { xyz = [300, 200, 0] }

[[obstacle]]
name = "ball"
shape = "sphere"
radius = 60
xyz = [0, -900, 500]
margin = 10

[[obstacle]]
name = "cart"
shape = "box"
size = [100, 100, 100]
trajectory = [{ time = 0, xyz = [2000, 0, 0] }, { time = 0.4, xyz = [2000, 400, 0] }]
"""
PROGRAM = """\
PROGRAM beside_a_ball;
{ Down past a ball, & <up>. }
BEGIN
  WRITELN('down & <up>');
  OBSTACLE ball;
  MOVE_INC LIN (0, 0, -60);
  MOVE_INC LIN (0, 0, 60);
  OBSTACLEEND ball;
ENDPROGRAM;
"""


@pytest.fixture(scope="package")
def folder(tmp_path_factory):
    """A folder with p.irl and p.toml."""
    found = tmp_path_factory.mktemp("view")
    (found / "p.irl").write_text(PROGRAM)
    (found / "p.toml").write_text(CELL)
    return found


@pytest.fixture(scope="package")
def run(folder):
    """The run of p.irl."""
    return irlx.run(folder / "p.irl")


@pytest.fixture(scope="package")
def shown(folder, run):
    """What a viewer shows of it."""
    program = irlx.load(folder / "p.irl")
    return shown_run(run, load_cell(folder / "p.toml"), program.source)
