"""WITH RECONFIGURATION with a posture for the via point of a CIRCLE, on a gantry: closed form postures."""

from math import pi

import numpy as np
import pytest

from irlx.blocks import ArcCourse, JointTarget, LimitKind, MoveBlock, MoveKind, PoseTarget
from irlx.pacing.posture_term import Asked
from irlx.pacing.row_check import broken_bound
from long_run import first

pytestmark = [pytest.mark.req("LANG-62"), pytest.mark.req("LANG-68")]

RADIUS = 0.5
WEIGHTS = np.array([3.0, 1.0])


def target(point):
    return PoseTarget(tuple(float(c) for c in point), None)


def joints(values):
    return None if values is None else JointTarget(tuple(float(value) for value in values))


def circle(shop, kit, via_konf, konf, via=0.4 * pi, end=1.2 * pi, angle=None, **law):
    """CIRCLE about z of `RADIUS` from the start; via and end point at angles from it."""
    centre = kit.position(shop.pacer.q) - np.array([RADIUS, 0, 0])

    def at(phi):
        return target(centre + RADIUS * np.array([np.cos(phi), np.sin(phi), 0.0]))

    course = ArcCourse(at(via), angle, via_reconfiguration=joints(via_konf))
    data = {"target": at(end), "course": course, "reconfiguration": joints(konf), "law": shop.law(**law)}
    return shop.execute(MoveBlock(**shop._data(), kind=MoveKind.CIRCLE, **data))


def konfs(kit):
    """A posture for the via point that is far from both others, and one for the end."""
    return kit.moved(0.6, -0.9, 0, 0, 0, 0, 0), kit.moved(-0.3, -0.4, 0, 0, 0, 0, 0)


def hermite(knots, values, x):
    """Fritsch's and Butland's monotone cubic through three points, written out; of one joint."""
    h, slopes = np.diff(knots), np.diff(values) / np.diff(knots)

    def end(h0, h1, m0, m1):
        d = ((2.0 * h0 + h1) * m0 - h0 * m1) / (h0 + h1)
        if d * m0 <= 0.0:
            return 0.0
        return 3.0 * m0 if m0 * m1 <= 0.0 and abs(d) > 3.0 * abs(m0) else d

    middle = 0.0
    if slopes[0] * slopes[1] > 0.0:
        w0, w1 = 2.0 * h[1] + h[0], h[1] + 2.0 * h[0]
        middle = (w0 + w1) / (w0 / slopes[0] + w1 / slopes[1])
    rates = [end(h[0], h[1], *slopes), middle, end(h[1], h[0], slopes[1], slopes[0])]
    i = int(x > knots[1])
    t = (x - knots[i]) / h[i]
    lower, upper = (1 + 2 * t) * (1 - t) ** 2, t * t * (3 - 2 * t)
    bent = h[i] * (t * (1 - t) ** 2 * rates[i] - t * t * (1 - t) * rates[i + 1])
    return lower * values[i] + upper * values[i + 1] + bent


def nearest_rail(tool_x, konf_rail, konf_x):
    """Rail of the posture with the tool at x that is nearest to (rail, x): the miss is shared by weights."""
    return konf_rail + (tool_x - konf_rail - konf_x) * WEIGHTS[1] / WEIGHTS.sum()


def codes(shop):
    return [warning.code for warning in shop.pacer.warnings]


def row_at(rows, share):
    """Row that is nearest to a share of the way."""
    return rows.q[int(np.argmin(np.abs(rows.s / rows.length - share)))]


