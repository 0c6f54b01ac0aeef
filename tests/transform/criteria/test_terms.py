"""What CRITERION adds to a tick, against the formulas written out."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.robot.limits import JointLimits
from irlx.transform.criteria.combined import Combined, Weighted
from irlx.transform.criteria.library import LIBRARY, STANDARD_GRAVITY, TermSetting, known, register
from irlx.transform.criteria.posture import Posture
from irlx.transform.criteria.some_joints import OfSomeJoints
from irlx.transform.criteria.term import (
    REFERENCE_TICK,
    EnergyIncrement,
    KineticEnergy,
    MeasureTerm,
    Term,
    VelocityRatio,
)
from irlx.transform.measures.measure import Measure
from irlx.transform.measures.smallest_singular_value import SmallestSingularValue

pytestmark = pytest.mark.req("TRF-15")

Q = np.array([0.3, -0.2, 0.5])


class Sum(Measure):
    """c = sum of q + 1, large values good: its gradient is all ones."""

    name = "sum"
    sense = -1

    def value(self, q):
        return float(np.sum(q)) + 1.0

    def gradient(self, q):
        return np.ones(q.size)


class Square(Sum):
    """c = 1/2 q'q, small values good."""

    name = "square"
    sense = 1

    def value(self, q):
        return float(0.5 * q @ q)

    def gradient(self, q):
        return q.copy()


class Given(Term):
    """b and B as they are given."""

    name = "given"

    def __init__(self, linear, quadratic=None, share=1.0, acting=True):
        self._linear, self._quadratic, self._share, self._acting = linear, quadratic, share, acting

    def linear(self, q, elapsed):
        return elapsed * self._linear

    def quadratic(self, q):
        return self._quadratic

    def acts(self, q):
        return self._acting

    def posture_share(self, q):
        return self._share


def test_a_measure_is_gone_down_or_its_logarithm_up() -> None:
    """Downhill is -b: of what is to be large that is uphill, in shares of the value."""
    down = MeasureTerm(Square(), 4.0, Q).linear(Q, 0.02)
    np.testing.assert_allclose(down, 4.0 * 0.02 * Q, rtol=1e-15)
    up = MeasureTerm(Sum(), 4.0, Q).linear(Q, 0.02)
    np.testing.assert_allclose(up, -4.0 * 0.02 * np.ones(3) / 1.6, rtol=1e-15)


def test_a_value_counts_as_a_tenth_of_that_at_the_start_at_least() -> None:
    """From 1.6 on: at 0.5 it is 0.5, at 0.01 it is 0.16, else a vanishing value would be worth any motion."""
    term = MeasureTerm(Sum(), 1.0, Q)
    for value, counted in ((0.5, 0.5), (0.01, 0.16), (0.0, 0.16), (-3.0, 0.16)):
        q = np.array([value - 1.0, 0.0, 0.0])
        np.testing.assert_allclose(term.linear(q, 1.0), -np.ones(3) / counted, rtol=1e-12)


def test_energies_are_those_of_the_mass_matrix(arm7) -> None:
    term, q = KineticEnergy(arm7.kinematics), arm7.q
    assert not np.any(term.linear(q, 0.02))
    mass = term.quadratic(q) * REFERENCE_TICK**2
    assert mass.shape == (7, 7)
    np.testing.assert_array_equal(term.quadratic(q), EnergyIncrement(arm7.kinematics).quadratic(q))


def test_the_ratio_of_speeds_takes_weights_over_the_square_of_the_tools() -> None:
    weights = np.array([3.0, 2.0, 1.0])
    term = VelocityRatio(weights, 0.5)
    np.testing.assert_allclose(term.quadratic(Q), weights / 0.25, rtol=1e-15)
    assert not np.any(term.linear(Q, 0.02))
    # A tool that all but stands is counted with 1 mm/s.
    np.testing.assert_allclose(VelocityRatio(weights, 1e-9).quadratic(Q), weights * 1e6, rtol=1e-12)


