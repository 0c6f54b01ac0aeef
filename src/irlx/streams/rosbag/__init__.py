"""ROS 2 bags: folders of a metadata.yaml and one MCAP file, played and read by what ROS 2 has for bags.

`rosbags` brings the message definitions; it is imported only when a bag is written.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from irlx.streams.atomic_folder import AtomicFolder
from irlx.streams.extra import require
from irlx.streams.joint_stream import StreamHeader
from irlx.streams.rosbag.files import may_replace
from irlx.streams.scan import ScanItem
from irlx.streams.writer import StreamWriter

__all__ = ["check_rosbag", "rosbag_writer", "scan_rosbag"]


def rosbag_writer(path: Path, header: StreamHeader) -> StreamWriter:
    """A writer of ROS 2 bags. Raises StreamError: IRL720 without rosbags, IRL003 where no bag can be put."""
    _require(path)
    from irlx.streams.rosbag.writer import RosbagWriter

    return RosbagWriter(path, header)


def scan_rosbag(path: str | os.PathLike[str]) -> Iterator[ScanItem]:
    """Scan of a ROS 2 bag that irlx wrote; see `irlx.streams.rosbag.reader`."""
    from irlx.streams.rosbag.reader import scan

    return scan(Path(path))


def check_rosbag(path: Path) -> None:
    """Raise StreamError where no bag can be written: IRL720 without rosbags, IRL003."""
    _require(path)
    AtomicFolder(path, may_replace).discard()


def _require(path: Path) -> None:
    require("rosbags.typesys", "ros", path, "a ROS 2 bag")
