"""The metadata of a bag, as ROS 2 wants them beside the MCAP file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING

from irlx.streams.rosbag.files import MCAP
from irlx.streams.rosbag.messages import TOPICS, Topic

if TYPE_CHECKING:
    # Not imported: reading needs no definitions, and so no package beyond irlx.
    from irlx.streams.rosbag.definitions import Definition

VERSION = 8
"""The last version that ROS 2 Humble reads; later releases read it as well."""


def metadata_text(
    counts: Mapping[Topic, int], begin_ns: int, end_ns: int, definitions: Mapping[str, Definition]
) -> str:
    """YAML of a bag with `counts` messages of each topic, the first at `begin_ns`, the last at `end_ns`."""
    begin = f"{{nanoseconds_since_epoch: {begin_ns}}}"
    duration, total = f"{{nanoseconds: {end_ns - begin_ns}}}", sum(counts.values())
    lines = [
        f"version: {VERSION}",
        "storage_identifier: mcap",
        f"relative_file_paths: [{MCAP}]",
        f"duration: {duration}",
        f"starting_time: {begin}",
        f"message_count: {total}",
        "topics_with_message_count:",
        *(line for topic in Topic for line in _topic(topic, counts[topic], definitions)),
        "compression_format: ''",
        "compression_mode: ''",
        "files:",
        f"- path: {MCAP}",
        f"  starting_time: {begin}",
        f"  duration: {duration}",
        f"  message_count: {total}",
        "custom_data: null",
        "ros_distro: irlx",
    ]
    return "".join(f"{line}\n" for line in lines)


def metadata_file(text: str) -> bytes:
    """Content of metadata.yaml for the text of `metadata_text`, which the MCAP file has as well."""
    inner = "".join(f"  {line}" for line in text.splitlines(keepends=True))
    return f"rosbag2_bagfile_information:\n{inner}".encode()


def _topic(topic: Topic, count: int, definitions: Mapping[str, Definition]) -> list[str]:
    name, kind = TOPICS[topic]
    entries = {
        "name": name,
        "type": kind,
        "serialization_format": "cdr",
        "offered_qos_profiles": "",
        "type_description_hash": definitions[kind].digest,
    }
    # Strings of JSON are strings of YAML.
    told = [f"    {key}: {json.dumps(value)}" for key, value in entries.items()]
    return ["- topic_metadata:", *told, f"  message_count: {count}"]