@pytest.mark.parametrize("whole", [False, True])
def test_a_term_of_some_joints_has_nothing_for_the_others(whole: bool) -> None:
    joints = np.array([1, 2])
    own = np.array([[2.0, 0.5], [0.5, 3.0]]) if whole else np.array([2.0, 3.0])
    term = OfSomeJoints(Given(np.array([5.0, 7.0]), own, 0.3), joints)
    np.testing.assert_array_equal(term.linear(Q, 0.1), [0.0, 0.5, 0.7000000000000001])
    wanted = np.array([[0, 0, 0], [0, 2.0, 0.5], [0, 0.5, 3.0]]) if whole else np.array([0.0, 2.0, 3.0])
    np.testing.assert_array_equal(term.quadratic(Q), wanted)
    assert term.acts(Q)
    assert term.posture_share(Q) == 0.3
    assert term.name == "given"
    assert OfSomeJoints(Given(np.ones(2)), joints).quadratic(Q) is None
    assert not OfSomeJoints(Given(np.ones(2), acting=False), joints).acts(Q)


TERMS = {
    "linear alone": [Given(np.array([1.0, -2.0, 0.5]))],
    "diagonal": [Given(np.array([1.0, -2.0, 0.5]), np.array([0.5, 2.0, 1.0]), 0.25)],
    "whole": [Given(np.zeros(3), np.array([[2.0, 0.3, 0.1], [0.3, 1.0, 0.0], [0.1, 0.0, 4.0]]), 0.5)],
}
TERMS["all"] = [term for terms in TERMS.values() for term in terms]
TERMS["one that does not act"] = [
    *TERMS["diagonal"],
    Given(np.full(3, 99.0), np.full(3, 99.0), 0.0, acting=False),
]
WEIGHTS, REFERENCE, ELAPSED = np.array([3.0, 1.0, 2.0]), np.array([0.1, 0.2, -0.3]), 0.04


@pytest.mark.parametrize("name", TERMS)
def test_terms_are_added_to_the_posture_term(name: str) -> None:
    """share 1/2 (q + S - r)' W (q + S - r) + sum w (b' S + 1/2 S' B S), scaled as a whole."""
    weighted = tuple(Weighted(term, 0.5 + k) for k, term in enumerate(TERMS[name]))
    begun = Combined(Posture(WEIGHTS, REFERENCE), weighted, ELAPSED).begun(Q)

    def phi(step: np.ndarray) -> float:
        away = Q + step - REFERENCE
        share, added = 1.0, 0.0
        for one in weighted:
            if one.term.acts(Q):
                share *= one.term.posture_share(Q)
                matrix = one.term.quadratic(Q)
                square = np.diag(matrix) if matrix is not None and matrix.ndim == 1 else matrix
                bend = 0.0 if square is None else 0.5 * step @ square @ step
                added += one.weight * (one.term.linear(Q, ELAPSED) @ step + bend)
        return share * 0.5 * away @ (WEIGHTS * away) + added

    rng, nothing = np.random.default_rng(3), np.zeros(3)
    scale = begun.value(Q, np.ones(3)) / phi(np.ones(3))
    for step in rng.normal(size=(4, 3)):
        assert begun.value(Q, step) == pytest.approx(scale * phi(step), rel=1e-12)
        slope = [(phi(step + h) - phi(step - h)) / 2e-4 for h in 1e-4 * np.eye(3)]
        np.testing.assert_allclose(begun.gradient(Q, step), scale * np.array(slope), rtol=1e-8, atol=1e-9)
        hessian = begun.hessian()
        times = hessian * step if hessian.ndim == 1 else hessian @ step
        np.testing.assert_allclose(begun.gradient(Q, step) - begun.gradient(Q, nothing), times, atol=1e-12)
        least = step + begun.pull(Q, step)
        np.testing.assert_allclose(begun.gradient(Q, least), 0.0, atol=1e-10)
    diagonal = begun.hessian() if begun.hessian().ndim == 1 else begun.hessian().diagonal()
    assert np.sum(diagonal) == pytest.approx(np.sum(WEIGHTS), rel=1e-12)


