"""A platform on a curve of its own while its arm moves the tool: from the cell to the verified stream."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import irlx
from irlx.promises import CLOSURE, CONDITION

pytestmark = pytest.mark.req("TRF-22")

POINTS = np.array([[0.0, 0.0], [0.8, 0.2], [1.6, -0.2], [2.4, 0.3]])
WAY = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(POINTS, axis=0).T))])
SPLINE = CubicSpline(WAY, POINTS, bc_type="natural")
FINE = np.linspace(-0.5, WAY[-1] + 0.5, 40_001)
HEADING = float(np.degrees(np.arctan2(*SPLINE(0.0, 1)[::-1])))

CELL = """[robot]
model = "mobile9"
start = [0, 0, {heading}, 8, 25, 15, 10, 45, -8]
[motion]
tick_ms = 40
speed = 200
acc = 800
[[constraint]]
name = "aisle"
link = "platform"
path = [[0, 0], [800, 200], [1600, -200], [2400, 300]]
"""
WITH_HEADING = CELL.format(heading=HEADING) + "heading = true\n"
LINES = """  MOVE_INC LIN POSITION(500, 0, 0);
  MOVE_INC LIN POSITION(0, 150, 0);
  MOVE_INC LIN POSITION(-500, -150, 0);"""


def ran(folder: Path, body: str, cell: str = WITH_HEADING, declarations: str = "") -> irlx.Run:
    (folder / "p.toml").write_text(cell, encoding="utf-8")
    (folder / "p.irl").write_text(f"PROGRAM p; {declarations}\nBEGIN\n{body}\nENDPROGRAM\n", encoding="utf-8")
    return irlx.run(folder / "p.irl")


def curve() -> tuple[np.ndarray, np.ndarray]:
    """Points and tangent angles of SciPy's spline, straight beyond its ends, at FINE."""
    inside = np.clip(FINE, 0.0, WAY[-1])
    rate = SPLINE(inside, 1)
    tangent = rate / np.linalg.norm(rate, axis=1, keepdims=True)
    return SPLINE(inside) + (FINE - inside)[:, None] * tangent, np.arctan2(tangent[:, 1], tangent[:, 0])


def off_path(q: np.ndarray) -> tuple[float, float]:
    """Largest distance (m) of the platform from the curve, and angle (rad) to it, by SciPy and samples."""
    points, angles = curve()
    away, turned = [], []
    for x, y, phi in q[:, :3]:
        k = int(np.argmin(np.hypot(points[:, 0] - x, points[:, 1] - y)))
        tangent = np.array([np.cos(angles[k]), np.sin(angles[k])])
        away.append(abs(tangent[0] * (y - points[k, 1]) - tangent[1] * (x - points[k, 0])))
        turned.append(abs(np.angle(np.exp(1j * (phi - angles[k])))))
    return max(away), max(turned)


def assert_kept(run: irlx.Run, folder: Path) -> irlx.Report:
    report = irlx.verify(run, program=folder / "p.irl", cell=folder / "p.toml")
    assert report.passed, str(report)
    assert report["constraints"].status == "ok"
    assert report["constraints"].worst.constraint == "aisle"
    assert run.summary.path_position_error <= 1e-9
    return report


def test_the_platform_stays_on_its_curve_and_along_it(tmp_path: Path) -> None:
    free = ran(tmp_path, LINES, WITH_HEADING[: WITH_HEADING.index("[[constraint]]")])
    away, turned = off_path(free.q)
    assert away > 0.005
    assert turned > 0.05
    run = ran(tmp_path, LINES)
    away, turned = off_path(run.q)
    # The samples of this file are 0.1 mm apart.
    assert away <= 1e-7
    assert turned <= 2e-3
    assert np.ptp(run.q[:, 0]) > 0.2
    assert_kept(run, tmp_path)


def test_without_heading_the_platform_may_turn(tmp_path: Path) -> None:
    run = ran(tmp_path, LINES, CELL.format(heading=0))
    assert off_path(run.q)[0] <= 1e-7
    assert_kept(run, tmp_path)


