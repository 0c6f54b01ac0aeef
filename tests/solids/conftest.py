"""Mesh files in a temporary folder."""

import pytest

from irlx.solids.shape import Mesh


@pytest.fixture
def mesh(tmp_path):
    """Write bytes to a file of a name; the mesh in it."""

    def write(name, content, scale=(1.0, 1.0, 1.0)):
        (tmp_path / name).write_bytes(content)
        return Mesh(str(tmp_path / name), scale)

    return write
