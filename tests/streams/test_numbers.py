"""Text <-> float64 against Python's own writing and reading, bit by bit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from irlx.streams.numbers import table_of, texts_of, texts_of_rows

finite = st.floats(allow_nan=False, allow_infinity=False)


def digits(text: str) -> str:
    return text.partition("e")[0].replace(".", "").lstrip("-0").rstrip("0")


def bits(values: np.ndarray) -> list[int]:
    return np.ascontiguousarray(values).view(np.int64).ravel().tolist()


@pytest.mark.req("STR-01")
@given(st.lists(finite, min_size=1))
def test_any_float_comes_back(values: list[float]) -> None:
    array = np.array(values)
    texts = texts_of(array)
    assert bits(np.array([float(text) for text in texts])) == bits(array)
    assert bits(table_of(b",".join(texts) + b"\n", len(values))) == bits(array)
    # As few digits as they take: Python finds as many.
    assert [digits(text.decode()) for text in texts] == [digits(repr(value)) for value in values]


def test_awkward_numbers_come_back() -> None:
    tens = np.array([float(f"1e{k}") for k in range(-323, 309)])
    twos = 2.0 ** np.arange(-1074, 1023)
    both = np.concatenate([tens, twos, [0.0, 5e-324, 1.7976931348623157e308, 0.1 + 0.2]])
    values = np.concatenate([both, np.nextafter(both, 0), np.nextafter(both[:-2], np.inf), -both])
    text = b"".join(text + b"\n" for text in texts_of_rows(values.reshape(-1, 1)))
    assert bits(table_of(text, 1)) == bits(values)
    assert all(set(text) & set(b".e") for text in texts_of(values))


@pytest.mark.req("STR-01")
@pytest.mark.parametrize("seed", range(4))
def test_any_digits_are_rounded_to_the_nearest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    words = [
        f"{sign}{digits[0]}.{digits[1:]}e{exponent:+03d}"
        for sign, digits, exponent in zip(
            rng.choice(["", "-"], 5000).tolist(),
            [f"{m:017d}" for m in rng.integers(0, 10**17, 5000).tolist()],
            rng.integers(-99, 100, 5000).tolist(),
            strict=True,
        )
    ]
    text = "".join(f"{word.rjust(24)}\n" for word in words).encode()
    assert bits(table_of(text, 1)) == bits(np.array([float(word) for word in words]))


def test_numbers_half_way_between_two_floats() -> None:
    """Whole numbers beyond 2^53 that lie exactly between two floats, and their neighbours."""
    numbers = [
        2**power + odd * 2 ** (power - 53) + near
        for power in (53, 54, 55, 56)
        for odd in (1, 3, 5, 777, 2**20 + 1, 2**50 - 1)
        for near in (-1, 0, 1)
    ]
    text = "".join(f"{number}.0\n{number}\n" for number in numbers).encode()
    wanted = np.repeat([float(number) for number in numbers], 2)
    assert bits(table_of(text, 1)) == bits(wanted)


def test_rows_and_columns() -> None:
    table = np.array([[1.0, -0.0, 1e-7], [2.5, 3.0, 1e22]])
    assert texts_of_rows(table, b", ") == [b"1.0, -0.0, 1e-7", b"2.5, 3.0, 1e+22"]
    assert texts_of_rows(table[:, ::2]) == [b"1.0,1e-7", b"2.5,1e+22"]
    assert texts_of_rows(table[:0]) == texts_of(table[0, :0]) == []
    assert np.array_equal(table_of(b"1.0, -0.0,  1e-7\n2.5,3,1e22\n", 3), table)


WRONG = (b"", b"\n", b"1.0\n2.0,3.0\n", b"1.0,\n", b",1.0\n", b"1.0;2.0\n", b"[1.0]\n", b"NaN\n")
WORSE = (b"1.0 2.0\n", b"1_0\n", b"0x1\n", b"true\n", b'"1"\n', b"1.0\n\n2.0\n", b"--1\n", b".5\n", b"5.\n")


@pytest.mark.parametrize("text", WRONG + WORSE)
def test_what_is_no_table(text: bytes) -> None:
    with pytest.raises(ValueError):  # noqa: PT011 (the words are not ours)
        table_of(text, 1)
