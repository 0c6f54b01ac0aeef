"""RECONFIGURATION and WITH RECONFIGURATION on a gantry with a rail: nearest postures are closed form."""

from types import SimpleNamespace

import numpy as np
import pytest

from irlx.blocks import JointTarget, LimitKind, MoveBlock, MoveKind, PoseTarget, ReconfigureBlock
from irlx.diagnostics import CATALOGUE, Place
from irlx.pacing import reconfigure as reconfigure_module
from irlx.pacing.errors import PacingError
from irlx.pacing.reconfigure import _curve_through, _planned
from irlx.pacing.row_check import BrokenBound, broken_bound
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.planned import PlannedMotion, Refusal
from irlx.robot.kinematics import Kinematics
from irlx.transform.clearance import TooNear


def reconfigure(shop, values, **law):
    target = JointTarget(tuple(float(value) for value in values))
    return shop.execute(ReconfigureBlock(**shop._data(), target=target, law=shop.law(**law)))


def move(shop, kind, target, konf, **law):
    konf = JointTarget(tuple(float(value) for value in konf))
    return shop.execute(
        MoveBlock(**shop._data(), kind=kind, target=target, law=shop.law(**law), reconfiguration=konf)
    )


def codes(shop):
    return [warning.code for warning in shop.pacer.warnings]


def shifted(kit, way):
    """The start posture with the rail moved by `way` and x moved back."""
    return kit.moved(way, -way, 0, 0, 0, 0, 0)


def nearest(kit, q, konf, weights=(3.0, 1.0)):
    """Closed form: the tool keeps rail + x; the miss is shared against the weights."""
    rail, x = weights
    miss = (q[0] + q[1]) - (konf[0] + konf[1])
    end = q.copy()
    end[0], end[1] = konf[0] + miss * x / (rail + x), konf[1] + miss * rail / (rail + x)
    return end


@pytest.mark.req("LANG-65")
@pytest.mark.req("TRF-15")
@pytest.mark.parametrize("dt", [0.001, 0.01, 0.05])
def test_a_posture_of_the_same_pose_is_reached_exactly(kit, dt):
    bounds = kit.limits(speed=0.8, acceleration=3.0)
    shop = kit.shop(bounds, dt)
    konf = shifted(kit, 1.0)
    rows = reconfigure(shop, konf)
    assert rows.q[-1].tobytes() == konf.tobytes()
    assert rows.q[-2].tobytes() == konf.tobytes()
    assert rows.path_position_error.max() <= 1e-12
    assert rows.path_orientation_error.max() <= 1e-12
    assert broken_bound(kit.start, rows.q, bounds, dt) is None
    assert np.all(np.diff(rows.q[:, 0]) >= 0.0)
    # A ramp, a cruise at 0.8 and a ramp take 1.52 s; half the acceleration is kept in reserve.
    assert 1.5 <= len(rows) * dt <= 2.2
    assert shop.pacer.warnings == []
    assert np.array_equal(shop.pacer.q, konf)
    assert shop.pacer.tick == len(rows)
    # The way is as long as the path of the joints: rail and x go 1 each.
    assert rows.length == rows.s[-1] == pytest.approx(2.0**0.5)


