"""The law of a chain where a bound is next to nothing, and the time of each of its stages."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

from irlx.motion.chain_law import Stage, chain_law
from irlx.motion.sections import Sections


def stage(kit, speeds, accs, **law: object) -> Stage:
    lengths = np.full(len(speeds), 0.5)
    bounds = Sections(lengths, np.array(speeds), np.array(accs), np.full(len(speeds), 1e3))
    return Stage(bounds, kit.law(**law), kit.place)


@pytest.mark.req("MOT-06")
@pytest.mark.parametrize(("speeds", "accs"), [([1.0, 1e-110], [1.0, 1.0]), ([1.0, 1.0], [1.0, 1e-110])])
def test_a_section_that_stands_makes_the_whole_chain_stand(kit, speeds, accs) -> None:
    law = chain_law([stage(kit, [1.0], [1.0]), stage(kit, speeds, accs)], 1.5)
    assert law.duration == inf
    assert law.length == 1.5


@pytest.mark.req("MOT-06")
def test_each_stage_takes_its_own_time(kit) -> None:
    """TIME counts from hand-over to hand-over, OVERRIDE makes it longer."""
    stages = [
        stage(kit, [1.0], [2.0], duration=1.5),
        stage(kit, [1.0, 0.8], [2.0, 2.0]),
        stage(kit, [1.0], [2.0], duration=1.6, override=0.5),
    ]
    law = chain_law(stages, 2.0)
    times = law.times_at(np.array([0.0, 0.5, 1.5, 2.0]))
    assert times[1] - times[0] == pytest.approx(1.5, rel=1e-9)
    assert times[3] - times[2] == pytest.approx(3.2, rel=1e-9)
    assert law.length == 2.0