def test_the_curve_holds_with_the_options(tmp_path: Path) -> None:
    konf = "VAR MAIN_JOINT: k := (0, 0, 26, 0, 30, 10, 0, 50, 0);"
    body = f"""  CYCLICSTART;
{LINES}
  CYCLICEND;
  RECONFIGURATION k;
  MOVE_INC LIN POSITION(200, 0, 0) WITH RECONFIGURATION k;"""
    run = ran(tmp_path, body, declarations=konf)
    assert off_path(run.q)[0] <= 1e-7
    report = assert_kept(run, tmp_path)
    assert report["cyclic closure"].worst.value <= CLOSURE


@pytest.mark.parametrize("joints", ["1, 2, 3", "1, 2", "1"])
def test_a_frozen_platform_stays_where_it_is_on_its_curve(tmp_path: Path, joints: str) -> None:
    """Its equations rest with it: as many joints may be frozen as without the constraint."""
    body = f"""  MOVE_INC LIN POSITION(200, 0, 0);
  FREEZESTART {joints};
  MOVE_INC LIN POSITION(100, 50, 0);
  MOVE_INC LIN POSITION(-100, -50, 0);
  FREEZEEND;
  MOVE_INC LIN POSITION(-200, 0, 0);"""
    run = ran(tmp_path, body)
    assert off_path(run.q)[0] <= 1e-7
    moves = list(dict.fromkeys(run.block[run.block > 0].tolist()))
    frozen = np.isin(run.block, moves[1:3])
    assert np.ptp(run.q[frozen, :3], axis=0).max() <= 1e-12
    assert np.ptp(run.q[~frozen, :3], axis=0).min() > 1e-3
    assert_kept(run, tmp_path)


def test_a_turn_that_is_frozen_keeps_a_heading_platform_from_driving(tmp_path: Path) -> None:
    """On a bend the platform turns as it drives: with its turn frozen it stands, and the arm has to move."""
    body = """  MOVE_INC LIN POSITION(400, 0, 0);
  FREEZESTART 3;
  MOVE_INC LIN POSITION(60, 30, 0);
  FREEZEEND;"""
    run = ran(tmp_path, body)
    moves = list(dict.fromkeys(run.block[run.block > 0].tolist()))
    last = run.block == moves[-1]
    assert np.ptp(run.q[last, :3], axis=0).max() <= 1e-8
    assert_kept(run, tmp_path)


def test_a_slow_platform_slows_the_tool_and_not_the_other_way(tmp_path: Path) -> None:
    """The path is sacred: where the platform cannot follow, both take their time."""
    slow = "(-20, -20, -2, -20, -20, -20, -20, -20, -20), (20, 20, 2, 20, 20, 20, 20, 20, 20)"
    run = ran(tmp_path, f"  JOINTSPEEDLIMIT {slow};\n  MOVE_INC LIN POSITION(80, 0, 0);")
    assert run.summary.slowed
    assert off_path(run.q)[0] <= 1e-7
    assert np.abs(run.qd[:, :2]).max() <= 0.02 * (1.0 + 1e-9)
    assert_kept(run, tmp_path)


def test_a_closed_path(tmp_path: Path) -> None:
    cell = CELL.format(heading=90).replace(
        "[[0, 0], [800, 200], [1600, -200], [2400, 300]]", f"{RING}\nclosed = true"
    )
    run = ran(tmp_path, LINES, cell)
    radius = np.hypot(run.q[:, 0] + 0.8, run.q[:, 1])
    # A spline through twelve points of a circle differs from it by 0.3 mm.
    assert np.ptp(radius) < 1e-3
    assert np.ptp(run.q[:, 1]) > 0.05
    assert_kept(run, tmp_path)


_TWELFTHS = np.arange(12) * np.pi / 6
RING = str(np.column_stack([800 * np.cos(_TWELFTHS) - 800, 800 * np.sin(_TWELFTHS)]).round(9).tolist())


def test_a_stream_that_leaves_the_path_fails(tmp_path: Path) -> None:
    run = ran(tmp_path, "  MOVE_INC LIN POSITION(300, 0, 0);")
    run.save(tmp_path / "p.npz")
    with np.load(tmp_path / "p.npz") as file:
        arrays = dict(file)
    original = arrays["q"].copy()
    for joint, unit in ((1, "m"), (2, "rad")):
        arrays["q"] = original.copy()
        arrays["q"][20, joint] += 4.0 * CONDITION
        np.savez(tmp_path / "p.npz", **arrays)
        found = irlx.verify(tmp_path / "p.npz", cell=tmp_path / "p.toml")["constraints"]
        assert found.status == "failed"
        assert (found.first.tick, found.first.constraint, found.worst.unit) == (20, "aisle", unit)
    arrays["q"] = original.copy()
    arrays["q"][:, 2] += np.pi
    np.savez(tmp_path / "p.npz", **arrays)
    turned = irlx.verify(tmp_path / "p.npz", cell=tmp_path / "p.toml")["constraints"]
    assert turned.worst.value == pytest.approx(np.pi, abs=1e-6)


