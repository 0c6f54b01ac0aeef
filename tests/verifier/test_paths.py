"""Path geometry: lines with turns, pure turns, half turns, against SciPy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.verifier.geometry.paths import LineWay

START = (np.array([0.3, -0.2, 0.5]), Rotation.from_rotvec([0.2, 0.5, -0.4]))


def poses(step, turn, s):
    positions = START[0] + s[:, None] * np.array(step)
    return positions, (START[1] * Rotation.from_rotvec(s[:, None] * np.array(turn))).as_matrix()


def deviation(step, turn, positions, rotations):
    goal = (START[0] + np.array(step), (START[1] * Rotation.from_rotvec(turn)).as_matrix())
    return LineWay((START[0], START[1].as_matrix()), goal).deviation(positions, rotations)


@pytest.mark.req("MOT-20")
@pytest.mark.parametrize(
    ("step", "turn"),
    [
        ((0.4, 0.1, -0.2), (0.3, 0.2, 0.1)),
        ((0.4, 0.1, -0.2), (0, 0, 0)),
        ((0, 0, 0), (0.3, 0.2, 0.1)),
        ((0, 0, 0), (0, 0, 3.1415926)),
        ((0, 0, 0), (0, 0, np.pi)),
        ((0.4, 0, 0), (0, -np.pi, 0)),
        ((1e-7, 0, 0), (0, 1.5, 0)),
        ((1e-5, 1e-5, 0), (0, 0, 1e-5)),
        ((0, 0, 0), (0, 0, 0)),
    ],
)
def test_points_of_the_path_are_on_it(step, turn) -> None:
    s = np.linspace(0, 1, 101)
    found = deviation(step, turn, *poses(step, turn, s))
    assert found.position.max() < 1e-12
    assert found.orientation.max() < 1e-12
    assert (np.diff(found.along) > -1e-12).all()


def test_what_is_off_is_measured() -> None:
    step, turn = (0.4, 0.0, 0.0), (0.0, 0.0, 0.5)
    positions, rotations = poses(step, turn, np.linspace(0, 1, 11))
    positions[3, 1] += 2e-6
    positions[10, 0] += 3e-6
    rotations[5] = rotations[5] @ Rotation.from_rotvec([4e-6, 0, 0]).as_matrix()
    rotations[6] = rotations[6] @ Rotation.from_rotvec([0, 0, 5e-6]).as_matrix()
    found = deviation(step, turn, positions, rotations)
    assert found.position[3] == pytest.approx(2e-6, rel=1e-6)
    assert found.position[10] == pytest.approx(3e-6, rel=1e-6)
    assert found.orientation[[5, 6]] == pytest.approx([4e-6, 5e-6], rel=1e-6)
    assert np.delete(found.position, [3, 10]).max() < 1e-12


def test_a_slipping_position_shows_in_a_pure_turn() -> None:
    positions, rotations = poses((0, 0, 0), (0, 0, 0.5), np.linspace(0, 1, 11))
    positions[4, 2] += 2e-6
    found = deviation((0, 0, 0), (0, 0, 0.5), positions, rotations)
    assert found.position[4] == pytest.approx(2e-6, rel=1e-6)
    assert found.along[-1] == pytest.approx(0.5)
