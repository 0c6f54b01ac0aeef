"""Robots by name: those packaged, those of the data package, and what is said where it is missing."""

import json
from importlib import metadata
from math import radians
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from irlx.cell import external
from irlx.cell.external import external_names, external_section
from irlx.cell.named import named_section, named_urdf, robot_names
from irlx.cell.packaged import packaged_names, packaged_urdf
from irlx.cell.robot_data import robot_data_folder
from irlx.diagnostics import Place
from irlx.robot.kinematics import Kinematics

needs_robot_data = pytest.mark.skipif(
    robot_data_folder() is None, reason='the data package is missing: pip install "irlx[robots]"'
)
AXES = {"baxter_left": 7, "baxter_right": 7, "kinova": 6, "panda": 7, "talos_left": 9, "tiago": 8}
AXES |= {"ur10": 6, "ur3": 6, "ur5": 6, "xarm7": 7, "z1": 6}
OWN = {"arm7": 7, "rail6": 7, "mobile8": 8, "mobile9": 9, "gantry9": 9, "snake20": 20}
WEIGHTS = {
    "mobile8": [60, 60, 6, 5, 4, 3, 2, 1],
    "mobile9": [60, 60, 30, 6, 5, 4, 3, 2, 1],
    "gantry9": [30, 25, 20, 6, 5, 4, 3, 2, 1],
    "snake20": [1] * 20,
}
MASSES = {"mobile8": 200.0, "mobile9": 200.0, "gantry9": 350.0}
"""Weights of robots that bring their own: those of the platform are per m2."""


def named(cell, name):
    return cell(f"[robot]\nmodel = '{name}'\n")


def smallest_singular_value(found):
    kinematics = Kinematics(found.robot)
    _, jacobian = kinematics.difference(found.start, kinematics.target(*kinematics.tool_pose(found.start)))
    return np.linalg.svd(jacobian, compute_uv=False)[-1]


@pytest.mark.req("CELL-04")
def test_names():
    names = (
        "arm7",
        "dual14",
        "gantry9",
        "irb6",
        "koch11",
        "mobile8",
        "mobile9",
        "planar3",
        "planar4",
        "rail6",
        "snake20",
    )
    assert packaged_names() == names
    assert external_names() == tuple(sorted(AXES))
    assert robot_names() == packaged_names() + external_names()


@pytest.mark.req("CELL-04")
@pytest.mark.parametrize("name", OWN)
def test_robots_of_our_own_start_well(cell, name):
    found = named(cell, name)
    assert (len(found.robot.axes), found.robot.tip) == (OWN[name], "tool")
    assert found.weights.tolist() == WEIGHTS.get(name, [7, 6, 5, 4, 3, 2, 1])
    assert found.warnings == ()
    assert np.isfinite(found.limits.speed_upper).all()
    assert np.isfinite(found.limits.acceleration_upper).all()
    room = np.minimum(found.start - found.limits.position_lower, found.limits.position_upper - found.start)
    assert room.min() > radians(30)
    assert smallest_singular_value(found) > 0.2


ARM = [(0.08, 0, 0.2), (0, 0, 0.42), (0.18, 0, 0.05), (0.2, 0, 0), (0.07, 0, 0)]
"""Steps of the 6-axis arm from the second of its axes to the last."""
CHAINS = {
    "arm7": ("zyzyzyz", [(0, 0, h) for h in (0.18, 0.13, 0.2, 0.2, 0.18, 0.18, 0.07)], (0, 0, 0.07)),
    "rail6": ("|zyyxyx", [(0, 0, 0.12), (0, 0, 0.18), *ARM], (0.05, 0, 0)),
    "mobile8": ("-|zyyxyx", [(0, 0, 0.06), (0, 0, 0), (0.1, 0, 0.24), *ARM], (0.05, 0, 0)),
    "mobile9": ("-|zzyyxyx", [(0, 0, 0.06), (0, 0, 0), (0, 0, 0), (0.1, 0, 0.24), *ARM], (0.05, 0, 0)),
    "gantry9": ("-|!zyyxyx", [(0, 0, 3), (0, 0, 0.12), (0, 0, -0.62), (0, 0, -0.8), *ARM], (0.05, 0, 0)),
    "snake20": ("zy" * 10, [(0.12, 0, 0.5), *[(0.08, 0, 0)] * 19], (0.08, 0, 0)),
}
HANGS = {"gantry9": 3}
"""The axis whose frame is turned by half a circle about x: from there on the arm hangs."""
SLIDES = {"|": (0, 1, 0), "-": (1, 0, 0), "!": (0, 0, 1)}
"""Axes (slides - | ! along x, y, z), the steps to them, and to the tool, m: as the reference draws them."""


