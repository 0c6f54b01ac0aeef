"""One record: number, code and operands <-> one line of text."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass

Scalar = int | float | str | bool | None
Value = Scalar | list[Scalar]

LINE_END = b" ;\n"

_TOKEN = re.compile(
    r'(?P<text>"(?:[^"\\\x00-\x1f]|\\.)*")'
    r"|(?P<word>(?:true|false|none)\b)"
    r"|(?P<float>-?(?:[0-9]+(?:\.[0-9]+(?:e[+-]?[0-9]+)?|e[+-]?[0-9]+)|inf\b)|nan\b)"
    r"|(?P<int>-?[0-9]{1,18}(?![0-9.e]))"
)
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(?:\.[A-Za-z0-9_]+)*=")
_HEAD = re.compile(r"([1-9][0-9]{0,17}), ([0-9]{3})(?=[ ,])")
_WORDS: dict[str, Scalar] = {"true": True, "false": False, "none": None}
_SURROGATE = re.compile("[\ud800-\udfff]")


class RecordError(ValueError):
    """Text that is no record, or a record with other operands than its code has."""


@dataclass(frozen=True)
class Record:
    """Number (from 1), code, and the operands in order; `names` has '' where an operand has no name."""

    number: int
    code: int
    names: tuple[str, ...]
    values: tuple[Value, ...]

    def fields(self) -> dict[str, Value]:
        """Operands by name; raises RecordError where one has no name, or two have the same."""
        if "" in self.names:
            raise RecordError(f"operand {self.names.index('') + 1} needs a name")
        found = dict(zip(self.names, self.values, strict=True))
        if len(found) != len(self.names):
            raise RecordError("two operands have the same name")
        return found


def record_text(number: int, code: int, operands: dict[str, Value]) -> bytes:
    """Line of a record with named operands, UTF-8, line end included."""
    words = [f"{name}={value_text(value)}" for name, value in operands.items()]
    return ", ".join([str(number), f"{code:03d}", *words]).encode() + LINE_END


def value_text(value: Value) -> str:
    """Text of an operand's value: numbers by repr (they read back to the same bits), strings quoted."""
    if isinstance(value, list):
        return f"({' '.join(map(value_text, value))})"
    if value is None or isinstance(value, bool):
        return {None: "none", True: "true", False: "false"}[value]
    if isinstance(value, str):
        quoted = json.dumps(value, ensure_ascii=False)
        # File names may hold bytes that are no text; UTF-8 has no form for what they become.
        return _SURROGATE.sub(lambda found: f"\\u{ord(found[0]):04x}", quoted)
    return repr(float(value)) if isinstance(value, float) else repr(int(value))


def parse_record(line: bytes) -> Record:
    """Record of a line (with or without its line end); raises RecordError saying what is wrong."""
    try:
        text = line.removesuffix(b"\n").decode()
    except UnicodeDecodeError as cause:
        raise RecordError(f"it is no UTF-8 text (byte {cause.start + 1})") from cause
    if not text.endswith(" ;"):
        raise RecordError("it does not end with ' ;'")
    head = _HEAD.match(text)
    if head is None:
        raise RecordError("it does not begin with a record number and a code of three digits")
    names, values = [], []
    at = head.end()
    while not text.startswith(" ;", at):
        if not text.startswith(", ", at):
            raise RecordError(f"column {at + 1}: ', ' or ' ;' is missing")
        name = _NAME.match(text, at + 2)
        value, at = _value(text, name.end() if name else at + 2)
        names.append(name[0][:-1] if name else "")
        values.append(value)
    if at + 2 != len(text):
        raise RecordError(f"column {at + 3}: text follows the end of the record")
    return Record(int(head[1]), int(head[2]), tuple(names), tuple(values))


def _value(text: str, at: int) -> tuple[Value, int]:
    """Value that begins at an offset, and the offset behind it."""
    if not text.startswith("(", at):
        return _scalar(text, at)
    items: list[Scalar] = []
    at += 1
    while not text.startswith(")", at):
        if items:
            if not text.startswith(" ", at):
                raise RecordError(f"column {at + 1}: a blank or ')' is missing")
            at += 1
        item, at = _scalar(text, at)
        items.append(item)
    return items, at + 1


def _scalar(text: str, at: int) -> tuple[Scalar, int]:
    token = _TOKEN.match(text, at)
    if token is None:
        raise RecordError(f"column {at + 1}: a value is missing")
    word = token[0]
    kind = token.lastgroup
    if kind == "text":
        try:
            return str(json.loads(word)), token.end()
        except ValueError as cause:
            raise RecordError(f"column {at + 1}: the string holds a wrong escape") from cause
    if kind == "word":
        return _WORDS[word], token.end()
    return (int(word) if kind == "int" else float(word)), token.end()