def test_a_ptp_that_leaves_the_path_is_refused(tmp_path: Path) -> None:
    with pytest.raises(irlx.RunError) as refused:
        ran(tmp_path, "  MOVE PTP (800, 200, 0, 8, 25, 15, 10, 45, -8);", CELL.format(heading=0))
    assert refused.value.reason.code == "IRL351"
    run = ran(tmp_path, f"  MOVE PTP (0, 0, {HEADING}, 30, 25, 15, 10, 45, -8);")
    assert np.abs(run.q[-1, 3] - np.radians(30.0)) <= 1e-9


LINK = 'link = "platform"\n'
AT, PATH = "constraint[1]", "constraint[1].path"


@pytest.mark.parametrize(
    ("section", "code", "key", "says"),
    [
        ("path = [[0, 0], [1, 1]]", "IRL603", AT, "link beside path"),
        (f"{LINK}closed = true", "IRL603", AT, "one of joints, use, axis, path"),
        (f"{LINK}path = [[0, 0], [900, 0]]\nvalue = 1", "IRL603", AT, "no value beside path"),
        ("joints = { joint_1 = 1 }\nheading = true", "IRL603", AT, "no heading beside joints"),
        (f"{LINK}path = [[0, 0], [9, 0, 0]]", "IRL603", f"{PATH}[2]", ""),
        (f"{LINK}path = [[0, 0], [9, inf]]", "IRL603", f"{PATH}[2][2]", ""),
        ('link = "platfrom"\npath = [[0, 0], [900, 0]]', "IRL643", f"{AT}.link", "did you mean 'platform'"),
        (f"{LINK}path = []", "IRL626", PATH, "needs 2 points, found 0"),
        (f"{LINK}path = [[0, 0], [0.5, 0.5]]", "IRL626", PATH, "points 1 and 2"),
        (f"{LINK}path = [[0, 0], [9, 9]]\nclosed = true", "IRL626", PATH, "needs 3"),
        (f"{LINK}path = [[0, 0], [900, 0], [400, 0]]", "IRL627", PATH, "near to itself"),
        (f"{LINK}path = [[0, 10], [900, 10]]", "IRL619", AT, "10 mm off its path"),
        (f"{LINK}path = [[0, 0], [0, 900]]\nheading = true", "IRL619", AT, "-90 deg"),
        (f"{LINK}path = [[900, 0], [0, 0]]\nheading = true", "IRL619", AT, "180 deg"),
        # Whatever the joints do, the root stands where it is.
        ('link = "floor"\npath = [[0, 0], [900, 0]]', "IRL624", AT, "joints can move 0"),
    ],
)
def test_faults_of_a_cell(tmp_path: Path, section: str, code: str, key: str, says: str) -> None:
    text = CELL.format(heading=0)
    cell = text[: text.index("[[constraint]]")] + f'[[constraint]]\nname = "a"\n{section}\n'
    with pytest.raises(irlx.CellError) as caught:
        ran(tmp_path, "  MOVE_INC LIN POSITION(-100, 0, 0);", cell)
    found = {(d.code, d.place.key): d.message for d in caught.value.diagnostics}
    assert (code, key) in found
    assert says in found[code, key]


def test_the_page_that_helps_says_by_how_much(tmp_path: Path) -> None:
    """A start that follows what the message says keeps the heading."""
    with pytest.raises(irlx.CellError) as caught:
        ran(tmp_path, LINES, WITH_HEADING.replace(str(HEADING), "0"))
    words = caught.value.diagnostics[0].message
    turned = float(words[words.index("turned by ") + 10 : words.index(" deg")])
    ran(tmp_path, "  MOVE_INC LIN POSITION(20, 0, 0);", WITH_HEADING.replace(str(HEADING), str(-turned)))
