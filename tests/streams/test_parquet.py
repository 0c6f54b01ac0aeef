"""Parquet: what pyarrow alone reads, what is refused, how much memory it takes."""

import json
import tracemalloc
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from irlx.streams import (
    JointStream,
    RowBatch,
    StreamError,
    open_writer,
    read_stream,
    scan_stream,
    write_stream,
)
from irlx.streams.header_plain import header_to_plain, record_to_plain
from irlx.streams.parquet import writer as parquet_writer

pytestmark = pytest.mark.req("STR-04")

TOOL = ["tool_x", "tool_y", "tool_z", "tool_qx", "tool_qy", "tool_qz", "tool_qw"]


def bits(column) -> bytes:
    return column.to_numpy().tobytes()


def drawn(kit, rows: int, seed: int = 3) -> JointStream:
    """Random rows, zeros of both signs and denormal numbers among them."""
    rng = np.random.default_rng(seed)
    q = rng.normal(size=(rows, 7)) * 10.0 ** rng.integers(-12, 4, (rows, 7))
    q[rng.integers(rows, size=rows // 5), rng.integers(7, size=rows // 5)] = -0.0
    q[rng.integers(rows, size=rows // 5), rng.integers(7, size=rows // 5)] = 0.0
    q[rng.integers(rows, size=9), rng.integers(7, size=9)] = 5e-324
    ticks, block = np.arange(rows, dtype=np.int64), rng.integers(4, size=rows)
    return JointStream(kit.header(), (), ticks, q, block, rng.normal(size=(rows, 7)), True)


def test_the_table_is_the_stream(good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.parquet")
    table = pq.read_table(tmp_path / "a.parquet")
    names = good.header.joint_names
    joints = [f"{prefix}_{name}" for prefix in ("q", "qd", "qdd") for name in names]
    assert table.column_names == ["tick", "t", "block", *joints, *TOOL]
    whole = {"tick": good.ticks, "t": good.t, "block": good.block}
    whole |= {f"q_{name}": good.q[:, at] for at, name in enumerate(names)}
    whole |= {f"qd_{name}": good.qd[:, at] for at, name in enumerate(names)}
    whole |= {f"qdd_{name}": good.qdd[:, at] for at, name in enumerate(names)}
    whole |= {name: good.tool[:, at] for at, name in enumerate(TOOL)}
    assert list(whole) == table.column_names
    for name, values in whole.items():
        assert table.schema.field(name).type == (pa.int64() if values.dtype == np.int64 else pa.float64())
        assert not table.schema.field(name).nullable
        assert bits(table[name]) == values.tobytes(), name
    told = {key.decode(): json.loads(text) for key, text in table.schema.metadata.items()}
    assert set(told) == {"irlx.header", "irlx.records", "irlx.end"}
    assert told["irlx.header"] == header_to_plain(good.header)
    assert told["irlx.records"] == [record_to_plain(record) for record in good.records]
    assert told["irlx.end"]["samples"] == len(good.ticks)
    assert told["irlx.end"]["complete"] is True


def test_zeros_keep_their_sign(gantry_kit, tmp_path: Path) -> None:
    stream = drawn(gantry_kit, 3000)
    write_stream(stream, tmp_path / "a.parquet")
    table = pq.read_table(tmp_path / "a.parquet")
    for at, name in enumerate(stream.header.joint_names):
        column = table[f"q_{name}"].to_numpy()
        assert column.tobytes() == stream.q[:, at].tobytes()
        assert np.signbit(column[column == 0]).any()


def test_names_that_look_the_same_stay_apart(gantry_kit, tmp_path: Path) -> None:
    names = ("a\t", "a ", "a\n", "ось", "a__", "b", "c")
    header = gantry_kit.header(joint_names=names)
    good = drawn(gantry_kit, 20)
    stream = JointStream(header, (), good.ticks, good.q, good.block, good.tool, True)
    write_stream(stream, tmp_path / "a.parquet")
    table = pq.read_table(tmp_path / "a.parquet")
    assert table.column_names[3:10] == ["q_a ", "q_a _", "q_a __", "q_ось", "q_a__", "q_b", "q_c"]
    assert bits(table["q_a _"]) == stream.q[:, 1].tobytes()
    assert read_stream(tmp_path / "a.parquet").header.joint_names == names


def test_row_groups_do_not_depend_on_batches(gantry_kit, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(parquet_writer, "ROWS_OF_A_GROUP", 100)
    stream = drawn(gantry_kit, 350)
    rng = np.random.default_rng(5)
    for name in ("a", "b"):
        with open_writer(tmp_path / f"{name}.parquet", stream.header) as writer:
            start = 0
            while start < 350:
                part = slice(start, start + int(rng.integers(1, 130)))
                batch = [array[part].copy() for array in (stream.ticks, stream.q, stream.block, stream.tool)]
                writer.samples(*batch)
                # A caller may use its arrays again.
                batch[1][:] = 7.0
                start = part.stop
    assert (tmp_path / "a.parquet").read_bytes() == (tmp_path / "b.parquet").read_bytes()
    groups = pq.ParquetFile(tmp_path / "a.parquet").metadata
    assert [groups.row_group(at).num_rows for at in range(groups.num_row_groups)] == [100, 100, 100, 50]
    assert read_stream(tmp_path / "a.parquet").qdd.tobytes() == stream.qdd.tobytes()
    assert bits(pq.read_table(tmp_path / "a.parquet")["qdd_y"]) == stream.qdd[:, 2].tobytes()


def repacked(path: Path, change=lambda table: table, **options) -> None:
    """The file written anew by pyarrow, its metadata kept."""
    table = pq.read_table(path)
    changed = change(table)
    pq.write_table(changed.replace_schema_metadata(table.schema.metadata), path, **options)


@pytest.mark.parametrize(
    "options", [{"compression": "gzip", "row_group_size": 37}, {"use_dictionary": False}]
)
def test_files_that_were_packed_anew_are_read(options, good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.parquet")
    repacked(tmp_path / "a.parquet", **options)
    found = read_stream(tmp_path / "a.parquet")
    assert found.q.tobytes() == good.q.tobytes()
    assert found.complete


def column_set(name: str, row: int, value):
    def change(table):
        at = table.column_names.index(name)
        values = table[name].to_numpy().copy()
        values[row] = value
        return table.set_column(at, table.schema.field(at), pa.array(values))

    return change


def without_column(table):
    return table.drop_columns(["tool_qw"])


def in_another_order(table):
    return table.select([*table.column_names[1:], "tick"])


def with_small_floats(table):
    at = table.column_names.index("t")
    return table.set_column(at, "t", table["t"].cast(pa.float32()))


def with_a_hole(table):
    values = table["q_y"].to_pylist()
    values[5] = None
    return table.set_column(table.column_names.index("q_y"), "q_y", pa.array(values, pa.float64()))


CHANGES = [
    (column_set("q_y", 40, 0.5), "IRL702", "checksum"),
    (column_set("t", 40, 0.5), "IRL702", "checksum"),
    (column_set("qdd_y", 40, 0.5), "IRL702", "checksum"),
    (column_set("block", 40, 3), "IRL702", "checksum"),
    (column_set("tick", 40, 39), "IRL703", "tick 39 follows tick 39"),
    (column_set("q_y", 40, np.nan), "IRL701", "row of tick 40: .*finite"),
    (column_set("tool_x", 40, np.inf), "IRL701", "row of tick 40: .*finite"),
    (lambda table: table.slice(0, 100), "IRL704", "should hold 297 samples, but 100 are there"),
    (without_column, "IRL701", "columns"),
    (in_another_order, "IRL701", "columns"),
    (with_small_floats, "IRL701", "columns"),
    (with_a_hole, "IRL701", "damaged"),
]


@pytest.mark.parametrize(("change", "code", "words"), CHANGES)
def test_changed_values_are_found(change, code: str, words: str, good: JointStream, tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    write_stream(good, path)
    repacked(path, change)
    with pytest.raises(StreamError, match=words) as caught:
        read_stream(path)
    assert caught.value.reason.code == code


@pytest.mark.parametrize(
    ("key", "old", "new", "code", "words"),
    [
        (b"irlx.header", b'"weld.irl"', b'"wels.irl"', "IRL702", "checksum"),
        (b"irlx.records", b'"tick": 0', b'"tick": 1', "IRL702", "checksum"),
        (b"irlx.end", b"true", b"false", "IRL702", "checksum"),
        (b"irlx.end", b"true", b"1", "IRL701", "irlx.end has samples, complete and sha256"),
        (b"irlx.header", b'"format_version": ', b'"format_version": 9', "IRL706", "version 9"),
        (b"irlx.header", b'"tip"', b'"top"', "IRL701", "metadata: .*top"),
        (b"irlx.records", b"[", b"[[", "IRL701", "damaged"),
        (b"irlx.records", b"[{", b"[" * 100_000 + b"[{", "IRL701", "damaged"),
    ],
)
def test_changed_metadata_are_found(
    key: bytes, old: bytes, new: bytes, code: str, words: str, good: JointStream, tmp_path: Path
) -> None:
    path = tmp_path / "a.parquet"
    write_stream(good, path)
    table = pq.read_table(path)
    texts = dict(table.schema.metadata)
    assert old in texts[key]
    texts[key] = texts[key].replace(old, new, 1)
    pq.write_table(table.replace_schema_metadata(texts), path)
    with pytest.raises(StreamError, match=words) as caught:
        read_stream(path)
    assert caught.value.reason.code == code


def test_files_of_others(tmp_path: Path) -> None:
    pq.write_table(pa.table({"tick": [0, 1]}), tmp_path / "a.parquet")
    with pytest.raises(StreamError, match=r"irlx\.header is missing: irlx did not write this file") as caught:
        read_stream(tmp_path / "a.parquet")
    assert caught.value.reason.code == "IRL701"


def test_rows_before_a_damaged_page_come_out(gantry_kit, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(parquet_writer, "ROWS_OF_A_GROUP", 5000)
    stream, path = drawn(gantry_kit, 20_000), tmp_path / "a.parquet"
    write_stream(stream, path)
    column = pq.ParquetFile(path).metadata.row_group(2).column(4)
    data = bytearray(path.read_bytes())
    data[column.data_page_offset + column.total_compressed_size - 20] ^= 4
    path.write_bytes(data)
    batches = []
    with pytest.raises(StreamError, match="IRL701"):
        batches.extend(item for item in scan_stream(path) if isinstance(item, RowBatch))
    assert [len(batch.ticks) for batch in batches] == [4096, 4096]
    assert b"".join(batch.q.tobytes() for batch in batches) == stream.q[:8192].tobytes()


def test_memory_of_writing_does_not_grow(gantry_kit, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(parquet_writer, "ROWS_OF_A_GROUP", 4000)
    peaks = []
    for portions in (3, 12):
        part = drawn(gantry_kit, 4000)
        before = pa.total_allocated_bytes()
        tracemalloc.start()
        try:
            with open_writer(tmp_path / "a.parquet", part.header) as writer:
                for number in range(portions):
                    writer.samples(part.ticks + 4000 * number, part.q, part.block, part.tool)
                held = pa.total_allocated_bytes() - before
            peaks.append(tracemalloc.get_traced_memory()[1] + held)
        finally:
            tracemalloc.stop()
    # A portion is 1 MB of numbers.
    assert peaks[1] < peaks[0] + 500_000
