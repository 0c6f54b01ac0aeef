"""One random program, run by irlx and by the evaluator, and what is not the same."""

from __future__ import annotations

import math
from dataclasses import dataclass

from computing_programs import with_all_parentheses, with_few_parentheses, written
from computing_tables import CLOSE, OPEN
from irlx.blocks import Question
from irlx.interpreter.channels.setup import ChannelSetup
from irlx.interpreter.errors import InterpreterError
from irlx.interpreter.interpret import Interpretation
from irlx.interpreter.setting import Setting
from irlx.interpreter.values import UNSET
from irlx.language.analysis import analyse
from irlx.language.parser import parse
from irlx.language.source import source_text
from reference_evaluator.program import Ending, evaluated
from reference_evaluator.trouble import TooLong
from reference_evaluator.types import ORIENTATION, POSE, POSITION, Array, Simple

JOINTS = 7
CLOSENESS = 1e-9
"""How far numbers from angles and rotations may differ, as a share of the larger of 1 and their size."""
STATIC = {"IRL502", "IRL503", "IRL504", "IRL505", "IRL506"}
"""Errors of values that the text tells: a check may refuse the program for them before it runs."""
DEFAULTS = {"R_SPEED": 250.0, "R_ACC": 1000.0, "R_SPEED_ORI": 90.0, "R_ACC_ORI": 180.0}
DEFAULTS |= {"R_SPEED_PTP": 100.0, "R_ACC_PTP": 100.0}


@dataclass(frozen=True)
class Found:
    """What irlx makes of a program: values of its variables, None where they are not known, output, error."""

    variables: dict | None
    output: str
    error: tuple[str, tuple[int, int]] | None


def by_irlx(tree, source) -> Found:
    """The program run by irlx, with nothing but its interpreter."""
    output: list[str] = []
    channels = ChannelSetup().in_memory(lambda name, text: output.append(text))
    names = tuple(f"j{number}" for number in range(1, JOINTS + 1))
    ready, error = None, None
    try:
        ready = Interpretation(
            tree, source, Setting(names, (False,) * JOINTS, DEFAULTS), channels=channels, max_steps=1_000_000
        )
        steps = ready.run()
        item = next(steps, None)
        while item is not None:
            # WRITE and PAUSE ask whether the robot stands; it always does.
            item = steps.send((0.0,) * JOINTS if isinstance(item, Question) else None)
    except StopIteration:
        pass
    except InterpreterError as found:
        span = found.reason.place.span
        error = found.reason.code, (span.start, span.end)
    variables = None if ready is None else {k: v.value for k, v in ready.scope.variables.items()}
    return Found(variables, "".join(output), error)


def opened(value):
    """A value of irlx as nested lists, None where nothing was set."""
    return (
        [opened(part) for part in value.values]
        if hasattr(value, "values")
        else None
        if value is UNSET
        else value
    )


def same(type, expected, found, near=False):
    """Whether both hold the same: exactly, or closely where the value comes from rotations."""
    if type == ORIENTATION and None not in (*expected, *found):
        return any(
            all(abs(a - sign * b) <= CLOSENESS for a, b in zip(expected, found, strict=True))
            for sign in (1, -1)
        )
    if not isinstance(type, Simple):
        near = near or type in (POSITION, POSE)
        parts = [type.element] * len(expected) if isinstance(type, Array) else type.parts
        return len(expected) == len(found) and all(
            same(part, a, b, near) for part, a, b in zip(parts, expected, found, strict=True)
        )
    if expected is None or found is None:
        return expected is found
    if near and isinstance(found, float):
        return abs(expected - found) <= CLOSENESS * max(1.0, abs(expected))
    if isinstance(expected, float) and isinstance(found, float):
        return expected == found and math.copysign(1.0, expected) == math.copysign(1.0, found)
    return expected == found and expected.__class__ is found.__class__


def in_short_text(marked, span):
    """Where a span of the text with all parentheses is in that with few."""
    shifts, dropped = {}, 0
    for place, sign in enumerate(marked):
        shifts[place] = place - dropped
        dropped += sign in (OPEN, CLOSE)
    shifts[len(marked)] = len(marked) - dropped
    return shifts[span[0]], shifts[span[1]]


def differences(marked, expected: Ending, found: Found) -> list[str]:
    """What irlx and the evaluator disagree on."""
    told = []
    trouble = expected.trouble and (expected.trouble.code, in_short_text(marked, expected.trouble.span))
    if trouble != found.error:
        text = with_few_parentheses(marked)

        def shown(error):
            return "no error" if error is None else f"{error[0]} at {error[1]} {text[slice(*error[1])]!r}"

        told.append(f"error: {shown(trouble)}, irlx: {shown(found.error)}")
    if expected.output != found.output:
        told.append(f"output: {expected.output!r}, irlx: {found.output!r}")
    if found.variables is None:
        return told
    for name, value in expected.variables.items():
        there = opened(found.variables[name])
        if not same(value.type, value.data, there, near=name.startswith("ne")):
            told.append(f"{name}: {value.data}, irlx: {there}")
    return told


def judged(seed) -> tuple[str, list[str]]:
    """How the program of a seed ends (`refused`, `long`, `end` or a code), and what differs."""
    return compared(written(seed))


def compared(marked) -> tuple[str, list[str]]:
    """The same of a text, with the marks of parentheses that may be left out, or without any."""
    short = source_text("t.irl", with_few_parentheses(marked))
    analysis = analyse(short)
    errors = {d.code for d in analysis.diagnostics if d.is_error}
    if errors:
        return "refused", sorted(errors - STATIC)
    whole = parse(source_text("t.irl", with_all_parentheses(marked)))
    try:
        expected = evaluated(whole.tree, JOINTS)
    except TooLong:
        return "long", []
    found = by_irlx(analysis.tree, short)
    return expected.trouble.code if expected.trouble else "end", differences(marked, expected, found)
