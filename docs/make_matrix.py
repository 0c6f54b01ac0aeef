"""Writes the table of requirements and their tests in `docs/quality.md`.

python docs/make_matrix.py           # rewrites the table
python docs/make_matrix.py --check   # exit code 1 where it is not up to date
python docs/make_matrix.py LANG-04   # names the tests of an id

Requirements are those of `docs/requirements.toml`; tests carry them by `@pytest.mark.req("LANG-01")`, on a
function, on a case of it (`marks=`) or, as `pytestmark`, on a module. Marks are read from the text of the
tests; nothing is carried out.
"""

from __future__ import annotations

import argparse
import ast
import sys
from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

HERE = Path(__file__).resolve().parent
TESTS = HERE.parent / "tests"
QUALITY = HERE / "quality.md"
BEGIN = "<!-- requirements: written by make_matrix.py -->\n"
END = "<!-- end of requirements -->\n"
# A row names the files with most tests of an id; counts would change with every new test.
FILES_SHOWN = 3


def requirements() -> dict[str, dict[str, str]]:
    """Areas of `requirements.toml`, each with `title`, `page` and the sentences of its ids."""
    return tomllib.loads((HERE / "requirements.toml").read_text(encoding="utf-8"))


def ids() -> list[str]:
    """All ids, in the order of the file."""
    return [name for area in requirements().values() for name in area if name not in {"title", "page"}]


@cache
def marked() -> dict[str, dict[str, list[str]]]:
    """Tests by requirement and file: `{id: {"cli/test_files.py": ["test_x", ...]}}`, in sorted order."""
    found: dict[str, dict[str, list[str]]] = defaultdict(dict)
    for path in sorted(TESTS.rglob("test_*.py")):
        for name, tests in _marks_of(path).items():
            found[name][path.relative_to(TESTS).as_posix()] = tests
    return found


def _marks_of(path: Path) -> dict[str, list[str]]:
    text = path.read_text(encoding="utf-8")
    if "mark.req(" not in text:
        return {}
    outside, tests = _parts(ast.parse(text).body)
    found: dict[str, list[str]] = defaultdict(list)
    for test in tests:
        for name in sorted({*_names(test.decorator_list)}):
            found[name].append(test.name)
    # What stands outside of tests holds for all of them: pytestmark, and lists of cases above their test.
    for name in _names(outside):
        found[name] += [test.name for test in tests if test.name not in found[name]]
    return found


def _parts(body: Sequence[ast.stmt]) -> tuple[list[ast.AST], list[ast.FunctionDef]]:
    """What of a module or class is no function, and its tests."""
    outside: list[ast.AST] = []
    tests: list[ast.FunctionDef] = []
    for node in body:
        if isinstance(node, ast.ClassDef):
            within, more = _parts(node.body)
            outside += [*node.decorator_list, *within]
            tests += more
        elif not isinstance(node, ast.FunctionDef):
            outside.append(node)
        elif node.name.startswith("test"):
            tests.append(node)
    return outside, tests


def _names(nodes: Sequence[ast.AST]) -> Iterator[str]:
    yield from (name for whole in nodes for node in ast.walk(whole) if (name := _name_of(node)))


def _name_of(node: ast.AST) -> str:
    """The id of a call `pytest.mark.req(id)`, else nothing."""
    match node:
        case ast.Call(func=ast.Attribute(attr="req"), args=[ast.Constant(value=str(name))]):
            return name
    return ""


def table() -> str:
    """Markdown: a table an area, a row an id: its sentence and the files that hold most of its tests."""
    tests = marked()
    lines: list[str] = []
    for area in requirements().values():
        page = Path(area["page"]).name
        lines += ["", f"### {area['title']}", "", f"Described in [{page}]({area['page']}).", ""]
        lines += ["| id | what | tests |", "|---|---|---|"]
        for name, sentence in area.items():
            if name not in {"title", "page"}:
                lines.append(f"| {name} | {sentence} | {_shown(tests.get(name, {}))} |")
    return "\n".join([*lines, "", ""])


def _shown(files: dict[str, list[str]]) -> str:
    ordered = sorted(files, key=lambda file: (-len(files[file]), file))
    names = [f"`{file}`" for file in ordered[:FILES_SHOWN]]
    return ", ".join(names) + (" and others" if len(ordered) > FILES_SHOWN else "")


def rewritten(text: str) -> str:
    """The page with the table of today.

    Raises:
        ValueError: The page lacks one of the two marks.
    """
    before, _, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not end:
        raise ValueError(f"{QUALITY.name} needs the lines {BEGIN.strip()} and {END.strip()}")
    return before + BEGIN + table() + END + after


def main() -> int:
    """Write, check, or name tests; the exit code."""
    parser = argparse.ArgumentParser(description="Writes the table of requirements and their tests.")
    parser.add_argument("id", nargs="?", help="only name the tests of this requirement")
    parser.add_argument("--check", action="store_true", help="only say whether the table is up to date")
    arguments = parser.parse_args()
    if arguments.id:
        for file, tests in marked().get(arguments.id, {}).items():
            print(*(f"tests/{file}::{test}" for test in tests), sep="\n")
        return int(arguments.id not in ids())
    text = QUALITY.read_text(encoding="utf-8")
    new = rewritten(text)
    if arguments.check:
        return int(new != text)
    QUALITY.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