@pytest.mark.req("CELL-04")
@pytest.mark.parametrize("name", OWN)
def test_geometry_of_our_own(cell, name):
    found = named(cell, name)
    axes, steps, tool = CHAINS[name]
    kinematics = Kinematics(found.robot)
    model = pin.buildModelFromXML(packaged_urdf(name))
    assert 6.0 < sum(inertia.mass for inertia in model.inertias[1:]) < MASSES.get(name, 100.0)
    rng = np.random.default_rng(7)
    for _ in range(20):
        q = rng.uniform(found.limits.position_lower, found.limits.position_upper)
        position, rotation = np.zeros(3), Rotation.identity()
        for number, (axis, step, value) in enumerate(zip(axes, steps, q, strict=True)):
            position = position + rotation.apply(step)
            if number == HANGS.get(name):
                rotation = rotation * Rotation.from_euler("x", np.pi)
            if axis in SLIDES:
                position = position + rotation.apply(value * np.array(SLIDES[axis]))
            else:
                rotation = rotation * Rotation.from_euler(axis, value)
        actual = kinematics.tool_pose(q)
        assert np.abs(actual[1] - position - rotation.apply(tool)).max() < 1e-14
        assert np.abs(actual[0] - rotation.as_matrix()).max() < 1e-14


@pytest.mark.parametrize("name", OWN)
def test_bodies_of_our_own_are_primitives_with_possible_inertias(name):
    text = packaged_urdf(name)
    assert "<mesh" not in text
    for inertia in pin.buildModelFromXML(text).inertias[1:]:
        moments = np.linalg.eigvalsh(inertia.inertia)
        assert inertia.mass > 0.0
        assert moments[0] > 0.0
        assert moments[0] + moments[1] >= moments[2]


@needs_robot_data
@pytest.mark.req("CELL-04")
@pytest.mark.parametrize("name", AXES)
def test_robots_of_the_data_package(cell, name):
    found = named(cell, name)
    assert found.model == name
    assert len(found.robot.axes) == AXES[name]
    assert np.isfinite(found.limits.speed_upper).all()
    assert smallest_singular_value(found) > 0.1


@needs_robot_data
@pytest.mark.req("CELL-04")
@pytest.mark.req("CELL-05")
def test_panda(cell):
    found = named(cell, "panda")
    assert found.robot.tip == "panda_hand_tcp"
    assert found.robot.joint_names == tuple(f"panda_joint{number}" for number in range(1, 8))
    assert found.start == pytest.approx(np.radians([0, -45, 0, -135, 0, 90, 45]))
    assert found.limits.acceleration_upper == pytest.approx([15, 7.5, 10, 12.5, 15, 20, 20], rel=1e-15)
    assert found.limits.speed_upper.tolist() == [2.175] * 4 + [2.61] * 3
    assert found.limits.position_upper[3] == -0.0698
    assert found.warnings == ()
    # The ready posture of Franka's arm: flange over the base's x axis, the tool straight down.
    rotation, position = Kinematics(found.robot).tool_pose(found.start)
    assert rotation[:, 2] == pytest.approx([0, 0, -1], abs=1e-12)
    assert position[1] == pytest.approx(0.0, abs=1e-12)


@needs_robot_data
@pytest.mark.req("CELL-04")
def test_panda_with_a_locked_joint_and_another_tip(cell):
    whole = named(cell, "panda")
    found = cell("[robot]\nmodel = 'panda'\nlocked = { panda_joint3 = 10 }\n")
    assert found.robot.joint_names == whole.robot.joint_names[:2] + whole.robot.joint_names[3:]
    assert found.start.tolist() == [*whole.start[:2], *whole.start[3:]]
    assert found.limits.acceleration_upper == pytest.approx([15, 7.5, 12.5, 15, 20, 20])
    finger = cell("[robot]\nmodel = 'panda'\ntip = 'panda_rightfinger'\n")
    assert finger.robot.joint_names == whole.robot.joint_names


@pytest.mark.req("CELL-04")
def test_without_the_data_package(faults, monkeypatch):
    monkeypatch.setattr(external, "robot_data_folder", lambda: None)
    message = "the robot 'panda' is in the package example-robot-data, which is not installed: "
    expected = ("IRL614", "robot.model", message + 'pip install "irlx[robots]"')
    assert faults("[robot]\nmodel = 'panda'\n") == [expected]
    page = Path(__file__).parents[2] / "docs" / "diagnostics" / "IRL614.md"
    assert expected[2] in page.read_text(encoding="utf-8")


@pytest.mark.req("CELL-04")
def test_a_data_package_without_the_robot(faults, monkeypatch, tmp_path):
    monkeypatch.setattr(external, "robot_data_folder", lambda: tmp_path)
    ((code, _, message),) = faults("[robot]\nmodel = 'panda'\n")
    assert code == "IRL614"
    assert message.endswith(
        f'of which {tmp_path} has no panda_description/urdf/panda.urdf: pip install --upgrade "irlx[robots]"'
    )


