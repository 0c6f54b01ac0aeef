"""The explanation of one tick as plain text for a terminal."""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees

from irlx.pacing.explanation import JointTick, NearRow, PathTick, QuadraticTick, TickExplanation

_NAMED = 14


def tick_text(found: TickExplanation) -> str:
    """Lines on what a tick was asked for, the bounds of every joint, and the criteria; deg and mm."""
    lines = [
        f"tick {found.tick} ({found.time:.6g} s), line {found.line}: {found.motion}, {found.way_of_pacing}"
    ]
    if found.path is not None:
        lines += _path_lines(found.path)
    position, orientation = found.path_error
    lines.append(_line("path error", f"{position:.2g} m, {orientation:.2g} rad"))
    lines += [
        _line("criterion" if c.chosen else "compared", f"{c.name}: {c.value:.6g}") for c in found.criteria
    ]
    held = [f"{joint.name} {joint.held}" for joint in found.joints if joint.held]
    lines.append(_line("active", ", ".join(held) if held else "no bound holds a joint"))
    width = max(len(joint.name) for joint in found.joints)
    lines.append(f"{'joint':<{width}}  {'value':>12}  {'step':>12}  {'from':>12}  {'':<12}  {'to':>12}  ")
    lines += [_joint_line(joint, width) for joint in found.joints]
    if found.problem is not None:
        lines += _problem_lines(found.problem)
    return "\n".join(lines)


def _path_lines(path: PathTick) -> list[str]:
    unit, scale = ("deg", degrees(1.0)) if path.turns else ("mm", 1000.0)
    way, length = path.way * scale, path.length * scale
    rate, programmed = path.rate * scale, path.programmed_rate * scale
    x, y, z = (value * 1000.0 for value in path.position)
    quaternion = " ".join(f"{value:.6f}" for value in path.orientation)
    linear = " ".join(f"{value * 1000.0:.5g}" for value in path.twist[:3])
    angular = " ".join(f"{degrees(value):.5g}" for value in path.twist[3:])
    return [
        _line(
            "demand",
            f"{way:.6g} of {length:.6g} {unit}, at {rate:.5g} of {programmed:.5g} {unit}/s programmed",
        ),
        _line("", f"position {x:.6g} {y:.6g} {z:.6g} mm, orientation (x y z w) {quaternion}"),
        _line("", f"twist {linear} mm/s, {angular} deg/s"),
    ]


def _problem_lines(problem: QuadraticTick) -> list[str]:
    """The quadratic problem as a table: a column a joint, lines for g, H and the rows of J with their e."""
    size = f"{len(problem.joints)} joints, {len(problem.rows)} rows, {problem.unknowns} unknowns when compact"
    width = max(len(name) for name in (*problem.rows, "gradient"))
    column = max(10, *(len(name) for name in problem.joints))

    def line(label: str, values: Iterable[str], last: str = "") -> str:
        return f"{label:<{width}}  {' '.join(f'{value:>{column}}' for value in values)}  {last}".rstrip()

    def numbers(values: Iterable[object]) -> list[str]:
        return [f"{value:.4g}" for value in values]

    lines = [f"problem: min g'd + 1/2 d'Hd, J d = e, from <= d <= to; {size}; rad and m"]
    lines.append(line("", problem.joints, "e"))
    lines.append(line("gradient", numbers(problem.gradient)))
    for row in problem.hessian if isinstance(problem.hessian[0], tuple) else [problem.hessian]:
        lines.append(line("hessian", numbers(row if isinstance(row, tuple) else (row,))))
    for name, row, left in zip(problem.rows, problem.jacobian, problem.left, strict=True):
        lines.append(line(name, numbers(row), f"{left:.4g}"))
    for near in problem.near:
        lines.append(line("clear", numbers(near.coefficients), f">= {near.least:.4g}  {_pair(near)}"))
    return lines


def _pair(near: NearRow) -> str:
    return f"{near.link} and {near.other}, {near.distance * 1e3:.6g} mm"


def _joint_line(joint: JointTick, width: int) -> str:
    unit, scale = ("mm", 1000.0) if joint.prismatic else ("deg", degrees(1.0))
    value, step, lower, upper = (
        f"{number * scale:.6g}" for number in (joint.value, joint.step, joint.lower, joint.upper)
    )
    words = f"{joint.name:<{width}}  {value:>12}  {step:>12}  {lower:>12}  {joint.lower_source:<12}"
    held = f"  held: {joint.held}" if joint.held else ""
    return f"{words}  {upper:>12}  {joint.upper_source:<12}  {unit}{held}"


def _line(label: str, words: str) -> str:
    return f"{label:<{_NAMED}}{words}"
