"""The page around the data: whatever programs and file names hold, it stays data."""

import json

import pytest

from irlx.report.replay import page
from page_data import read_page

pytestmark = pytest.mark.req("REP-04")

NASTY = [
    "</script><script>alert(1)</script>",
    "<!-- <script>",
    "]]> & &amp; &lt;",
    "line\u2028separator\u2029paragraph",
    "{{script}} {{data}} {{title}} \\1 \\g<1>",
    '"quotes" \\u003c \\',
    "ściana 🤖 \U0010ffff",
]


@pytest.mark.parametrize("text", NASTY)
def test_any_text_comes_out_as_it_went_in(text):
    html = page.page_of(text, json.dumps({"text": text}, ensure_ascii=False).encode()).decode()
    reader = read_page(html)
    assert json.loads(reader.data) == {"text": text}
    assert reader.title.startswith(text)
    plain = page.page_of("", b"{}").decode()
    assert html.count("<script") == plain.count("<script")
    assert html.count("</script>") == plain.count("</script>")
    assert not {"\u2028", "\u2029"} & set(json.loads(json.dumps(reader.data)))


def test_a_page_fetches_nothing():
    reader = read_page(page.page_of("t", b"{}").decode())
    assert [name for name in reader.fetched if not name.startswith(("#", "data:"))] == []
    html = page.page_of("t", b"{}").decode()
    assert "@import" not in html
    assert "url(http" not in html


def test_scripts_cannot_end_their_element(monkeypatch):
    assets = {"page.html": "<script>{{script}}</script>", "page.css": "", "page.js": 's = "</SCRIPT>";'}
    monkeypatch.setattr(page, "_asset", assets.__getitem__)
    assert page.page_of("t", b"{}") == b'<script>s = "<\\/SCRIPT>";</script>'
