"""Bytes or text of a program file to a `SourceText`: UTF-8, without byte-order mark, in NFC."""

from __future__ import annotations

from unicodedata import normalize

from irlx.diagnostics import Diagnostic, IrlxError, Place, SourceText, report

__all__ = ["decode_source", "source_text"]

_BYTE_ORDER_MARK = "\ufeff"


def source_text(name: str, text: str) -> SourceText:
    """Text of a program under the name that messages shall give it."""
    return SourceText(name, normalize("NFC", text.removeprefix(_BYTE_ORDER_MARK)))


def decode_source(name: str, content: bytes) -> SourceText:
    """Decode the bytes of a program file.

    Raises IrlxError with IRL130 for bytes that are not UTF-8 and IRL131 for binary content; both name
    the offset of the byte.
    """
    finding = _binary(name, content)
    if finding is not None:
        raise IrlxError(finding)
    try:
        return source_text(name, content.decode("utf-8"))
    except UnicodeDecodeError as error:
        place = Place(name, key=f"byte {error.start}")
        byte = f"0x{content[error.start]:02X}"
        raise IrlxError(report("IRL130", place, byte=byte, offset=error.start)) from None


def _binary(name: str, content: bytes) -> Diagnostic | None:
    offset = content.find(0)
    if offset < 0:
        return None
    return report("IRL131", Place(name, key=f"byte {offset}"), offset=offset)
