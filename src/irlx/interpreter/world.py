"""What all parts of a running program share: the machine, system variables, data lists, modules."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

from irlx.interpreter.channels.channels import Channels
from irlx.interpreter.list_text import Rewritten, rewritten
from irlx.interpreter.machine import Machine
from irlx.interpreter.quaternion import IDENTITY
from irlx.interpreter.scope import Followed, Scope, Variable
from irlx.interpreter.setting import SYSTEM_REALS, Setting
from irlx.interpreter.types import (
    ADD_JOINT,
    BOOL,
    INT,
    POSE,
    REAL,
    STRING,
    Array,
    Record,
    joint_bounds,
    joint_weights,
    predefined_types,
)
from irlx.interpreter.values import ArrayValue, RecordValue, Value, share, unset_value
from irlx.language.data_lists import ImportedList

ListValues: TypeAlias = "Callable[[ImportedList, Scope, World], dict[str, Variable]]"


class World:
    """Exists once a run; `modules` are the scopes of those that are declared, by casefolded name."""

    def __init__(self, setting: Setting, machine: Machine, channels: Channels | None = None) -> None:
        self.setting = setting
        self.machine = machine
        self.channels = channels or Channels()
        self.modules: dict[str, Scope] = {}
        self._lists: dict[str, dict[str, Variable]] = {}
        self._first: dict[str, dict[str, Value]] = {}
        joints = len(setting.joint_names)
        empty = RecordValue(ADD_JOINT, ())
        turns = ArrayValue(Array(((1, joints),), INT), [0] * joints, shared=True)
        self.rest: Mapping[str, tuple[Value, ...]] = {"JOINT": (empty,), "ROBTARGET": (0, turns, empty)}
        self._system = _system_variables(setting)

    def scope(self, announced: frozenset[str], imported: frozenset[str]) -> Scope:
        """A fresh scope with what every part knows: system variables, poses of the cell, predefined types."""
        types = predefined_types(len(self.setting.joint_names))
        return Scope(dict(self._system), types, announced=announced, imported=imported)

    def data_list(self, found: ImportedList, scope: Scope, values: ListValues) -> dict[str, Variable]:
        """Variables of a data list: the same ones for all that import it."""
        known = self._lists.get(found.source.name)
        if known is None:
            known = self._lists[found.source.name] = values(found, scope, self)
            first = {key: variable.value for key, variable in known.items()}
            for value in first.values():
                share(value)
            self._first[found.source.name] = first
        return known

    def rewritten(self, found: ImportedList) -> Rewritten:
        """Text of a data list that was imported, with its present values."""
        name = found.source.name
        return rewritten(found, self._lists.get(name, {}), self._first.get(name, {}))


def _system_variables(setting: Setting) -> dict[str, Variable]:
    joints = len(setting.joint_names)
    here = RecordValue(POSE, (_reals(0, (0.0, 0.0, 0.0)), _reals(1, IDENTITY)))
    each = joint_weights(joints)
    weights = ArrayValue(each, list(setting.weights or (1.0,) * joints), shared=True)
    known = [
        *(Variable(name, REAL, float(setting.default(name))) for name in SYSTEM_REALS),
        Variable("R_C_PASS", BOOL, setting.default("R_C_PASS")),
        Variable("R_PROFILE", STRING, setting.default("R_PROFILE")),
        Variable("R_BASE", POSE, here),
        Followed("R_TOOL", POSE, here),
        Followed("R_WEIGHTS", each, weights),
    ]
    variables = {variable.name.casefold(): variable for variable in known}
    for name, (at, turned) in setting.poses.items():
        value = RecordValue(POSE, (_reals(0, at), _reals(1, turned)))
        variables[name.casefold()] = Variable(name, POSE, value, constant=True)
    types = predefined_types(joints)
    asked = {
        "R_JOINT_ACT": types["joint"],
        "R_ROBTARGET_ACT": types["robtarget"],
        "R_JBD": joint_bounds(types),
    }
    asked |= dict.fromkeys(("R_MOVE_TIME", "R_DISTANCE_FORW", "R_DISTANCE_BACK"), REAL)
    # Read by questions; what stands here says that they cannot be set.
    for name, type in asked.items():
        variables[name.casefold()] = Variable(name, type, unset_value(type), constant=True)
    return variables


def _reals(field: int, values: tuple[float, ...]) -> Value:
    type = POSE.fields[field][1]
    if not isinstance(type, Record):
        raise TypeError("parts of a pose are records")
    return RecordValue(type, values)
