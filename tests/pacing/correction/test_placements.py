"""Where obstacles may be said to be, and how answers that say nothing of the kind are told."""

from __future__ import annotations

from math import inf, nan, pi

import numpy as np
import pytest

from irlx.diagnostics import Place
from irlx.pacing.correction.placements import FARTHEST, read_placements
from irlx.pacing.errors import PacingError
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene
from irlx.solids.placement import Placement as Lying
from irlx.solids.shape import Solid, Sphere

PLACE = Place("weld.irl")
SCENE = Scene(
    {
        name.casefold(): Obstacle(name, (Solid(Sphere(0.1)),), Lying((0.0, 0.0, 0.0)), 0.01, 0.3)
        for name in ("Ball", "wall")
    }
)


def test_places_and_turns() -> None:
    found = read_placements({"BALL": (1, 2, 3), "wall": [0.5, 0, 0, 0, 0, pi]}, 3, SCENE, PLACE)
    assert [one.name for one in found] == ["Ball", "wall"]
    np.testing.assert_array_equal(found[0].position, [1.0, 2.0, 3.0])
    assert found[0].rotation is None
    np.testing.assert_array_equal(found[1].position, [0.5, 0.0, 0.0])
    np.testing.assert_array_equal(found[1].rotation, [0.0, 0.0, pi])


@pytest.mark.parametrize("answer", [None, {}, {"ball": None}])
def test_nothing_new(answer: object) -> None:
    assert read_placements(answer, 3, SCENE, PLACE) == []


class Odd:
    """No array, and it says so in its own way."""

    def __array__(self, *given, **named):
        raise TypeError("not here")

    def __len__(self):
        raise RuntimeError("not even that")


@pytest.mark.parametrize("pose", [(FARTHEST, -FARTHEST, 0), (0, 0, 0, pi, 0, 0)])
def test_as_far_as_may_be_said(pose: tuple[float, ...]) -> None:
    (found,) = read_placements({"ball": pose}, 3, SCENE, PLACE)
    np.testing.assert_array_equal(found.position, pose[:3])


@pytest.mark.parametrize(
    ("answer", "found"),
    [
        ([("ball", (0, 0, 0))], "list"),
        (7, "int"),
        ({3: (0, 0, 0)}, "the name 3"),
        ({"ball": (0, 0, 0), "Ball": (0, 0, 1)}, "'Ball' twice"),
        ({"ball": (0, 0)}, "tuple of 2 for 'ball'"),
        ({"ball": 3.0}, "float for 'ball'"),
        ({"ball": np.array(3.0)}, "ndarray for 'ball'"),
        ({"ball": Odd()}, "Odd for 'ball'"),
        ({"ball": "abc"}, "str of 3 for 'ball'"),
        ({"ball": [[1, 2], [3]]}, "list of 2 for 'ball'"),
        ({"ball": [True, False, True]}, "list of 3 for 'ball'"),
        ({"ball": (0, nan, inf)}, "0, nan, inf for 'ball'"),
        ({"ball": (0, -1000.5, 0)}, "a place 1000.5 m away, more than 1000, for 'ball'"),
        ({"ball": (0, 0, 0, 0, 3.2, 0)}, "a turn of 3.2 rad, more than half of one, for 'ball'"),
        ({"ball": (0, 0, 0, 3, 3, 0)}, "a turn of 4.24264 rad, more than half of one, for 'ball'"),
    ],
)
def test_answers_that_are_none(answer: object, found: str) -> None:
    with pytest.raises(PacingError) as caught:
        read_placements(answer, 3, SCENE, PLACE)
    (told,) = caught.value.diagnostics
    assert (told.code, told.data["found"], told.data["tick"], told.place) == ("IRL585", found, 3, PLACE)


def test_a_name_that_is_no_obstacle() -> None:
    with pytest.raises(PacingError) as caught:
        read_placements({"bal": (0, 0, 0)}, 3, SCENE, PLACE)
    (told,) = caught.value.diagnostics
    assert (told.code, told.data["name"], told.data["tick"]) == ("IRL586", "bal", 3)
    assert (told.data["near"], told.data["known"]) == ("; did you mean 'Ball'?", "Ball, wall")
    with pytest.raises(PacingError) as caught:
        read_placements({"bal": (0, 0, 0)}, 3, Scene({}), None)
    assert caught.value.diagnostics[0].data["known"] == "none"
