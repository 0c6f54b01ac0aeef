from dataclasses import replace

import numpy as np
import pytest

from irlx.streams import JointStream


def test_differences_are_backward_and_from_rest(good: JointStream) -> None:
    dt = 0.004
    assert good.dt == dt
    assert np.array_equal(good.t, np.arange(len(good.ticks)) * 4_000_000 / 1e9)
    assert not good.qd[0].any()
    assert not good.qdd[0].any()
    assert np.array_equal(good.qd[5], (good.q[5] - good.q[4]) / dt)
    assert np.array_equal(good.qdd[1], good.qd[1] / dt)
    assert not good.qd[-1].any()


@pytest.mark.parametrize(
    ("name", "wrong"),
    [
        ("q", np.zeros((3, 7))),
        ("ticks", np.zeros(297)),
        ("block", np.zeros((297, 1), dtype=np.int64)),
        ("tool", np.zeros((297, 6))),
    ],
)
def test_wrong_arrays(name: str, wrong: np.ndarray, good: JointStream) -> None:
    with pytest.raises(ValueError, match="needs shape"):
        replace(good, **{name: wrong})


@pytest.mark.parametrize(
    "change",
    [
        {"joint_units": ("rad",)},
        {"joint_units": ("in",) * 7},
        {"joint_names": ("a",) * 7},
        {"weights": (1.0,)},
        {"tick_ns": 0},
    ],
)
def test_wrong_headers(change: dict[str, object], gantry_kit) -> None:
    with pytest.raises(ValueError, match=r"joint|tick"):
        gantry_kit.header(**change)
