"""IN FRAME: the frame of the cell in which the poses of a MOVE count, instead of R_BASE."""

from __future__ import annotations

from dataclasses import replace

from irlx.blocks import LinkFrame, PoseIncrement, PoseTarget, Target
from irlx.diagnostics import Place
from irlx.interpreter.base import Base
from irlx.interpreter.context import Context
from irlx.interpreter.errors import InterpreterError
from irlx.interpreter.functions import pose
from irlx.interpreter.quaternion import Quaternion, Vector
from irlx.interpreter.values import RecordValue
from irlx.language import tree
from irlx.language.frames import unknown_frame


class FrameBase(Base):
    """A frame of the cell as the base of one statement.

    Poses in one that stands still become poses in the root frame of the robot; those in one that moves with
    a link stay as they are, and `link_frame` tells which it is.
    """

    def __init__(
        self, link_frame: LinkFrame | None = None, at: tuple[Vector, Quaternion] | None = None
    ) -> None:
        self.link_frame = link_frame
        self._at = at

    def _parts(self) -> tuple[Vector, Quaternion] | None:
        return self._at

    @property
    def _pose(self) -> RecordValue:
        if self._at is None:
            raise TypeError("a frame that moves has no pose")
        return pose(*self._at)


def base_of(name: tree.Name | None, context: Context, node: tree.Node) -> Base:
    """The base of the poses of a statement: the frame of the cell that it names, else R_BASE.

    Raises InterpreterError, IRL290, for a name that the cell does not have.
    """
    if name is None:
        return Base(context, node)
    setting = context.setting
    moving = setting.frames.get(name.key)
    if moving is not None:
        return FrameBase(moving)
    for known, at in setting.poses.items():
        if known.casefold() == name.key:
            return FrameBase(at=at)
    names = [*setting.poses, *(frame.name for frame in setting.frames.values())]
    raise InterpreterError(unknown_frame(name.name, names, Place.in_text(context.source, name.span)))


def link_frame_of(base: Base) -> LinkFrame | None:
    """The frame that moves with a link of which a base is one."""
    return base.link_frame if isinstance(base, FrameBase) else None


def told_in(target: Target, frame: LinkFrame | None) -> Target:
    """A target with the name of the moving frame in which it counts."""
    if frame is None or not isinstance(target, PoseTarget | PoseIncrement):
        return target
    return replace(target, frame=frame.name)
