"""Circles from the program's text to the verified stream, on the packaged robot."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx

pytestmark = [pytest.mark.req("MOT-01"), pytest.mark.req("MOT-11"), pytest.mark.req("MOT-20")]

# The tool of the start posture stands at (11500, 1000, 3500) mm, not turned.
DECLARATIONS = """VAR POSITION: top := (11400, 1000, 3600), far := (11300, 1000, 3500),
  side := (11400, 1100, 3500);
POSE: tilted := ((11300, 1000, 3500), ORIZYX(10, 0, 0)), turned := ((11400, 1000, 3600), ORIZYX(0, 20, 0));
MAIN_JOINT: j;"""


def text_of(body):
    return f"PROGRAM p;\n{DECLARATIONS}\nBEGIN\n{body}\nENDPROGRAM\n"


@pytest.fixture
def ran(folder):
    """Run of a body with the folder's cell; verified."""

    def run(body):
        (folder / "p.irl").write_text(text_of(body), encoding="utf-8")
        done = irlx.run(folder / "p.irl")
        assert [str(d) for d in done.diagnostics if d.code != "IRL621"] == []
        report = irlx.verify(done)
        assert report.passed, str(report)
        return done

    return run


def off_circle(positions):
    """Largest distance of positions (N, 3) from the circle through their first, and top and far.

    The start posture's tool is some 1e-9 m beside its round numbers: the circle begins where it is.
    """
    start, top, far = positions[0], np.array([11.4, 1.0, 3.6]), np.array([11.3, 1.0, 3.5])
    plane = np.array([top - start, far - start, np.cross(top - start, far - start)])
    centre = start + np.linalg.solve(plane, [0.5 * plane[0] @ plane[0], 0.5 * plane[1] @ plane[1], 0.0])
    axis = plane[2] / np.linalg.norm(plane[2])
    radii = np.linalg.norm(positions - centre, axis=1)
    return max(
        np.max(np.abs(radii - np.linalg.norm(start - centre))), np.max(np.abs((positions - centre) @ axis))
    )


def test_program_text_to_verified_stream(inside, folder, names):
    body = """  CYCLICSTART;
  MOVE CIRCLE top, tilted SPEED := 300;
  MOVE CIRCLE top, far ANGLE := -540 CIRC_ORI := 'END';
  MOVE LIN far;
  MOVE CIRCLE turned, POSITION(11500, 1000, 3500) CIRC_ORI := 'VIA' TIME := 4;
  CYCLICEND;"""
    (folder / "p.irl").write_text(text_of(body), encoding="utf-8")
    done = inside("run", "p.irl", "-o", "p.irdata", "-o", "p.npz")
    assert done.returncode == 1  # the third point of the second circle is its start
    assert "IRL427" in done.stderr
    (folder / "p.irl").write_text(
        text_of(body.replace("top, far ANGLE", "top, side ANGLE")), encoding="utf-8"
    )
    done = inside("run", "p.irl", "--tick", "100", "-o", "p.irdata", "-o", "p.npz")
    assert done.returncode == 0, done.stderr
    assert done.stdout.count(" checks passed") == 2
    assert {"p.irdata", "p.npz"} <= set(names(folder))
    checked = inside("verify", "p.irdata", "--json")
    assert checked.returncode == 0, checked.stdout
    assert json.loads(checked.stdout)["passed"] is True
    listed = inside("blocks", "p.irl").stdout.splitlines()
    assert listed[2].startswith(
        "3 MOVE CIRCLE via (11400 1000 3600) kept in R_BASE to (11400 1100 3500) kept"
    )
    assert "angle -540 deg" in listed[2]


def test_a_half_circle_lies_on_it(ran):
    run = ran("  MOVE CIRCLE top, far;")
    assert off_circle(run.tool[:, :3]) < 1e-12 * 11.5
    assert run.tool[:, 2].max() == pytest.approx(3.6, abs=1e-3)
    np.testing.assert_allclose(run.tool[-1, :3], [11.3, 1.0, 3.5], atol=1e-12)


