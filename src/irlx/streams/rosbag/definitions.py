"""Definitions of the message types, from `rosbags`."""

from __future__ import annotations

from typing import NamedTuple

from rosbags.typesys import Stores, get_typestore


class Definition(NamedTuple):
    """A message type: its name, its definition as text of .msg files, and its hash."""

    name: str
    text: str
    digest: str


def definitions_of(names: list[str]) -> list[Definition]:
    """Definitions of message types, as ROS 2 Humble and what followed have them."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    return [
        Definition(name, store.generate_msgdef(name, ros_version=2)[0], store.hash_rihs01(name))
        for name in names
    ]
