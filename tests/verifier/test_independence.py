"""The verifier shares with the rest readers, blocks, plain robot data and promised numbers; nothing else."""

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src" / "irlx"
SHARED = {
    "irlx.blocks",
    "irlx.blocks.codec",
    "irlx.diagnostics",
    "irlx.promises",
    "irlx.robot.axis_direction",
    "irlx.robot.description",
    "irlx.robot.limits",
    "irlx.robot.link_path",
    "irlx.robot.relation",
    "irlx.scene.obstacle",
    "irlx.scene.scene",
    "irlx.solids.mesh_file",
    "irlx.solids.placement",
    "irlx.solids.shape",
    "irlx.streams.error",
    "irlx.streams.joint_stream",
    "irlx.streams.scan",
}
"""What its modules may import of irlx, beside each other."""
LIBRARIES = {"numpy", "numpy.typing"}


def imports(path: Path) -> set[str]:
    """What a module imports when it runs; what types alone ask for does not count."""
    found = set()
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for_types = [
        part
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING"
        for part in node.body
    ]
    for node in ast.walk(tree):
        if node in for_types:
            continue
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            found.add(node.module)
    return found


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("path", sorted((SOURCE / "verifier").rglob("*.py")), ids=lambda path: path.name)
def test_a_module_imports_only_what_is_shared(path):
    used = imports(path)
    of_irlx = {name for name in used if name.split(".")[0] == "irlx"}
    assert {name for name in of_irlx if not name.startswith("irlx.verifier")} <= SHARED
    numeric = {"numpy", "scipy", "pinocchio", "proxsuite", "pin", "coal", "hppfcl"}
    assert {name for name in used if name.split(".")[0] in numeric} <= LIBRARIES


@pytest.mark.req("STR-06")
def test_what_is_shared_holds_no_motion():
    """The shared modules import nothing that computes motion either, wherever they lead."""
    waiting, seen = set(SHARED), set()
    while waiting:
        name = waiting.pop()
        seen.add(name)
        file = SOURCE.parent.joinpath(*name.split("."))
        file = file / "__init__.py" if file.is_dir() else file.with_suffix(".py")
        waiting |= {n for n in imports(file) if n.split(".")[0] == "irlx" and n != "irlx._version"} - seen
    parts = {name.split(".")[1] for name in seen}
    assert parts <= {"blocks", "diagnostics", "promises", "robot", "scene", "solids", "streams"}
    assert not any(name.startswith("irlx.robot.kinematics") for name in seen)
    # Of the scene its plain data, not the distances that the motion keeps.
    assert {name for name in seen if name.startswith("irlx.scene")} == {
        "irlx.scene.obstacle",
        "irlx.scene.scene",
    }
