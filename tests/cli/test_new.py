"""`irlx new`: what it writes runs, passes the verifier, says what it should, and replaces nothing unasked."""

import re
import sys
from importlib.resources import files

import numpy as np
import pytest

import irlx
from irlx.cell.external import external_section
from irlx.cell.load import load_cell
from irlx.cell.robot_data import robot_data_folder
from long_run import first

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROBOTS = files("irlx.cell") / "robots"
needs_robot_data = pytest.mark.skipif(robot_data_folder() is None, reason='pip install "irlx[robots]"')


def judged(folder, name):
    """The run of a new program, all findings on the way to it looked at."""
    program, cell = folder / f"{name}.irl", folder / f"{name}.toml"
    assert irlx.check(program, cell) == []
    assert irlx.format_source(program.read_text()) == program.read_text()
    assert max(map(len, (program.read_text() + cell.read_text()).splitlines())) <= 200
    run = irlx.run(program)
    assert run.complete
    assert [one for one in run.diagnostics if one.severity.value != "info"] == []
    assert irlx.verify(run, program, cell).passed
    return run


ROBOTS_ALIKE = ("arm7", "koch11", "mobile8", "planar3", "planar4", "rail6")
"""Packaged robots with one tip, all of whose joints are driven."""

LONG = {"koch11", "arm7", "rail6", "mobile8", "planar4"}
"""Robots whose first programs take seconds to run twice."""


@pytest.mark.parametrize(
    "name", [pytest.param(one, marks=[pytest.mark.slow] * (one in LONG)) for one in ROBOTS_ALIKE]
)
def test_a_packaged_robot_by_its_urdf(inside, folder, name):
    """As anybody's URDF: nothing is known of it but the file."""
    (folder / "parts").mkdir()
    (folder / "parts" / "robot.urdf").write_text((ROBOTS / f"{name}.urdf").read_text())
    done = inside("new", "cells_first", "--urdf", "parts/robot.urdf")
    assert (done.returncode, done.stderr) == (0, "")
    written = [line.split()[1] for line in done.stdout.splitlines() if line.startswith("written")]
    assert written == ["cells_first.toml:", "cells_first.irl:"]
    assert [line.split()[0] for line in done.stdout.splitlines()] == ["written", "written", "next", "next"]
    table = tomllib.loads((folder / "cells_first.toml").read_text())
    assert table["robot"]["model"] == "parts/robot.urdf"
    run = judged(folder, "cells_first")
    cell = load_cell(folder / "cells_first.toml")
    spare = len(cell.robot.axes) > len(cell.robot.coordinates)
    assert ("CYCLICSTART" in (folder / "cells_first.irl").read_text()) == spare
    # The tool comes back to where the lines began, and the arm with it.
    begin = np.flatnonzero(run.block == run.block[1])[-1]
    np.testing.assert_allclose(run.tool[begin, :3], run.tool[-1, :3], atol=1e-6)
    np.testing.assert_allclose(run.q[begin], run.q[-1], atol=1e-5)
    assert np.ptp(run.tool[begin:, :3], axis=0).max() > 0.02


@pytest.mark.parametrize("name", ["planar3", pytest.param("arm7", marks=pytest.mark.slow)])
def test_a_robot_by_name(inside, folder, name):
    done = inside("new", "first", "--robot", name)
    assert (done.returncode, done.stderr) == (0, "")
    table = tomllib.loads((folder / "first.toml").read_text())
    assert table["robot"]["model"] == name
    # What the robot brings itself is not written again.
    assert set(table["robot"]) <= {"model", "tip", "limits", "task"}
    assert table["robot"]["limits"] == {}
    judged(folder, "first")


@needs_robot_data
@pytest.mark.parametrize("name", first(1, ["panda", "ur5"]))
def test_robots_of_the_extra_by_their_urdf(inside, folder, name):
    section = external_section(name)
    urdf = robot_data_folder() / section.model
    done = inside("new", "first", "--urdf", urdf, "--tip", section.tip)
    assert (done.returncode, done.stderr) == (0, "")
    assert "acceleration, per s2. A guess" in (folder / "first.toml").read_text()
    judged(folder, "first")


@needs_robot_data
@pytest.mark.slow
@pytest.mark.parametrize("name", [one.name[:-5] for one in (ROBOTS / "external").iterdir()])
def test_every_robot_of_the_extra_by_its_urdf_and_by_name(inside, folder, name):
    section = external_section(name)
    assert (
        inside("new", "u", "--urdf", robot_data_folder() / section.model, "--tip", section.tip).returncode
        == 0
    )
    judged(folder, "u")
    done = inside("new", "n", "--robot", name)
    assert (done.returncode, done.stderr) == (0, "")
    # With the meshes of some of them a verifier would look at self-collision for minutes.
    assert "checks passed, without self-collision for its meshes" in done.stdout
    assert "self_collision" not in (folder / "n.toml").read_text()


def test_limits_that_count_only_without_the_mark(inside, folder):
    """The hints are true: with the marks taken away the cell has the same limits."""
    (folder / "r.urdf").write_text((ROBOTS / "mobile8.urdf").read_text())
    inside("new", "first", "--urdf", "r.urdf")
    text = (folder / "first.toml").read_text()
    taken = re.sub(r"^# (position|speed|weights) = ", r"\1 = ", text, flags=re.MULTILINE)
    assert taken.count("\nposition = ") == taken.count("\nspeed = ") - 1 == 1
    weights = re.search(r"^weights = .*\n", taken, re.MULTILINE)[0]
    (folder / "second.toml").write_text(taken)
    plain, told = load_cell(folder / "first.toml"), load_cell(folder / "second.toml")
    assert weights
    np.testing.assert_array_equal(plain.weights, told.weights)
    for kind in ("position", "speed", "acceleration"):
        for one, other in zip(plain.limits.pair(kind), told.limits.pair(kind), strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-5)


