"""Blocks that cannot be executed: the code, its place, its data, and a state that stays as it was."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import LimitKind, MoveKind
from irlx.diagnostics import IrlxError


class Refused:
    """Runs what must fail and checks that posture, tick and options stay."""

    def __init__(self, shop) -> None:
        self.shop = shop
        self.pacer = shop.pacer
        self.before = (self.pacer.q.tobytes(), self.pacer.tick, self.pacer.options)

    def __call__(self, action, code: str, line: int):
        with pytest.raises(IrlxError) as caught:
            action()
        assert (self.pacer.q.tobytes(), self.pacer.tick, self.pacer.options) == self.before
        reason = caught.value.reason
        assert reason.code == code
        assert reason.place.line == line
        return reason


@pytest.fixture
def refused(shop) -> Refused:
    return Refused(shop)


@pytest.mark.req("LANG-60")
@pytest.mark.parametrize("kind", LimitKind)
def test_crossed_range_is_refused(kit, shop, refused, kind: LimitKind) -> None:
    upper = np.full(7, 1.0)
    lower = np.array([-1.0, 2.0, -1, -1, -1, 1.5, -1])
    reason = refused(lambda: shop.switch(kind, kit.range(upper, lower)), "IRL340", 1)
    per = {"POSITION": "", "SPEED": "/s", "ACCELERATION": "/s2"}[kind.value]
    assert (
        reason.data["joints"] == f"x (2000 mm{per} to 1000 mm{per}), b (85.9437 deg{per} to 57.2958 deg{per})"
    )


@pytest.mark.req("LANG-60")
@pytest.mark.parametrize("kind", [LimitKind.SPEED, LimitKind.ACCELERATION])
def test_rate_without_standstill_is_refused(kit, shop, refused, kind: LimitKind) -> None:
    clause = shop.clause(kind, kit.range(1.0, [-1, -1, 0.5, -1, 0.0, -1, -1]), 9)
    action = lambda: shop.line(kit.position(kit.start) + 0.1, clauses=[clause])  # noqa: E731
    reason = refused(action, "IRL342", 9)
    assert reason.data["joints"].startswith("y (500 mm")
    assert "a (" not in reason.data["joints"]


@pytest.mark.req("LANG-60")
def test_range_wider_than_the_robots_warns_and_does_not_widen(kit, shop) -> None:
    shop.switch(LimitKind.POSITION, kit.range([9, 1, 1, 9, 1, 1, 1]))
    (warning,) = shop.pacer.warnings
    assert warning.code == "IRL341"
    assert not warning.is_error
    assert warning.place.line == 1
    assert warning.data["joints"] == "rail, z"
    reason = Refused(shop)(lambda: shop.to([6.0, 0, 0, 0, 0, 0, 0], duration=9.0), "IRL424", 2)
    assert reason.data["upper"] == "5000 mm"


@pytest.mark.req("LANG-60")
def test_range_equal_to_the_robots_but_for_rounding_does_not_warn(kit, shop) -> None:
    shop.switch(LimitKind.POSITION, kit.range(np.nextafter(5.0, 6.0)))
    assert shop.pacer.warnings == []


@pytest.mark.req("LANG-60")
@pytest.mark.parametrize("by", ["switch", "clause"])
def test_joint_outside_a_limit_that_begins_is_refused(kit, shop, refused, by: str) -> None:
    bounds = kit.range([1, 0.4, 1, 1, 1, 1, 1])
    if by == "switch":
        reason = refused(lambda: shop.switch(LimitKind.POSITION, bounds), "IRL345", 1)
    else:
        clause = shop.clause(LimitKind.POSITION, bounds, 5)
        reason = refused(lambda: shop.line([0.6, 0, 0], clauses=[clause]), "IRL345", 5)
    assert reason.data == {"joint": "x", "value": "500 mm", "side": "above", "bound": "400 mm"}


@pytest.mark.req("LANG-60")
def test_joint_exactly_on_a_limit_that_begins_is_fine(kit, shop) -> None:
    shop.switch(LimitKind.POSITION, kit.range(np.maximum(np.abs(kit.start), 1e-300)))
    assert shop.pacer.options.limits


@pytest.mark.req("LANG-60")
def test_joint_left_outside_the_switch_by_a_wider_clause_is_refused(kit, shop) -> None:
    """The clause lets x go where the switch forbids it; the next move begins outside the switch."""
    shop.switch(LimitKind.POSITION, kit.range([1.0, 0.6, 1, 1, 1, 1, 1]))
    clause = shop.clause(LimitKind.POSITION, kit.range(2.0), 2)
    shop.freeze(1)
    shop.line(kit.beyond(0.4, 0.0, 0.0), clauses=[clause])
    shop.freeze()
    reason = Refused(shop)(lambda: shop.line(kit.beyond(0.4, 0.1, 0.0)), "IRL345", 5)
    assert reason.data["joint"] == "x"


@pytest.mark.req("LANG-63")
def test_freezing_a_joint_there_is_not_or_too_many_is_refused(shop, refused) -> None:
    assert refused(lambda: shop.freeze(2, 8), "IRL346", 1).data == {"number": 8, "joints": 7}
    assert refused(lambda: shop.freeze(0), "IRL346", 2).data["number"] == 0
    reason = refused(lambda: shop.freeze(1, 5), "IRL347", 3)
    assert reason.data == {"frozen": 2, "joints": 7, "spare": 1, "rows": 6}
    shop.freeze(5, 5)
    assert shop.pacer.options.frozen == (5, 5)


@pytest.mark.req("LANG-63")
def test_ptp_of_a_frozen_joint_is_refused(kit, shop) -> None:
    shop.freeze(5)
    reason = Refused(shop)(lambda: shop.to(kit.start + 0.1 * np.eye(7)[4], duration=2.0), "IRL343", 2)
    assert reason.data == {"joint": "a"}
    assert shop.to(kit.start + 0.1 * np.eye(7)[1], duration=2.0) is not None


@pytest.mark.req("MOT-05")
@pytest.mark.parametrize("kind", MoveKind)
def test_joint_target_outside_its_limits_is_refused(kit, shop, refused, kind: MoveKind) -> None:
    target = kit.start.copy()
    target[[1, 5]] = 5.5, -5.25
    action = lambda: shop.to(target, kind)  # noqa: E731
    with pytest.raises(IrlxError) as caught:
        action()
    assert [d.data["joint"] for d in caught.value.diagnostics] == ["x", "b"]
    reason = refused(action, "IRL424", 2)
    assert reason.data == {"joint": "x", "value": "5500 mm", "lower": "-5000 mm", "upper": "5000 mm"}


@pytest.mark.req("MOT-05")
def test_ptp_to_a_pose_out_of_reach_says_what_is_missing(kit, shop, refused) -> None:
    """Rail and x end at 5 m each, so 12 m are missed by 2 m."""
    reason = refused(lambda: shop.ptp_pose([12.0, 0.0, 0.0]), "IRL522", 1)
    assert float(reason.data["distance"]) == pytest.approx(2000.0, rel=1e-3)
    assert float(reason.data["angle"]) == pytest.approx(0.0, abs=1e-2)


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize(
    ("action", "code"),
    [
        (lambda shop, p: shop.line(p + 1.0, duration=0.1), "IRL421"),
        (lambda shop, p: shop.line(p, Rotation.from_euler("ZYX", [0.1, -0.2, 0.3 + np.pi])), "IRL422"),
        (lambda shop, p: shop.to(np.zeros(7)), "IRL423"),
    ],
)
def test_moves_that_cannot_be_planned_leave_the_state(kit, shop, refused, action, code: str) -> None:
    refused(lambda: action(shop, kit.position(kit.start)), code, 1)


@pytest.mark.req("MOT-20")
def test_acceleration_that_ends_the_motion_too_hard_slows_it(kit) -> None:
    """The line asks for 2 m/s2 of a joint that has 1.9: its ramps get longer, nothing is broken."""
    shop = kit.shop(limits=kit.limits(5.0, 3.0, [5.0, 5.0, 1.9, 5, 5, 5, 5]))
    rows = shop.line(kit.beyond(0.0, 0.5, 0.0))
    accelerations = np.diff(np.vstack([kit.start, kit.start, rows.q]), n=2, axis=0) / shop.dt**2
    assert np.max(np.abs(accelerations[:, 2])) <= 1.9 * (1.0 + 1e-9)
    assert len(rows) * shop.dt == pytest.approx(0.5 / 0.5 + 0.5 / 1.9, abs=3.0 * shop.dt)
