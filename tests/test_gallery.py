"""The gallery: every picture that the README shows is one that the script draws, of a program that exists."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs" / "pictures"


def drawn():
    """Name, program and cell of every picture, read without matplotlib."""
    tree = ast.parse((PICTURES / "draw_gallery.py").read_text(encoding="utf-8"))
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    made = [call for call in calls if isinstance(call.func, ast.Name) and call.func.id == "Picture"]
    return [tuple(argument.value for argument in call.args[:3]) for call in made]


def test_the_readme_shows_what_is_drawn():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    shown = re.findall(r"\(docs/pictures/gallery_(\w+)\.png\)", readme)
    assert sorted(shown) == sorted(name for name, _, _ in drawn())
    assert len(set(shown)) == len(shown) >= 4


def test_pictures_are_there_and_small():
    for name, program, cell in drawn():
        assert (ROOT / "programs" / program).is_file()
        assert (ROOT / "programs" / cell).is_file()
        picture = (PICTURES / f"gallery_{name}.png").read_bytes()
        assert picture.startswith(b"\x89PNG")
        assert int.from_bytes(picture[16:20], "big") == 800
        assert len(picture) < 200_000
