"""The viewer's server, without a browser: its scene, obstacles that are moved, the program run again."""

import socket
import sys
import urllib.request

import numpy as np
import pinocchio as pin
import pytest

import irlx
from irlx.cell.packaged import packaged_urdf
from irlx.diagnostics import IrlxError
from irlx.solids.placement import Placement
from irlx.viewer.serve import free_port
from irlx.viewer.subject import subject_of_stream

pytest.importorskip("viser", reason="viser is not installed: pip install 'irlx[test]'")
pytestmark = [
    pytest.mark.req("REP-05"),
    # What viser's event loop leaves behind when it ends is not ours to mend.
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
]


@pytest.fixture(scope="module")
def viewer(folder):
    with irlx.view(folder / "p.irl", port=0, block=False, open_page=False) as found:
        yield found


def pose_in_the_scene(viewer, link):
    """Pose of a link from the poses of its nodes, each in the one above it."""
    pose = pin.SE3.Identity()
    path = viewer.robot.paths[link]
    above = [name for name, own in viewer.robot.paths.items() if f"{path}/".startswith(f"{own}/")]
    for name in sorted(above, key=lambda name: len(viewer.robot.paths[name])):
        node = viewer.robot.nodes[name]
        w, x, y, z = node.wxyz
        pose = pose * pin.SE3(pin.Quaternion(w, x, y, z).normalized(), np.array(node.position))
    return pose


@pytest.mark.parametrize("share", [0.0, 0.31, 1.0])
def test_links_are_where_forward_kinematics_has_them(viewer, share):
    model = pin.buildModelFromXML(packaged_urdf("arm7"))
    data = model.createData()
    row = round(share * (viewer.rows - 1))
    viewer.seek(row)
    assert viewer.row == row
    pin.framesForwardKinematics(model, data, viewer.shown.stream.q[row])
    links = [frame for frame in model.frames if frame.type == pin.FrameType.BODY]
    assert len(links) >= 9
    for frame in links:
        placed = data.oMf[model.getFrameId(frame.name, pin.FrameType.BODY)]
        assert np.allclose(pose_in_the_scene(viewer, frame.name).homogeneous, placed.homogeneous, atol=1e-6)
    tool = viewer.shown.stream.tool[row]
    assert np.allclose(viewer.tool.position, tool[:3])
    assert np.allclose(np.roll(viewer.tool.wxyz, -1), tool[3:])


def test_it_is_served_on_this_machine_alone(viewer):
    assert viewer.url.startswith("http://127.0.0.1:")
    with urllib.request.urlopen(viewer.url, timeout=10) as page:
        assert b"<html" in page.read(2000)
    # Pages may ask for a tunnel to other hosts; there is none.
    assert viewer.server.request_share_url() is None


def test_what_moves_by_itself_is_where_it_is_then(viewer):
    cart = viewer.obstacles._bodies["cart"]
    for row, due in ((0, 0.0), (5, 0.2), (viewer.rows - 1, 0.4)):
        viewer.seek(row)
        assert np.allclose(cart.position, (2.0, due, 0.0))


@pytest.fixture
def put_back(viewer):
    """Leaves the obstacles where the cell has them, and the run of that shown."""
    yield
    viewer.obstacles.put_back()
    viewer.run_again(timeout=60)
    assert not viewer.failure


@pytest.mark.usefixtures("put_back")
def test_a_moved_obstacle_changes_the_run_again(viewer):
    before = viewer.shown
    elbow = viewer.robot.origins(before.stream.q[0])[4]
    viewer.place("ball", Placement(tuple(elbow + np.array([0.0, -0.16, 0.0]))))
    assert viewer.shown is before
    viewer.run_again(timeout=60)
    assert not viewer.failure
    assert viewer.shown is not before
    assert viewer.shown.stream.complete
    change = np.abs(viewer.shown.stream.q[:5] - before.stream.q[:5]).max(), len(viewer.shown.stream.q)
    assert change[0] > 1e-3 or change[1] != len(before.stream.q)
    assert np.allclose(viewer.shown.stream.tool[-1], before.stream.tool[-1], atol=1e-6)
    assert "cell" in viewer.shown.stream.header.making.given
    assert "clearance" in [line.label for line in viewer.shown.summary]


@pytest.mark.usefixtures("put_back")
def test_a_run_that_fails_says_why_and_the_last_good_one_stays(viewer):
    before = viewer.shown
    viewer.place("ball", Placement(tuple(before.stream.tool[len(before.stream.q) // 2, :3])))
    viewer.run_again(timeout=60)
    assert viewer.failure
    assert viewer.failure[0].code.startswith("IRL5")
    assert viewer.failure[0].place.text is not None
    assert viewer.shown is before
    assert "xyz = [" in viewer.obstacles_text()


def test_the_shown_run_is_that_of_the_program_again(viewer, run):
    assert np.array_equal(viewer.shown.stream.q, run.q)


def test_a_run_that_has_been_made(folder, run):
    with irlx.view(run, port=0, block=False, open_page=False) as found:
        assert found.rows == len(run.t)
        assert found.shown.text.text == (folder / "p.irl").read_text()
        assert set(found.shown.cell.scene.obstacles) == {"ball", "cart"}
        found.run_again()
        assert found.shown.stream is run.stream


@pytest.mark.parametrize(("ending", "runs_again"), [("npz", True), ("csv", False)])
def test_a_stream_is_shown_as_it_is(folder, run, ending, runs_again):
    path = folder / f"written.{ending}"
    run.save(path)
    found = subject_of_stream(path, folder / "p.toml")
    assert np.array_equal(found.shown.stream.q, run.q)
    assert (found.again is not None) is runs_again
    assert not found.shown.diagnostics
    if found.again is not None:
        again = found.again(found.shown.cell, lambda block, seconds: None)
        assert np.array_equal(again.stream.q, run.q)


def test_a_stream_of_another_robot_is_told(folder, run, tmp_path):
    path = tmp_path / "written.npz"
    run.save(path)
    text = (folder / "p.toml").read_text()
    (tmp_path / "p.toml").write_text(text + "[robot.origins.joint_7]\nxyz = [0, 0, 500]\n")
    (found,) = subject_of_stream(path).shown.diagnostics
    assert found.code == "IRL015"


def test_a_stream_without_its_cell_has_the_robot_of_its_name(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run.save(tmp_path / "written.npz")
    found = subject_of_stream(tmp_path / "written.npz")
    assert found.shown.cell.robot.name == "arm7"
    assert not found.shown.cell.scene.obstacles


def test_ports():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(IrlxError, match=f"IRL014: .* port {port} of 127.0.0.1: it is in use"):
            free_port("127.0.0.1", port)
    assert free_port("127.0.0.1", port) == port
    assert free_port("127.0.0.1", 0) > 0
    for wrong in (-1, 65536):
        with pytest.raises(IrlxError, match="IRL006: --port"):
            free_port("127.0.0.1", wrong)
    with pytest.raises(IrlxError, match="IRL014"):
        free_port("no.such.host.invalid", None)


def test_two_viewers_at_once_have_ports_of_their_own(viewer, folder, run):
    with irlx.view(run, folder / "p.toml", block=False, open_page=False) as other:
        assert other.url != viewer.url


def test_without_the_extra(monkeypatch, folder):
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(IrlxError) as caught:
        irlx.view(folder / "p.irl")
    assert str(caught.value) == "error IRL010: irlx view needs viser: pip install 'irlx[view]'"
