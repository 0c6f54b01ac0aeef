"""Scans: the content of a stream in portions, what stands before damage, and how little memory that takes."""

import shutil
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from irlx.streams import (
    KNOWN_ENDINGS,
    BlockRecord,
    JointStream,
    RowBatch,
    ScanItem,
    StreamEnd,
    StreamError,
    StreamHeader,
    StreamWriter,
    collect,
    read_stream,
    scan_of,
    scan_stream,
    write_stream,
)
from irlx.streams.header_plain import header_to_plain
from irlx.streams.irdata.samples import parse_samples, samples_text
from long_run import chequered, first

ROWS = 12_000
BLOCK_TICKS = (0, 0, 4000, 4001, 9000, ROWS)


def noise(kit, rows: int, seed: int = 7) -> JointStream:
    """Random rows with a gap in their ticks, values of every size and sign among them, and some blocks."""
    rng = np.random.default_rng(seed)
    ticks = np.arange(rows, dtype=np.int64)
    ticks[rows // 2 :] += 5
    q = rng.normal(size=(rows, 7)) * 10.0 ** rng.integers(-12, 4, (rows, 7))
    q[rng.integers(rows, size=50), rng.integers(7, size=50)] = -0.0
    q[rng.integers(rows, size=50), rng.integers(7, size=50)] = 5e-324
    block = np.searchsorted(BLOCK_TICKS, ticks, side="left").astype(np.int64)
    origin = kit.Origin("weld.irl", 1, 2, 3)
    records = tuple(
        BlockRecord(tick, kit.FreezeBlock(id=number, origin=origin, joints=(1,)))
        for number, tick in enumerate(BLOCK_TICKS, 1)
    )
    return JointStream(kit.header(), records, ticks, q, block, rng.normal(size=(rows, 7)), True)


@pytest.fixture(scope="module")
def long(gantry_kit) -> JointStream:
    return noise(gantry_kit, ROWS)


@pytest.fixture(scope="module")
def long_file(long, tmp_path_factory) -> Callable[[Path], None]:
    """`long_file(path)`: the long stream there, in the format of its ending; each is written once."""
    folder = tmp_path_factory.mktemp("long")

    def put(path: Path) -> None:
        written = folder / f"a{path.suffix}"
        if not written.exists():
            write_stream(long, written)
        shutil.copyfile(written, path)

    return put


def until_fault(scan: Iterator[ScanItem]) -> tuple[list[ScanItem], StreamError]:
    """What a scan gives before it raises, and what it raises."""
    items: list[ScanItem] = []
    try:
        for item in scan:
            items.append(item)
    except StreamError as fault:
        return items, fault
    pytest.fail("nothing was raised")


def batches_of(items: list[ScanItem]) -> list[RowBatch]:
    return [item for item in items if isinstance(item, RowBatch)]


def assert_rows(items: list[ScanItem], stream: JointStream, rows: int) -> None:
    """The batches hold exactly the first rows of the stream, bit by bit; rates too where they are stated."""
    batches = batches_of(items)
    for name in ("ticks", "q", "block", "tool"):
        found = [getattr(batch, name) for batch in batches]
        wanted = getattr(stream, name)[:rows]
        assert b"".join(part.tobytes() for part in found) == wanted.tobytes(), name
        assert {part.dtype for part in found} <= {wanted.dtype}
    for name in ("t", "qd", "qdd"):
        stated = b"".join(getattr(batch.rates, name).tobytes() for batch in batches if batch.rates)
        assert stated in (b"", getattr(stream, name)[:rows].tobytes()), name


@pytest.mark.req("STR-01")
@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
@pytest.mark.parametrize("complete", [True, False])
def test_a_scan_gives_what_was_written(ending: str, complete: bool, long, tmp_path: Path) -> None:
    path = tmp_path / f"a{ending}"
    stream = JointStream(long.header, long.records, long.ticks, long.q, long.block, long.tool, complete)
    write_stream(stream, path)
    items = list(scan_stream(path))
    header, *middle, end = items
    assert isinstance(header, StreamHeader)
    assert header_to_plain(header) == header_to_plain(stream.header)
    assert end == StreamEnd(complete)
    assert all(isinstance(item, RowBatch | BlockRecord) for item in middle)
    batches = batches_of(middle)
    assert len(batches) >= 3
    assert all(0 < len(batch.ticks) <= 4096 for batch in batches)
    assert all((batch.rates is None) == (ending == ".irdata") for batch in batches)
    assert_rows(items, stream, ROWS)
    records = tuple(item for item in middle if isinstance(item, BlockRecord))
    assert records == (() if ending == ".csv" else stream.records)


def test_irdata_comes_in_the_order_of_the_file(long, long_file, tmp_path: Path) -> None:
    long_file(tmp_path / "a.irdata")
    rows, seen = 0, []
    for item in scan_stream(tmp_path / "a.irdata"):
        if isinstance(item, RowBatch):
            rows += len(item.ticks)
        elif isinstance(item, BlockRecord):
            seen.append((item.tick, rows))
    assert seen == [(tick, int((long.ticks <= tick).sum())) for tick in BLOCK_TICKS]


@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
@pytest.mark.parametrize("rows", [0, 1])
def test_few_rows(ending: str, rows: int, good: JointStream, tmp_path: Path) -> None:
    arrays = (good.ticks, good.q, good.block, good.tool)
    write_stream(JointStream(good.header, (), *(a[:rows] for a in arrays), True), tmp_path / f"a{ending}")
    items = list(scan_stream(tmp_path / f"a{ending}"))
    assert [len(batch.ticks) for batch in batches_of(items)] == [1] * rows
    assert len(items) == 2 + rows
    assert items[-1] == StreamEnd(True)


def test_a_stream_in_memory_is_scanned_like_a_file(long) -> None:
    items = list(scan_of(long))
    assert items[0] is long.header
    assert items[-1] == StreamEnd(True)
    assert [len(batch.ticks) for batch in batches_of(items)] == [4096, 4096, ROWS - 8192]
    assert_rows(items, long, ROWS)
    again = collect(scan_of(long))
    assert again.records == long.records
    assert_rows(list(scan_of(again)), long, ROWS)


def test_collect_refuses_what_is_no_scan(good: JointStream) -> None:
    items = list(scan_of(good))
    for wrong in ([], items[1:], items[:-1]):
        with pytest.raises(ValueError, match=r"a scan (begins|ends) with"):
            collect(iter(wrong))


def test_unknown_endings_are_refused_at_the_call(tmp_path: Path) -> None:
    with pytest.raises(StreamError, match="IRL707"):
        scan_stream(tmp_path / "a.txt")


@pytest.mark.parametrize("ending", [".irdata", ".csv"])
def test_cut_files(ending: str, long, long_file, tmp_path: Path) -> None:
    path = tmp_path / f"a{ending}"
    long_file(path)
    data = path.read_bytes()
    path.write_bytes(data[: len(data) * 3 // 4])
    items = list(scan_stream(path))
    assert items[-1] == StreamEnd(False)
    rows = sum(len(batch.ticks) for batch in batches_of(items))
    assert ROWS * 2 // 3 < rows < ROWS * 4 // 5
    assert_rows(items, long, rows)


def lines_of(path: Path, mark: bytes) -> tuple[list[bytes], list[int]]:
    """Lines of a file, and which of them are samples."""
    lines = path.read_bytes().splitlines(keepends=True)
    return lines, [at for at, line in enumerate(lines) if mark in line and line[:1].isdigit()]


@pytest.mark.parametrize("row", [0, 40, 9876, ROWS - 1])
@pytest.mark.parametrize(
    ("ending", "mark", "place"), [(".irdata", b", 900, ", "record"), (".csv", b",", "line")]
)
def test_rows_before_a_damaged_line_come_out(
    row: int, ending: str, mark: bytes, place: str, long, long_file, tmp_path: Path
) -> None:
    path = tmp_path / f"a{ending}"
    long_file(path)
    lines, samples = lines_of(path, mark)
    damaged = lines[samples[row]].replace(b"e", b"x", 1)
    # Without the end of the file its checksum cannot tell first that something is wrong.
    path.write_bytes(b"".join([*lines[: samples[row]], damaged, *lines[samples[row] + 1 : -1]]))
    items, fault = until_fault(scan_stream(path))
    assert fault.reason.code == "IRL701"
    assert f"{place} {samples[row] + 1}: " in str(fault)
    assert "numbers" in str(fault)
    assert_rows(items, long, row)


@pytest.mark.parametrize(
    ("ending", "row"),
    chequered([pytest.param(ending, id=ending) for ending in KNOWN_ENDINGS], [1, 40, 8192, 9876]),
)
def test_rows_before_a_tick_that_falls_come_out(
    ending: str, row: int, long, long_file, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ticks = long.ticks.copy()
    ticks[row] = ticks[row - 1]
    path = tmp_path / f"a{ending}"
    if ending == ".irdata":
        long_file(path)
        lines, samples = lines_of(path, b", 900, ")
        old, new = b", 900, %d, " % long.ticks[row], b", 900, %d, " % ticks[row]
        lines[samples[row]] = lines[samples[row]].replace(old, new)
        path.write_bytes(b"".join(lines))
    else:
        # Writers refuse what is to be read here.
        monkeypatch.setattr(StreamWriter, "_check", lambda *_: None)
        write_stream(JointStream(long.header, (), ticks, long.q, long.block, long.tool, True), path)
    items, fault = until_fault(scan_stream(path))
    assert fault.reason.code == "IRL703"
    assert f"tick {ticks[row]} follows tick {ticks[row]}" in str(fault)
    assert_rows(items, long, row)


@pytest.mark.parametrize("ending", [".irdata", ".csv"])
@pytest.mark.parametrize(("old", "code"), [(b'sha256": "', "IRL702"), (b'"samples": 1', "IRL704")])
def test_all_rows_come_out_before_wrong_sums(
    ending: str, old: bytes, code: str, long, long_file, tmp_path: Path
) -> None:
    path = tmp_path / f"a{ending}"
    long_file(path)
    if ending == ".irdata":
        old = old.replace(b'"', b"").replace(b": ", b"=") + b'"' * (code == "IRL702")
    *lines, last = path.read_bytes().splitlines(keepends=True)
    at = last.index(old) + len(old)
    wrong = b"0" if last[at : at + 1] != b"0" else b"1"
    path.write_bytes(b"".join([*lines, last[:at], wrong, last[at + 1 :]]))
    items, fault = until_fault(scan_stream(path))
    assert fault.reason.code == code
    assert_rows(items, long, ROWS)


def test_checksum_of_csv_goes_before_damaged_lines(long, long_file, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    long_file(path)
    lines, samples = lines_of(path, b",")
    lines[samples[100]] = lines[samples[100]].replace(b"e", b"x", 1)
    path.write_bytes(b"".join(lines))
    items, fault = until_fault(scan_stream(path))
    assert fault.reason.code == "IRL702"
    assert_rows(items, long, 100)


@pytest.mark.parametrize("column", [1, 3, 10, 17, 24])
def test_every_value_of_csv_must_be_finite(column: int, long, long_file, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    long_file(path)
    lines, samples = lines_of(path, b",")
    words = lines[samples[7000]].split(b",")
    lines[samples[7000]] = b",".join([*words[:column], b"1e999", *words[column + 1 :]])
    path.write_bytes(b"".join(lines[:-1]))
    items, fault = until_fault(scan_stream(path))
    assert fault.reason.code == "IRL701"
    assert "all values finite" in str(fault)
    assert_rows(items, long, 7000)


@pytest.mark.parametrize("more", [b"x", b"1,2,3\n", b"\n", b"# more\n", b"# more", b"\r"])
def test_text_after_the_closing_comment_of_csv(more: bytes, long, long_file, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    long_file(path)
    path.write_bytes(path.read_bytes() + more)
    items, fault = until_fault(scan_stream(path))
    assert fault.reason.code == "IRL701"
    assert_rows(items, long, ROWS)


@pytest.mark.parametrize("member", ["q", "qdd", "tool", "block", "t"])
def test_a_damaged_array_of_npz_is_found_at_its_end(member: str, long, long_file, tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    long_file(path)
    data = path.read_bytes()
    content = getattr(long, member).tobytes()
    damaged = bytearray(data)
    damaged[data.index(content) + len(content) - 3] ^= 1
    path.write_bytes(damaged)
    items, fault = until_fault(scan_stream(path))
    assert fault.reason.code == "IRL701"
    assert f"Bad CRC-32 for file '{member}.npy'" in str(fault)
    assert_rows(items, long, 8192)


def arrays_of(path: Path) -> dict[str, np.ndarray]:
    with np.load(path, allow_pickle=False) as file:
        return dict(file)


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
@pytest.mark.parametrize("order", ["C", "F"])
def test_npz_that_numpy_wrote(save, order: str, long, long_file, tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    long_file(path)
    save(path, **{key: np.asarray(array, order=order) for key, array in arrays_of(path).items()})
    items = list(scan_stream(path))
    assert len(batches_of(items)) == 3
    assert_rows(items, long, ROWS)


@pytest.mark.parametrize("member", ["t", "q", "qd", "qdd", "tool", "block"])
def test_arrays_of_another_shape_or_type(member: str, good: JointStream, tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    write_stream(good, path)
    arrays = arrays_of(path)
    right = arrays[member]
    for wrong in (right[:-1], right.astype(np.float32), right.astype(">f8"), right.astype(str), right[0]):
        np.savez(path, **{**arrays, member: wrong})
        items, fault = until_fault(scan_stream(path))
        assert fault.reason.code == "IRL701"
        assert not items


@pytest.mark.parametrize("turn", first(1, range(8)))
def test_damaged_heads_of_arrays_are_refused(good: JointStream, tmp_path: Path, turn: int) -> None:
    """Every byte of a head, which is read long before the checksum of its array; in eight turns every bit."""
    path = tmp_path / "a.npz"
    write_stream(good, path)
    data = path.read_bytes()
    begin = data.index(b"\x93NUMPY", data.index(b"qd.npy"))
    for at in range(begin, begin + 128):
        damaged = bytearray(data)
        damaged[at] ^= 1 << (at + turn) % 8
        path.write_bytes(damaged)
        with pytest.raises(StreamError, match="IRL701"):
            read_stream(path)


def test_lines_give_the_same_one_by_one_and_together(long) -> None:
    rows = RowBatch(long.ticks, long.q, long.block, long.tool).part(slice(0, 500))
    lines = samples_text(17, rows).splitlines(keepends=True)
    together = parse_samples(lines, 17, 7)
    singly = [parse_samples([line], number, 7) for number, line in enumerate(lines, 17)]
    for field in range(4):
        assert together[field].tobytes() == rows[field].tobytes()
        assert b"".join(batch[field].tobytes() for batch in singly) == rows[field].tobytes()


@pytest.mark.parametrize(
    ("row", "old", "new"),
    [
        (900, b" ;\n", b" ; ;\n"),
        (4001, b" ;\n", b" ; ;\n"),
        (900, b", 900, 900, ", b", 901, 900, "),
        (900, b", 900, 900, ", b", 900,  900,"),
        (4001, b", 900, 4001, ", b", 900, 4001,"),
    ],
)
def test_samples_in_another_form(row: int, old: bytes, new: bytes, long, long_file, tmp_path: Path) -> None:
    """Among many lines (row 900) and between two blocks (row 4001) a sample must have the one form."""
    path = tmp_path / "a.irdata"
    long_file(path)
    lines, samples = lines_of(path, b", 900, ")
    at = samples[row]
    assert old in lines[at]
    lines[at] = lines[at].replace(old, new, 1)
    path.write_bytes(b"".join(lines[:-1]))
    items, fault = until_fault(scan_stream(path))
    assert fault.reason.code == "IRL701"
    assert f"record {at + 1}: " in str(fault)
    assert_rows(items, long, row)


@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_memory_does_not_grow_with_the_file(
    ending: str, gantry_kit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in ("scan", "npz_reader", "parquet.reader"):
        monkeypatch.setattr(f"irlx.streams.{module}._PORTION", 1024)
    peaks = []
    for rows in (2_500, 8_500):
        path = tmp_path / f"a{rows}{ending}"
        write_stream(noise(gantry_kit, rows), path)
        tracemalloc.start()
        try:
            seen = sum(len(item.ticks) for item in scan_stream(path) if isinstance(item, RowBatch))
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
        assert seen == rows
    # Rows of q and tool alone take 0.28 and 0.95 MB, as text 1.1 and 3.7 MB.
    assert peaks[1] < peaks[0] + 500_000, peaks
    assert peaks[1] < 16_000_000


@pytest.mark.parametrize("names", [["a"], [], list("abcdefg")], ids=["one", "none", "others"])
def test_joint_names_beside_other_ones_in_the_header(names: list[str], good, tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    write_stream(good, path)
    with np.load(path) as file:
        arrays = {**file, "joint_names": np.array(names, dtype=np.str_)}
    np.savez(path, **arrays)
    with pytest.raises(StreamError) as error:
        read_stream(path)
    assert error.value.reason.code == "IRL701"
    assert "joint_names" in error.value.reason.message