def test_a_robot_without_any_limits(inside, folder):
    text = re.sub(r"<limit [^>]*/>", "", (ROBOTS / "planar3.urdf").read_text())
    (folder / "r.urdf").write_text(text)
    assert inside("new", "first", "--urdf", "r.urdf").returncode == 0
    table = tomllib.loads((folder / "first.toml").read_text())
    assert table["robot"]["limits"] == {"speed": [60] * 3, "acceleration": [240] * 3}
    judged(folder, "first")


def test_the_path_goes_from_the_cell_to_the_urdf(inside, folder):
    (folder / "cells").mkdir()
    (folder / "models").mkdir()
    (folder / "models" / "ärm 7.urdf").write_text((ROBOTS / "planar3.urdf").read_text())
    assert inside("new", "cells/first.irl", "--urdf", "models/ärm 7.urdf").returncode == 0
    table = tomllib.loads((folder / "cells" / "first.toml").read_text())
    assert table["robot"]["model"] == "../models/ärm 7.urdf"
    judged(folder / "cells", "first")


def test_a_urdf_without_an_ending_is_no_robot_by_name(inside, folder):
    (folder / "arm7").write_text((ROBOTS / "planar3.urdf").read_text())
    assert inside("new", "first", "--urdf", "arm7").returncode == 0
    assert tomllib.loads((folder / "first.toml").read_text())["robot"]["model"] == "./arm7"
    assert len(load_cell(folder / "first.toml").robot.axes) == 3


def test_files_that_are_there_stay(inside, folder, names):
    before = {name: (folder / name).read_bytes() for name in names(folder)}
    done = inside("new", "p", "--robot", "planar3")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("IRL669") == 2
    assert {name: (folder / name).read_bytes() for name in names(folder)} == before
    assert inside("new", "p", "--robot", "planar3", "--force").returncode == 0
    assert 'model = "planar3"' in (folder / "p.toml").read_text()


def two_ends(text):
    return text.replace(
        "</robot>",
        '<link name="lens"/><joint name="eye" type="fixed"><parent link="link_2"/>'
        '<child link="lens"/></joint></robot>',
    )


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["9lives", "--robot", "arm7"], "IRL006"),
        (["move", "--robot", "arm7"], "no keyword"),
        (["first", "--robot", "arm8"], "did you mean 'arm7'"),
        (["first", "--urdf", "none.urdf"], "IRL611"),
        (["first", "--urdf", "none"], "IRL611"),
        (["nowhere/first", "--robot", "planar3"], "IRL003"),
        (["first", "--urdf", "two.urdf"], "2 links at an end (tool, lens)"),
        (["first", "--urdf", "two.urdf", "--tip", "lens"], "IRL613"),
    ],
)
def test_what_cannot_be_done(inside, folder, names, arguments, told):
    (folder / "two.urdf").write_text(two_ends((ROBOTS / "planar3.urdf").read_text()))
    before = names(folder)
    done = inside("new", *arguments)
    assert told in done.stderr
    assert (done.returncode, done.stdout) == (2, "")
    assert names(folder) == before


def test_no_way_for_any_line(inside, folder):
    """Joints that may hardly move: the program goes to its posture, and says that more was not found."""
    text = re.sub(
        r'lower="[^"]*" upper="[^"]*"', 'lower="0" upper="1e-4"', (ROBOTS / "arm7.urdf").read_text()
    )
    (folder / "r.urdf").write_text(text)
    done = inside("new", "first", "--urdf", "r.urdf")
    assert done.returncode == 0
    assert "IRL664" in done.stderr
    program = (folder / "first.irl").read_text()
    assert "MOVE PTP" in program
    assert "LIN" not in program
    judged(folder, "first")


def slides(axes):
    """A chain of slides of 2 m along axes."""
    joints = "".join(
        f'<link name="l{k}"/><joint name="j{k}" type="prismatic">'
        f'<parent link="l{k - 1}"/><child link="l{k}"/>'
        f'<axis xyz="{axis}"/><limit lower="-1" upper="1" velocity="0.5" effort="9"/></joint>'
        for k, axis in enumerate(axes, 1)
    )
    return f'<robot name="slides"><link name="l0"/>{joints}</robot>'


@pytest.mark.parametrize(
    ("axes", "task", "lines"),
    [
        (["0 1 0", "0 0 1"], ["y", "z"], 4),
        (["1 0 0", "0.6 0.8 0", "0 0 1", "1 0 0"], ["x", "y", "z"], 4),
    ],
)
def test_slides(inside, folder, axes, task, lines):
    (folder / "r.urdf").write_text(slides(axes))
    done = inside("new", "first", "--urdf", "r.urdf")
    assert (done.returncode, done.stderr) == (0, "")
    assert tomllib.loads((folder / "first.toml").read_text())["robot"]["task"] == task
    assert (folder / "first.irl").read_text().count("MOVE LIN") == lines
    judged(folder, "first")


def test_joints_that_only_turn_the_tip(inside, folder):
    (folder / "r.urdf").write_text(slides(["0 0 1", "0 1 0", "1 0 0"]).replace("prismatic", "revolute"))
    done = inside("new", "first", "--urdf", "r.urdf")
    assert (done.returncode, done.stderr) == (0, "")
    assert "first.irl: 3 moves; tried" in done.stdout
    assert "MOVE LIN there;" in (folder / "first.irl").read_text()
    run = judged(folder, "first")
    # A turn on the spot, there and back.
    assert np.ptp(run.tool[:, :3], axis=0).max() < 1e-9
    assert np.ptp(run.tool[:, 3:], axis=0).max() > 0.05
