"""The gallery: every picture that the README shows is one that the script draws, of a program that exists."""

import ast
import importlib.util
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


def all_commands():
    spec = importlib.util.spec_from_file_location("all_pictures", PICTURES / "__main__.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return [" ".join(command) for command in module.commands()]


def test_one_command_draws_every_picture():
    drawing = all_commands()
    assert all((ROOT / command.split()[0]).is_file() for command in drawing)
    drawn_kinds = {Path(command.split()[0]).stem.removeprefix("draw_") for command in drawing}
    pictures = [path for path in PICTURES.iterdir() if path.suffix in (".png", ".svg")]
    assert len(pictures) >= 25
    for picture in pictures:
        kind = picture.stem.partition("_")[0]
        assert {kind, f"{kind}s"} & drawn_kinds, picture.name


def test_experiments_are_drawn_as_their_page_says():
    page = (ROOT / "docs" / "experiments.md").read_text(encoding="utf-8")
    told = re.findall(
        r"`python (programs/koch/experiments\.py \d\.\d --joints .* --out docs/pictures)`", page
    )
    assert len(told) == 6
    assert set(told) <= set(all_commands())
