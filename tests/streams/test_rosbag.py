"""ROS 2 bags: what the readers of `rosbags` find in them, which folders are replaced, what is refused."""

import json
import shutil
import tracemalloc
import zlib
from pathlib import Path

import numpy as np
import pytest
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore

from irlx.streams import (
    BlockRecord,
    JointStream,
    RowBatch,
    StreamError,
    StreamWriter,
    open_writer,
    read_stream,
    scan_stream,
    write_stream,
)
from irlx.streams.header_plain import header_to_plain, record_to_plain
from irlx.streams.rosbag import trajectories
from long_run import first
from stream_files import content_of

pytestmark = pytest.mark.req("STR-04")

STORE = get_typestore(Stores.ROS2_HUMBLE)


def messages_of(path: Path) -> dict[str, list]:
    """Time of the bag, message and its bytes, by topic, as `rosbags` reads them."""
    found: dict[str, list] = {}
    with AnyReader([path], default_typestore=STORE) as reader:
        for connection, time, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            found.setdefault(connection.topic, []).append((time, message, data, connection.msgtype))
    return found


def nanoseconds(stamp) -> int:
    return stamp.sec * 10**9 + stamp.nanosec


def moving(kit, joints: int, names: tuple[str, ...], rows: int = 400, seed: int = 2) -> JointStream:
    """Rows that stand and move in turns, of every length; some joints stand while others move."""
    rng = np.random.default_rng(seed)
    steps = rng.normal(size=(rows, joints)) * (rng.random((rows, joints)) < 0.7)
    steps[rng.integers(rows, size=rows // 4)] = 0.0
    steps[100:140] = 0.0
    steps[200:300] = 1e-9
    steps[0] = steps[-1] = 0.0
    limits = type(kit.header().limits)(*(np.full(joints, np.inf) * sign for sign in (-1, 1) * 3))
    header = kit.header(
        joint_names=names, joint_units=("rad",) * joints, weights=(1.0,) * joints, limits=limits
    )
    ticks, block = np.arange(rows, dtype=np.int64), rng.integers(4, size=rows)
    return JointStream(header, (), ticks, np.cumsum(steps, axis=0), block, rng.normal(size=(rows, 7)), True)


def test_every_row_is_three_messages(good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.rosbag")
    found = messages_of(tmp_path / "a.rosbag")
    states, poses, blocks = (found[topic] for topic in ("/joint_states", "/tool_pose", "/irlx/block"))
    assert len(states) == len(poses) == len(blocks) == len(good.ticks)
    for row, (state, pose, block) in enumerate(zip(states, poses, blocks, strict=True)):
        time_ns = int(good.ticks[row]) * good.header.tick_ns
        assert state[0] == pose[0] == block[0] == time_ns
        assert nanoseconds(state[1].header.stamp) == nanoseconds(pose[1].header.stamp) == time_ns
        assert state[1].header.frame_id == pose[1].header.frame_id == "root"
        assert state[1].name == list(good.header.joint_names)
        assert state[1].position.tobytes() == good.q[row].tobytes()
        assert state[1].velocity.tobytes() == good.qd[row].tobytes()
        assert state[1].effort.size == 0
        position, turn = pose[1].pose.position, pose[1].pose.orientation
        tool = [position.x, position.y, position.z, turn.x, turn.y, turn.z, turn.w]
        assert np.array(tool).tobytes() == good.tool[row].tobytes()
        assert block[1].data == good.block[row]


def test_header_records_and_end_are_texts(good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.rosbag")
    found = messages_of(tmp_path / "a.rosbag")
    ((time, header, _, _),) = found["/irlx/header"]
    assert (time, json.loads(header.data)) == (0, header_to_plain(good.header))
    records = found["/irlx/record"]
    assert [json.loads(record[1].data) for record in records] == [record_to_plain(r) for r in good.records]
    assert [record[0] for record in records] == [r.tick * good.header.tick_ns for r in good.records]
    ((time, end, _, _),) = found["/irlx/end"]
    told = json.loads(end.data)
    assert time == int(good.ticks[-1]) * good.header.tick_ns
    assert (told["samples"], told["complete"]) == (len(good.ticks), True)


def motions_of(stream: JointStream) -> list[tuple[int, int]]:
    """First and last row of every motion: from a row at rest to the next one, found row by row."""
    found, begin = [], None
    for row in range(1, len(stream.q)):
        moves = stream.q[row].tolist() != stream.q[row - 1].tolist()
        if moves and begin is None:
            begin = row - 1
        elif not moves and begin is not None:
            found.append((begin, row))
            begin = None
    return found


def assert_trajectories(stream: JointStream, found: list) -> None:
    motions = motions_of(stream)
    assert len(found) == len(motions) > 1
    for (time, message, _, _), (begin, end) in zip(found, motions, strict=True):
        assert time == int(stream.ticks[begin]) * stream.header.tick_ns
        # 0: a controller begins when the message comes.
        assert nanoseconds(message.header.stamp) == 0
        assert message.joint_names == list(stream.header.joint_names)
        assert (
            np.array([p.positions for p in message.points]).tobytes() == stream.q[begin : end + 1].tobytes()
        )
        rates = np.array([p.velocities for p in message.points])
        assert rates.tobytes() == stream.qd[begin : end + 1].tobytes()
        assert not rates[0].any()
        assert not rates[-1].any()
        assert rates[1:-1].any(axis=1).all()
        times = np.array([nanoseconds(point.time_from_start) for point in message.points])
        assert times[0] == 0
        assert (np.diff(times) > 0).all()
        due = (stream.ticks[begin : end + 1] - stream.ticks[begin]) * stream.header.tick_ns
        assert times.tolist() == due.tolist()
        assert not any(p.accelerations.size or p.effort.size for p in message.points)


def test_every_motion_is_a_trajectory(good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.rosbag")
    assert_trajectories(good, messages_of(tmp_path / "a.rosbag")["/joint_trajectory"])


NAMES = [("a",), ("ab", "c"), ("abc", "d", "öä"), ("joint_1", "joint_2", "j", "kk", "mmm"), tuple("abcdefgh")]


@pytest.mark.parametrize("names", NAMES, ids=len)
@pytest.mark.parametrize("more", first(2, ["", "xxx", "x", "xx", "xxxx"]))
def test_messages_are_those_of_rosbags(names, more: str, gantry_kit, tmp_path: Path) -> None:
    """Lengths of names shift all that follows: every message is what `rosbags` makes of its content."""
    names = (*names[:-1], names[-1] + more)
    stream = moving(gantry_kit, len(names), names)
    write_stream(stream, tmp_path / "a.rosbag")
    found = messages_of(tmp_path / "a.rosbag")
    for topic in found.values():
        for _, message, data, kind in topic:
            assert bytes(STORE.serialize_cdr(message, kind)) == bytes(data)
    assert_trajectories(stream, found["/joint_trajectory"])


def test_long_motions_are_kept_in_a_file(good: JointStream, tmp_path: Path, monkeypatch) -> None:
    write_stream(good, tmp_path / "a.rosbag")
    monkeypatch.setattr(trajectories, "_IN_MEMORY", 1000)
    monkeypatch.setattr(trajectories, "_PORTION", 777)
    write_stream(good, tmp_path / "b.rosbag")
    assert content_of(tmp_path / "a.rosbag") == content_of(tmp_path / "b.rosbag")


def test_a_motion_that_does_not_end_is_no_trajectory(good: JointStream, tmp_path: Path) -> None:
    motions = motions_of(good)
    rows = motions[1][1] - 3
    arrays = (array[:rows] for array in (good.ticks, good.q, good.block, good.tool))
    write_stream(JointStream(good.header, (), *arrays, False), tmp_path / "a.rosbag")
    found = messages_of(tmp_path / "a.rosbag")
    assert len(found["/joint_trajectory"]) == 1
    assert json.loads(found["/irlx/end"][0][1].data)["complete"] is False


def test_gaps_in_ticks_are_gaps_in_time(good: JointStream, tmp_path: Path) -> None:
    ticks = good.ticks * 3
    ticks[20:] += 1_000_000
    stream = JointStream(good.header, (), ticks, good.q, good.block, good.tool, True)
    write_stream(stream, tmp_path / "a.rosbag")
    found = messages_of(tmp_path / "a.rosbag")
    assert [state[0] for state in found["/joint_states"]] == (ticks * good.header.tick_ns).tolist()
    assert_trajectories(stream, found["/joint_trajectory"])
    assert read_stream(tmp_path / "a.rosbag").ticks.tobytes() == ticks.tobytes()


def test_metadata_tell_what_is_there(good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.rosbag")
    assert sorted(path.name for path in (tmp_path / "a.rosbag").iterdir()) == ["metadata.yaml", "stream.mcap"]
    found = messages_of(tmp_path / "a.rosbag")
    counts = {topic: len(messages) for topic, messages in found.items()}
    last = int(good.ticks[-1]) * good.header.tick_ns
    for path in (tmp_path / "a.rosbag", tmp_path / "a.rosbag" / "stream.mcap"):
        with Reader(path) as reader:
            assert {one.topic: one.msgcount for one in reader.connections} == counts
            assert (reader.start_time, reader.end_time) == (0, last + 1)
            assert reader.message_count == sum(counts.values())
    with Reader(tmp_path / "a.rosbag") as reader:
        assert {one.topic: one.digest for one in reader.connections} == {
            one.topic: STORE.hash_rihs01(one.msgtype) for one in reader.connections
        }


def test_a_scan_comes_in_the_order_of_the_run(good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.rosbag")
    rows = 0
    for item in scan_stream(tmp_path / "a.rosbag"):
        if isinstance(item, RowBatch):
            rows += len(item.ticks)
        elif isinstance(item, BlockRecord):
            assert rows == int((good.ticks <= item.tick).sum())
    assert rows == len(good.ticks)


def test_chunks_do_not_depend_on_batches(gantry_kit, tmp_path: Path) -> None:
    stream = moving(gantry_kit, 3, ("a", "b", "c"), rows=2000)
    rng = np.random.default_rng(5)
    for name in ("a", "b"):
        with open_writer(tmp_path / f"{name}.rosbag", stream.header) as writer:
            start = 0
            while start < 2000:
                part = slice(start, start + int(rng.integers(1, 700)))
                batch = [array[part].copy() for array in (stream.ticks, stream.q, stream.block, stream.tool)]
                writer.samples(*batch)
                batch[1][:] = 7.0
                start = part.stop
    assert content_of(tmp_path / "a.rosbag") == content_of(tmp_path / "b.rosbag")
    assert_trajectories(stream, messages_of(tmp_path / "a.rosbag")["/joint_trajectory"])


@pytest.mark.parametrize("record", [False, True])
def test_times_that_ros_has_no_numbers_for(record: bool, good: JointStream, tmp_path: Path) -> None:
    tick = 2**31 * 10**9 // good.header.tick_ns
    writer = open_writer(tmp_path / "a.rosbag", good.header)
    row = (good.q[:1], good.block[:1], good.tool[:1])
    writer.samples(np.array([tick - 1]), *row)
    late = BlockRecord(tick, good.records[0].block)
    with pytest.raises(StreamError, match=r"IRL708.*2147483648 s, ROS has times"):
        writer.block(late) if record else writer.samples(np.array([tick]), *row)
    assert not list(tmp_path.iterdir())


def test_memory_of_writing_does_not_grow(gantry_kit, tmp_path: Path, monkeypatch) -> None:
    """One motion without a stop, the rows of which go to a file."""
    monkeypatch.setattr(trajectories, "_IN_MEMORY", 100_000)
    monkeypatch.setattr(trajectories, "_PORTION", 100_000)
    peaks = []
    for portions in (3, 9):
        part = moving(gantry_kit, 7, tuple("abcdefg"), rows=1024)
        tracemalloc.start()
        try:
            with open_writer(tmp_path / "a.rosbag", part.header) as writer:
                for number in range(portions):
                    q = np.arange(1024.0)[:, None] + np.arange(7) + 1024 * number
                    writer.samples(part.ticks + 1024 * number, q, part.block, part.tool)
                writer.samples(np.array([1024 * portions]), q[-1:], part.block[:1], part.tool[:1])
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
        with Reader(tmp_path / "a.rosbag") as reader:
            wanted = [one for one in reader.connections if one.topic == "/joint_trajectory"]
            ((_, _, data),) = reader.messages(wanted)
        assert len(data) > 144 * (1024 * portions + 1)
    # 6000 points have 0.9 MB.
    assert peaks[1] < peaks[0] + 100_000


def refusal(stream: JointStream, path: Path) -> str:
    with pytest.raises(StreamError) as caught:
        write_stream(stream, path)
    assert caught.value.reason.code == "IRL003"
    return str(caught.value)


def test_only_bags_of_irlx_are_replaced(good: JointStream, tmp_path: Path) -> None:
    part = JointStream(good.header, (), good.ticks[:5], good.q[:5], good.block[:5], good.tool[:5], False)
    path = tmp_path / "a.rosbag"
    write_stream(part, path)
    write_stream(good, path)
    assert len(read_stream(path).ticks) == len(good.ticks)
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.rosbag"]
    (path / "notes.txt").write_text("mine")
    assert "no ROS 2 bag of irlx" in refusal(part, path)
    assert (path / "notes.txt").read_text() == "mine"
    (path / "notes.txt").unlink()
    before = content_of(path)
    (path / "stream.mcap").write_bytes(before["stream.mcap"].replace(b"irlx", b"ilrx", 1))
    assert "that irlx did not write" in refusal(part, path)
    shutil.rmtree(path)
    path.write_text("a file")
    assert "it is a file" in refusal(part, path)
    assert path.read_text() == "a file"
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.rosbag"]


def test_a_folder_that_comes_meanwhile_is_kept(good: JointStream, tmp_path: Path) -> None:
    writer = open_writer(tmp_path / "a.rosbag", good.header)
    (tmp_path / "a.rosbag").mkdir()
    (tmp_path / "a.rosbag" / "notes.txt").write_text("mine")
    with pytest.raises(StreamError, match="IRL003"):
        writer.close()
    assert content_of(tmp_path / "a.rosbag") == {"notes.txt": b"mine"}
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.rosbag"]


def test_a_bag_that_cannot_be_put_in_place_leaves_the_one_before(
    good: JointStream, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_stream(good, tmp_path / "a.rosbag")
    before = content_of(tmp_path / "a.rosbag")
    rename, failed = Path.rename, []

    def fail(path: Path, target: Path) -> Path:
        # The one before has got another name by then.
        if not target.exists() and not failed:
            failed.append(path)
            raise OSError(5, "Input/output error")
        return rename(path, target)

    monkeypatch.setattr(Path, "rename", fail)
    assert "input/output error" in refusal(good, tmp_path / "a.rosbag")
    assert {path.name: content_of(path) for path in tmp_path.iterdir()} == {"a.rosbag": before}


def test_two_processes_that_write_the_same_bag(
    good: JointStream, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another bag appears between the look at the place and the renaming: it is not written into."""
    path, rename, others = tmp_path / "a.rosbag", Path.rename, []

    def meanwhile(own: Path, target: Path) -> Path:
        if target == path and len(others) < 2:
            others.append(own)
            shutil.copytree(own, path) if not path.exists() else shutil.rmtree(path)
        return rename(own, target)

    monkeypatch.setattr(Path, "rename", meanwhile)
    write_stream(good, path)
    write_stream(good, path)
    assert len(others) == 2
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.rosbag"]
    assert read_stream(path).complete


def test_a_link_to_a_bag_is_followed(good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "real.rosbag")
    (tmp_path / "link.rosbag").symlink_to(tmp_path / "real.rosbag")
    write_stream(good, tmp_path / "link.rosbag")
    assert (tmp_path / "link.rosbag").is_symlink()
    assert read_stream(tmp_path / "link.rosbag").complete
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link.rosbag", "real.rosbag"]


def test_a_renamed_bag_stays_whole(good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.rosbag")
    (tmp_path / "a.rosbag").rename(tmp_path / "weld.rosbag")
    assert read_stream(tmp_path / "weld.rosbag").complete
    assert len(messages_of(tmp_path / "weld.rosbag")["/joint_states"]) == len(good.ticks)


def test_an_exception_leaves_nothing(good: JointStream, tmp_path: Path) -> None:
    def interrupted() -> None:
        with open_writer(tmp_path / "a.rosbag", good.header) as writer:
            writer.samples(good.ticks[:9], good.q[:9], good.block[:9], good.tool[:9])
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_disk_that_fills_up(good: JointStream, tmp_path: Path) -> None:
    writer = open_writer(tmp_path / "a.rosbag", good.header)
    with open("/dev/full", "wb", buffering=0) as full:
        writer._mcap._file = full
        with pytest.raises(StreamError, match=r"IRL003.*no space left"):
            writer.block(good.records[0])
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("metadata", [True, False])
def test_a_bag_that_was_cut_is_read_to_its_last_whole_chunk(
    metadata: bool, gantry_kit, tmp_path: Path
) -> None:
    """As a process that was killed leaves it."""
    stream = moving(gantry_kit, 2, ("a", "b"), rows=4000)
    write_stream(stream, tmp_path / "a.rosbag")
    file = tmp_path / "a.rosbag" / "stream.mcap"
    data = file.read_bytes()
    file.write_bytes(data[: len(data) * 3 // 4])
    if not metadata:
        (tmp_path / "a.rosbag" / "metadata.yaml").unlink()
    found = read_stream(tmp_path / "a.rosbag")
    rows = len(found.ticks)
    assert rows in (1024, 2048, 3072)
    assert found.q.tobytes() == stream.q[:rows].tobytes()
    assert not found.complete


def test_what_a_killed_process_leaves_is_read(good: JointStream, tmp_path: Path) -> None:
    writer = open_writer(tmp_path / "a.rosbag", good.header)
    for record in good.records:
        rows = good.ticks[writer.rows :] <= record.tick
        part = slice(writer.rows, writer.rows + int(rows.sum()))
        writer.samples(good.ticks[part], good.q[part], good.block[part], good.tool[part])
        writer.block(record)
    writer._mcap._file.flush()
    (left,) = tmp_path.iterdir()
    assert left.suffix == ".rosbag"
    found = read_stream(left)
    assert (len(found.ticks), found.records) == (writer.rows, good.records)
    assert not found.complete
    writer.abort()


@pytest.mark.parametrize("name", ["metadata.yaml", "stream.mcap"])
def test_a_bag_without_one_of_its_files(name: str, good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.rosbag")
    (tmp_path / "a.rosbag" / name).unlink()
    with pytest.raises(StreamError, match=f"{name} is missing") as caught:
        read_stream(tmp_path / "a.rosbag")
    assert caught.value.reason.code == "IRL701"


def test_a_file_is_no_bag(tmp_path: Path) -> None:
    (tmp_path / "a.rosbag").write_text("x")
    with pytest.raises(StreamError, match=r"IRL701.*it is a file"):
        read_stream(tmp_path / "a.rosbag")


def test_metadata_of_another_bag(good: JointStream, tmp_path: Path) -> None:
    part = JointStream(good.header, (), good.ticks[:5], good.q[:5], good.block[:5], good.tool[:5], True)
    write_stream(good, tmp_path / "a.rosbag")
    write_stream(part, tmp_path / "b.rosbag")
    shutil.copy(tmp_path / "b.rosbag" / "metadata.yaml", tmp_path / "a.rosbag" / "metadata.yaml")
    with pytest.raises(StreamError, match=r"it does not fit metadata\.yaml"):
        read_stream(tmp_path / "a.rosbag")
    (tmp_path / "a.rosbag" / "metadata.yaml").write_bytes(b"\xff\n\xfe")
    with pytest.raises(StreamError, match="IRL701"):
        read_stream(tmp_path / "a.rosbag")


def chunk_at(data: bytes, inside: int) -> tuple[int, int, int]:
    """Where the CRC of the chunk around a place stands, where its messages begin, and where they end."""
    at = 8
    while True:
        code, length = data[at], int.from_bytes(data[at + 1 : at + 9], "little")
        if code == 6 and at + 9 <= inside < at + 9 + length:
            return at + 9 + 24, at + 9 + 40, at + 9 + length
        at += 9 + length


@pytest.mark.parametrize("mended", [False, True])
def test_a_value_that_was_changed(mended: bool, good: JointStream, tmp_path: Path) -> None:
    """The checksum of its chunk is wrong; where that is made good, the one of the whole bag is."""
    write_stream(good, tmp_path / "a.rosbag")
    file = tmp_path / "a.rosbag" / "stream.mcap"
    data = bytearray(file.read_bytes())
    place = data.index(good.q[60].tobytes())
    data[place] ^= 1
    crc, begin, end = chunk_at(data, place)
    if mended:
        data[crc : crc + 4] = zlib.crc32(data[begin:end]).to_bytes(4, "little")
    file.write_bytes(data)
    rows = []
    with pytest.raises(StreamError) as caught:
        rows.extend(len(item.ticks) for item in scan_stream(tmp_path / "a.rosbag") if hasattr(item, "ticks"))
    assert caught.value.reason.code == ("IRL702" if mended else "IRL701")
    assert sum(rows) == len(good.ticks) if mended else 0 < sum(rows) <= 60


@pytest.mark.parametrize("old", [b"root\0", b"\x07\0\0\0\x05\0\0\0rail"])
def test_messages_in_another_form(old: bytes, good: JointStream, tmp_path: Path) -> None:
    """What is the same in every message is compared as well, whatever checksums say."""
    write_stream(good, tmp_path / "a.rosbag")
    file = tmp_path / "a.rosbag" / "stream.mcap"
    data = bytearray(file.read_bytes())
    place = data.index(old, data.index(good.q[60].tobytes()) - 200)
    data[place] ^= 1
    crc, begin, end = chunk_at(data, place)
    data[crc : crc + 4] = zlib.crc32(data[begin:end]).to_bytes(4, "little")
    file.write_bytes(data)
    with pytest.raises(StreamError, match="another form") as caught:
        read_stream(tmp_path / "a.rosbag")
    assert caught.value.reason.code == "IRL701"


def test_fewer_samples_than_said(good: JointStream, tmp_path: Path) -> None:
    with open_writer(tmp_path / "a.rosbag", good.header) as writer:
        writer.samples(good.ticks, good.q, good.block, good.tool)
        writer.rows += 1
    with pytest.raises(StreamError, match="should hold 298 samples, but 297 are there") as caught:
        read_stream(tmp_path / "a.rosbag")
    assert caught.value.reason.code == "IRL704"


@pytest.mark.parametrize("ending", [".parquet", ".rosbag"])
def test_blocks_whose_ticks_fall(ending: str, good: JointStream, tmp_path: Path, monkeypatch) -> None:
    falling = tuple(BlockRecord(9 - at, record.block) for at, record in enumerate(good.records[:2]))
    stream = JointStream(good.header, falling, good.ticks, good.q, good.block, good.tool, True)
    monkeypatch.setattr(StreamWriter, "block", lambda writer, record: writer._put_block(record))
    write_stream(stream, tmp_path / f"a{ending}")
    with pytest.raises(StreamError, match=r"tick 8 follows (one of )?tick 9") as caught:
        read_stream(tmp_path / f"a{ending}")
    assert caught.value.reason.code == "IRL701"


def test_rows_that_are_not_finite(good: JointStream, tmp_path: Path, monkeypatch) -> None:
    tool = good.tool.copy()
    tool[40, 2] = np.inf
    monkeypatch.setattr(StreamWriter, "_check", lambda *_: None)
    stream = JointStream(good.header, (), good.ticks, good.q, good.block, tool, True)
    write_stream(stream, tmp_path / "a.rosbag")
    with pytest.raises(StreamError, match="the row of tick 40 has values that are not finite"):
        read_stream(tmp_path / "a.rosbag")
