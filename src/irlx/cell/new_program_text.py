"""Text of a first program for a robot: to a posture, then straight lines and back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from irlx.cell.bare_robot import BareRobot
from irlx.language.format import format_source

Offset = tuple[float, float, float]

_LONGEST_NAME = 40
"""Characters of the robot's name that a comment has."""


@dataclass(frozen=True)
class FirstMoves:
    """Where the tool goes from its first posture: to `corners` about it (mm), or to that of another posture.

    Corners lie along axes of the root frame, or of the tool where they are `turned`. `there` is a posture,
    deg | mm. Without corners and `there` the program only goes to its posture.
    """

    corners: tuple[Offset, ...] = ()
    turned: bool = False
    there: tuple[float, ...] = ()


def new_program_text(name: str, bare: BareRobot, ready: Sequence[float], moves: FirstMoves) -> str:
    """The program `name` in irlx's form; `ready` is its first posture, deg | mm."""
    declared = [
        "  { A posture: one value a joint from base to tip, degrees, of slides mm. }",
        f"  MAIN_JOINT: ready := {_posture(ready)};",
    ]
    body = [
        "  MOVE PTP ready SPEED_PTP := 50;  { every joint straight to its value, half as fast as it may }"
    ]
    if moves.there:
        declared.append(f"  MAIN_JOINT: there := {_posture(moves.there)};")
        body += [
            "  MOVE LIN there;  { straight to where the tool is in that posture, which the arm takes }",
            "  MOVE LIN ready;",
        ]
    elif moves.corners:
        declared.append("  POSE: here;")
        body += _round(bare, moves)
    lines = [
        f"PROGRAM {name};",
        f"{{ First moves of {_comment(bare.robot.name)}: to a posture, then straight lines and back. }}",
        f"SYSTEM SPECIFICATION {name};  {{ the cell: {name}.toml }}",
        "VAR",
        *declared,
        "BEGIN",
        *body,
        "ENDPROGRAM;",
    ]
    return format_source("\n".join(lines) + "\n", f"{name}.irl")


def _round(bare: BareRobot, moves: FirstMoves) -> list[str]:
    """Statements that lead the tool from corner to corner and back."""
    spare = len(bare.robot.axes) - len(bare.robot.coordinates)
    edge = sum(part * part for part in moves.corners[0]) ** 0.5
    words = "a joint is to spare" if spare == 1 else f"{spare} joints are to spare"
    targets = [_target(corner, moves.turned) for corner in moves.corners]
    return [
        "  here := FK(ready);  { where the tool is in that posture: mm and degrees in the root frame }",
        *([f"  CYCLICSTART;  {{ {words}: the posture comes back with the tool }}"] if spare > 0 else []),
        f"  MOVE LIN {targets[0]};  {{ {edge:g} mm in a straight line, not turned }}",
        *(f"  MOVE LIN {target};" for target in targets[1:]),
        "  MOVE LIN here;",
        *(["  CYCLICEND;"] if spare > 0 else []),
    ]


def _target(offset: Offset, turned: bool) -> str:
    point = f"POSITION({', '.join(f'{part:g}' for part in offset)})"
    return f"here @ POSE({point}, ORIQUAT(1, 0, 0, 0))" if turned else f"here + {point}"


def _posture(values: Sequence[float]) -> str:
    return f"MAIN_JOINT({', '.join(map(_real, values))})"


def _real(value: float) -> str:
    """A number of the language, that of a whole one with a point."""
    return f"{value:.0f}." if value == round(value) else f"{value:.12g}"


def _comment(words: str) -> str:
    """Words that a comment can hold, on one line."""
    return words[:_LONGEST_NAME].replace("{", "(").replace("}", ")").replace("\n", " ")
