"""What a page says of a run, against independent truth."""

import base64
import gzip
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise

import numpy as np
import pinocchio as pin
import pytest

import irlx
from irlx.cell.load import load_cell
from irlx.cell.robot_data import robot_data_folder
from irlx.report.appearance.build import appearance_of
from irlx.report.replay.data import replay_json
from irlx.report.replay.of_run import replay_of
from irlx.report.replay.writing import notebook_html
from page_data import page_data, read_page

pytestmark = pytest.mark.req("REP-04")
needs_robot_data = pytest.mark.skipif(robot_data_folder() is None, reason="the data package is missing")

CELL = """[robot]
model = "arm7"
[robot.limits]
position = [170, 170, 170, 170, 170, 170, 170]
speed = [60, 60, 60, 60, 60, 60, 60]
acceleration = [300, 300, 300, 300, 300, 300, 300]
[robot.self_collision]
active = false
[motion]
tick_ms = 8
speed = 300
[frames]
desk = { xyz = [600, 0, 100], rpy = [0, 0, 90] }
[[obstacle]]
name = "post"
shape = "cylinder"
radius = 40
length = 900
xyz = [0, -500, 450]
margin = 20
influence = 2000
"""
TEXT = """PROGRAM p;
{ a comment with </script> and <b>tags</b> }
VAR OUTPUT BOOL: gripper AT 1;
  MAIN_JOINT_SPEED_MIN: slow := (-30., -30., -30., -30., -30., -30., -30.);
  MAIN_JOINT_SPEED_MAX: fast := (30., 30., 30., 30., 30., 30., 30.);
BEGIN
  WRITELN('we begin');
  OBSTACLE post;
  MOVE_INC LIN (0, 50, -30);
  gripper := TRUE;
  JOINTSPEEDLIMIT slow, fast;
  R_TOOL := POSE(POSITION(0, 20, 120), ORIXYZ(0, 20, 0));
  MOVE_INC LIN (0, -60, 0);
  JOINTSPEEDLIMITEND;
  WAIT 0.1 SEC;
  OBSTACLEEND post; WRITELN('we end');
  MOVE_INC LIN (30, 0, 20);
ENDPROGRAM;
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A run with something of everything, its page, and the page that was written while it ran."""
    folder = tmp_path_factory.mktemp("made")
    (folder / "p.toml").write_text(CELL, encoding="utf-8")
    (folder / "p.irl").write_text(TEXT, encoding="utf-8")
    run = irlx.run(folder / "p.irl")
    run.save(folder / "saved.html")
    outcome = irlx.record(folder / "p.irl", [folder / "p.irdata", folder / "recorded.html"])
    assert outcome.page == folder / "recorded.html"
    return folder, run, page_data(folder / "saved.html")


def test_a_page_saved_and_one_written_on_the_way_are_the_same(made):
    folder, _, data = made
    assert page_data(folder / "recorded.html") == data


def test_head(made):
    _, run, data = made
    assert data["format"] == "irlx page 1"
    assert data["complete"] is True
    assert data["program"]["text"] == TEXT
    assert {"MOVE", "LIN", "ENDPROGRAM"} <= set(data["program"]["keywords"])
    assert (data["tick_s"], data["ticks_per_frame"]) == (0.008, 3)
    assert data["joints"] == [{"name": name, "unit": "rad"} for name in run.joint_names]
    assert data["summary"]["plain"]["samples"] == len(run.t)
    assert data["summary"]["text"].startswith("p.irl: complete, ")


def test_frames_are_rows_of_the_run(made):
    _, run, data = made
    frames = data["frames"]
    ticks = np.array(frames["tick"])
    assert ticks.tolist() == sorted({*range(0, len(run.t), 3), len(run.t) - 1})
    np.testing.assert_allclose(np.array(frames["q"]).T, run.q[ticks], atol=5.1e-10, rtol=0)
    np.testing.assert_allclose(np.array(frames["tool"]).T, run.tool[ticks], atol=5.1e-10, rtol=0)
    lines = {block["id"]: block["line"] for block in data["blocks"]}
    assert frames["line"] == [lines.get(number, 0) for number in run.block[ticks].tolist()]
    assert {0, 9, 13, 15, 17} <= set(frames["line"])
    for line in set(frames["line"]) - {0}:
        assert TEXT.splitlines()[line - 1].split()[0] in {"MOVE_INC", "WAIT"}


