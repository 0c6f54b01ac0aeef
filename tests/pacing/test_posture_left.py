"""Why a posture is left, and from which difference on it is."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.diagnostics import Place
from irlx.pacing.posture_left import POSTURE_REACHED, posture_left, why_left
from irlx.transform.posture_flow import FlowEnd

MORE = np.nextafter(POSTURE_REACHED, 1.0)
STALLED = "no posture nearby that keeps the tool pose and the limits is nearer"
HELD = "rail is frozen or may not move"


@pytest.mark.parametrize(
    ("rail", "y", "why"),
    [
        (0.1, 0.0, HELD),
        # A joint that is off by what counts as reached is none that could not come nearer.
        (0.1, POSTURE_REACHED, HELD),
        (0.1, -POSTURE_REACHED, HELD),
        (0.1, MORE, f"{STALLED}; {HELD}"),
        (-0.1, -MORE, f"{STALLED}; {HELD}"),
        (POSTURE_REACHED, MORE, STALLED),
        (0.0, 0.2, STALLED),
    ],
)
def test_reasons_are_those_of_the_joints_that_are_off(kit, rail: float, y: float, why: str) -> None:
    remaining = np.array([rail, 0.0, y, 0.0, 0.0, 0.0, 0.0])
    held = np.arange(7) == 0
    assert why_left(FlowEnd.STALLED, remaining, held, kit.gantry()) == why
    told = posture_left(remaining, why, kit.gantry(), Place("t.irl"))
    assert len(told) == (max(abs(rail), abs(y)) > POSTURE_REACHED)
