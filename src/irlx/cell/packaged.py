"""Robots that come with irlx: primitive-only URDFs, each with a cell of its own; a program to begin with."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

_FOLDER = files("irlx.cell") / "robots"
_DEMO = files("irlx.cell") / "demo"

DEMO_ROBOT = "arm7"
"""The robot of the program to begin with."""


@cache
def packaged_names() -> tuple[str, ...]:
    """Names of the packaged robots."""
    return tuple(sorted(entry.name[:-5] for entry in _FOLDER.iterdir() if entry.name.endswith(".urdf")))


def packaged_urdf(name: str) -> str:
    """URDF text of a packaged robot."""
    return (_FOLDER / f"{name}.urdf").read_text(encoding="utf-8")


def packaged_cell(name: str) -> bytes:
    """Cell file of a packaged robot: tip, start, weights, its own limits."""
    return (_FOLDER / f"{name}.toml").read_bytes()


def demo_texts() -> tuple[str, str]:
    """Program and cell to begin with, which are to be called demo.irl and demo.toml."""
    program, cell = ((_DEMO / f"demo.{ending}").read_text(encoding="utf-8") for ending in ("irl", "toml"))
    return program, cell