def test_speeds_show_every_peak(made):
    _, run, data = made
    ticks, speed = data["frames"]["tick"], np.array(data["frames"]["speed"]).T
    way = np.linalg.norm(np.diff(run.tool[:, :3], axis=0, prepend=run.tool[:1, :3]), axis=1) / 0.008
    turns = [pin.Quaternion(row).toRotationMatrix() for row in run.tool[:, 3:]]
    turned = [
        0.0,
        *(np.linalg.norm(pin.log3(a.T @ b)) / 0.008 for a, b in pairwise(turns)),
    ]
    for frame, (first, last) in enumerate(zip([-1, *ticks], ticks, strict=False)):
        since = slice(first + 1, last + 1)
        qd = run.qd[since]
        truth = qd[np.argmax(np.abs(qd), axis=0), np.arange(7)]
        np.testing.assert_allclose(speed[frame], truth, atol=5.1e-7, rtol=0)
        assert data["frames"]["tool_speed"][frame] == pytest.approx(way[since].max(), abs=1e-6)
        assert data["frames"]["turn_speed"][frame] == pytest.approx(max(turned[since]), abs=1e-5)
    assert np.abs(speed).max() == pytest.approx(np.abs(run.qd).max(), abs=1e-6)


def drawn_pose(data, q, tick):
    """Pose of the tool by the links and joints of the page alone."""
    poses = []
    for link in data["robot"]["links"]:
        pose = pin.SE3.Identity()
        if link["parent"] >= 0:
            joint = link["joint"]
            value = joint["offset"] + (0.0 if joint["of"] is None else joint["multiplier"] * q[joint["of"]])
            axis = np.array(joint["axis"]) * value
            turn = pin.exp3(axis) if joint["kind"] == "revolute" else np.eye(3)
            slide = axis if joint["kind"] == "prismatic" else np.zeros(3)
            pose = poses[link["parent"]] * placed(joint) * pin.SE3(turn, slide)
        poses.append(pose)
    tool = [one for one in data["tools"] if one["tick"] <= tick][-1]
    return poses[data["robot"]["tip"]] * placed(tool)


def placed(plain):
    return pin.XYZQUATToSE3(np.array([*plain["xyz"], *plain["quat"]]))


def test_links_and_joints_lead_to_the_tool(made):
    _, _, data = made
    assert len(data["tools"]) == 2
    frames = data["frames"]
    for q, tool, tick in zip(
        np.array(frames["q"]).T, np.array(frames["tool"]).T, frames["tick"], strict=True
    ):
        error = pin.log6(drawn_pose(data, q, tick).actInv(pin.XYZQUATToSE3(tool))).vector
        assert np.abs(error).max() < 2e-8


def test_singular_values_are_those_of_finite_differences(made):
    folder, _, data = made
    reach = load_cell(folder / "p.toml").robot.reach
    frames, step = data["frames"], 1e-6
    for frame in range(0, len(frames["tick"]), 20):
        q, tick = np.array(frames["q"])[:, frame], frames["tick"][frame]
        here = drawn_pose(data, q, tick)
        columns = []
        for unit in np.eye(len(q)):
            ahead, behind = (drawn_pose(data, q + side * step * unit, tick) for side in (1, -1))
            apart = pin.log6(here.actInv(ahead)).vector - pin.log6(here.actInv(behind)).vector
            columns.append(apart / (2 * step))
        jacobian = np.array(columns).T
        jacobian[:3] /= reach
        truth = np.linalg.svd(jacobian, compute_uv=False)[-1]
        assert frames["singular"][frame] == pytest.approx(truth, abs=1e-7)


