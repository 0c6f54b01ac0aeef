"""`irlx robots`: the table, one robot, the check of a URDF."""

import json
from importlib.resources import files

import pytest

from irlx.cell import overview
from irlx.cell.named import named_section, robot_names
from irlx.cell.overview import robot_overviews
from irlx.cell.packaged import packaged_names
from irlx.cell.robot_data import robot_data_folder

ROBOTS = files("irlx.cell") / "robots"
needs_robot_data = pytest.mark.skipif(robot_data_folder() is None, reason='pip install "irlx[robots]"')


def test_the_table_has_every_robot_with_what_it_is(inside):
    done = inside("robots")
    assert (done.returncode, done.stderr) == (0, "")
    head, *rows = done.stdout.splitlines()
    assert head.split() == ["robot", "axes", "task", "tip", "limits", "what", "it", "is"]
    assert [row.split()[0] for row in rows if row][: len(robot_names())] == list(robot_names())
    about = head.index("what")
    assert all(len(row[about:].split()) >= 2 for row in rows[: len(robot_names())])
    (planar,) = [row for row in rows if row.startswith("planar3 ")]
    assert "x y rz" in planar
    (platform,) = [row for row in rows if row.startswith("mobile8 ")]
    assert "2 slides, 6" in platform


def test_overviews_say_what_cells_of_these_names_have(inside):
    """Against the cell loader, which reads the same files in another way."""
    found = json.loads(inside("robots", "--json").stdout)
    assert [robot["name"] for robot in found] == list(robot_names())
    for robot in found:
        section = named_section(robot["name"])
        assert robot["axes"] == len(section.start)
        assert (robot["tip"], robot["packaged"]) == (section.tip, robot["name"] in packaged_names())
        assert robot["task"] == (section.task or ["x", "y", "z", "rx", "ry", "rz"])
        assert robot["slides"] is None or robot["slides"] <= robot["axes"]
        if robot["limits"] is not None:
            assert ("acceleration" in robot["limits"]) == isinstance(section.limits.acceleration, list)


def test_robots_of_the_extra_where_it_is_missing(inside, monkeypatch):
    monkeypatch.setattr(overview, "robot_data_folder", lambda: None)
    done = inside("robots")
    assert done.returncode == 0
    assert done.stdout.splitlines()[-1] == 'not installed: pip install "irlx[robots]"'
    (panda,) = [one for one in robot_overviews() if one.name == "panda"]
    assert (panda.installed, panda.axes, panda.slides, panda.limits) == (False, 7, None, None)
    assert all(one.installed for one in robot_overviews() if one.packaged)


def test_an_old_data_package_lacks_some(inside, monkeypatch, tmp_path):
    monkeypatch.setattr(overview, "robot_data_folder", lambda: tmp_path)
    assert inside("robots").returncode == 0
    assert not any(one.installed for one in robot_overviews() if not one.packaged)


def test_one_robot(inside):
    done = inside("robots", "rail6")
    assert done.returncode == 0
    lines = done.stdout.splitlines()
    assert lines[0] == "robot       rail6: 7 axes from 'rail' to the tip 'tool'"
    assert lines[1] == "task        x y z rx ry rz: 1 axis to spare"
    assert lines[4].split() == ["rail_joint", "prismatic", "mm", "150", "+-1000", "+-1500", "+-4000"]
    assert "-100 .. 130" in lines[6]


def test_one_robot_as_json(inside):
    found = json.loads(inside("robots", "koch11", "--json").stdout)
    assert len(found["joints"]) == 11
    slide = found["joints"][9]
    assert (slide["kind"], slide["unit"], slide["start"]) == ("prismatic", "mm", -462.314722)
    assert slide["position"] == [-700.0, 700.0]
    assert slide["speed"] == [None, None]


def test_a_robot_by_its_urdf(inside, folder):
    (folder / "arm.urdf").write_text((ROBOTS / "planar4.urdf").read_text())
    done = inside("robots", "arm.urdf")
    assert "task        x y rz: 1 axis to spare" in done.stdout
    assert done.stdout.splitlines()[-1].split()[3] == "-"
    shorter = inside("robots", "arm.urdf", "--tip", "link_3")
    assert "no axis to spare" in shorter.stdout


@pytest.mark.parametrize(
    ("arguments", "code", "told"),
    [
        (["robots", "arm77"], 2, "did you mean 'arm7'"),
        (["robots", "none.urdf"], 2, "IRL611"),
        (["robots", "nope"], 2, "error IRL611: no robot 'nope'\n  help: irlx robots lists all names;"),
        (["robots", "--check", "none.urdf"], 2, "IRL001"),
        (["robots", "arm7", "--tip", "tol"], 2, "did you mean 'tool'"),
    ],
)
def test_what_is_not_there(inside, arguments, code, told):
    done = inside(*arguments)
    assert (done.returncode, done.stdout) == (code, "")
    assert told in done.stderr


@pytest.mark.parametrize("arguments", [["robots", "arm7", "--check", "a.urdf"], ["robots", "--tip", "tool"]])
def test_usage(inside, arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        inside(*arguments)
    assert caught.value.code == 2
    assert "usage:" in capsys.readouterr().err


def test_check_of_a_sound_robot(inside, folder):
    (folder / "arm.urdf").write_text((ROBOTS / "arm7.urdf").read_text())
    done = inside("robots", "--check", "arm.urdf")
    assert done.returncode == 0
    assert done.stdout == "arm.urdf: 0 errors, 0 warnings, 1 note\n"
    assert "info IRL653" in done.stderr


def test_check_of_one_that_cannot_be_used(inside, folder):
    (folder / "arm.urdf").write_text((ROBOTS / "arm7.urdf").read_text().replace("joint_2", "joint_1", 1))
    done = inside("robots", "--check", "arm.urdf")
    assert done.returncode == 1
    assert "error IRL612" in done.stderr.splitlines()[0]
    assert done.stdout.startswith("arm.urdf: 1 error, ")
    found = json.loads(inside("robots", "--check", "arm.urdf", "--json").stdout)
    assert (found[0]["code"], found[0]["severity"]) == ("IRL612", "error")


def test_findings_alike_are_counted(inside, folder):
    (folder / "arm.urdf").write_text((ROBOTS / "koch11.urdf").read_text())
    done = inside("robots", "--check", "arm.urdf", "--tip", "tcp")
    assert done.returncode == 0
    assert done.stderr.count("warning IRL659") == 3
    assert "8 more with IRL659; --json has all of them" in done.stderr
    assert done.stdout == "arm.urdf: 0 errors, 11 warnings, 1 note\n"
    found = json.loads(inside("robots", "--check", "arm.urdf", "--json").stdout)
    assert sum(one["code"] == "IRL659" for one in found) == 11


@needs_robot_data
def test_one_robot_of_the_extra(inside):
    done = inside("robots", "kinova")
    assert "continuous" in done.stdout
    assert done.stdout.splitlines()[4].split()[4] == "-"