@pytest.mark.req("LANG-65")
def test_the_nearest_posture_and_the_distance_left(kit, shop):
    konf = kit.moved(1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    rows = reconfigure(shop, konf)
    assert np.max(np.abs(rows.q[-1] - nearest(kit, kit.start, konf))) < 1e-9
    assert codes(shop) == ["IRL349"]
    (warning,) = shop.pacer.warnings
    assert "rail 250 mm, x 750 mm are left" in warning.message
    assert warning.place.line_and_column == (1, 1)


@pytest.mark.req("LANG-65")
def test_joints_that_the_pose_holds_stay(kit, shop):
    rows = reconfigure(shop, kit.moved(0.5, -0.5, 0.2, 0, 0.1, 0, 0))
    assert np.max(np.abs(rows.q[-1] - shifted(kit, 0.5))) < 1e-9
    assert np.max(np.abs(rows.q[:, 2:] - kit.start[2:])) < 1e-12
    assert "y 200 mm, a 5.72958 deg are left" in shop.pacer.warnings[0].message


def test_beyond_a_limit_the_nearest_inside(kit, shop):
    shop.switch(LimitKind.POSITION, kit.range([0.4, 1, 1, 1, 1, 1, 1]))
    assert codes(shop) == []
    konf = shifted(kit, 0.7)
    rows = reconfigure(shop, konf)
    assert rows.q[-1][0] == 0.4
    assert abs(rows.q[-1][1] - 0.1) < 1e-12
    assert codes(shop) == ["IRL350", "IRL349"]
    assert "rail at 700 mm, outside its limits -400 mm to 400 mm" in shop.pacer.warnings[0].message
    assert np.all(rows.q[:, 0] <= 0.4)
    assert rows.limits.position_upper[0] == 0.4


def test_frozen_joints_stay_and_are_named(kit, shop):
    shop.freeze(1)
    assert reconfigure(shop, shifted(kit, 0.3)) is None
    assert codes(shop) == ["IRL349"]
    assert "rail is frozen or may not move" in shop.pacer.warnings[0].message
    assert shop.pacer.tick == 0


def test_a_joint_that_may_not_move_stays(kit, shop):
    speeds = np.full(7, 1.0)
    speeds[1] = 0.0
    shop.switch(LimitKind.SPEED, kit.range(speeds))
    assert reconfigure(shop, shifted(kit, 0.3)) is None
    assert "x is frozen or may not move" in shop.pacer.warnings[0].message


def test_the_present_posture_takes_no_tick(kit, shop):
    assert reconfigure(shop, kit.start) is None
    assert reconfigure(shop, kit.start + 1e-16) is None
    assert shop.pacer.warnings == []


@pytest.mark.req("LANG-65")
@pytest.mark.parametrize("way", [2e-10, 1e-9, 3e-9])
def test_a_way_of_a_rounding_is_gone(kit, way):
    """A flow stands still at most points of a way so short; the curve through them ended in an error."""
    shop = kit.shop(kit.limits(speed=0.8, acceleration=3.0), 0.004)
    konf = shifted(kit, way)
    rows = reconfigure(shop, konf)
    assert rows.q[-1].tobytes() == konf.tobytes()
    assert 2 <= len(rows) <= 5


def test_a_curve_through_points_where_a_flow_stood_still():
    rng = np.random.default_rng(1)
    first, last = rng.normal(size=4), rng.normal(size=4)
    for stood in (1, 3, 7):
        points = np.vstack([np.tile(first, (stood + 1, 1)), np.linspace(first, last, 9 - stood)[1:]])
        curve = _curve_through(points)
        assert len(curve.s) == 9
        assert np.all(np.diff(curve.s) > 0.0)
        assert curve.q[0].tobytes() == first.tobytes()
        assert curve.q[-1].tobytes() == last.tobytes()
        np.testing.assert_allclose(curve.s[-1], np.linalg.norm(last - first), rtol=1e-14)
        np.testing.assert_allclose(np.diff(curve.q, 2, axis=0), 0.0, atol=1e-14)


def test_joints_without_limits_move_with_the_programmed_speed(kit, shop):
    rows = reconfigure(shop, shifted(kit, 2.0), speed=0.25)
    speeds = np.diff(np.vstack([kit.start, rows.q]), axis=0) / shop.dt
    accelerations = np.diff(speeds, axis=0) / shop.dt
    assert 0.24 < np.abs(speeds).max() <= 0.25 * (1 + 1e-9)
    assert np.abs(accelerations).max() <= 0.25 / 0.2 * (1 + 1e-9)


def test_outside_a_limit_that_holds_again_nothing_moves(kit, shop):
    clause = shop.clause(LimitKind.POSITION, kit.range(5.0), 1)
    shop.switch(LimitKind.POSITION, kit.range(1.0))
    shop.to(kit.moved(2.0, 0, 0, 0, 0, 0, 0), clauses=[clause], duration=2.0)
    with pytest.raises(PacingError) as caught:
        reconfigure(shop, kit.start)
    assert caught.value.diagnostics[0].code == "IRL345"


# ---- WITH RECONFIGURATION


def pose_beyond(kit, *way):
    return PoseTarget(tuple(float(value) for value in kit.beyond(*way)), None)


@pytest.mark.req("LANG-62")
def test_a_line_ends_in_the_posture_and_cyclic_comes_back(kit, shop):
    shop.cyclic()
    konf = kit.moved(0.6, -0.4, 0, 0, 0, 0, 0)
    rows = move(shop, MoveKind.LIN, pose_beyond(kit, 0.2, 0, 0), konf)
    assert np.max(np.abs(rows.q[-1] - konf)) < 1e-9
    assert shop.pacer.warnings == []
    # Back to where the cyclic option was switched on: the posture of that moment returns.
    back = shop.line(kit.beyond(0, 0, 0))
    assert np.max(np.abs(back.q[-1] - kit.start)) < 1e-6


def test_a_line_to_a_pose_that_the_posture_does_not_have(kit, shop):
    konf = kit.moved(1.0, 0, 0, 0, 0, 0, 0)
    rows = move(shop, MoveKind.LIN, pose_beyond(kit, 0.2, 0, 0), konf)
    assert np.max(np.abs(rows.q[-1] - nearest(kit, kit.moved(0.2, 0, 0, 0, 0, 0, 0), konf))) < 1e-8
    assert codes(shop) == ["IRL349"]
    assert "rail 200 mm, x 600 mm are left" in shop.pacer.warnings[0].message


def test_the_clause_comes_before_the_posture_of_the_target(kit, shop):
    target = JointTarget(tuple(kit.moved(0.2, 0, 0, 0, 0, 0, 0).tolist()))
    konf = kit.moved(-0.3, 0.5, 0, 0, 0, 0, 0)
    rows = move(shop, MoveKind.LIN, target, konf)
    assert np.max(np.abs(rows.q[-1] - konf)) < 1e-9
    assert shop.pacer.warnings == []


def test_a_move_of_no_length_leaves_the_posture(kit, shop):
    assert move(shop, MoveKind.LIN, pose_beyond(kit, 0, 0, 0), shifted(kit, 0.2)) is None
    assert codes(shop) == ["IRL349"]
    assert "the statement RECONFIGURATION" in shop.pacer.warnings[0].message


@pytest.mark.req("LANG-69")
def test_ptp_to_a_pose_ends_near_the_posture(kit, shop):
    konf = kit.moved(0.7, -0.4, 0, 0, 0, 0, 0)
    rows = move(shop, MoveKind.PTP, pose_beyond(kit, 0.3, 0, 0), konf, duration=2.0)
    assert np.max(np.abs(rows.q[-1] - konf)) < 1e-6
    assert shop.pacer.warnings == []


@pytest.mark.req("LANG-69")
def test_ptp_to_joint_values_takes_these(kit, shop):
    target = kit.moved(0.2, 0, 0, 0, 0, 0, 0)
    joints = JointTarget(tuple(target.tolist()))
    rows = move(shop, MoveKind.PTP, joints, kit.start, duration=2.0)
    assert np.array_equal(rows.q[-1], target)
    assert codes(shop) == ["IRL349"]
    assert "a posture itself" in shop.pacer.warnings[0].message


def test_codes_are_warnings():
    assert not any(CATALOGUE[code].severity.name == "ERROR" for code in ("IRL349", "IRL350"))


# ---- the plan, its stages answered by hand


class Flow:
    """A way whose points tell how far inside they keep."""

    points = "as it is"

    def further_inside(self, widening):
        return widening


BROKEN = Refusal(0.3, broken=BrokenBound(7, 0, LimitKind.POSITION, 1.1, 1.0))


def planned_on(answers, monkeypatch, kit, clearance=None):
    """What `_planned` makes of these answers, with the points that it asked for."""
    asked = []

    def on_curve(model, points, ticking):
        asked.append(points)
        return answers[len(asked) - 1]

    monkeypatch.setattr(reconfigure_module, "_on_curve", on_curve)
    kinematics = Kinematics(kit.gantry())
    model = Model(kinematics, kit.limits(), np.ones(7), np.ones(7, dtype=bool), clearance)
    return lambda: _planned(model, Flow(), None, 10, Place("t.irl")), asked


def test_a_curve_that_swings_beyond_a_limit_is_laid_further_inside_until_it_does_not(kit, monkeypatch):
    for refused in range(4):
        made = PlannedMotion(None, None, None, 1.0)
        run, asked = planned_on([BROKEN] * refused + [made], monkeypatch, kit)
        assert run() is made
        assert asked == ["as it is", 4.0, 16.0, 64.0][: refused + 1]
    run, asked = planned_on([BROKEN] * 4, monkeypatch, kit)
    with pytest.raises(PacingError) as caught:
        run()
    assert caught.value.diagnostics[0].code == "IRL523"
    assert caught.value.diagnostics[0].data["tick"] == 17
    assert len(asked) == 4


def test_what_comes_too_near_is_told_with_its_tick_and_no_other_curve_is_tried(kit, monkeypatch):
    pair = SimpleNamespace(link="l3", other="wall", obstacle=None)
    clearance = SimpleNamespace(distances=SimpleNamespace(pairs=[None, pair]))
    near = Refusal(0.3, near=TooNear(1, 0.0199, 0.02), tick=5)
    run, asked = planned_on([near], monkeypatch, kit, clearance)
    with pytest.raises(PacingError) as caught:
        run()
    told = caught.value.diagnostics[0]
    assert (told.code, told.data["tick"]) == ("IRL561", 15)
    assert "'wall'" in told.data["pair"]
    assert asked == ["as it is"]