def test_clearance_is_the_nearest_on_the_way(made):
    _, run, data = made
    frames = data["frames"]
    near = np.array([np.inf if value is None else value for value in frames["clearance"]])
    for frame, (first, last) in enumerate(zip([-1, *frames["tick"]], frames["tick"], strict=False)):
        assert near[frame] == pytest.approx(run.clearances.distance[first + 1 : last + 1].min(), abs=1e-6)
    assert near.min() == pytest.approx(run.summary.clearance.distance, abs=1e-6)
    pair = data["pairs"][frames["nearest"][int(np.argmin(near))]]
    assert (pair["link"], pair["other"], pair["margin"]) == (run.summary.clearance.link, "post", 0.02)
    assert frames["nearest"][0] == -1
    assert frames["clearance"][0] is None


def test_watched_while_the_obstacle_is_on(made):
    _, run, data = made
    frames = data["frames"]
    end = data["blocks"][-2]["tick"]
    assert data["blocks"][-2]["text"].startswith("OBSTACLE")
    assert 0 < end < len(run.t) - 1
    before = [-1, *frames["tick"]]
    assert frames["watched"] == [last < end for last in before[:-1]]
    np.testing.assert_array_equal(run.clearances.watched[1:], np.arange(1, len(run.t)) <= end)


def test_limits_are_those_that_the_verifier_knows(made):
    _, run, data = made
    starts = [limits["tick"] for limits in data["limits"]]
    speeds = [limits["speed"][1][0] for limits in data["limits"]]
    assert np.degrees(speeds) == pytest.approx([60.0, 30.0, 60.0])
    moves = {block["id"]: block for block in data["blocks"] if block["text"].startswith("MOVE")}
    slow = sorted(moves)[1]
    rows = np.flatnonzero(run.block == slow)
    assert starts == [0, rows[0], rows[-1] + 1]
    assert data["limits"][0]["acceleration"][0] == pytest.approx([-np.radians(300.0)] * 7)
    assert irlx.verify(run).passed


def test_events(made):
    _, run, data = made
    events = data["events"]
    by_kind = {kind: [e for e in events if e["kind"] == kind] for kind in {e["kind"] for e in events}}
    assert [(e["label"], e["line"]) for e in by_kind["message"]] == [("we begin", 7), ("we end", 16)]
    assert [e["label"] for e in by_kind["signal"]] == ["OUT_1 = TRUE"]
    (wait,) = by_kind["wait"]
    assert (wait["label"], wait["line"]) == ("WAIT 0.1 s", 15)
    assert (wait["last"] - wait["first"]) * 0.008 == pytest.approx(0.1, abs=0.016)
    assert np.ptp(run.q[wait["first"] : wait["last"] + 1], axis=0).max() == 0.0
    assert len(by_kind.get("limit", ())) + len(by_kind.get("slowed", ())) == len(run.events)
    (nearest,) = by_kind["nearest"]
    assert abs(nearest["first"] - run.summary.clearance.tick) < 3
    assert "post" in nearest["text"]
    ticks = [event["first"] for event in events]
    assert ticks == sorted(ticks)
    assert all(0 <= event["first"] <= event["last"] < len(run.t) for event in events)


def test_places_and_obstacles(made):
    _, _, data = made
    (desk,) = data["places"]
    assert (desk["name"], desk["xyz"]) == ("desk", pytest.approx([0.6, 0.0, 0.1]))
    assert desk["quat"] == pytest.approx([0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)])
    (post,) = data["obstacles"]
    assert (post["name"], post["margin"], post["influence"]) == ("post", 0.02, 2.0)
    (shape,) = post["shapes"]
    assert (shape["kind"], shape["radius"], shape["length"]) == ("cylinder", 0.04, 0.9)


def test_a_notebook_gets_a_small_page(made):
    _, run, data = made
    html = notebook_html(run)
    assert html == run._repr_html_()
    assert len(html) < 500_000
    assert html == notebook_html(run)
    small = page_data(unpacked(read_frame(html)))
    assert small["small"] is True
    assert len(small["frames"]["tick"]) <= 300
    assert small["program"]["text"] == TEXT
    assert small["limits"] == data["limits"]
    assert '<th scope="row"' in html
    assert "path error" in html


def unpacked(html):
    """The page that a packed one unpacks, as its script does."""
    (letters,) = re.findall(r'atob\("([A-Za-z0-9+/=]+)"\)', html)
    return gzip.decompress(base64.b64decode(letters)).decode()


