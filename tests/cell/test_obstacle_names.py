"""Names of obstacles read from a cell without loading it."""

import subprocess
import sys

import pytest

from irlx.cell.obstacle_names import obstacle_names

pytestmark = pytest.mark.req("LANG-64")


@pytest.mark.parametrize(
    ("content", "names"),
    [
        (
            '[[obstacle]]\nname = "Wall"\n[[obstacle]]\nname = "s\u0301ciana_1"\nmembers = 3\n',
            ("Wall", "ściana_1"),
        ),
        ('\ufeff[[obstacle]]\nname = "a"\n[[obstacle]]\nshape = "box"\n[[obstacle]]\nname = 3\n', ("a",)),
        ("obstacle = 3\n", ()),
        ("obstacle = [3]\n", ()),
        ("[obstacle]\nname = 'a'\n", ()),
        ("[robot]\n", ()),
        ("[[obstacle\n", ()),
    ],
)
def test_names_of_a_file(tmp_path, content, names):
    path = tmp_path / "c.toml"
    path.write_text(content, encoding="utf-8")
    assert obstacle_names(path) == names
    assert obstacle_names(tmp_path / "no.toml") == ()


def test_no_numeric_library_is_loaded():
    code = (
        "import sys, irlx.cell.obstacle_names; sys.exit('numpy' in sys.modules or 'pydantic' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
