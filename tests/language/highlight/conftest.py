"""The programs that are coloured: those of the repository and the conformance cases."""

from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="session")
def sources():
    """Texts of all programs, modules and data lists, by their path, also those with mistakes in them."""
    found = [
        path
        for folder in ("programs", "tests/conformance", "tests/language/data")
        for ending in ("irl", "dat")
        for path in sorted((ROOT / folder).rglob(f"*.{ending}"))
    ]
    texts = {}
    for path in found:
        try:
            texts[path.relative_to(ROOT).as_posix()] = path.read_bytes().decode("utf-8")
        except UnicodeDecodeError:
            continue
    assert len(texts) > 250
    return texts
