import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from irlx.streams.irdata.digits import FIELD, WIDTH, fill_fields


def texts(values: np.ndarray) -> list[str]:
    fields = np.empty(values.shape, FIELD)
    fill_fields(fields, values)
    data = fields.tobytes().decode("ascii")
    step = WIDTH + 2
    return [data[at + 2 : at + step] for at in range(0, len(data), step)]


def assert_same_bits(values: np.ndarray) -> None:
    back = np.array([float(text) for text in texts(values)]).reshape(values.shape)
    assert np.array_equal(back.view(np.int64), values.view(np.int64))


@pytest.mark.req("STR-01")
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1))
def test_any_float_reads_back(values: list[float]) -> None:
    assert_same_bits(np.array(values))


def test_neighbours_of_powers_read_back() -> None:
    tens = np.array([float(f"1e{k}") for k in range(-307, 308)])
    twos = 2.0 ** np.arange(-1070, 1023)
    both = np.concatenate([tens, twos])
    assert_same_bits(np.concatenate([both, np.nextafter(both, 0), np.nextafter(both, np.inf), -both]))


def test_digits_are_the_correctly_rounded_ones() -> None:
    rng = np.random.default_rng(5)
    values = np.concatenate([rng.normal(size=2000), np.exp(rng.uniform(-60, 60, 2000)), [0.0, -0.0, 1.0]])
    assert texts(values) == [f"{value:.16e}".rjust(WIDTH) for value in values.tolist()]


def test_extreme_values_take_pythons_text() -> None:
    assert texts(np.array([[1e-320, -1.7976931348623157e308]])) == [
        "1e-320".rjust(WIDTH),
        "-1.7976931348623157e+308".rjust(WIDTH),
    ]
