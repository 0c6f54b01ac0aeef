"""Where the data package example-robot-data keeps its robots; nothing of it is imported."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import suppress
from importlib import metadata
from pathlib import Path

PACKAGE = "example-robot-data"
_CMEEL_PREFIX = "cmeel.prefix"
"""The folder, inside site-packages, that wheels made with cmeel install to as if it were /usr."""


def robot_data_folder() -> Path | None:
    """Folder with the robots of example-robot-data, None where the package is not installed."""
    for prefix in _prefixes():
        folder = prefix / "share" / PACKAGE / "robots"
        try:
            if folder.is_dir():
                return folder
        except OSError:  # A folder on the path may be unreadable; the package may still be elsewhere.
            continue
    return None


def _prefixes() -> Iterator[Path]:
    """Prefixes that the package may be installed to, the likeliest first.

    The wheel, wherever pip put it or somebody unpacked it; the prefix of Python itself, for conda and
    packages of the system; what a sourced ROS workspace names.
    """
    with suppress(metadata.PackageNotFoundError):
        yield Path(str(metadata.distribution(PACKAGE).locate_file(_CMEEL_PREFIX)))
    yield from (Path(entry) / _CMEEL_PREFIX for entry in sys.path)
    yield from (Path(sys.prefix), Path(sys.base_prefix))
    workspaces = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    yield from (Path(entry) for entry in workspaces if entry)
