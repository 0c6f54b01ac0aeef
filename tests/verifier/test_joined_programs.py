"""Short programs whose moves pass into each other are carried out as the verifier says they must be.

More of them: `tests/campaigns/differential.py joined`, and `smooth`.
"""

from __future__ import annotations

import pytest

from joined_programs import judged, judged_smooth
from long_run import first

pytestmark = [pytest.mark.req("STR-06"), pytest.mark.req("MOT-06")]

FOUND = [25, 52, 73, 663]
"""Legs run within a tick behind corners no row tells of: the verifier took rows for off the path."""


@pytest.mark.parametrize(
    "seed",
    [*FOUND, 1000, 10001, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(2000, 2200))],
)
def test_the_verifier_has_nothing_against_what_is_carried_out(seed: int) -> None:
    _, wrong = judged(seed)
    assert wrong == [], f"seed {seed}"


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize("seed", first(1, [21, *range(20), *range(22, 60)]))
def test_nor_against_s_curves(seed: int) -> None:
    """The first one comes out of corners to PTPs."""
    _, wrong = judged_smooth(seed)
    assert wrong == [], f"seed {seed}"
