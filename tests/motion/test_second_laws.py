"""Time laws by irlx, and by integration, closed forms and Ruckig: laws of sections, LIN, PTP, slowed lines.

`second_laws` says what is compared. More of them: `tests/campaigns/differential.py laws`.
"""

from collections import Counter

import pytest

from long_run import portions
from second_laws import judged

SLOW = 11
"""A line whose slowing takes longer than all the others together."""

QUICK = [seed for seed in range(36) if seed != SLOW]

pytestmark = [pytest.mark.req("MOT-03"), pytest.mark.req("MOT-20")]


def ends(seeds):
    found, told = Counter(), []
    for seed in seeds:
        end, differences = judged(seed)
        found[end] += 1
        told += [f"seed {seed}, {end}: {line}" for line in differences]
    assert not told, "\n".join(told)
    return found


def test_laws_are_those_of_others():
    found = ends(QUICK)
    assert found["refused"] < 0.1 * len(QUICK), found
    assert found["slowed"] == 2, found


@pytest.mark.slow
@pytest.mark.parametrize("seeds", [[SLOW], *portions(range(36, 4036), 500)])
def test_many_laws_are_those_of_others(seeds):
    ends(seeds)
