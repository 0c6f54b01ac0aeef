"""CRITERION through a whole run: each criterion lowers its own measure, and no promise is broken for it."""

from __future__ import annotations

from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.transform.measures.dynamic_manipulability import DynamicManipulability
from irlx.transform.measures.gravity_torque import GravityTorque
from irlx.transform.measures.inertia import inertia_matrix
from irlx.transform.measures.joint_centring import JointCentring
from irlx.transform.measures.manipulability import Manipulability
from irlx.transform.measures.smallest_singular_value import SmallestSingularValue
from kept_runs import kept_report, kept_run
from long_run import first
from machines import machine

WAYS = {"arm7": (-100, 150, -60), "koch11": (-800, 500, 300)}
CELL = """[robot]
model = "{model}"
[robot.limits]
acceleration = {acceleration}
[robot.self_collision]
active = false
[motion]
tick_ms = {tick}
speed = 200
acc = 1000
"""


def measures(name: str) -> dict[str, object]:
    robot = machine(name)
    kinematics, limits = robot.kinematics, robot.limits
    return {
        "MANIPULABILITY": Manipulability(kinematics),
        "SMALLEST_SINGULAR_VALUE": SmallestSingularValue(kinematics),
        "DYNAMIC_MANIPULABILITY": DynamicManipulability(kinematics),
        "GRAVITY_TORQUE": GravityTorque(kinematics),
        "JOINT_CENTRING": JointCentring(limits, "square"),
        "JOINT_BARRIER": JointCentring(limits, "barrier"),
    }


@cache
def home_of(name: str) -> str:
    """Pose of the start posture as a program writes it."""
    robot = machine(name)
    position, rotation = robot.pose(robot.start)
    x, y, z, w = Rotation.from_matrix(rotation).as_quat().tolist()
    return f"({tuple((1e3 * position).tolist())}, ORIQUAT{(w, x, y, z)})"


class Shop:
    """Programs of two lines, out and back, with whatever stands around them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def run(self, name: str, body: str, tick: float = 20, acceleration: float = 600.0) -> irlx.Run:
        joints = machine(name).n
        cell = CELL.format(model=name, acceleration=[acceleration] * joints, tick=tick)
        (self.folder / "p.toml").write_text(cell, encoding="utf-8")
        away = f"home + POSITION{WAYS[name]}"
        head = f"PROGRAM p;\nVAR POSE: home := {home_of(name)}, away;\nBEGIN\n  away := {away};"
        text = f"{head}\n{body}\nENDPROGRAM;\n"
        (self.folder / "p.irl").write_text(text, encoding="utf-8")
        files = self.folder / "p.irl", self.folder / "p.toml"
        report = kept_report(*files)
        assert report.passed, report
        return kept_run(*files)


@pytest.fixture
def shop(tmp_path: Path) -> Shop:
    return Shop(tmp_path)


PLAIN = "  MOVE LIN away;\n  MOVE LIN home;"


def added(criterion: str) -> str:
    return f"  CRITERION {criterion};\n{PLAIN}\n  CRITERIONEND {criterion.split(maxsplit=1)[0]};"


ON_KOCH11 = [
    (criterion, "koch11")
    for criterion in (
        "JOINT_BARRIER",
        "MANIPULABILITY",
        "SMALLEST_SINGULAR_VALUE",
        "JOINT_CENTRING",
        "DYNAMIC_MANIPULABILITY",
    )
]
"""Criteria of which the smaller robot and two others on this one tell by default."""


@pytest.mark.req("TRF-10")
@pytest.mark.parametrize(
    ("criterion", "name"),
    [
        *product(("MANIPULABILITY", "SMALLEST_SINGULAR_VALUE", "GRAVITY_TORQUE"), ("arm7",)),
        *product(("JOINT_CENTRING", "JOINT_BARRIER", "DYNAMIC_MANIPULABILITY"), ("arm7",)),
        ("GRAVITY_TORQUE", "koch11"),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in ON_KOCH11),
    ],
)
def test_a_criterion_lowers_its_own_measure(name, criterion, shop) -> None:
    measure = measures(name)[criterion]
    free, drawn = shop.run(name, PLAIN), shop.run(name, added(criterion))
    before, after = (np.mean([measure.sense * measure.value(q) for q in run.q]) for run in (free, drawn))
    at_end = [measure.sense * measure.value(run.q[-1]) for run in (free, drawn)]
    assert after < before
    assert at_end[1] < at_end[0]
    np.testing.assert_array_equal(free.q[0], drawn.q[0])


def energy(name: str, run: irlx.Run) -> float:
    kinematics = machine(name).kinematics
    return sum(0.5 * v @ inertia_matrix(kinematics, q) @ v for q, v in zip(run.q, run.qd, strict=True))


@pytest.mark.req("TRF-10")
@pytest.mark.parametrize("name", first(1, ["arm7", "koch11"]))
def test_kinetic_energy_is_lowered(name, shop) -> None:
    assert energy(name, shop.run(name, added("KINETIC_ENERGY"))) < energy(name, shop.run(name, PLAIN))


@pytest.mark.req("TRF-10")
def test_the_energy_increment_stays_below_that_of_least_motion(shop) -> None:
    """The work of a tick: kinetic energy and what is lifted, by the potential of the masses."""
    kinematics = machine("arm7").kinematics

    def raised(run: irlx.Run) -> float:
        import pinocchio as pin

        model, data = kinematics.model, kinematics.data
        potential = np.array([pin.computePotentialEnergy(model, data, q) for q in run.q])
        return float(potential[len(potential) // 2] - potential[0]) + energy("arm7", run) * run.stream.dt

    assert raised(shop.run("arm7", added("ENERGY_INCREMENT"))) < raised(shop.run("arm7", PLAIN))


@pytest.mark.req("TRF-10")
@pytest.mark.parametrize("name", first(1, ["arm7", "koch11"]))
def test_the_velocity_ratio_alone_is_least_motion(name, shop) -> None:
    free, drawn = shop.run(name, PLAIN), shop.run(name, added("VELOCITY_RATIO WEIGHT := 3"))
    np.testing.assert_allclose(drawn.q, free.q, atol=1e-9)


@pytest.mark.req("TRF-10")
def test_half_the_tick_gives_nearly_the_same_postures(shop) -> None:
    """First order in the tick: a quarter of the difference at a quarter of the tick, roughly."""
    ends = {t: shop.run("arm7", added("JOINT_CENTRING GAIN := 20"), tick=t).q[-1] for t in (4, 8, 16, 32)}
    apart = [float(np.abs(ends[t] - ends[t // 2]).max()) for t in (32, 16, 8)]
    assert apart[2] < 0.45 * apart[0] < 0.45 * 0.05, apart


@pytest.mark.req("TRF-06")
def test_weights_and_clauses_add_up(shop) -> None:
    """Twice the weight of one is two clauses' worth of gain; a clause replaces the switch of its name."""
    doubled = shop.run("arm7", added("JOINT_CENTRING WEIGHT := 2, GAIN := 5"))
    gained = shop.run("arm7", added("JOINT_CENTRING GAIN := 10"))
    np.testing.assert_allclose(doubled.q, gained.q, atol=1e-12)
    clauses = "  MOVE LIN away WITH CRITERION JOINT_CENTRING GAIN := 10;\n"
    clauses += "  MOVE LIN home WITH CRITERION JOINT_CENTRING GAIN := 10;"
    np.testing.assert_array_equal(shop.run("arm7", clauses).q, gained.q)
    over = "  CRITERION JOINT_CENTRING GAIN := 3;\n" + clauses + "\n  CRITERIONEND JOINT_CENTRING;"
    np.testing.assert_array_equal(shop.run("arm7", over).q, gained.q)


