"""Messages that the documents show are such as irlx gives: severity and words of the catalogue."""

import re
from pathlib import Path

import pytest

from irlx.diagnostics import CATALOGUE

ROOT = Path(__file__).parents[2]
SHOWN = re.compile(r"\b(error|warning|info) (IRL\d{3}): (.*)")
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def shown_messages():
    for page in PAGES:
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            if found := SHOWN.search(line):
                yield pytest.param(*found.groups(), id=f"{page.relative_to(ROOT)}:{number}")


def with_any_values(message):
    """What a message of the catalogue may look like."""
    return "".join(
        ".*" if part.startswith("{") else re.escape(part) for part in re.split(r"({.*?})", message)
    )


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize(("severity", "code", "words"), list(shown_messages()))
def test_a_message_shown_is_one_of_the_catalogue(severity, code, words):
    entry = CATALOGUE[code]
    assert severity == entry.severity.value
    assert re.fullmatch(with_any_values(entry.message), words)
