"""Random programs, run by irlx and by an evaluator that was written from the reference alone.

Compared are all variables of the program at its end, what it has written, and the error it ends in, with its
code and its place. `reference_evaluator` says what is in it; a failing program is written anew by
`computing_programs.written(seed)`. The long campaign is `tests/campaigns/differential.py programs`.
"""

from collections import Counter
from pathlib import Path

import pytest

from long_run import portions
from reference_evaluator.comparison import compared, judged

CORPUS = sorted((Path(__file__).parents[1] / "corpus" / "second_opinions").glob("*.irl"))
QUICK = range(30)

pytestmark = [pytest.mark.req("LANG-11"), pytest.mark.req("LANG-30"), pytest.mark.req("LANG-40")]


def ends(seeds):
    """How many programs end in which way; nothing may differ."""
    found, told = Counter(), []
    for seed in seeds:
        end, differences = judged(seed)
        found[end] += 1
        told += [f"seed {seed}: {line}" for line in differences]
    assert not told, "\n".join(told)
    return found


def test_programs_come_to_the_same():
    found = ends(QUICK)
    # Most programs must have something to say: few that a check refuses, some of every kind of end.
    assert found["refused"] + found["long"] < 0.2 * len(QUICK), found
    assert found["end"] > 0.2 * len(QUICK), found
    assert len(found) > 6, found


@pytest.mark.slow
@pytest.mark.parametrize("seeds", portions(range(60, 20_060), 1000))
def test_many_programs_come_to_the_same(seeds):
    ends(seeds)


@pytest.mark.parametrize("path", CORPUS, ids=lambda path: path.stem)
def test_what_once_differed(path):
    end, differences = compared(path.read_text(encoding="utf-8"))
    assert end != "refused"
    assert not differences
