"""Cells written to a temporary folder, and what loading them tells."""

import pytest

from irlx.cell.errors import CellError
from irlx.cell.load import load_cell

KOCH = '[robot]\nmodel = "koch11"\n'


def urdf(joints=7, slides=(2,), limit='<limit lower="-2" upper="2" velocity="1.5" effort="1"/>'):
    """A chain of joints j1 .. jn, alternately about z and y; the numbers in `slides` are prismatic."""
    parts = ['<robot name="chain"><link name="base"/>']
    for number in range(1, joints + 1):
        kind = "prismatic" if number in slides else "revolute"
        axis = "0 0 1" if number % 2 else "0 1 0"
        parent = f"link{number - 1}" if number > 1 else "base"
        parts.append(
            f'<link name="link{number}"/><joint name="j{number}" type="{kind}">'
            f'<parent link="{parent}"/><child link="link{number}"/>'
            f'<origin xyz="0 0 0.3"/><axis xyz="{axis}"/>{limit}</joint>'
        )
    return "".join([*parts, "</robot>"])


@pytest.fixture
def cell(tmp_path):
    """Load a cell file of a given text; other files of its folder by name."""

    def load(text, **files):
        for name, content in files.items():
            (tmp_path / f"{name}.urdf").write_text(content, encoding="utf-8")
        path = tmp_path / "cell.toml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return load_cell(path)

    return load


@pytest.fixture
def faults(cell):
    """Code, key path and message of every fault of a cell."""

    def run(text, **files):
        with pytest.raises(CellError) as caught:
            cell(text, **files)
        return [(d.code, d.place.key, d.message) for d in caught.value.diagnostics]

    return run


@pytest.fixture
def koch():
    """Beginning of a cell that names the packaged robot."""
    return KOCH


@pytest.fixture
def chain():
    """Maker of URDF texts."""
    return urdf
