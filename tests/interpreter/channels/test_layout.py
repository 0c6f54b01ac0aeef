"""Texts of values, against Python's own formatting."""

import random
from decimal import Decimal

import pytest

from irlx.interpreter.channels.layout import laid_out, plain


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0, "0"),
        (-(2**63), "-9223372036854775808"),
        (1.0, "1.0"),
        (0.1, "0.1"),
        (-0.0, "-0.0"),
        (1e16, "1E+16"),
        (5e-324, "5E-324"),
        (True, "TRUE"),
        (False, "FALSE"),
        ("it's", "it's"),
        ("", ""),
    ],
)
def test_plain(value, text):
    assert plain(value) == text


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize("seed", range(4))
def test_layouts_against_python(seed):
    chance = random.Random(seed)
    for _ in range(300):
        width, precision = chance.choice([0, 1, 5, 12, 1000]), chance.choice([0, 1, 3, 17, 100])
        x = chance.choice([0.0, -0.0, 0.5, 2.5, 1e300, 5e-324, chance.gauss(0, 1e3)])
        i = chance.choice([0, -1, 2**63 - 1, -(2**63), chance.randint(-999, 999)])
        assert laid_out(x, width, precision) == f"{x:{width}.{precision}f}"
        # Decimal has room for every digit of an INT, float has not.
        assert laid_out(i, width, precision) == f"{Decimal(i):{width}.{precision}f}"
        assert laid_out(i, width, None) == f"{i:{width}d}"
        for text in ("", "ab", "żółć", "x" * 20):
            assert laid_out(text, width, None) == f"{text:>{width}}"
        assert laid_out(True, width, None) == f"{'TRUE':>{width}}"
        assert float(laid_out(x, width, None)) == x
