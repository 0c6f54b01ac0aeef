"""The virtual joints of a tolerance: in postures that are asked for, and dropped again from rows."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import irlx
from irlx.blocks import ToleranceClause
from irlx.pacing.posture_term import Asked
from irlx.pacing.rows import MotionRows, PathPart
from irlx.pacing.slowdown.clock_bounds import Governor
from irlx.pacing.slowing import Slowing
from irlx.pacing.tolerance import Widened, _weights, narrowed, widened


@pytest.fixture
def level(kit):
    """The gantry with its tool turned as the world is: the tool's place is rail + x, y, z."""
    return kit.shop(start=np.where(np.arange(7) > 3, 0.0, kit.start))


def widened_by(shop, bands, asked: Asked | None = None) -> Widened:
    clause = ToleranceClause(bands, shop.origin(1))
    situation = shop.pacer._situation
    return widened(situation, situation.in_force(), asked, clause, (situation.pose, situation.pose))


def test_postures_that_are_asked_for_stand_off_within_the_bands(level) -> None:
    """A posture whose tool is 4 mm off in x and 30 mm in y; bands of 10 mm each."""
    end, via = level.start.copy(), level.start.copy()
    end[:3] += [0.1, -0.096, -0.03]
    via[1] += 0.002
    found = widened_by(level, (0.01, 0.01, 0.0, 0.0, 0.0, 0.0), Asked(end, ((0.25, via),)))
    assert found.freed is not None
    assert found.asked is not None
    names = found.situation.robot.joint_names
    x, y = names.index("TOLERANCE dx"), names.index("TOLERANCE dy")
    (share, on_the_way), own = found.asked.on_the_way[0], found.freed.joints
    assert share == 0.25
    for posture, q, dx, dy in ((found.asked.end, end, 0.004, -0.01), (on_the_way, via, 0.002, 0.0)):
        assert posture.shape == (9,)
        assert np.array_equal(posture[own], q)
        np.testing.assert_allclose(posture[[x, y]], [dx, dy], atol=1e-12)


def test_without_bands_all_is_as_it_was(level) -> None:
    asked = Asked(level.start)
    found = widened_by(level, (0.0,) * 6, asked)
    assert found.freed is None
    assert found.asked is asked


def rows_of(block: str, q: np.ndarray, path: PathPart | None) -> MotionRows:
    n = len(q)
    nothing, poses = np.zeros(n), (np.zeros((n, 3)), np.zeros((n, 3, 3)))
    active = np.arange(q.size).reshape(q.shape).astype(np.int8)
    return MotionRows(block, 1, q, *poses, nothing, nothing, active, nothing, 1.0, 0, path=path)


def test_rows_of_the_robot_alone(kit, level) -> None:
    """What a virtual joint made slow no joint of the robot did: it is told as the path's own."""
    freed = widened_by(level, (0.01, 0.0, 0.0, 0.0, 0.0, 0.0)).freed
    assert freed is not None
    virtual = next(iter(set(range(8)) - set(freed.joints.tolist())))
    places = [int(freed.joints[2]), virtual, -1]
    told = tuple(Slowing(0, 1, 0.1, 0.5, 0.4, Governor.SPEED, joint, 0.2) for joint in places)
    path = PathPart(None, None, None, False, 0.0, True, told, np.ones(8, dtype=bool))
    q = np.random.default_rng(1).normal(size=(3, 8))
    rows = narrowed(rows_of("move", q, path), freed)
    assert np.array_equal(rows.q, q[:, freed.joints])
    np.testing.assert_allclose(rows.tool_position, [kit.position(row) for row in rows.q], atol=1e-12)
    assert rows.active.shape == (3, 7)
    assert rows.path is not None
    assert [found.joint for found in rows.path.slowings] == [2, -1, -1]
    assert rows.freed is not None
    assert np.array_equal(rows.freed.q[1:], q)
    assert narrowed(rows_of("joints", q, None), freed).path is None
    plain = rows_of("move", q, path)
    assert narrowed(plain, None) is plain


@pytest.mark.parametrize(("slide", "least"), [(0.1, 0.9), (2.0, 5.0)])
def test_virtual_joints_take_a_thousandth_of_the_cheapest_turn(slide: float, least: float) -> None:
    """A slide that reaches 3 m counts by the square of that, and a virtual slide the other way round."""
    axes = (SimpleNamespace(is_prismatic=True), SimpleNamespace(is_prismatic=False))
    robot, setup = SimpleNamespace(axes=axes, reach=3.0), SimpleNamespace(weights=np.array([slide, 5.0]))
    found = _weights(SimpleNamespace(robot=robot, setup=setup), np.array([0, 2]), {1: 1, 4: 3}, 4)
    np.testing.assert_allclose(found, [slide, 1e-3 * least / 9.0, 5.0, 1e-3 * least], rtol=1e-12)


@pytest.mark.req("MOT-20")
def test_a_narrow_band_costs_no_time(tmp_path) -> None:
    """A joint accelerates slowly, so that the move is planned: its bands are hardly more than none."""
    (tmp_path / "p.toml").write_text('[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 50\n')
    taken = []
    for dz in ("0", "1e-7"):
        (tmp_path / "p.irl").write_text(
            "PROGRAM p;\n"
            "VAR MAIN_JOINT_ACCEL_MIN: lo := (-8, -80, -100, -300, -420, -14, -18);\n"
            "  MAIN_JOINT_ACCEL_MAX: hi := (8, 80, 100, 300, 420, 14, 18);\n"
            "BEGIN\n  JOINTACCELLIMIT lo, hi;\n"
            "  MOVE LIN POSITION(453.65232, 302.42264, 411.290692) ACC := 815.922\n"
            f"    WITH TOLERANCE (180, 5, {dz}, 0, 1, 0);\n"
            "ENDPROGRAM;\n"
        )
        taken.append(len(irlx.run(tmp_path / "p.irl").q))
    assert taken[0] == taken[1]
