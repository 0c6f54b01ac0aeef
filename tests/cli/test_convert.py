"""`irlx convert` and `irlx.convert`: other formats without loss, programs, refusals, how little memory."""

import os
import re
import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import irlx
from arm_streams import arm_stream, there_and_back
from controller_programs import read_krl, read_rapid, read_robodk, read_urscript
from gantry import good
from irlx.blocks import InputBlock, Port, SignalBlock, SignalKind, WaitBlock
from irlx.cli.convert import _TARGETS
from irlx.cli.main import main
from irlx.diagnostics.codes.stream import STREAM
from irlx.exporters import TARGETS
from irlx.streams import (
    BlockRecord,
    JointStream,
    RowBatch,
    StreamEnd,
    StreamError,
    read_stream,
    scan_of,
    write_stream,
)
from irlx.streams.header_plain import header_to_plain
from irlx.streams.scan import in_file_order

__all__ = ["good"]

PAGES = Path(__file__).parents[2] / "docs" / "diagnostics"
OWN = (".irdata", ".npz", ".jsonl")


def cut(path: Path) -> None:
    """Cut a text file in the middle of a line in its last third."""
    data = path.read_bytes()
    path.write_bytes(data[: len(data) - len(data) // 3])


@pytest.mark.req("STR-04")
@pytest.mark.req("STR-03")
@pytest.mark.parametrize("chain", [(".npz", ".jsonl"), (".jsonl", ".npz"), (".jsonl",), (".npz",)])
@pytest.mark.parametrize(("version", "complete"), [(1, True), (2, True), (2, False)])
def test_round_trips_give_the_same_bytes(
    chain: tuple[str, ...], version: int, complete: bool, good: JointStream, tmp_path: Path
) -> None:
    header = replace(good.header, format_version=version)
    stream = replace(good, header=header, complete=complete)
    first = tmp_path / "first.irdata"
    write_stream(stream, first)
    path = first
    for number, ending in enumerate((*chain, ".irdata")):
        out = tmp_path / f"{number}{ending}"
        assert irlx.convert(path, out) == ()
        path = out
    assert path.read_bytes() == first.read_bytes()


@pytest.mark.parametrize("source", OWN)
@pytest.mark.parametrize("ending", [*OWN, ".csv"])
def test_a_converted_file_is_the_one_that_is_written(
    source: str, ending: str, good: JointStream, tmp_path: Path
) -> None:
    write_stream(good, tmp_path / f"a{source}")
    irlx.convert(tmp_path / f"a{source}", tmp_path / f"b{ending}")
    write_stream(good, tmp_path / f"c{ending}")
    assert (tmp_path / f"b{ending}").read_bytes() == (tmp_path / f"c{ending}").read_bytes()


def test_a_stream_in_memory_and_a_run(folder, tmp_path: Path) -> None:
    run = irlx.run(folder / "p.irl")
    irlx.convert(run, tmp_path / "a.jsonl")
    irlx.convert(run.stream, [tmp_path / "b.jsonl", tmp_path / "b.src"])
    run.save(tmp_path / "c.jsonl")
    assert (tmp_path / "a.jsonl").read_bytes() == (tmp_path / "c.jsonl").read_bytes()
    assert (tmp_path / "b.jsonl").read_bytes() == (tmp_path / "c.jsonl").read_bytes()
    assert read_krl((tmp_path / "b.src").read_bytes()).axes[-1] == "E5"


@pytest.mark.parametrize("seed", range(8))
def test_records_wait_for_the_row_of_their_tick(seed: int, gantry_records) -> None:
    print("seed", seed)
    rng = np.random.default_rng(seed)
    stream = gantry_records(rng)
    items = list(in_file_order(scan_of(stream)))
    assert header_to_plain(items[0]) == header_to_plain(stream.header)
    assert items[-1] == StreamEnd(True)
    assert [item for item in items if isinstance(item, BlockRecord)] == list(stream.records)
    last, given = -1, 0
    for item in items[1:-1]:
        if isinstance(item, RowBatch):
            assert len(item.ticks)
            assert item.ticks.tolist() == stream.ticks[given : given + len(item.ticks)].tolist()
            last, given = int(item.ticks[-1]), given + len(item.ticks)
        else:
            behind = stream.ticks[stream.ticks <= item.tick]
            assert last == (behind[-1] if len(behind) else -1)
    assert given == len(stream.ticks)
    # What is in order stays as it is.
    again = list(in_file_order(iter(items)))
    assert [type(item) for item in again] == [type(item) for item in items]


@pytest.fixture
def gantry_records():
    """Streams with rows at some ticks and records at any, several at some, behind the last row as well."""

    def make(rng: np.random.Generator) -> JointStream:
        rows = int(rng.integers(0, 9))
        ticks = np.sort(rng.choice(20, rows, replace=False))
        stream = arm_stream("rr", 2.0, rng.normal(size=(rows, 2)), ticks=ticks)
        (record,) = stream.records
        places = np.sort(rng.integers(0, 22, int(rng.integers(0, 8)))).tolist()
        records = (BlockRecord(tick, replace(record.block, id=k)) for k, tick in enumerate(places, 1))
        return replace(stream, records=tuple(records))

    return make


@pytest.mark.parametrize("source", [".irdata", ".jsonl", ".csv"])
@pytest.mark.parametrize("ending", OWN)
def test_cut_files_stay_incomplete(source: str, ending: str, tmp_path: Path) -> None:
    write_stream(arm_stream(), tmp_path / f"a{source}")
    cut(tmp_path / f"a{source}")
    part = read_stream(tmp_path / f"a{source}")
    assert not part.complete
    assert 0 < len(part.ticks) < 88
    irlx.convert(tmp_path / f"a{source}", tmp_path / f"b{ending}")
    converted = read_stream(tmp_path / f"b{ending}")
    assert not converted.complete
    assert converted.q.tobytes() == part.q.tobytes()
    assert converted.records == part.records


def test_a_cut_file_is_no_program(tmp_path: Path) -> None:
    rows = np.vstack([there_and_back(6), np.tile(there_and_back(6)[-1], (200, 1))])
    write_stream(arm_stream(q=rows), tmp_path / "a.irdata")
    cut(tmp_path / "a.irdata")
    before = sorted(tmp_path.iterdir())
    with pytest.raises(StreamError, match="IRL716"):
        irlx.convert(tmp_path / "a.irdata", [tmp_path / "b.npz", tmp_path / "b.script"])
    # Not even the format that could hold it: one call, one answer.
    assert sorted(tmp_path.iterdir()) == before
    irlx.convert(tmp_path / "a.irdata", tmp_path / "b.script", incomplete=True)
    assert "not complete" in read_urscript((tmp_path / "b.script").read_bytes()).comments[-1]


def test_damage_leaves_nothing(tmp_path: Path) -> None:
    path = tmp_path / "a.irdata"
    write_stream(arm_stream(), path)
    lines = path.read_bytes().split(b"\n")
    lines[40] = lines[40].replace(b"900", b"901")
    path.write_bytes(b"\n".join(lines))
    with pytest.raises(StreamError, match="IRL701"):
        irlx.convert(path, [tmp_path / "b.npz", tmp_path / "b.script"])
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("ending", [".csv", ".npz", ".script"])
def test_an_output_is_never_the_input(ending: str, tmp_path: Path) -> None:
    path = tmp_path / "a.irdata"
    write_stream(arm_stream(), path)
    data = path.read_bytes()
    link, hard = tmp_path / f"link{ending}", tmp_path / f"hard{ending}"
    link.symlink_to(path)
    os.link(path, hard)
    for out in (link, hard, path):
        with pytest.raises(StreamError, match="IRL005"):
            irlx.convert(path, [tmp_path / "b.npz", out])
    assert path.read_bytes() == data
    assert not (tmp_path / "b.npz").exists()


@pytest.mark.parametrize(
    ("out", "target", "found"),
    [
        ("b.txt", None, "IRL004: -o b.txt: no format has the ending '.txt'; known: .irdata, "),
        ("b", None, ".script, .src, .mod"),
        ("b.csv", "krl", "IRL006: --to krl: b.csv has the ending of another format; name it b.src"),
        ("b.mod", "robodk", "name it b.csv"),
        ("b.npz", "urscript", "name it b.script"),
        ("b.SCRIPT", "rapid", "name it b.mod"),
        ("b.src", "fanuc", "IRL006: --to fanuc: no such target; known: urscript, krl, rapid, robodk"),
    ],
)
def test_endings(out: str, target: str | None, found: str, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(StreamError, match=re.escape(found)):
        irlx.convert(arm_stream("rrrrrr", 10.0), out, target)
    assert not list(tmp_path.iterdir())


def test_capitals_and_other_endings(tmp_path: Path) -> None:
    stream = arm_stream("rrrrrr", 10.0)
    irlx.convert(stream, [tmp_path / "A.SRC", tmp_path / "B.Npz"])
    irlx.convert(stream, [tmp_path / "weld.prg", tmp_path / "weld"], "rapid")
    assert read_krl((tmp_path / "A.SRC").read_bytes()).name == "A"
    assert (tmp_path / "weld").read_bytes() == (tmp_path / "weld.prg").read_bytes()
    assert read_rapid((tmp_path / "weld").read_bytes()).name == "weld"


def test_sources_that_cannot_be_read(tmp_path: Path) -> None:
    for name, code in (("a.txt", "IRL707"), ("missing.npz", "IRL001"), (".", "IRL707")):
        with pytest.raises(StreamError, match=code):
            irlx.convert(tmp_path / name, tmp_path / "b.npz")
    assert not list(tmp_path.iterdir())


def test_csv_says_what_it_lacks(good: JointStream, tmp_path: Path) -> None:
    (note,) = irlx.convert(good, [tmp_path / "a.npz", tmp_path / "a.csv"])
    assert (note.code, note.severity.value) == ("IRL719", "info")
    assert str(note.place) == str(tmp_path / "a.csv")
    assert note.message == f"CSV: blocks are left out, {len(good.records)} in this stream"
    # Nothing is lost where nothing was.
    assert irlx.convert(tmp_path / "a.csv", tmp_path / "b.csv") == ()


def test_what_comes_of_a_csv_says_that_it_has_no_blocks(good: JointStream, tmp_path: Path) -> None:
    """Its rows name blocks that are nowhere; a stream whose rows name none lacks nothing."""
    irlx.convert(good, tmp_path / "a.csv")
    (note,) = irlx.convert(tmp_path / "a.csv", [tmp_path / "b.csv", tmp_path / "b.jsonl"])
    assert (note.code, str(note.place)) == ("IRL729", str(tmp_path / "b.jsonl"))
    assert note.message.startswith("JSON Lines: the stream that it was made from has no blocks")
    assert ".npz" in note.help
    assert ".csv" not in note.help
    assert not irlx.verify(tmp_path / "b.jsonl").passed
    nameless = replace(good, block=np.zeros_like(good.block), records=())
    assert irlx.convert(nameless, tmp_path / "c.npz") == ()


def test_programs_say_that_signals_are_left_out(tmp_path: Path) -> None:
    stream = arm_stream("rrrrrr", 10.0)
    origin = stream.records[0].block.origin
    port = Port("OUT_1", SignalKind.BOOL)
    blocks = (
        SignalBlock(id=1, origin=origin, port=port, value=1.0),
        WaitBlock(id=2, origin=origin, duration=0.01),
        WaitBlock(id=3, origin=origin, duration=0.01, condition="IN_1"),
        InputBlock(id=4, origin=origin, port=port, value=0.0),
    )
    stream = replace(stream, records=tuple(BlockRecord(40, block) for block in blocks))
    notes = irlx.convert(stream, [tmp_path / "a.src", tmp_path / "a.jsonl", tmp_path / "a.mod"])
    assert [(note.code, Path(str(note.place)).name) for note in notes] == [
        ("IRL719", "a.src"),
        ("IRL719", "a.mod"),
    ]
    words = "outputs, inputs and conditions of waits are left out, 3 in this stream"
    assert [note.message for note in notes] == [f"KRL: {words}", f"RAPID: {words}"]


@pytest.fixture
def weld(tmp_path: Path, monkeypatch) -> Path:
    """A folder to work in with weld.irdata: six turning joints, 10 ms."""
    monkeypatch.chdir(tmp_path)
    write_stream(arm_stream("rrrrrr", 10.0), tmp_path / "weld.irdata")
    return tmp_path


def test_the_command(weld: Path, capsys) -> None:
    outputs = ["weld.npz", "weld.src", "weld.mod"]
    assert main(["convert", "weld.irdata", *(word for out in outputs for word in ("-o", out))]) == 0
    out, err = capsys.readouterr()
    assert out.splitlines() == [f"written     {name}" for name in outputs]
    assert err == ""
    assert main(["convert", "weld.npz", "-o", "weld.csv", "--to", "robodk"]) == 0
    assert len(read_robodk((weld / "weld.csv").read_bytes()).points) == 89
    assert main(["verify", "weld.npz"]) in (0, 1)


def test_the_command_notes_on_stderr_in_one_line(weld: Path, capsys) -> None:
    assert main(["convert", "weld.irdata", "-o", "weld.csv"]) == 0
    out, err = capsys.readouterr()
    assert out == "written     weld.csv\n"
    assert len([line for line in err.splitlines() if not line.startswith("  help: ")]) == 1


def test_usage(weld: Path, capsys) -> None:
    for words in (["weld.irdata"], ["-o", "a.npz"]):
        with pytest.raises(SystemExit) as caught:
            main(["convert", *words])
        assert caught.value.code == 2
    assert main(["convert", "weld.irdata", "-o", "a.csv", "--to", "fanuc"]) == 2
    assert "IRL006: --to fanuc: not one of urscript, krl, rapid, robodk" in capsys.readouterr().err
    for words, code in ((["weld.txt", "-o", "a.npz"], 2), (["weld.irdata", "-o", "a.script"], 1)):
        assert main(["convert", *words]) == code
    assert [path.name for path in weld.iterdir()] == ["weld.irdata"]


def test_help_shows_an_example_and_every_target(capsys) -> None:
    assert tuple(TARGETS) == _TARGETS
    with pytest.raises(SystemExit) as caught:
        main(["convert", "--help"])
    assert caught.value.code == 0
    shown = " ".join(capsys.readouterr().out.split())
    for words in (
        "examples:",
        "irlx convert programs/koch/square.irdata -o square.src",
        *_TARGETS,
        *OWN,
        ".csv",
        ".mod",
    ):
        assert words in shown


MADE = {
    "IRL710": lambda: arm_stream("rrrrrrr"),
    "IRL711": lambda: arm_stream("mrrrrrr"),
    "IRL712": lambda: arm_stream("rrrrrr", 10.0),
    "IRL713": lambda: arm_stream(q=np.zeros((4, 6)), ticks=[0, 1, 2, 7]),
    "IRL714": lambda: arm_stream(q=np.where(np.arange(30).reshape(5, 6) == 19, np.nan, 0.0)),
    "IRL715": lambda: arm_stream(q=there_and_back(6)[:21], complete=False),
    "IRL716": lambda: arm_stream(complete=False),
    "IRL717": lambda: arm_stream(q=np.zeros((0, 6)), complete=False),
    "IRL718": arm_stream,
    "IRL719": arm_stream,
}
"""What the example of each page converts."""


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize("code", [code.id for code in STREAM if "IRL709" < code.id < "IRL720"])
def test_the_pages_are_true(code: str, tmp_path: Path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    page = (PAGES / f"{code}.md").read_text(encoding="utf-8")
    assert "## What helps\n" in page
    shown = re.search(r"```console\n\$ irlx (.*)\n(.*)\n```", page)
    words = shown[1].split()
    stream = MADE[code]()
    if words[1].endswith(".npz"):
        # No writer of irlx takes such values.
        write_stream(replace(stream, q=np.nan_to_num(stream.q)), words[1])
        with np.load(words[1]) as file:
            arrays = {**file, "q": stream.q}
        np.savez(words[1], **arrays)
    else:
        write_stream(stream, words[1])
    is_note = ": info " in shown[2]
    assert main(words) == (0 if is_note else 1)
    assert capsys.readouterr().err.splitlines()[0] == shown[2]
    assert len(list(tmp_path.iterdir())) == (2 if is_note else 1)


@pytest.mark.req("STR-05")
@pytest.mark.parametrize("ending", [".script", ".mod", ".src", ".csv", ".jsonl", ".irdata"])
def test_memory_does_not_grow_with_the_stream(ending: str, tmp_path: Path) -> None:
    peaks = []
    target = "robodk" if ending == ".csv" else None
    for rows in (9_000, 14_000):
        q = np.zeros((rows, 6))
        q[:, 2] = np.sin(np.arange(rows) / 100)
        q[-1] = q[-2]
        write_stream(arm_stream("rrrrrr", 2.0 if ending == ".script" else 10.0, q), tmp_path / "a.npz")
        del q
        tracemalloc.start()
        try:
            irlx.convert(tmp_path / "a.npz", tmp_path / f"b{ending}", target)
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
        assert (tmp_path / f"b{ending}").stat().st_size > 60 * rows
    # 5,000 rows of q and tool alone take 0.5 MB, as text up to 1.3 MB.
    assert peaks[1] < peaks[0] + 200_000
