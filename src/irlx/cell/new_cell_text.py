"""Text of a cell for a robot that has none yet, with a comment to every line."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np

from irlx.cell.bare_robot import BareRobot
from irlx.cell.build import from_si
from irlx.robot.description import COORDINATES, RobotDescription

_SPEEDING_UP = 0.25
"""Time, s, in which accelerations that nobody knows take a joint to its full speed."""

_SPEED = {False: 60.0, True: 250.0}
"""Speeds, deg/s and mm/s, of joints that have no speed limit."""

_COLUMN = 34
_LONGEST = 108


@dataclass(frozen=True)
class CellChoices:
    """What a new cell says: the model as its file names it, posture (deg | mm), tool speed mm/s.

    `watched`: whether links are kept off each other, None for a robot that answers this by itself.
    """

    name: str
    model: str
    start: tuple[float, ...] | None
    speed: float
    watched: bool | None


def new_cell_text(bare: BareRobot, choices: CellChoices) -> str:
    """TOML of the cell; `bare` is its robot."""
    return "\n".join([*_robot(bare, choices), *_limits(bare), *_links(choices), *_motion(choices)]) + "\n"


def _robot(bare: BareRobot, choices: CellChoices) -> list[str]:
    robot, count = bare.robot, len(bare.robot.axes)
    what = "a robot that irlx knows by name" if bare.has_name else "its URDF, from this file"
    joints = (f"{joint.name} ({'mm' if joint.is_prismatic else 'deg'})" for joint in robot.axes)
    lines = [
        f"# The cell of {choices.name}.irl: which robot stands there, and what its joints may do.",
        "# Lengths are mm, angles degrees, times s. What has # before it does not count yet.",
        "",
        "[robot]",
        _line(f"model = {_text(choices.model)}", what),
        _line(f"tip = {_text(robot.tip)}", "the link that moves address"),
    ]
    if robot.coordinates != COORDINATES and not bare.has_name:
        lines += _task(robot)
    lines += _wrapped("# Axes, from base to tip: ", joints)
    if choices.start is not None:
        lines.append(_line(f"start = {_numbers(choices.start)}", "the posture at the start of a run"))
    elif bare.start is not None:
        lines.append(f"# start = {_numbers(bare.start)}")
    weights = bare.section.weights or [float(count - k) for k in range(count)]
    lines += [
        "# Weights, per rad2 | m2: what moving each joint costs. With joints to spare, cheap ones move more.",
        f"# weights = {_numbers(weights)}",
        "# Joints of the chain that are held, deg | mm:",
        f"# locked = {{ {_text(robot.joint_names[0]) if robot.joint_names else 'joint'} = 0 }}",
    ]
    return lines


def _task(robot: RobotDescription) -> list[str]:
    """Lines on what moves ask for."""
    where = "the tip" if robot.task_frame is None else "the link below"
    rest = "the rest no joint moves"
    if robot.free:
        rest = "turns come as they do"
    elif robot.task_frame is not None:
        rest = "the other turn follows"
    task = f"task = [{', '.join(map(_text, robot.coordinates))}]"
    lines = [_line(task, f"what moves ask for, in the frame of {where}: {rest}")]
    if robot.task_frame is not None:
        lines.append(_line(f"task_frame = {_text(robot.task_frame)}", "the link before the last axis"))
    if robot.free:
        lines.append(_line(f"free = [{', '.join(map(_text, robot.free))}]", "nobody asks for these"))
    return lines


def _limits(bare: BareRobot) -> list[str]:
    """Limits: known ones as hints, those that nothing tells as guesses that count."""
    lines = [
        "",
        "[robot.limits]  # one entry a joint: plus or minus a number, [lower, upper], or false for none",
    ]
    source = "the robot's own" if bare.has_name else "those of the URDF"
    for kind in ("position", "speed", "acceleration"):
        pairs = [_bounds(bare, kind, joint) for joint in range(len(bare.robot.axes))]
        entries = [_entry(pair) for pair in pairs]
        if all(entry != "false" for entry in entries):
            lines += [
                f"# {kind}: {source}; without the # this line counts instead",
                f"# {_list(kind, entries)}",
            ]
        elif kind == "position":
            lines += ["# position: false has no limit", f"# {_list(kind, entries)}"]
        elif kind == "speed":
            guessed = [_guessed_speed(bare, joint) for joint in range(len(pairs))]
            lines += ["# speed, per s. A guess where the robot tells none: put in the data sheet's"]
            lines += [_list(kind, _kept(entries, guessed))]
        else:
            guessed = [f"{_speed(bare, joint) / _SPEEDING_UP:.4g}" for joint in range(len(pairs))]
            lines += [
                f"# acceleration, per s2. A guess, full speed within {_SPEEDING_UP:g} s: see the data sheet"
            ]
            lines += [_list(kind, _kept(entries, guessed))]
    return lines


def _links(choices: CellChoices) -> list[str]:
    if choices.watched is None:
        return []
    words = "links are kept off each other, 5 mm apart; may_touch names pairs that need not be"
    if not choices.watched:
        words = "true keeps links off each other: needs shapes that do not overlap; with meshes it takes long"
    lines = ["", "[robot.self_collision]", f"active = {'true' if choices.watched else 'false'}  # {words}"]
    return [*lines, '# may_touch = [["link_a", "link_b"]]']


def _motion(choices: CellChoices) -> list[str]:
    return [
        "",
        "[motion]  # what moves do that do not say it themselves",
        _line(f"speed = {choices.speed:g}", "mm/s"),
        _line(f"acc = {4.0 * choices.speed:g}", "mm/s2"),
        _line("# speed_ori = 90", "deg/s"),
        _line("# tick_ms = 10", "time from one row of the stream to the next"),
        "",
        "# Poses that programs use by name, and obstacles that they may keep clear of (OBSTACLE table;)",
        "# [frames]",
        "# bench = { xyz = [600, 0, 200], rpy = [0, 0, 90] }",
        "# [[obstacle]]",
        '# name = "table"',
        '# shape = "box"',
        "# size = [800, 1200, 20]",
        "# xyz = [700, 0, -10]",
    ]


def _bounds(bare: BareRobot, kind: str, joint: int) -> tuple[float, float]:
    """Lower and upper bound of a joint, deg | mm."""
    lower, upper = (float(side[joint]) for side in bare.limits.pair(kind))
    return from_si(bare.robot, joint, lower), from_si(bare.robot, joint, upper)


def _entry(pair: tuple[float, float]) -> str:
    lower, upper = pair
    if not (isfinite(lower) and isfinite(upper)):
        return "false"
    return f"{upper:.6g}" if lower == -upper else f"[{lower:.6g}, {upper:.6g}]"


def _speed(bare: BareRobot, joint: int) -> float:
    """Full speed of a joint, deg/s | mm/s; a guess where it has no limit, or one that stands for none."""
    limit = _bounds(bare, "speed", joint)[1]
    slides = bare.robot.axes[joint].is_prismatic
    return limit if isfinite(limit) and 0.0 < limit < 100.0 * _SPEED[slides] else _SPEED[slides]


def _guessed_speed(bare: BareRobot, joint: int) -> str:
    return f"{_speed(bare, joint):.4g}"


def _kept(entries: Sequence[str], guessed: Sequence[str]) -> list[str]:
    """What is known, and guesses for the rest."""
    return [guess if entry == "false" else entry for entry, guess in zip(entries, guessed, strict=True)]


def _list(key: str, entries: Sequence[str]) -> str:
    return f"{key} = [{', '.join(entries)}]"


def _numbers(values: Sequence[float]) -> str:
    return f"[{', '.join(f'{float(np.round(value, 6)):.10g}' for value in values)}]"


def _text(words: str) -> str:
    """A string of TOML, whose escapes are those of JSON."""
    return json.dumps(words, ensure_ascii=False)


def _line(entry: str, comment: str) -> str:
    return f"{entry:<{_COLUMN}}  # {comment}"


def _wrapped(first: str, words: Iterable[str]) -> list[str]:
    """Words with commas between, in lines of comment."""
    lines, line = [], first
    for number, word in enumerate(words):
        joined = f"{', ' if number else ''}{word}"
        if len(line) + len(joined) > _LONGEST:
            lines.append(f"{line},")
            line, joined = "#   ", word
        line += joined
    return [*lines, line]