@pytest.mark.parametrize("name", TERMS)
def test_what_terms_ask_for_is_held_to_a_size(name: str) -> None:
    """The way of b, -H^-1 b, is as long as asked, measured by H, and leads where it led; all else stays."""
    weighted = tuple(Weighted(term, 0.5 + k) for k, term in enumerate(TERMS[name]))
    begun = Combined(Posture(WEIGHTS, REFERENCE), weighted, ELAPSED).begun(Q)
    nothing = tuple(
        Weighted(Given(np.zeros(3), w.term.quadratic(Q), w.term.posture_share(Q)), w.weight)
        for w in weighted
        if w.term.acts(Q)
    )
    bare = Combined(Posture(WEIGHTS, REFERENCE), nothing, ELAPSED).begun(Q)
    step = np.array([0.1, -0.4, 0.2])

    def asked(criterion) -> np.ndarray:
        return criterion.gradient(Q, step) - bare.gradient(Q, step)

    inverse = begun.inverse_hessian()
    inverse = np.diag(inverse) if inverse.ndim == 1 else inverse
    size = float(np.sqrt(asked(begun) @ inverse @ asked(begun)))
    assert begun.asking_at_most(1.001 * size) is begun
    if size == 0.0:
        return
    held = begun.asking_at_most(0.25 * size)
    np.testing.assert_allclose(asked(held), 0.25 * asked(begun), rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(held.hessian(), begun.hessian())
    base = Posture(WEIGHTS, REFERENCE)
    assert base.asking_at_most(0.0) is base


def test_terms_that_do_not_act_leave_the_posture_term_itself() -> None:
    base = Posture(WEIGHTS, REFERENCE)
    combined = Combined(base, (Weighted(Given(np.ones(3), acting=False), 1.0),), ELAPSED)
    assert combined.begun(Q) is base
    assert combined.name == "posture + given"
    assert combined.value(Q, np.ones(3)) == base.value(Q, np.ones(3))
    np.testing.assert_array_equal(combined.gradient(Q, np.ones(3)), base.gradient(Q, np.ones(3)))
    with pytest.raises(TypeError):
        combined.hessian()


def setting(arm) -> TermSetting:
    limits = JointLimits.unlimited(arm.n).with_pair("position", arm.lower, arm.upper)
    return TermSetting(arm.kinematics, limits, arm.weights, arm.q, 0.5)


def test_gravity_torques_count_as_shares_of_that_of_the_stretched_arm(koch11) -> None:
    """A unit of mass or length changes nothing: torques over m g reach."""
    inertials = koch11.kinematics.description.inertials
    mass = sum(one.mass for one in inertials.values())
    if not mass:
        pytest.skip("a robot without masses")
    entry = LIBRARY["GRAVITY_TORQUE"]
    made = entry.make(setting(koch11), 1.0).linear(koch11.q, 1.0)
    own = entry.make(setting(koch11), 2.0).linear(koch11.q, 1.0)
    np.testing.assert_allclose(own, 2.0 * made, rtol=1e-12)
    assert np.max(np.abs(made)) * (mass * STANDARD_GRAVITY * koch11.kinematics.description.reach) ** 2 > 0.0
    assert np.max(np.abs(made)) < 10.0


def test_what_the_library_makes(arm7) -> None:
    for name, entry in LIBRARY.items():
        if not entry.needs_masses:
            assert entry.make(setting(arm7), 1.0).linear(arm7.q, 0.01).shape == (7,)
        assert (entry.gain is None) == (name in {"VELOCITY_RATIO", "KINETIC_ENERGY", "ENERGY_INCREMENT"})
    centring = LIBRARY["JOINT_CENTRING"].make(setting(arm7), 1.0).linear(arm7.q, 1.0)
    # Squares of shares of the half range, of every joint alone.
    np.testing.assert_allclose(centring / arm7.q, (centring / arm7.q)[0], rtol=1e-9)


def test_criteria_of_users() -> None:
    class Own(Square):
        name = "own_sum"

    assert register(Own) is Own
    assert known()["OWN_SUM"].gain == 10.0
    assert "OWN_SUM" not in LIBRARY
    for name in ("joint_centring", "no name"):
        with pytest.raises(ValueError, match=r"library|no name"):
            register(type("Other", (Square,), {"name": name}))


def test_signs_of_measures() -> None:
    """1 where small values are good, -1 where large ones are, so that gains mean what they say."""
    assert SmallestSingularValue.sense == -1
    assert Square.sense == 1