@pytest.mark.req("CELL-04")
def test_a_data_package_with_a_broken_file(faults, monkeypatch, tmp_path):
    monkeypatch.setattr(external, "robot_data_folder", lambda: tmp_path)
    file = tmp_path / (external_section("panda").model or "")
    file.parent.mkdir(parents=True)
    for content, words in [(b"\xff", "codec can't decode"), (b"<robot", "not well-formed XML")]:
        file.write_bytes(content)
        ((code, key, message),) = faults("[robot]\nmodel = 'panda'\n")
        assert (code, key) == ("IRL612", "robot.model")
        assert words in message


@pytest.mark.req("CELL-03")
@pytest.mark.parametrize(("name", "near"), [("pnada", "panda"), ("Panda", "panda"), ("arm_7", "arm7")])
def test_unknown_names_list_all_robots(cell, name, near):
    with pytest.raises(Exception, match=f"no robot '{name}'; did you mean '{near}'") as caught:
        named(cell, name)
    (found,) = caught.value.diagnostics
    assert found.code == "IRL611"
    for known in robot_names():
        assert known in found.help


@pytest.mark.req("CELL-04")
@pytest.mark.parametrize("name", sorted(AXES))
def test_what_the_tables_hold(name):
    section = external_section(name)
    assert section.model.endswith(".urdf")
    assert not Path(section.model).is_absolute()
    assert section.tip
    assert len(section.start) == AXES[name]
    assert named_section(name) == section


class Elsewhere:
    """No package of any Python, no prefix, no workspace; a place to put some."""

    def __init__(self, monkeypatch, folder):
        self.folder, self.patch = folder, monkeypatch
        monkeypatch.setattr(metadata, "distribution", self.absent)
        monkeypatch.setattr("sys.path", [""])
        monkeypatch.setattr("sys.prefix", str(folder / "no"))
        monkeypatch.setattr("sys.base_prefix", str(folder / "no"))
        monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
        monkeypatch.chdir(folder)

    @staticmethod
    def absent(name):
        raise metadata.PackageNotFoundError(name)

    def robots_in(self, prefix):
        robots = self.folder / prefix / "share" / "example-robot-data" / "robots"
        robots.mkdir(parents=True)
        return robots


@pytest.fixture
def elsewhere(monkeypatch, tmp_path):
    return Elsewhere(monkeypatch, tmp_path)


def test_no_data_folder(elsewhere):
    assert robot_data_folder() is None


def test_data_folder_of_a_wheel(elsewhere):
    class Distribution:
        @staticmethod
        def locate_file(path):
            return elsewhere.folder / "site" / path

    elsewhere.patch.setattr(metadata, "distribution", lambda name: Distribution)
    assert robot_data_folder() is None
    assert elsewhere.robots_in("site/cmeel.prefix") == robot_data_folder()


def test_data_folder_of_an_unpacked_wheel(elsewhere):
    elsewhere.patch.setattr("sys.path", ["", str(elsewhere.folder / "unpacked")])
    assert elsewhere.robots_in("unpacked/cmeel.prefix") == robot_data_folder()


def test_data_folder_of_conda(elsewhere):
    elsewhere.patch.setattr("sys.prefix", str(elsewhere.folder / "conda"))
    assert elsewhere.robots_in("conda") == robot_data_folder()


def test_data_folder_of_a_workspace(elsewhere):
    elsewhere.patch.setenv("AMENT_PREFIX_PATH", f"/no:{elsewhere.folder / 'ros'}")
    assert elsewhere.robots_in("ros") == robot_data_folder()


@needs_robot_data
def test_the_urdf_is_that_of_the_package():
    text = (robot_data_folder() / "panda_description" / "urdf" / "panda.urdf").read_text(encoding="utf-8")
    assert named_urdf("panda", Place("cell.toml")) == text


@needs_robot_data
@pytest.mark.req("STR-06")
def test_a_panda_stream_is_verified_without_its_cell(tmp_path, monkeypatch, capsys):
    from irlx.cli.main import main

    (tmp_path / "p.toml").write_text("[robot]\nmodel = 'panda'\n")
    program = (
        "PROGRAM p;\nVAR POSITION: by := (0, 0, 20);\nBEGIN\n  MOVE LIN POSITION(310, 0, 500);\nENDPROGRAM;\n"
    )
    (tmp_path / "p.irl").write_text(program)
    monkeypatch.chdir(tmp_path)
    assert main(["run", "p.irl", "--quiet"]) == 0
    (tmp_path / "p.toml").unlink()
    capsys.readouterr()
    assert main(["verify", "p.irdata", "--json"]) == 0
    checks = json.loads(capsys.readouterr().out)["checks"]
    unmade = {check["name"] for check in checks if check["status"] == "not checked"}
    assert unmade == {"program", "robot limits"}
    monkeypatch.setattr(external, "robot_data_folder", lambda: None)
    assert main(["verify", "p.irdata"]) == 2
    assert "IRL614" in capsys.readouterr().err
