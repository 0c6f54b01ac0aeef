"""Bands of WITH TOLERANCE about poses in which not all turns count, against poses made by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.verifier.geometry.allowance import Allowance

pytestmark = pytest.mark.req("LANG-66")

FEW = 200


def made(bands: np.ndarray, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Tools that stand off frames by x and the turn b about y, where the turn about the last axis of the
    wrist does not count: attitudes (R, 9, 3), positions (R, 3), frames asked for (R, 3, 3), values (R, 2)."""
    rng = np.random.default_rng(seed)
    wrist, asked = Rotation.random(FEW, random_state=rng), Rotation.random(FEW, random_state=rng)
    # What follows: none, a rounding, or up to a tenth of a radian.
    turn = rng.choice([0.0, 1e-16, 1e-3, 0.1], FEW) * rng.uniform(-1.0, 1.0, FEW)
    axes = wrist.as_matrix()
    frames = Rotation.from_rotvec(turn[:, None] * axes[:, :, 2]) * asked
    values = bands * rng.choice([-1.0, 0.0, 1e-16, 0.5, 1.0], (FEW, 2))
    tool = frames * Rotation.from_rotvec(values[:, 1:] * np.array([0.0, 1.0, 0.0]))
    counted = np.swapaxes(axes, 1, 2) * np.array([1.0, 1.0, 0.0])[:, None]
    left = np.swapaxes(axes, 1, 2) * np.array([0.0, 0.0, 1.0])[:, None]
    attitudes = np.concatenate([tool.as_matrix(), counted, left], axis=1)
    positions = frames.apply(values[:, :1] * np.array([1.0, 0.0, 0.0]))
    return attitudes, positions, asked.as_matrix(), values


@pytest.mark.parametrize("seed", range(3))
def test_a_tool_within_its_bands_is_nowhere_off(seed: int) -> None:
    bands = np.array([2e-3, 0.08])
    attitudes, positions, asked, _ = made(bands, seed)
    # Where y does not count either, nothing tells how far the tool is turned about it.
    sure = np.linalg.norm(np.einsum("rij,rj->ri", attitudes[:, 3:6], asked[:, :, 1]), axis=1) > 0.2
    assert np.count_nonzero(sure) > FEW // 2
    attitudes, positions, asked = attitudes[sure], positions[sure], asked[sure]
    allowance = Allowance((bands[0], 0.0, 0.0, 0.0, bands[1], 0.0), True)
    assert np.max(allowance.turned_off(attitudes, asked)) < 1e-10
    frames = allowance.frames(attitudes, asked)
    offsets = np.einsum("rji,rj->ri", frames, positions)
    assert np.max(np.abs(allowance.shifted_off(offsets))) < 1e-10
    assert np.max(allowance.excess(positions, attitudes, (np.zeros((len(asked), 3)), asked))) < 1e-10


@pytest.mark.parametrize("beyond", [1e-6, 1e-3])
def test_what_passes_a_band_is_found(beyond: float) -> None:
    bands = np.array([2e-3, 0.08])
    attitudes, positions, asked, values = made(bands, 7)
    sure = np.linalg.norm(np.einsum("rij,rj->ri", attitudes[:, 3:6], asked[:, :, 1]), axis=1) > 0.2
    narrow = Allowance((1.0, 0.0, 0.0, 0.0, bands[1] - beyond, 0.0), True)
    passed = narrow.excess(positions, attitudes, (np.zeros((FEW, 3)), asked))
    expected = np.abs(values[:, 1]) - bands[1] + beyond
    np.testing.assert_allclose(passed[sure], expected[sure], rtol=0.0, atol=1e-10)
    assert np.count_nonzero(passed[sure] > 0.9 * beyond) > 5
    turned = narrow.turned_off(attitudes, asked)
    assert np.all(turned[sure & (expected > 0.0)] > 0.1 * beyond)
