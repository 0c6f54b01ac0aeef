"""What a sensor may ask for, and how answers that are none are told."""

from __future__ import annotations

from math import inf, nan, pi

import numpy as np
import pytest

from irlx.diagnostics import Place
from irlx.pacing.correction.request import FARTHEST, read_request
from irlx.pacing.errors import PacingError
from irlx.robot.task import Task

PLACE = Place("weld.irl")
WHOLE = Task()


def read(answer: object, task: Task = WHOLE) -> np.ndarray | None:
    return read_request(answer, 7, task, PLACE)


@pytest.mark.parametrize(
    "answer", [(1, 2, 3, 0, 0, 1), [1.0, 2.0, 3.0, 0.0, 0.0, 1.0], np.array([1, 2, 3, 0, 0, 1])]
)
def test_six_numbers_of_any_kind(answer: object) -> None:
    found = read(answer)
    np.testing.assert_array_equal(found, [1.0, 2.0, 3.0, 0.0, 0.0, 1.0])
    assert found.dtype == np.float64


def test_nothing_new() -> None:
    assert read(None) is None


def test_what_the_task_leaves_out_counts_as_nothing() -> None:
    np.testing.assert_array_equal(
        read((1, 2, 3, 0.1, 0.2, 0.3), Task(("x", "y", "z", "rz"))), [1, 2, 3, 0, 0, 0.3]
    )


def test_an_answer_stays_as_it_is() -> None:
    """The array belongs to the sensor, which may go on using it."""
    answer = np.arange(6.0) / 10
    read(answer, Task(("x", "y", "z")))
    np.testing.assert_array_equal(answer, np.arange(6.0) / 10)


class Odd:
    """No array, and it says so in its own way."""

    def __array__(self, *given, **named):
        raise TypeError("not here")

    def __len__(self):
        raise RuntimeError("not even that")


@pytest.mark.parametrize(
    ("answer", "code", "found"),
    [
        ((1, 2, 3), "IRL580", "tuple of 3"),
        ("abcdef", "IRL580", "str of 6"),
        ([[1, 2], [3]], "IRL580", "list of 2"),
        (4.0, "IRL580", "float"),
        (np.array(4.0), "IRL580", "ndarray"),
        (Odd(), "IRL580", "Odd"),
        ([True] * 6, "IRL580", "list of 6"),
        (["1"] * 6, "IRL580", "list of 6"),
        (np.zeros((6, 1)), "IRL580", "ndarray of (6, 1)"),
        ((0, nan, 0, 0, 0, 0), "IRL581", "0, nan, 0, 0, 0, 0"),
        ((0, 0, 0, -inf, 0, 0), "IRL581", "0, 0, 0, -inf, 0, 0"),
    ],
)
def test_answers_that_are_none(answer: object, code: str, found: str) -> None:
    with pytest.raises(PacingError) as caught:
        read(answer)
    (told,) = caught.value.diagnostics
    assert (told.code, told.data["found"], told.data["tick"], told.place) == (code, found, 7, PLACE)


@pytest.mark.parametrize(
    "answer", [(0, 0, FARTHEST, 0, 0, 0), (0, 0, 0, 0, pi, 0), (0, 0, 0, 0, np.nextafter(pi, 4), 0)]
)
def test_as_far_as_may_be_asked(answer: tuple[float, ...]) -> None:
    np.testing.assert_array_equal(read(answer), answer)


@pytest.mark.parametrize("answer", [(0, 0, 1000.001, 0, 0, 0), (0, 0, 0, 0, pi + 1e-9, 0)])
def test_too_far(answer: tuple[float, ...]) -> None:
    with pytest.raises(PacingError) as caught:
        read(answer)
    (told,) = caught.value.diagnostics
    assert (told.code, told.data["farthest"]) == ("IRL582", "1000")
