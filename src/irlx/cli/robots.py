"""`irlx robots`: robots known by name, one of them in detail, and what is odd in a URDF."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Sequence
from math import degrees, isinf
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from irlx.cell.bare_robot import BareRobot
    from irlx.cell.overview import RobotOverview
    from irlx.diagnostics import Diagnostic

_EXAMPLE = """\
examples:
  irlx robots
  irlx robots arm7
  irlx robots --check src/irlx/cell/robots/arm7.urdf
"""
_KINDS = ("position", "speed", "acceleration")
_MOST_ALIKE = 3
"""Findings of one code that are printed; the rest are counted."""


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "robots",
        help="list the robots known by name, or look for what is odd in a URDF",
        description="List the robots that a cell may name, show the joints of one, or say what is missing "
        "or odd in a URDF.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "name", nargs="?", metavar="NAME", help="show the joints of this robot, or of a URDF by its path"
    )
    parser.add_argument("--check", metavar="F.urdf", help="say what is missing or odd in a URDF")
    parser.add_argument("--tip", metavar="LINK", help="the link that programs move (default: the only end)")
    parser.add_argument("--json", action="store_true", help="print as JSON")
    parser.set_defaults(command=command, refuse=parser.error)


def command(options: argparse.Namespace) -> int:
    """Print what was asked for on stdout; of a check 1 where no cell could use the URDF."""
    import json

    if options.check is not None:
        if options.name is not None:
            options.refuse("give a NAME or --check, not both")
        return _check(options)
    if options.name is not None:
        return _show(options)
    if options.tip is not None:
        options.refuse("--tip goes with a NAME or --check")
    from irlx.cell.overview import robot_overviews

    found = robot_overviews()
    _print(json.dumps([_plain(robot) for robot in found], indent=2) if options.json else _table(found))
    return 0


def _print(text: str) -> None:
    from irlx.cli.output import encodable

    print(encodable(text, sys.stdout))


def _plain(robot: RobotOverview) -> dict[str, object]:
    from dataclasses import asdict

    return asdict(robot)


def _table(robots: Sequence[RobotOverview]) -> str:
    rows = [("robot", "axes", "task", "tip", "limits", "what it is")]
    for robot in robots:
        rows.append((robot.name, _axes(robot), _task(robot.task), robot.tip, _limits(robot), robot.about))
    lines = _aligned(rows)
    if not all(robot.installed for robot in robots):
        lines.append('\nnot installed: pip install "irlx[robots]"')
    return "\n".join(lines)


def _axes(robot: RobotOverview) -> str:
    turning = robot.axes - (robot.slides or 0)
    if not robot.slides:
        return str(turning)
    return f"{robot.slides} slide{'s' if robot.slides > 1 else ''}, {turning}"


def _task(task: tuple[str, ...]) -> str:
    return "pose" if len(task) == 6 else " ".join(task)


def _limits(robot: RobotOverview) -> str:
    if robot.limits is None:
        return "not installed"
    return ", ".join(robot.limits).replace("acceleration", "accel") or "none"


def _aligned(rows: Iterable[Sequence[str]]) -> list[str]:
    """Rows as lines, columns below each other."""
    rows = [tuple(row) for row in rows]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    ]


def _show(options: argparse.Namespace) -> int:
    """Joints of one robot, with units of cells: deg | mm."""
    import json

    found = _found(options.name, options.tip)
    robot, joints = found.robot, [_joint(found, index) for index in range(len(found.robot.axes))]
    if options.json:
        plain = {"name": options.name, "root": robot.root, "tip": robot.tip, "task": list(robot.coordinates)}
        _print(json.dumps(_finite({**plain, "joints": joints}), indent=2))
        return 0
    spare = len(robot.axes) - len(robot.coordinates)
    words = "no axis" if spare == 0 else "1 axis" if spare == 1 else f"{spare} axes"
    lines = [
        f"{'robot':<12}{options.name}: {len(robot.axes)} axes from '{robot.root}' to the tip '{robot.tip}'",
        f"{'task':<12}{' '.join(robot.coordinates)}: {words} to spare",
        "",
    ]
    rows: list[tuple[str, ...]] = [("joint", "kind", "unit", "start", *_KINDS)]
    for joint in joints:
        start = "-" if joint["start"] is None else f"{joint['start']:g}"
        limits = (_pair(joint[kind]) for kind in _KINDS)
        rows.append((joint["name"], joint["kind"], joint["unit"], start, *limits))
    _print("\n".join([*lines, *_aligned(rows)]))
    return 0


def _found(name: str, tip: str | None) -> BareRobot:
    """The robot. Raises CellError, of a name that is none in words for a command: there is no cell file."""
    from dataclasses import replace

    from irlx.cell.bare_robot import bare_robot
    from irlx.cell.errors import CellError

    try:
        return bare_robot(name, tip)
    except CellError as error:
        helps = "irlx robots lists all names; of a URDF give the path"
        raise CellError(
            [
                replace(one, place=None, help=helps) if one.code == "IRL611" else one
                for one in error.diagnostics
            ]
        ) from error


def _joint(found: BareRobot, index: int) -> dict[str, Any]:
    """One joint as it is printed: kind, unit, start if known, [lower, upper] of each kind of limit."""
    joint = found.robot.axes[index]
    plain: dict[str, Any] = {"name": joint.name, "kind": joint.kind.value}
    plain["unit"] = "mm" if joint.is_prismatic else "deg"
    plain["start"] = None if found.start is None else found.start[index]
    factor = 1e3 if joint.is_prismatic else degrees(1.0)
    for kind in _KINDS:
        plain[kind] = [float(f"{factor * float(side[index]):.6g}") for side in found.limits.pair(kind)]
    return plain


def _pair(pair: Any) -> str:
    lower, upper = pair
    if upper == -lower:
        return "-" if isinf(upper) else f"+-{upper:g}"
    return f"{lower:g} .. {upper:g}"


def _finite(value: Any) -> Any:
    """The same with null for numbers that JSON has not."""
    if isinstance(value, dict):
        return {key: _finite(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_finite(one) for one in value]
    return None if isinstance(value, float) and isinf(value) else value


def _check(options: argparse.Namespace) -> int:
    import json

    from irlx.cell.robot_check.check import check_robot
    from irlx.diagnostics.plain import plain_diagnostic

    found = check_robot(options.check, options.tip)
    if options.json:
        _print(json.dumps([plain_diagnostic(one) for one in found], indent=2))
    else:
        _print_findings(found, options.check)
    return int(any(one.is_error for one in found))


def _print_findings(found: Sequence[Diagnostic], file: str) -> None:
    """Findings on stderr, those of one code beyond the first few as a number; a line on stdout."""
    from collections import Counter

    from irlx.cli.output import print_diagnostics
    from irlx.diagnostics import Severity

    seen: Counter[str] = Counter()
    total = Counter(one.code for one in found)
    for one in found:
        seen[one.code] += 1
        if seen[one.code] <= _MOST_ALIKE or total[one.code] == _MOST_ALIKE + 1:
            print_diagnostics((one,))
        elif seen[one.code] == total[one.code]:
            rest = total[one.code] - _MOST_ALIKE
            print(f"{rest} more with {one.code}; --json has all of them", file=sys.stderr)
    severities = Counter(one.severity for one in found)
    words = [
        f"{severities[severity]} {word}{'' if severities[severity] == 1 else 's'}"
        for severity, word in (
            (Severity.ERROR, "error"),
            (Severity.WARNING, "warning"),
            (Severity.INFO, "note"),
        )
    ]
    _print(f"{file}: {', '.join(words)}")