@pytest.mark.req("TRF-15")
@pytest.mark.parametrize(("via", "dt"), [(0.1 * pi, 0.05), (0.4 * pi, 0.01), (1.1 * pi, 0.05)])
def test_every_row_is_the_nearest_to_a_cubic_through_both_postures(kit, dt, via):
    shop = kit.shop(kit.limits(), dt)
    via_konf, konf = konfs(kit)
    rows = circle(shop, kit, via_konf, konf, via=via)
    knots = np.array([0.0, via / (1.2 * pi), 1.0])
    for share, q in zip(rows.s / rows.length, rows.q, strict=True):
        rail, x = (hermite(knots, np.array([kit.start[j], via_konf[j], konf[j]]), share) for j in (0, 1))
        assert abs(q[0] - nearest_rail(q[0] + q[1], rail, x)) < 1e-9


def test_the_posture_counts_where_the_via_point_is_and_not_at_the_end(kit):
    via_konf, konf = konfs(kit)
    plain, led = kit.shop(), kit.shop()
    rows = circle(plain, kit, None, konf), circle(led, kit, via_konf, konf)
    away = [np.abs(row_at(r, 1 / 3) - via_konf)[0] for r in rows]
    assert away[1] < 0.1 * away[0]
    assert np.max(np.abs(rows[0].q[-1] - rows[1].q[-1])) < 1e-9
    # What is left at the end is told, of the via point nothing.
    assert codes(plain) == codes(led) == ["IRL349"]
    assert plain.pacer.warnings[0].message == led.pacer.warnings[0].message


def test_without_one_the_reference_is_the_straight_one(kit):
    """As in streams of versions that knew no posture for the via point, bit by bit."""
    start, _ = kit.start, None
    end = kit.moved(0.1, 0.2, 0.3, 0, 0, 0, 0)
    reference = Asked(end).reference(start)
    for share in (0.0, 1 / 3, 0.7, 1.0):
        assert reference(share).tobytes() == (start + share * (end - start)).tobytes()


def test_the_reference_runs_smoothly_and_never_beyond_its_postures():
    rng = np.random.default_rng(5)
    for _ in range(30):
        start, via, end = rng.normal(size=(3, 7))
        at = rng.uniform(0.02, 0.98)
        reference = Asked(end, ((at, via),)).reference(start)
        for share, posture in ((0.0, start), (at, via), (1.0, end)):
            np.testing.assert_allclose(reference(share), posture, atol=1e-14)
        for low, high, one, other in ((0.0, at, start, via), (at, 1.0, via, end)):
            rows = np.array([reference(share) for share in np.linspace(low, high, 40)])
            # Between each two postures every joint goes one way.
            assert np.all(np.diff(rows, axis=0) * np.sign(other - one) >= -1e-13)
        step = 1e-7 * min(at, 1.0 - at)
        rates = [(reference(x + step) - reference(x)) / step for x in (at - step, at)]
        scale = np.max(np.abs([start, via, end])) / min(at, 1.0 - at)
        assert np.max(np.abs(rates[1] - rates[0])) < 1e-5 * scale


@pytest.mark.parametrize("angle", [0.39 * pi, -1.5 * pi])
def test_a_travel_that_does_not_come_to_the_via_point_knows_nothing_of_it(kit, angle):
    via_konf, konf = konfs(kit)
    rows = [circle(kit.shop(), kit, at_via, konf, angle=angle) for at_via in (None, via_konf)]
    assert rows[0].q.tobytes() == rows[1].q.tobytes()


@pytest.mark.parametrize(
    ("angle", "passed"), [(0.8 * pi, 0.4 * pi), (3.1 * pi, 0.4 * pi), (-1.9 * pi, 1.6 * pi)]
)
def test_with_angle_the_first_passing_counts(kit, angle, passed):
    via_konf, konf = konfs(kit)
    rows = circle(kit.shop(), kit, via_konf, konf, angle=angle)
    share = passed / abs(angle)
    row = row_at(rows, share)
    assert abs(row[0] - nearest_rail(row[0] + row[1], *via_konf[:2])) < 0.02
    last = rows.q[-1]
    assert abs(last[0] - nearest_rail(last[0] + last[1], *konf[:2])) < 1e-9


