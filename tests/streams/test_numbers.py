"""Text -> float64 against Python's own reading, bit by bit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from irlx.streams.irdata.numbers import counts_of, floats_of

PLAIN = b"0123456789+-.e"


def places(texts: list[bytes]) -> tuple[bytes, np.ndarray, np.ndarray]:
    """Texts with a comma behind each, and where each begins and ends."""
    ends = np.cumsum([len(text) + 1 for text in texts]) - 1
    return b",".join([*texts, b""]), ends - [len(text) for text in texts], ends


def assert_as_python(texts: list[bytes], allowed: bytes = PLAIN) -> None:
    found = floats_of(*places(texts), allowed)
    wanted = np.array([float(text) for text in texts])
    assert np.array_equal(found.view(np.int64), wanted.view(np.int64))


@pytest.mark.req("STR-01")
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1))
def test_any_float_comes_back(values: list[float]) -> None:
    texts = [f"{value:.16e}".encode() for value in values]
    assert np.array_equal(floats_of(*places(texts), PLAIN).view(np.int64), np.array(values).view(np.int64))
    assert_as_python([text.rjust(24) for text in texts], PLAIN + b" ")
    assert_as_python([repr(value).encode() for value in values])


@pytest.mark.req("STR-01")
@pytest.mark.parametrize("seed", range(4))
def test_any_digits_are_rounded_to_the_nearest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    digits = rng.integers(0, 10**17, 20_000)
    exponents = rng.integers(-99, 100, 20_000)
    signs = rng.choice(["", "-"], 20_000)
    words = [f"{m:017d}" for m in digits.tolist()]
    assert_as_python(
        [f"{s}{w[0]}.{w[1:]}e{e:+03d}".encode() for s, w, e in zip(signs, words, exponents, strict=True)]
    )


def test_numbers_half_way_between_two_floats() -> None:
    """Whole numbers beyond 2^53 that lie exactly between two floats, and their neighbours."""
    texts = []
    for power in (53, 54, 55, 56):
        half = 2 ** (power - 53)
        for odd in (1, 3, 5, 777, 2**20 + 1, 2**50 - 1):
            for number in (2**power + odd * half + near for near in (-1, 0, 1)):
                if number < 10**17:
                    text = str(number)
                    texts.append(f"{text[0]}.{text[1:].ljust(16, '0')}e+{len(text) - 1:02d}".encode())
    assert len(texts) > 60
    assert_as_python(texts)


def test_extremes_and_zeros() -> None:
    values = [5e-324, 1e-320, 2.2250738585072014e-308, 1.7976931348623157e308, 0.0, -0.0, 1e-99, 9.9e99, 1e22]
    texts = [f"{sign * value:.16e}".encode() for value in values for sign in (1, -1)]
    assert_as_python(texts)
    assert_as_python(
        [*texts, b"0.0000000000000001e-99", b"-0.0000000000000000e-99", b"9.9999999999999999e+99"]
    )
    assert floats_of(*places([b"1e999"]), PLAIN).tolist() == [np.inf]


@pytest.mark.parametrize("seed", range(3))
def test_damaged_numbers_are_read_as_python_reads_them_or_refused(seed: int) -> None:
    rng = np.random.default_rng(seed)
    read = refused = 0
    for _ in range(3000):
        text = bytearray(f"{rng.normal() * 10.0 ** rng.integers(-9, 9):.16e}".encode())
        text[rng.integers(len(text))] = b"0123456789+-.e _,x\n"[rng.integers(18)]
        line, starts, ends = bytes(text) + b",1.0,", np.array([0]), np.array([len(text)])
        try:
            if text.translate(None, PLAIN):
                raise ValueError
            wanted = float(text)
        except ValueError:
            refused += 1
            with pytest.raises(ValueError, match=r"number|float"):
                floats_of(line, starts, ends, PLAIN)
        else:
            read += 1
            assert floats_of(line, starts, ends, PLAIN).tobytes() == np.float64(wanted).tobytes()
    assert min(read, refused) > 300


def test_blanks_only_where_they_are_allowed() -> None:
    padded = b" -1.5000000000000000e+00"
    assert floats_of(*places([padded]), PLAIN + b" ").tolist() == [-1.5]
    with pytest.raises(ValueError, match="characters"):
        floats_of(*places([padded]), PLAIN)


def test_counts() -> None:
    texts = [b"0", b"7", b"00042", b"123456789012345", b"10"]
    assert counts_of(*places(texts)).tolist() == [0, 7, 42, 123456789012345, 10]
    for wrong in (b"", b"1234567890123456", b"-1", b"1.", b"1e3", b" 1"):
        with pytest.raises(ValueError, match="count"):
            counts_of(*places([b"1", wrong]))
