"""Ticks of random robots with everything that stands against them, by irlx and by optimisers of others.

`second_ticks` takes robots of 4 to 12 joints with limits, frozen joints, states on limits, zeros and residues
of 1e-16, and asks of every tick: are the bounds those of the table of the reference, is the tool on its path,
is phi at its least by its conditions and by two other solvers, and, where irlx finds no step, is there none.
More of them: `tests/campaigns/differential.py ticks`.
"""

from collections import Counter

import pytest

from long_run import portions
from second_ticks import judged

QUICK = [*range(8), 50, 66, 72, 274]
"""The last ones are ruled by gradients of a criterion."""

FROM_ELSEWHERE = 2300
"""Near a singular posture: no step is seen from where the tick starts, one from the middle of its bounds."""

TOUCHED = 588
"""Bounds that lack 3e-13 m to the pose: nothing that a promise knows of."""

pytestmark = [pytest.mark.req("TRF-01"), pytest.mark.req("TRF-02")]


def ends(seeds):
    found, told = Counter(), []
    for seed in seeds:
        end, differences = judged(seed)
        found[end] += 1
        told += [f"seed {seed}, {end}: {line}" for line in differences]
    assert not told, "\n".join(told)
    return found


def test_ticks_are_those_of_other_solvers():
    found = ends(QUICK)
    assert found["solved at bounds"] > 0.5 * len(QUICK), found
    assert found["no step"] > 0, found


@pytest.mark.slow
@pytest.mark.parametrize("seeds", portions(range(4000), 500))
def test_many_ticks_are_those_of_other_solvers(seeds):
    ends(seeds)


@pytest.mark.parametrize("seed", [FROM_ELSEWHERE, TOUCHED])
def test_a_step_that_is_not_found_from_where_the_tick_starts_is_found(seed):
    assert ends([seed]) == {"solved at bounds": 1}