@pytest.mark.req("MOT-21")
@pytest.mark.parametrize(
    "bounds", first(1, [{"acceleration": 0.2}, {"speed": 0.25, "acceleration": 0.8}, {"speed": 0.1}])
)
def test_a_move_slows_down_until_the_postures_are_reached(kit, bounds):
    """Both postures are nearest ones, as without limits: the move takes the time that the joints need."""
    via_konf, konf = konfs(kit)
    limits = kit.limits(**bounds)
    free, shop, plain = kit.shop(), kit.shop(limits), kit.shop(limits)
    unhurried, rows = circle(free, kit, via_konf, konf), circle(shop, kit, via_konf, konf)
    assert broken_bound(kit.start, unhurried.q, limits, 0.01) is not None
    assert broken_bound(kit.start, rows.q, limits, 0.01) is None
    assert len(rows) > len(unhurried)
    assert rows.path_position_error.max() < 1e-9
    row, last = row_at(rows, 1 / 3), rows.q[-1]
    assert abs(row[0] - nearest_rail(row[0] + row[1], *via_konf[:2])) < 0.005
    assert abs(last[0] - nearest_rail(last[0] + last[1], *konf[:2])) < 1e-9
    without = circle(plain, kit, None, konf)
    assert np.max(np.abs(without.q[-1] - last)) < 1e-9
    assert codes(shop) == codes(plain)


@pytest.mark.req("MOT-21")
def test_far_postures_are_reached_where_the_walk_to_them_lags(kit):
    """There the first posture for every knot is 2 mm behind at the via point and 10 mm at the end."""
    shop = kit.shop(kit.limits(position=9, speed=0.25), 0.002)
    via_konf, konf = kit.moved(1.8, -2.7, 0, 0, 0, 0, 0), kit.moved(-0.9, -1.2, 0, 0, 0, 0, 0)
    rows = circle(shop, kit, via_konf, konf)
    row, last = row_at(rows, 1 / 3), rows.q[-1]
    assert abs(row[0] - nearest_rail(row[0] + row[1], *via_konf[:2])) < 5e-4
    assert abs(last[0] - nearest_rail(last[0] + last[1], *konf[:2])) < 1e-9


def test_a_position_limit_on_the_way_is_kept_where_a_move_slows_down(kit):
    via_konf, konf = konfs(kit)
    limits = kit.limits(position=[0.5, 2, 2, 2, 2, 2, 2], speed=0.2, acceleration=0.8)
    shop = kit.shop(limits)
    rows = circle(shop, kit, via_konf, konf)
    assert codes(shop) == ["IRL350", "IRL349"]
    assert broken_bound(kit.start, rows.q, limits, 0.01) is None
    assert 0.49 < row_at(rows, 1 / 3)[0] <= 0.5


def test_a_posture_beyond_a_limit_is_a_warning_and_the_limit_stays(kit, shop):
    shop.switch(LimitKind.POSITION, kit.range([0.4, 2, 2, 2, 2, 2, 2]))
    via_konf, konf = konfs(kit)
    rows = circle(shop, kit, via_konf, konf)
    assert codes(shop) == ["IRL350", "IRL349"]
    assert "rail at 600 mm, outside its limits -400 mm to 400 mm" in shop.pacer.warnings[0].message
    assert rows.q[:, 0].max() <= 0.4


def test_frozen_joints_stay(kit, shop):
    shop.freeze(1)
    rows = circle(shop, kit, *konfs(kit))
    assert np.all(rows.q[:, 0] == kit.start[0])


def test_the_cyclic_option_is_off_and_comes_back(kit, shop):
    shop.cyclic()
    stored = shop.pacer.options.cyclic_posture
    via_konf, konf = konfs(kit)
    rows = circle(shop, kit, via_konf, konf)
    assert np.abs(row_at(rows, 1 / 3)[0] - via_konf[0]) < 0.1
    assert shop.pacer.options.cyclic_posture is stored
