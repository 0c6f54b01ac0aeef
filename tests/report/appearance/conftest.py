"""Cells in a temporary folder."""

import pytest

from irlx.cell.load import load_cell


@pytest.fixture
def cell(tmp_path):
    """Load a cell of a given text; URDF texts beside it by name."""

    def load(text, **models):
        for name, content in models.items():
            (tmp_path / f"{name}.urdf").write_text(content, encoding="utf-8")
        (tmp_path / "cell.toml").write_text(text, encoding="utf-8")
        return load_cell(tmp_path / "cell.toml")

    return load
