"""The page around the data of a replay: one HTML file that asks no host for anything."""

from __future__ import annotations

import re
from functools import cache
from html import escape
from importlib.resources import files

from irlx.report.legible import legible

_FOLDER = files("irlx.report") / "page"
_MARK = re.compile(r"\{\{(title|style|script|data)\}\}")
_END_OF_SCRIPT = re.compile(r"</(?=script)", re.IGNORECASE)


def page_of(title: str, data: bytes) -> bytes:
    """HTML, UTF-8, of a page that is called `title` and shows the JSON `data`.

    Text of programs may hold anything: nothing of it ends the element that it stands in, nor opens another.
    """
    parts = {
        "title": escape(legible(title)),
        "style": _asset("page.css"),
        "script": _END_OF_SCRIPT.sub(r"<\\/", _asset("page.js")),
        "data": _harmless(data.decode("utf-8")),
    }
    # In one pass: a mark in a text that is put in stays as it is.
    return _MARK.sub(lambda mark: parts[mark[1]], _asset("page.html")).encode("utf-8")


def _harmless(json: str) -> str:
    """The same JSON without characters that mean something to HTML, or are line ends to some scripts."""
    for character in "<>&\u2028\u2029":
        json = json.replace(character, f"\\u{ord(character):04x}")
    return json


@cache
def _asset(name: str) -> str:
    return (_FOLDER / name).read_text(encoding="utf-8")
