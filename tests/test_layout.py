"""The order of the house: who may import whom, and how long a module or function may be."""

import ast
from functools import cache
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "src" / "irlx"
ORDER = (
    "diagnostics",
    "language",
    "blocks",
    "solids",
    "robot",
    "scene",
    "interpreter",
    "motion",
    "transform",
    "pacing",
    "cell",
    "streams",
    "exporters",
    "verifier",
    "report",
    "notebook",
    "viewer",
    "cli",
)
"""Folders of the package; each may import from those before it and from itself."""
DOORS = {"notebook", "viewer", "cli"}
"""Folders through which people come in: they use what wires stages together."""
WIRING = {
    "given_inputs",
    "given_values",
    "job",
    "pipeline",
    "one_thread",
    "running",
    "recorded",
    "reproduction",
    "program",
    "checking",
    "dry_run",
    "first_program",
    "verification",
    "registration",
    "conformance",
    "conversion",
    "plotting",
}
"""Modules that wire stages together: only the doors, the package itself and they import them."""
ANYWHERE = {"_version", "promises"}

MOST_LINES = 450
LONGEST_FUNCTION = 60

MODULES = sorted(SOURCE.rglob("*.py"))


PARTS = sorted({path.relative_to(SOURCE).parts[0] for path in MODULES})
"""Folders of the package, and its own modules."""


def name_of(path):
    return path.relative_to(SOURCE).as_posix()


def modules_in(part):
    return [path for path in MODULES if path.relative_to(SOURCE).parts[0] == part]


STATEMENTS = ast.stmt | ast.excepthandler | ast.match_case


@cache
def text_of(path):
    return path.read_text(encoding="utf-8")


@cache
def nodes_of(path):
    """A module and its statements, those within others too: expressions, most of a tree, tell nothing."""
    found = [ast.parse(text_of(path))]
    for node in found:
        found += [child for child in ast.iter_child_nodes(node) if isinstance(child, STATEMENTS)]
    return tuple(found)


def imported_modules(path):
    """Absolute names of everything of irlx that a module imports, wherever in its text."""
    package = ["irlx", *path.relative_to(SOURCE).parent.parts]
    for node in nodes_of(path):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            module = ".".join([*base, *([node.module] if node.module else [])])
            yield from (f"{module}.{alias.name}" for alias in node.names)


def parts_used(path):
    """Folders and top-level modules of irlx that a module imports from."""
    names = {name.split(".")[1] for name in imported_modules(path) if name.startswith("irlx.")}
    return {name for name in names if (SOURCE / name).is_dir() or (SOURCE / f"{name}.py").is_file()}


def test_every_folder_has_its_place():
    folders = {path.name for path in SOURCE.iterdir() if path.is_dir() and any(path.glob("*.py"))}
    assert folders <= set(ORDER)
    top = {path.stem for path in SOURCE.glob("*.py")}
    assert top == WIRING | ANYWHERE | {"__init__", "__main__"}


@pytest.mark.req("QA-01")
@pytest.mark.parametrize("folder", PARTS)
def test_imports_go_upwards(folder):
    if folder in ORDER:
        allowed = {*ORDER[: ORDER.index(folder) + 1], *ANYWHERE}
        if folder in DOORS:
            allowed |= WIRING
    elif folder == "__main__.py":
        allowed = {"cli"}
    else:
        allowed = {*ORDER, *WIRING, *ANYWHERE} - {"cli"}
    beyond = {name_of(path): more for path in modules_in(folder) if (more := parts_used(path) - allowed)}
    assert not beyond


@pytest.mark.parametrize("part", PARTS)
def test_sizes(part):
    for path in modules_in(part):
        assert len(text_of(path).splitlines()) <= MOST_LINES, name_of(path)
        for node in nodes_of(path):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                lines = node.end_lineno - node.lineno
                assert lines < LONGEST_FUNCTION, f"{name_of(path)}: {node.name}"


@pytest.mark.parametrize("folder", ["language", "blocks", "diagnostics", "interpreter"])
def test_stages_that_know_no_numerics(folder):
    heavy = {"numpy", "scipy", "pinocchio", "proxsuite", "pydantic"}
    for path in (SOURCE / folder).rglob("*.py"):
        assert heavy.isdisjoint(name.split(".")[0] for name in imported_modules(path)), name_of(path)


def test_no_module_for_everything():
    assert not [name_of(path) for path in MODULES if path.stem in ("utils", "helpers", "common", "misc")]
