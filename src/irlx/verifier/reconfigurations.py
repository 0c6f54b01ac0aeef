"""Checks of reconfigurations: the posture moves, the tool stays where it was."""

from __future__ import annotations

import numpy as np

from irlx.blocks import ReconfigureBlock
from irlx.promises import PATH_ORIENTATION, PATH_POSITION
from irlx.streams.joint_stream import JointStream
from irlx.verifier.evidence import Evidence
from irlx.verifier.moves import segments
from irlx.verifier.rotations import angle_between
from irlx.verifier.tally import Tally


def reconfigurations_of(stream: JointStream) -> list[tuple[int, int]]:
    """Row that stands when a RECONFIGURATION begins, and its last row, for each one that has rows."""
    places = {identity: last for identity, _, last in segments(stream.block)}
    return [
        (record.tick, places[record.block.id])
        for record in stream.records
        if isinstance(record.block, ReconfigureBlock) and record.block.id in places
    ]


def add_reconfigurations(evidence: Evidence, position: Tally, orientation: Tally) -> None:
    """Add how far the tool strays from its pose at the start in the rows of every RECONFIGURATION."""
    for start, last in reconfigurations_of(evidence.stream):
        rows = np.arange(start + 1, last + 1)
        positions, rotations = evidence.poses
        at, turned = evidence.pose(start)
        position.add(rows, np.linalg.norm(positions[rows] - at, axis=1), PATH_POSITION)
        orientation.add(rows, angle_between(turned, rotations[rows]), PATH_ORIENTATION)