@pytest.mark.parametrize("angle", ["360", "720", "-360"])
def test_a_full_circle_comes_back_to_where_it_began(ran, angle):
    run = ran(f"  CYCLICSTART;\n  MOVE CIRCLE top, far ANGLE := {angle};\n  CYCLICEND;")
    assert off_circle(run.tool[:, :3]) < 1e-12 * 11.5
    np.testing.assert_allclose(run.tool[-1], run.tool[0], atol=1e-12)
    assert np.max(np.abs(run.q[-1] - run.q[0])) < 1e-6
    # Forward over the top, or backwards over the bottom; as many rounds as asked for.
    height = run.tool[:, 2] - 3.5
    assert np.sign(height[3]) == np.sign(float(angle))
    turns = np.unwrap(np.arctan2(height, run.tool[:, 0] - 11.4))
    assert turns[-1] - turns[0] == pytest.approx(np.radians(float(angle)), abs=1e-7)


def test_speed_and_normal_acceleration(ran):
    """SPEED 1000 mm/s on a radius of 100 mm would be 10 m/s2: ACC 2000 mm/s2 allows sqrt(0.2) m/s."""
    run = ran("  MOVE CIRCLE top, far ANGLE := 720;")
    speed = np.linalg.norm(np.diff(run.tool[:, :3], axis=0), axis=1) / 0.05
    allowed = np.sqrt(2.0 * 0.1)
    assert speed.max() <= allowed * (1 + 1e-9)
    assert speed.max() > 0.97 * allowed


@pytest.mark.req("MOT-02")
def test_orientation_turns_in_step_or_through_via(ran):
    run = ran("  MOVE CIRCLE turned, tilted;")
    turns = Rotation.from_quat(run.tool[:, 3:]).as_rotvec()
    assert np.max(np.abs(turns[:, :2])) < 1e-9
    assert turns[-1, 2] == pytest.approx(np.radians(10))
    run = ran("  MOVE CIRCLE turned, tilted CIRC_ORI := 'VIA' TIME := 4;")
    middle = np.argmin(np.linalg.norm(run.tool[:, :3] - [11.4, 1.0, 3.6], axis=1))
    turn = Rotation.from_quat(run.tool[middle, 3:]).as_rotvec()
    np.testing.assert_allclose(turn, [0, np.radians(20), 0], atol=2e-3)
    last = Rotation.from_quat(run.tool[-1, 3:]).as_rotvec()
    np.testing.assert_allclose(last, [0, 0, np.radians(10)], atol=1e-12)


@pytest.mark.req("LANG-69")
def test_a_circle_to_joint_values_ends_in_that_posture(ran):
    body = "  j := R_JOINT_ACT.M_JOINT;\n  MOVE CIRCLE top, far;\n  MOVE CIRCLE side, j TIME := 4;"
    run = ran(body)
    np.testing.assert_allclose(run.q[-1], run.q[0], atol=1e-6)
    # By ANGLE the move ends elsewhere: the posture gives its pose only, and nothing is warned about.
    run = ran(
        "  j := R_JOINT_ACT.M_JOINT;\n  MOVE CIRCLE top, far;\n  MOVE CIRCLE side, j ANGLE := 90 TIME := 4;"
    )
    np.testing.assert_allclose(run.tool[-1, :3], [11.4, 1.1, 3.5], atol=1e-9)


@pytest.mark.parametrize(
    ("body", "code", "marked"),
    [
        ("  MOVE CIRCLE top, POSITION(11500, 1000, 3500);", "IRL427", "MOVE CIRCLE top"),
        ("  MOVE CIRCLE POSITION(11400, 1000, 3500), far;", "IRL428", "MOVE CIRCLE POSITION"),
        ("  MOVE CIRCLE turned, far ANGLE := 80 CIRC_ORI := 'VIA';", "IRL429", "MOVE CIRCLE turned"),
        ("  MOVE CIRCLE top, far TIME := 0.2;", "IRL421", "MOVE CIRCLE top"),
        ("  MOVE CIRCLE top, far, top, far;", "IRL427", "top, far"),
    ],
)
def test_what_is_wrong_is_placed(folder, body, code, marked):
    (folder / "p.irl").write_text(text_of(body), encoding="utf-8")
    with pytest.raises(irlx.IrlxError) as caught:
        irlx.run(folder / "p.irl")
    reason = next(d for d in caught.value.diagnostics if d.code == code)
    place = reason.place
    assert place.text.text[place.span.start :].startswith(marked)