def read_frame(html):
    """What stands in the srcdoc of the one frame of a text."""
    found = []

    class Frame(HTMLParser):
        def handle_starttag(self, tag, attrs):
            if tag == "iframe":
                found.append(dict(attrs))

    Frame().feed(html)
    (frame,) = found
    assert frame["sandbox"] == "allow-scripts"
    return frame["srcdoc"]


def test_a_run_that_does_not_know_its_cell(made, tmp_path):
    _, run, _ = made
    bare = replace(run, source=None)
    with pytest.raises(irlx.StreamError, match="IRL722"):
        bare.save(tmp_path / "p.html")
    assert list(tmp_path.iterdir()) == []
    assert "<iframe" not in bare._repr_html_()


def a_minute(cell, tmp_path):
    """A run of 60 s with frames at the most a second, whose numbers have as many digits as numbers can."""
    (tmp_path / "p.toml").write_text(cell, encoding="utf-8")
    (tmp_path / "p.irl").write_text("PROGRAM p;\nBEGIN\n  WAIT 0.02 SEC;\nENDPROGRAM;\n", encoding="utf-8")
    run = irlx.run(tmp_path / "p.irl", tick_ms=20)
    rng, rows = np.random.default_rng(0), 3001
    q = run.q[:1] + np.cumsum(rng.uniform(-0.01, 0.01, (rows, run.q.shape[1])), axis=0)
    turns = rng.normal(size=(rows, 4))
    tool = np.hstack([rng.normal(size=(rows, 3)), turns / np.linalg.norm(turns, axis=1)[:, None]])
    stream = replace(run.stream, q=q, tool=tool, ticks=np.arange(rows), block=np.ones(rows, np.int64))
    return replace(run, stream=stream)


def test_a_minute_of_the_eleven_joint_robot_is_small(tmp_path):
    run = a_minute('[robot]\nmodel = "koch11"\n', tmp_path)
    run.save(tmp_path / "p.html")
    assert len(page_data(tmp_path / "p.html")["frames"]["tick"]) == 3001
    assert (tmp_path / "p.html").stat().st_size < 3e6


@needs_robot_data
def test_a_minute_of_a_robot_with_meshes_is_small(tmp_path):
    run = a_minute('[robot]\nmodel = "panda"\n', tmp_path)
    run.save(tmp_path / "p.html")
    assert (tmp_path / "p.html").stat().st_size < 6e6
    data = page_data(tmp_path / "p.html")
    looks = appearance_of(load_cell(tmp_path / "p.toml"))
    parts = [part for link in looks.robot.links for part in link.parts]
    shapes = [shape for link in data["robot"]["links"] for shape in link["shapes"]]
    assert len(data["meshes"]) == len({id(part.shape) for part in parts}) < len(parts) == len(shapes)
    for part, shape in zip(parts, shapes, strict=True):
        mesh = data["meshes"][shape["mesh"]]
        points = np.frombuffer(base64.b64decode(mesh["vertices"]), "<f4").reshape(-1, 3)
        faces = np.frombuffer(base64.b64decode(mesh["faces"]), {"u16": "<u2", "u32": "<u4"}[mesh["index"]])
        np.testing.assert_array_equal(points, part.shape.vertices.astype("f4"))
        np.testing.assert_array_equal(faces.reshape(-1, 3), part.shape.faces)
        assert shape["color"] == part.colour.code


def test_blocks_that_are_left_out_are_told(made):
    _, run, _ = made
    replay = replay_of(run, run.source)
    replay.found.blocks = 30_000
    data, lacking = replay_json(replay)
    assert [one.code for one in lacking] == ["IRL723"]
    assert f"the first {len(run.stream.records)} of 30,000 blocks" in json.loads(data)["diagnostics"][-1]


def test_data_are_json_of_plain_numbers(made):
    _, run, _ = made
    data, warnings = replay_json(replay_of(run, run.source))
    assert warnings == ()
    json.loads(data, parse_constant=pytest.fail)
    assert read_page(run.source.program_text).data == ""