@pytest.mark.req("TRF-14")
@pytest.mark.parametrize("acceleration", first(1, [400.0, 100.0]))
@pytest.mark.parametrize("name", ["arm7", pytest.param("koch11", marks=pytest.mark.slow)])
def test_switching_in_the_midst_breaks_no_bound(name, acceleration, shop) -> None:
    """Strong criteria switched on, over, off, under tight acceleration limits; the verifier judges."""
    body = f"""  MOVE LIN away;
  CRITERION JOINT_BARRIER GAIN := 80;
  MOVE LIN home;
  CRITERION MANIPULABILITY GAIN := 80, WEIGHT := 2;
  MOVE LIN away;
  CRITERIONEND JOINT_BARRIER;
  FREEZESTART 3;
  MOVE LIN home;
  FREEZEEND;
  CRITERION KINETIC_ENERGY;
{PLAIN}
  CRITERIONEND KINETIC_ENERGY;
  CRITERIONEND MANIPULABILITY;
  MOVE LIN away;"""
    if name == "arm7":
        body = body.replace("  FREEZESTART 3;\n", "").replace("  FREEZEEND;\n", "")
    run = shop.run(name, body, acceleration=acceleration)
    bound = np.radians(acceleration) * (1 + 1e-9)
    revolute = [joint != 9 or name == "arm7" for joint in range(run.q.shape[1])]
    assert np.abs(run.qdd[:, revolute]).max() <= bound + 1e-6


@pytest.mark.req("TRF-11")
def test_under_the_cyclic_option_a_criterion_adds_to_the_pull(shop) -> None:
    closed = f"  CYCLICSTART;\n{PLAIN}\n  CYCLICEND;"
    plain = shop.run("koch11", closed)
    assert plain.summary.closure.difference < 1e-6
    both = shop.run(
        "koch11", f"  CRITERION MANIPULABILITY GAIN := 50;\n{closed}\n  CRITERIONEND MANIPULABILITY;"
    )
    assert np.abs(both.q - plain.q).max() > 1e-3


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("CRITERION MANIPULABILTY;", "IRL360"),
        ("CRITERION JOINT_CENTRING DEPTH := 2;", "IRL361"),
        ("CRITERION KINETIC_ENERGY GAIN := 2;", "IRL361"),
        ("MOVE LIN away WITH CRITERION MANIPULABILTY;", "IRL360"),
    ],
)
def test_what_is_no_criterion_is_named_at_its_place(line, code, shop) -> None:
    with pytest.raises(irlx.IrlxError) as error:
        shop.run("arm7", f"  {line}")
    found = next(d for d in error.value.diagnostics if d.is_error)
    assert found.code == code
    assert found.place.line == 5
    if code == "IRL360":
        assert "did you mean 'MANIPULABILITY'" in found.message


