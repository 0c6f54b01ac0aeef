"""R_BASE: the frame that the poses of a program count in, against the root of the robot, where blocks do."""

from __future__ import annotations

from typing import TYPE_CHECKING

from irlx.interpreter.errors import fail
from irlx.interpreter.functions import compose, inverse, parts_of, position, vector_of
from irlx.interpreter.quaternion import IDENTITY, Quaternion, Vector, norm, rotate
from irlx.interpreter.scope import Variable
from irlx.interpreter.types import POSE, POSITION
from irlx.interpreter.values import RecordValue
from irlx.language import tree
from irlx.language.ranges import UNIT_LENGTH

if TYPE_CHECKING:
    from irlx.interpreter.context import Context

_NOWHERE: Vector = (0.0, 0.0, 0.0)


def rotation_parts(value: object, name: str, context: Context, node: tree.Node) -> tuple[Vector, Quaternion]:
    """Position (mm) and quaternion of the POSE that a frame variable holds.

    Raises InterpreterError at the node, IRL570, where an assignment to a part has left no orientation.
    """
    if not isinstance(value, RecordValue):
        raise TypeError("frames are poses")
    at, turned = parts_of(value)
    length = norm(turned)
    if abs(length - 1.0) > UNIT_LENGTH:
        raise fail("IRL570", context.source, node.span, name=name, length=f"{length:.9g}")
    return at, turned


class Base:
    """R_BASE as it is whenever something is asked of it; `node` is the place for messages."""

    def __init__(self, context: Context, node: tree.Node) -> None:
        variable = context.scope.found("r_base")
        if not isinstance(variable, Variable):
            raise TypeError("system variables are variables")
        self._variable, self._context, self._node = variable, context, node

    def _parts(self) -> tuple[Vector, Quaternion] | None:
        """Position and orientation of the base; None where it is the root, so that no digit changes."""
        at, turned = rotation_parts(self._variable.value, "R_BASE", self._context, self._node)
        return None if (at, turned) == (_NOWHERE, IDENTITY) else (at, turned)

    @property
    def _pose(self) -> RecordValue:
        value = self._variable.value
        assert isinstance(value, RecordValue)
        return value

    def in_root(self, value: RecordValue) -> RecordValue:
        """A POSE or POSITION of the program, or the pose of a ROBTARGET, in the root frame of the robot."""
        first = value.values[0]
        if isinstance(first, RecordValue) and first.type == POSE:
            value = first
        parts = self._parts()
        if parts is None:
            return value
        if value.type != POSITION:
            return compose(self._pose, value)
        (ox, oy, oz), (x, y, z) = parts[0], rotate(parts[1], vector_of(value))
        return position((ox + x, oy + y, oz + z))

    def shift(self, value: RecordValue) -> Vector:
        """A POSITION that something is moved by, along the axes of the base, along those of the root; mm."""
        parts, by = self._parts(), vector_of(value)
        return by if parts is None else rotate(parts[1], by)

    def in_base(self, pose: RecordValue) -> RecordValue:
        """A POSE in the root frame as the program has it."""
        return pose if self._parts() is None else compose(inverse(self._pose), pose)
