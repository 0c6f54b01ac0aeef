"""From bytes to text."""

import pytest

from irlx.diagnostics import IrlxError
from irlx.language.source import decode_source, source_text


@pytest.mark.req("LANG-01")
def test_byte_order_mark_is_dropped_and_text_normalised():
    assert decode_source("a.irl", b"\xef\xbb\xbfa\xcc\x81").text == "\u00e1"
    assert source_text("a.irl", "\ufeffx").text == "x"


@pytest.mark.parametrize(
    ("content", "code", "message"),
    [
        (b"PROGRAM gr\xfcn;", "IRL130", "not UTF-8 text: byte 0xFC at offset 10"),
        (b"\xc3", "IRL130", "not UTF-8 text: byte 0xC3 at offset 0"),
        (b"PRO\0GRAM", "IRL131", "not a text file: NUL byte at offset 3"),
    ],
)
def test_what_is_no_text(content, code, message):
    with pytest.raises(IrlxError) as raised:
        decode_source("a.irl", content)
    assert raised.value.reason.code == code
    assert raised.value.reason.message == message
    assert raised.value.reason.place is not None
    assert str(raised.value.reason.place).startswith("a.irl: byte ")