def test_a_robot_without_masses_is_refused_what_needs_them(tmp_path) -> None:
    links = "".join(f'<link name="l{i}"/>' for i in range(8))
    axes = ["0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1", "0 1 0", "0 0 1"]
    joints = "".join(
        f'<joint name="j{i}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<origin xyz="0 0 0.2"/><axis xyz="{axis}"/>'
        '<limit lower="-3" upper="3" velocity="2" effort="1"/></joint>'
        for i, axis in enumerate(axes)
    )
    (tmp_path / "r.urdf").write_text(f'<robot name="bare">{links}{joints}</robot>', encoding="utf-8")
    (tmp_path / "p.toml").write_text('[robot]\nmodel = "r.urdf"\nstart = [0, 30, 0, 60, 0, 30, 0]\n')
    (tmp_path / "p.irl").write_text("PROGRAM p;\nBEGIN\n  CRITERION KINETIC_ENERGY;\nENDPROGRAM;\n")
    with pytest.raises(irlx.RunError) as error:
        irlx.run(tmp_path / "p.irl")
    assert "IRL362" in {d.code for d in error.value.diagnostics}


PLUGIN = """
import numpy as np
import irlx


@irlx.register
class Elbow(irlx.Criterion):
    \"\"\"Draws joint 3 to half a radian.\"\"\"

    name = "elbow_at_half"
    sense = 1

    def __init__(self, kinematics, limits):
        self.joints = kinematics.joints

    def value(self, q):
        return 0.5 * float(q[2] - 0.5) ** 2

    def gradient(self, q):
        slope = np.zeros(self.joints)
        slope[2] = q[2] - 0.5
        return slope
"""


def test_a_criterion_of_ones_own(shop, tmp_path, monkeypatch, capsys) -> None:
    from irlx.cli.main import main

    (tmp_path / "elbow.py").write_text(PLUGIN, encoding="utf-8")
    shop.run("arm7", PLAIN)
    text = (tmp_path / "p.irl").read_text(encoding="utf-8")
    body = added("ELBOW_AT_HALF GAIN := 40")
    (tmp_path / "p.irl").write_text(text.replace(PLAIN, body), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert main(["run", "p.irl", "-o", "a.npz", "--plugin", "elbow.py"]) == 0
    free = shop.run("arm7", PLAIN)
    with np.load(tmp_path / "a.npz") as file:
        assert abs(file["q"][-1, 2] - 0.5) < 0.6 * abs(free.q[-1, 2] - 0.5)
    capsys.readouterr()
    (tmp_path / "broken.py").write_text("import no_such_module\n", encoding="utf-8")
    for name in ("broken.py", "missing.py", "no_such_module"):
        assert main(["run", "p.irl", "--plugin", name]) == 2
        assert "IRL009" in capsys.readouterr().err


def test_names_that_cannot_be_registered() -> None:
    for name in ("manipulability", "two words", ""):
        with pytest.raises(ValueError, match=r"criterion of the library|no name"):
            irlx.register(type("Other", (irlx.Criterion,), {"name": name}))


BARRIER = """PROGRAM p;
VAR
  MAIN_JOINT_MIN: low;
  MAIN_JOINT_MAX: high;
BEGIN
  low := R_JBD.LOWER;
  high := R_JBD.UPPER;
  high.A3.MAX := R_JOINT_ACT.M_JOINT.A3;
  JOINTLIMIT low, high;
  CRITERION JOINT_BARRIER;
  MOVE_INC LIN POSITION({way});
  CRITERIONEND JOINT_BARRIER;
  JOINTLIMITEND;
ENDPROGRAM;
"""


@pytest.mark.req("MOT-21")
@pytest.mark.parametrize("way", ["0.02, 0.01, 0", "5, 0, 0"])
def test_the_slope_of_a_barrier_on_a_limit_is_no_reason_to_crawl(tmp_path: Path, way: str) -> None:
    """Joint 3 stands on its limit, where the barrier is steepest: the move takes hardly longer, and leads it
    away. It took 33 s in place of 0.15."""
    (tmp_path / "p.irl").write_text(BARRIER.format(way=way))
    (tmp_path / "p.toml").write_text('[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 4\nspeed = 100\n')
    run = irlx.run(tmp_path / "p.irl", tmp_path / "p.toml")
    assert run.summary.planned == 1
    lost = sum(slowed.lost for slowed in run.summary.slowed)
    assert run.summary.duration < 2.5 * (run.summary.duration - lost)
    assert run.q[-1, 2] < run.q[0, 2]
    assert irlx.verify(run).passed
