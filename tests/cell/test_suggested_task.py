"""The task that a robot with few axes gets where nobody has said one."""

from __future__ import annotations

import re

import pytest

from irlx.cell.packaged import packaged_urdf
from irlx.cell.suggested_task import SuggestedTask, suggested_task
from irlx.cli.main import main
from irlx.robot.urdf import read_urdf

pytestmark = pytest.mark.req("TRF-21")

THREE = """<robot name="three">
  <link name="base"/><link name="a"/><link name="b"/><link name="c"/><link name="tool"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
    <origin xyz="0 0 0.4"/><limit lower="-3" upper="3" velocity="2" effort="9"/></joint>
  <joint name="j2" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" velocity="2" effort="9"/></joint>
  <joint name="j3" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 1 0"/>
    <origin xyz="0.4 0 0"/><limit lower="-2.5" upper="2.5" velocity="2" effort="9"/></joint>
  <joint name="end" type="fixed"><parent link="c"/><child link="tool"/><origin xyz="0.35 0 0"/></joint>
</robot>
"""
SLIDE = re.sub(r'  <joint name="j[23]".*?</joint>\n', "", THREE, flags=re.DOTALL)
SLIDE = SLIDE.replace('<link name="b"/><link name="c"/>', "").replace('parent link="c"', 'parent link="a"')


def test_what_the_joints_move():
    robot = read_urdf(packaged_urdf("planar3"), "tool")
    assert suggested_task(robot) == SuggestedTask(("x", "y", "rz"))


def test_five_axes_leave_one_turn_to_the_others():
    robot = read_urdf(packaged_urdf("irb6"), "tool")
    assert suggested_task(robot) == SuggestedTask(("x", "y", "z", "rx", "ry"), "wrist")


def test_three_axes_ask_for_the_position():
    assert suggested_task(read_urdf(THREE)) == SuggestedTask(("x", "y", "z"), None, ("rx", "ry", "rz"))


def test_one_axis_has_none():
    assert suggested_task(read_urdf(SLIDE)) is None


@pytest.mark.parametrize("name", ["irb6", "three"])
def test_a_first_program_for_it_runs(tmp_path, monkeypatch, capsys, name):
    monkeypatch.chdir(tmp_path)
    text = THREE if name == "three" else packaged_urdf("irb6").replace('name="irb6"', 'name="mine"')
    (tmp_path / "mine.urdf").write_text(text, encoding="utf-8")
    assert main(["new", "mine", "--urdf", "mine.urdf"]) == 0
    cell = (tmp_path / "mine.toml").read_text(encoding="utf-8")
    assert ('task_frame = "wrist"' in cell) == (name == "irb6")
    assert ('free = ["rx", "ry", "rz"]' in cell) == (name == "three")
    assert "checks passed" in capsys.readouterr().out
    assert main(["run", "mine.irl", "--quiet"]) == 0
