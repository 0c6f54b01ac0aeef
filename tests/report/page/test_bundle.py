"""The committed bundle of the replay page: licences, size, and that its sources give it."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

import irlx

ASSETS = Path(irlx.__file__).parent / "report" / "page"
SOURCES = Path(__file__).parents[3] / "page"
FILES = ("page.js", "page.css", "page.html", "LICENCES.txt")
MOST_BYTES = 800_000


def text_of(name):
    return (ASSETS / name).read_text(encoding="utf-8")


def test_it_is_small_enough():
    assert sum((ASSETS / name).stat().st_size for name in FILES) < MOST_BYTES


def test_notices_of_what_is_bundled_are_kept():
    notices = text_of("LICENCES.txt")
    for words in ("three.js authors", "Leon Sorokin", "Permission is hereby granted, free of charge"):
        assert words in notices
    assert notices in text_of("page.js")
    assert notices.count("THE SOFTWARE IS PROVIDED") == 2


@pytest.mark.req("REP-04")
def test_no_address_is_in_it():
    # The names of the XML languages that elements are made of look like addresses; nothing asks for them.
    names = r"http://www\.w3\.org/(?:1999/xhtml|2000/svg)"
    address = re.compile(r"(?:https?:)?//[a-z0-9-]+\.[a-z]", re.IGNORECASE)
    for name in FILES:
        assert not address.findall(re.sub(names, "", text_of(name)))


def test_the_template_has_its_marks_once():
    marks = re.findall(r"\{\{(\w+)\}\}", text_of("page.html"))
    assert sorted(set(marks)) == ["data", "script", "style", "title"]
    assert not re.search(r"\{\{(title|style|script|data)\}\}", text_of("page.js") + text_of("page.css"))
    # What is put into <script> and <style> does not end them.
    assert not re.search(r"</(script|style)|<!--", text_of("page.js") + text_of("page.css"), re.IGNORECASE)


def test_the_lock_names_no_host():
    lock = (SOURCES / "package-lock.json").read_text(encoding="utf-8")
    assert '"integrity"' in lock
    assert "://" not in lock


@pytest.mark.slow
def test_the_sources_give_the_same_bytes(tmp_path):
    """Needs node, npm and a network."""
    npm = shutil.which("npm")
    if npm is None:
        pytest.skip("npm is not installed")
    copy = tmp_path / "page"
    shutil.copytree(SOURCES, copy, ignore=shutil.ignore_patterns("node_modules"))
    subprocess.run([npm, "ci", "--no-audit", "--no-fund"], cwd=copy, check=True, capture_output=True)
    built = tmp_path / "built"
    subprocess.run([npm, "run", "build", "--", str(built)], cwd=copy, check=True, capture_output=True)
    for name in FILES:
        assert (built / name).read_bytes() == (ASSETS / name).read_bytes(), name
