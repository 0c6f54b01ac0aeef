"""Every requirement has a test, every mark a requirement, and the table in the docs is that of today."""

import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
QUALITY = ROOT / "docs" / "quality.md"


@pytest.fixture(scope="module")
def matrix():
    """The script that writes the table, as names."""
    return runpy.run_path(str(ROOT / "docs" / "make_matrix.py"))


@pytest.fixture(scope="module")
def marked(matrix):
    return matrix["marked"]()


@pytest.mark.req("QA-01")
def test_no_requirement_is_without_a_test(matrix, marked):
    assert [name for name in matrix["ids"]() if name not in marked] == []


@pytest.mark.req("QA-01")
def test_marks_name_requirements(matrix, marked):
    assert set(marked) <= set(matrix["ids"]())


def test_ids_stand_once_and_under_their_area(matrix):
    ids = matrix["ids"]()
    assert len(ids) == len(set(ids)) > 100
    for area, entries in matrix["requirements"]().items():
        assert (ROOT / "docs" / entries["page"]).is_file()
        assert all(name.startswith(f"{area}-") for name in entries if name not in {"title", "page"})


def test_the_reference_names_no_other_requirements(matrix):
    areas, known = "|".join(matrix["requirements"]()), set(matrix["ids"]())
    for page in (ROOT / "docs").rglob("*.md"):
        named = set(re.findall(rf"\b(?:{areas})-\d\d\b", page.read_text("utf-8")))
        assert named <= known, page.name


def test_the_table_is_that_of_today(matrix):
    # If this fails: python docs/make_matrix.py
    text = QUALITY.read_text("utf-8")
    assert matrix["rewritten"](text) == text


def test_marks_are_found_wherever_they_stand(matrix, tmp_path):
    path = tmp_path / "test_some.py"
    path.write_text(
        "import pytest\n"
        'CASES = [pytest.param(1, marks=pytest.mark.req("LANG-02"))]\n'
        '@pytest.mark.req("LANG-01")\n'
        '@pytest.mark.parametrize("x", [pytest.param(1, marks=[pytest.mark.req("MOT-01")])])\n'
        "def test_one(x): ...\n"
        "class TestMore:\n"
        '    @pytest.mark.req("LANG-01")\n'
        "    def test_two(self): ...\n"
        "def not_one(): ...\n",
        encoding="utf-8",
    )
    assert matrix["_marks_of"](path) == {
        "LANG-01": ["test_one", "test_two"],
        "MOT-01": ["test_one"],
        "LANG-02": ["test_one", "test_two"],
    }


@pytest.mark.req("QA-12")
def test_long_campaigns_are_left_to_the_hand_and_listed(matrix):
    options = matrix["tomllib"].loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["pytest"][
        "ini_options"
    ]
    assert "-m 'not slow'" in options["addopts"]
    text = QUALITY.read_text("utf-8")
    missing = []
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        name = path.relative_to(ROOT).as_posix()
        if "mark.slow" in path.read_text("utf-8") and path.name != Path(__file__).name:
            folders = [f"`{folder.as_posix()}`" for folder in Path(name).parents]
            if not any(listed in text for listed in (f"`{name}`", *folders)):
                missing.append(name)
    assert missing == []


@pytest.mark.req("QA-12")
def test_the_gate_carries_out_what_the_readme_says():
    gate = (ROOT / ".ci" / "run").read_text("utf-8").splitlines()[-1]
    assert gate.startswith("python -m pytest")
    assert gate in (ROOT / "README.md").read_text("utf-8") + (ROOT / "CONTRIBUTING.md").read_text("utf-8")


@pytest.mark.parametrize("page", ["README.md", "SECURITY.md", "CONTRIBUTING.md", "docs/quality.md"])
def test_tests_that_documents_name_are_there(page):
    named = set(re.findall(r"`(tests/[\w/]+\.py)(?:::(\w+))?", (ROOT / page).read_text("utf-8")))
    assert named
    for file, test in sorted(named):
        assert (ROOT / file).is_file(), file
        assert not test or f"def {test}(" in (ROOT / file).read_text("utf-8"), f"{file}::{test}"
