"""Numbers of fixed digits, compared with Python's own."""

import re

import numpy as np
import pytest

from irlx.exporters.number_lines import number_lines


def numbers_of(values: np.ndarray, digits: int) -> list[str]:
    text = number_lines(["<"], values[:, None], digits, [b">\n"] * len(values)).decode()
    assert text.count("\n") == len(values)
    return [re.fullmatch(r"<(.*)>", line)[1] for line in text.splitlines()]


@pytest.mark.parametrize("digits", [4, 8, 12])
@pytest.mark.parametrize("seed", range(3))
def test_any_size(digits: int, seed: int) -> None:
    print("seed", seed)
    rng = np.random.default_rng(seed)
    values = rng.uniform(-1.0, 1.0, 3000) * 10.0 ** rng.integers(-14, 7, 3000)
    for value, text in zip(values.tolist(), numbers_of(values, digits), strict=True):
        assert re.fullmatch(rf"-?(0|[1-9]\d*)\.\d{{{digits}}}", text)
        # Half of the last digit, and the roundings of one product and of reading back.
        assert abs(float(text) - value) <= 0.5 * 10.0**-digits + 3e-16 * abs(value)


@pytest.mark.parametrize("digits", [8, 12])
def test_edges(digits: int) -> None:
    whole = [0, 1, 9, 10, 99, 100, 999, 1000, 9999, 10_000, 10_001, 99_999, 100_000, 123_456, 1_000_000]
    sizes = [number + part for number in whole for part in (0.0, 0.25, 0.5)]
    values = np.array([*sizes, *(-size for size in sizes)])
    assert numbers_of(values, digits) == [f"{value + 0.0:.{digits}f}" for value in values]


def test_what_is_nothing_has_no_sign_and_what_carries_does() -> None:
    values = np.array([-0.0, -4.9e-9, 4.9e-9, -5.1e-9, 0.999999996, -9999.999999996, 5e-324])
    nothing = "0.00000000"
    told = [nothing, nothing, nothing, "-0.00000001", "1.00000000", "-10000.00000000", nothing]
    assert numbers_of(values, 8) == told


def test_what_stands_around_them() -> None:
    values = np.array([[1.0, 2.0, 3.0], [-1.0, 20.5, 0.0]])
    text = number_lines(["", ", ", "|"], values, 4, [b"\r\n", b" end\r\n"])
    assert text == b"1.0000, 2.0000|3.0000\r\n-1.0000, 20.5000|0.0000 end\r\n"
