"""What the page shows of a run, without the page."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from irlx.diagnostics import SourceText
from irlx.report.events import Slowed
from irlx.solids.placement import Placement
from irlx.viewer.curves import curves
from irlx.viewer.joint_html import joint_html
from irlx.viewer.obstacle_nodes import ObstacleNodes
from irlx.viewer.program_html import ProgramHtml
from irlx.viewer.shown import shown_stream
from irlx.viewer.trail import trail


def test_the_line_of_each_row_is_that_of_its_move(shown):
    lines = {shown.line_at(row).number for row in range(len(shown.stream.q))}
    assert lines == {0, 6, 7}
    for row in range(1, len(shown.stream.q)):
        block = shown.stream.block[row]
        record = next(one for one in shown.stream.records if one.block.id == block)
        assert shown.line_at(row).number == record.block.origin.line
    assert shown.line_at(0).number == 0


def test_rows_by_time(shown):
    assert [shown.row_at(time) for time in (-1.0, 0.0, 0.061, 1e9)] == [0, 0, 2, len(shown.stream.q) - 1]


def test_a_stream_file_tells_less(shown):
    found = shown_stream(shown.stream, "p.npz", shown.cell, None)
    assert found.summary[0].plain == f"p.npz: complete, {shown.duration:.6g} s"
    assert not found.slow_rows.any()
    assert found.switches_obstacles


def slowed(shown, first, last):
    numbers = dict.fromkeys(("first_time", "last_time", "way", "length", "requested", "achieved"), 0.0)
    event = Slowed(
        line=6,
        first_line=6,
        last_line=6,
        first_tick=first,
        last_tick=last,
        turns=False,
        joint="",
        kind="",
        bound=0.0,
        lost=0.0,
        **numbers,
    )
    return replace(shown, slowed=(event,))


def test_the_way_of_the_tool_and_where_it_was_slow(shown):
    corners, slow = trail(slowed(shown, 3, 5))
    assert np.array_equal(corners[0], shown.stream.tool[0, :3])
    assert np.array_equal(corners[-1], shown.stream.tool[-1, :3])
    assert np.flatnonzero(slow).tolist() == [3, 4, 5]
    assert not trail(shown)[1].any()


def test_no_slow_row_of_a_long_stream_is_lost(shown):
    rows = 20_001
    stream = shown.stream
    tool = np.zeros((rows, 7))
    tool[:, 0], tool[:, 6] = np.arange(rows), 1.0
    long = replace(
        stream,
        ticks=np.arange(rows),
        q=np.zeros((rows, 7)),
        block=np.zeros(rows, dtype=np.int64),
        tool=tool,
    )
    corners, slow = trail(slowed(replace(shown, stream=long), 777, 777))
    assert len(corners) <= 6001
    assert corners[-1, 0] == rows - 1
    reached = corners[slow, 0]
    assert len(reached) == 1
    assert 777 <= reached[0] < 777 + 4


def test_curves_keep_their_peaks(shown):
    rows = 5000
    q = np.zeros((rows, 7))
    q[3210, 2] = -1.5
    stream = replace(
        shown.stream,
        ticks=np.arange(rows),
        q=q,
        block=np.zeros(rows, dtype=np.int64),
        tool=np.tile(shown.stream.tool[:1], (rows, 1)),
    )
    angles, speeds, tool = curves(replace(shown, stream=stream))
    assert (angles.title, speeds.title, tool.title) == ("Joints, deg", "Joints, deg/s", "Tool, mm/s")
    assert len(angles.data[0]) <= 700
    assert angles.data[3].min() == pytest.approx(np.degrees(-1.5))
    assert angles.data[0][-1] == stream.t[-1]
    assert len(angles.series) == len(angles.data) == 8
    assert not tool.data[1].any()


def test_the_program_is_escaped_and_its_line_lit():
    text = SourceText("p.irl", "PROGRAM p;\n{ a < b\n  & c }\nBEGIN\n  WRITELN('<b>');\nENDPROGRAM;\n")
    html = ProgramHtml(text).lit(5)
    assert "<b>" not in html
    assert "&#x27;&lt;b&gt;&#x27;" in html
    lit = [part for part in html.split("<div") if "data-lit" in part]
    assert len(lit) == 1
    assert "WRITELN" in lit[0]
    assert html.count("<div") == html.count("</div>") == 7
    assert html.count("<span") == html.count("</span>")
    assert "data-lit" not in ProgramHtml(text).lit(0)


def test_of_a_long_program_the_part_around_the_line_is_shown():
    lines = "".join(f"  x{number} := 1;\n" for number in range(3, 400))
    html = ProgramHtml(SourceText("p.irl", f"PROGRAM p;\nBEGIN\n{lines}ENDPROGRAM;\n"))
    for line, first, last in ((1, 1, 33), (200, 184, 216), (400, 368, 400)):
        found = html.lit(line)
        assert found.count("<div") == 34
        assert f">{first:>4}  <" in found
        assert f">{last:>4}  <" in found


def test_joints_stand_between_their_limits(shown):
    upper = shown.cell.limits.position_upper
    q = shown.stream.q.copy()
    q[1, 0] = upper[0]
    html = joint_html(replace(shown, stream=replace(shown.stream, q=q)), 1)
    rows = html.split("<tr")[2:]
    assert len(rows) == 7
    assert f"{np.degrees(upper[0]):.1f} °" in rows[0]
    assert "left:calc(100.0% - 4px)" in rows[0]
    # On a limit the mark has another colour.
    assert "#e03131" in rows[0]
    assert "#e03131" not in rows[1]
    assert "-0.0" not in html


class Node(SimpleNamespace):
    """A node as far as obstacles use it."""

    def on_update(self, follow):
        self.follow = follow

    def remove(self):
        self.removed = True


class Scene:
    """A scene as far as obstacles use it: a dictionary of nodes."""

    def __init__(self):
        self.nodes = {}

    def _add(self, name, **given):
        self.nodes[name] = Node(**given)
        return self.nodes[name]

    add_frame = add_transform_controls = add_icosphere = add_box = _add


def drawn(name, *position):
    obstacle = SimpleNamespace(name=name, placement=Placement(position), trajectory=())
    return SimpleNamespace(obstacle=obstacle, parts=())


@pytest.fixture
def nodes():
    told = []
    scene = Scene()
    own = [drawn("left", 1.0, 0.0, 0.0), drawn("right", 3.0, 0.0, 0.0), drawn("cart", 0.0, 5.0, 0.0)]
    groups = {"both": ["left", "right"], "with_cart": ["left", "cart"], "none": []}
    found = ObstacleNodes(scene, own, ["left", "right"], groups, lambda: told.append(1))
    return found, scene, told


def test_obstacles_and_groups_that_stand_still_can_be_held(nodes):
    assert nodes[0].movable == ("left", "right", "both")


def test_the_handle_moves_an_obstacle(nodes):
    found, scene, told = nodes
    found.hold("left", 0.2)
    handle = scene.nodes["/handle"]
    assert tuple(handle.position) == (1.0, 0.0, 0.0)
    handle.position, handle.wxyz = (1.5, 0.25, 0.0), (1.0, 0.0, 0.0, 0.0)
    handle.follow(None)
    assert found.poses == {"left": Placement((1.5, 0.25, 0.0))}
    assert scene.nodes["/obstacles/0_left"].position == (1.5, 0.25, 0.0)
    assert told


def test_the_handle_of_a_group_turns_its_members_about_their_middle(nodes):
    found, scene, _ = nodes
    found.hold("both", 0.2)
    handle = scene.nodes["/handle"]
    assert tuple(handle.position) == (2.0, 0.0, 0.0)
    half = np.sqrt(0.5)
    handle.position, handle.wxyz = (2.0, 0.0, 1.0), (half, 0.0, 0.0, half)
    handle.follow(None)
    assert np.allclose(found.poses["left"].position, (2.0, -1.0, 1.0))
    assert np.allclose(found.poses["right"].position, (2.0, 1.0, 1.0))
    assert np.allclose(found.poses["right"].orientation, (0.0, 0.0, half, half))


def test_held_again_members_go_on_from_where_they_are(nodes):
    found, scene, _ = nodes
    found.place("left", Placement((0.0, 0.0, 2.0)))
    found.hold("both", 0.2)
    assert tuple(scene.nodes["/handle"].position) == (1.5, 0.0, 1.0)


def test_put_back(nodes):
    found, scene, _ = nodes
    found.hold("left", 0.2)
    first = scene.nodes["/handle"]
    first.scale = 0.2
    found.place("left", Placement((0.0, 0.0, 2.0)))
    assert first.removed
    scene.nodes["/handle"].scale = 0.2
    found.put_back()
    assert found.poses == {}
    assert scene.nodes["/obstacles/0_left"].position == (1.0, 0.0, 0.0)
    assert tuple(scene.nodes["/handle"].position) == (1.0, 0.0, 0.0)
    found.hold("", 0.2)


@pytest.mark.parametrize("name", ["cart", "both", "nobody"])
def test_only_obstacles_that_stand_still_are_placed(nodes, name):
    with pytest.raises(KeyError):
        nodes[0].place(name, Placement())
