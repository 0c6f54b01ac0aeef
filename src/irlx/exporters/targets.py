"""Which targets there are, by name and by file ending."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.exporters.krl import KrlWriter
from irlx.exporters.program_writer import ProgramWriter
from irlx.exporters.rapid import RapidWriter
from irlx.exporters.robodk import RoboDkWriter
from irlx.exporters.urscript import UrScriptWriter


@dataclass(frozen=True)
class Target:
    """One target: its name on the command line, its file ending, and its writer.

    `owns_ending` is False where the ending belongs to a stream format, so that the target has to be named.
    """

    name: str
    ending: str
    writer: type[ProgramWriter]
    owns_ending: bool = True


TARGETS = {
    target.name: target
    for target in (
        Target("urscript", ".script", UrScriptWriter),
        Target("krl", ".src", KrlWriter),
        Target("rapid", ".mod", RapidWriter),
        Target("robodk", ".csv", RoboDkWriter, owns_ending=False),
    )
}
"""Every target by its name."""


def target_of_ending(ending: str) -> Target | None:
    """The target that a file ending means by itself, None where there is none."""
    for target in TARGETS.values():
        if target.owns_ending and target.ending == ending.lower():
            return target
    return None
