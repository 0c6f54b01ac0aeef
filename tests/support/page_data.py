"""The data in a replay page, read as a browser would."""

import json
from html.parser import HTMLParser
from pathlib import Path


class _Reader(HTMLParser):
    """Collects the text of the data element, and every attribute that would fetch something."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.data, self.title, self.fetched, self._inside = "", "", [], ""

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self._inside = "data" if given.get("id") == "irlx-data" else tag
        self.fetched += [given[name] for name in ("src", "href", "action") if given.get(name)]

    def handle_endtag(self, tag):
        self._inside = ""

    def handle_data(self, data):
        if self._inside == "data":
            self.data += data
        elif self._inside == "title":
            self.title += data


def read_page(html):
    """The reader behind a page, a text or a path."""
    reader = _Reader()
    reader.feed(html if isinstance(html, str) else Path(html).read_text(encoding="utf-8"))
    return reader


def page_data(html):
    """The data of a page."""
    return json.loads(read_page(html).data)
