"""Cut and damaged files: read as far as they go, or refused with a code; never anything else."""

from pathlib import Path

import numpy as np
import pytest

from irlx.streams import KNOWN_ENDINGS, JointStream, StreamError, read_stream, write_stream
from irlx.streams.header_plain import header_to_plain
from long_run import first
from stream_files import LINES, SLOW_TO_OPEN, data_file


def small(kit, rows: int = 6) -> JointStream:
    maker = kit.Maker(np.array([0.1, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]))
    maker.record(kit.FreezeBlock, joints=(1, 7))
    maker.lin((0.5, 0.1, 0.3), (0.1, 0.2, 0.0), ticks=rows)
    return maker.stream()


def content(stream: JointStream) -> tuple[object, ...]:
    arrays = (stream.ticks, stream.q, stream.block, stream.tool)
    return (
        *(a.tobytes() for a in arrays),
        str(header_to_plain(stream.header)),
        stream.records,
        stream.complete,
    )


@pytest.mark.req("STR-01")
@pytest.mark.parametrize("turn", first(1, range(6)))
@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_cut_at_any_byte(ending: str, turn: int, gantry_kit, tmp_path: Path) -> None:
    """In six turns at every other byte of what is text."""
    whole = small(gantry_kit)
    path = tmp_path / f"a{ending}"
    write_stream(whole, path)
    file = data_file(path)
    data = file.read_bytes()
    step = {".npz": 21, ".parquet": 91, ".rosbag": 101}.get(ending, 12)
    readable, codes = set(), set()
    for length in range(turn * step // 6, len(data) - 1, step):
        file.write_bytes(data[:length])
        try:
            stream = read_stream(path)
        except StreamError as error:
            codes.add(error.reason.code)
            continue
        rows = len(stream.ticks)
        readable.add(rows)
        # Only the very last characters of the end record may be missing from a complete file.
        assert not stream.complete or length >= len(data) - 3
        assert np.array_equal(stream.q, whole.q[:rows])
        assert stream.records == whole.records[: len(stream.records)]
    assert codes <= {"IRL701", "IRL705"}
    rows = set(range(len(whole.ticks) + 1))
    # A chunk of a bag has all rows up to the next block.
    wanted = {".rosbag": {0, 1, len(whole.ticks)}, ".npz": set(), ".parquet": set()}
    assert readable == (rows if ending in LINES else wanted[ending])


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("seed", first(1, range(3, 8)))
@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_flipped_bits(ending: str, seed: int, gantry_kit, tmp_path: Path) -> None:
    whole = small(gantry_kit, rows=3)
    path = tmp_path / f"a{ending}"
    write_stream(whole, path)
    file = data_file(path)
    data = file.read_bytes()
    wanted, codes = content(read_stream(path)), set()
    rng = np.random.default_rng(seed)
    most = 90 if ending in SLOW_TO_OPEN else 240
    for place in rng.choice(len(data), size=min(len(data), most), replace=False).tolist():
        damaged = bytearray(data)
        damaged[place] ^= 1 << int(rng.integers(8))
        file.write_bytes(damaged)
        try:
            stream = read_stream(path)
        except StreamError as error:
            codes.add(error.reason.code[:5])
        else:
            assert content(stream) == wanted, place
    assert codes == {"IRL70"}


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_noise_and_mixtures(ending: str, gantry_kit, tmp_path: Path) -> None:
    path = tmp_path / f"a{ending}"
    write_stream(small(gantry_kit, rows=3), path)
    file = data_file(path)
    data = file.read_bytes()
    rng = np.random.default_rng(4)
    codes = set()
    for _ in range(150 if ending in SLOW_TO_OPEN else 300):
        damaged = bytearray(data[: rng.integers(len(data))])
        for place in rng.integers(0, max(len(damaged), 1), 4).tolist():
            damaged[place : place + int(rng.integers(3))] = rng.bytes(int(rng.integers(3)))
        file.write_bytes(damaged)
        try:
            read_stream(path)
        except StreamError as error:
            codes.add(error.reason.code[:5])
    assert codes == {"IRL70"}


def change(data: bytes, old: bytes, new: bytes) -> bytes:
    assert old in data
    return data.replace(old, new, 1)


@pytest.mark.req("STR-01")
@pytest.mark.parametrize(
    ("old", "new", "code", "words"),
    [
        (b"1, 100, ", b"2, 100, ", "IRL701", "record 1: .*its number is 2"),
        (b"version=3", b"version=4", "IRL706", "version 4"),
        (b"version=3", b"version=1", "IRL701", "record 5: .*code 200 is due"),
        (b"7, 201, joints=7", b"7, 201, joints=8", "IRL701", "record 15: "),
        (b'unit="m"', b'unit="in"', "IRL701", "record 14: .*'in'|rad"),
        (b"weight=7.0, ", b"", "IRL701", "record 8: .*weight"),
        (b", 420, tick=0", b", 421, tick=0", "IRL701", "record 16: .*421"),
        (b"joints=(1 7)", b"joints=(1 x)", "IRL701", "record 16: .*column"),
        (b"joints=(1 7)", b"joints=(1 7.0)", "IRL701", "record 16: .*joints.2"),
        (b'kind="LIN"', b'kind="ARC"', "IRL701", "record 17: .*ARC"),
        (b"law.speed=", b"law.pace=", "IRL701", "record 17: .*law"),
        (b"18, 900, 1, 2", b"18, 900, 0, 2", "IRL703", "record 18: .*tick 0 follows tick 0"),
        (b"18, 900, 1, 2", b"18, 900, 1.5, 2", "IRL701", "record 18: .*counts"),
        (b"19, 900, 2, 2", b"20, 900, 2, 2", "IRL701", "record 19: .*19 is due"),
        (b"19, 900, 2, 2", b"19, 900, 2, nan", "IRL701", "record 19: .*numbers"),
        (b"19, 900, 2, 2,", b"19, 900, 2, 2, 1.0,", "IRL701", "record 19: .*fields"),
        (b"19, 900, 2, 2,", b"19, 900, 2, 2, 1_0,", "IRL701", "record 19"),
        (b"18, 900, 1, 2", b"18, 900, 1, 3", "IRL702", "checksum"),
        (b"samples=5", b"samples=6", "IRL704", "should hold 6 samples, but 5"),
        (b"complete=true", b"complete=1", "IRL701", "end record"),
        (b"1, 100, ", b"\xff, 100, ", "IRL701", "record 1: .*UTF-8"),
    ],
)
def test_what_breaks_the_format_is_named(
    old: bytes, new: bytes, code: str, words: str, gantry_kit, tmp_path: Path
) -> None:
    path = tmp_path / "a.irdata"
    write_stream(small(gantry_kit, rows=3), path)
    path.write_bytes(change(path.read_bytes(), old, new))
    with pytest.raises(StreamError, match=words) as caught:
        read_stream(path)
    assert caught.value.reason.code == code


def test_text_after_the_end(gantry_kit, tmp_path: Path) -> None:
    path = tmp_path / "a.irdata"
    write_stream(small(gantry_kit, rows=3), path)
    data = path.read_bytes()
    for more in (data.splitlines(keepends=True)[-2], b"\n", b"x", b"22, 110, a=1 ;\n"):
        path.write_bytes(data + more)
        with pytest.raises(StreamError, match="IRL701"):
            read_stream(path)
