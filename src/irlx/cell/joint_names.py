"""Names of the joints of a cell's robot, read without loading the cell or any numeric library."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import Any

from irlx.cell.frame_names import cell_table
from irlx.diagnostics.whole_file import whole_text
from irlx.robot.urdf import read_urdf

_ROBOTS = files("irlx.cell") / "robots"


def joint_names(path: Path) -> tuple[str, ...]:
    """Names of the joints that move the tool, in order; none where the file or its robot is at fault.

    What is wrong with a cell is told when it is loaded; here it would only be told twice.
    """
    table = cell_table(path)
    asked = table.get("robot")
    if not isinstance(asked, dict) or not isinstance(asked.get("model"), str):
        return ()
    try:
        own, text = _model(asked["model"], path.parent)
        robot = {**own, **asked}
        held = dict.fromkeys(robot.get("locked", {}), 0.0)
        frames = table.get("frames", {}).values()
        links = [*robot.get("hands", ()), *(frame["link"] for frame in frames if "link" in frame)]
        return read_urdf(text, robot.get("tip"), held, dict.fromkeys(links)).joint_names
    except (OSError, ValueError, TypeError, AttributeError, RecursionError):
        return ()


def _model(model: str, folder: Path) -> tuple[dict[str, Any], str]:
    """What irlx knows of a robot by that name, and the URDF text of it or of the file of that path.

    Raises OSError where there is none.
    """
    if "/" in model or "." in model:
        return {}, whole_text(folder / model)
    packaged = _ROBOTS / f"{model}.toml"
    if packaged.is_file():
        return _robot_table(packaged), (_ROBOTS / f"{model}.urdf").read_text(encoding="utf-8")
    # Imported here: it looks for an installed package, which few cells need.
    from irlx.cell.robot_data import robot_data_folder

    own, data = _robot_table(_ROBOTS / "external" / f"{model}.toml"), robot_data_folder()
    if data is None:
        raise FileNotFoundError(model)
    return own, (data / str(own.get("model"))).read_text(encoding="utf-8")


def _robot_table(file: Any) -> dict[str, Any]:
    table = cell_table(file).get("robot")
    return table if isinstance(table, dict) else {}
