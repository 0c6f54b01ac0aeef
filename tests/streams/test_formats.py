"""Round trips of every format, provenance, atomic writing, failures of the file system."""

import json
import os
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from irlx.streams import KNOWN_ENDINGS, JointStream, StreamError, atomic, read_stream, write_stream
from irlx.streams.atomic import AtomicFile, check_writable
from irlx.streams.header_plain import header_to_plain
from stream_files import FOLDERS, content_of

WITH_BLOCKS = tuple(ending for ending in KNOWN_ENDINGS if ending != ".csv")


def awkward(kit) -> JointStream:
    """Few rows full of values and names that formats trip over."""
    values = [1e-320, -0.0, 0.1 + 0.2, 5e-324, 1.7976931348623157e308, -1e22, 1 / 3]
    q = np.array([values, values[::-1], np.nextafter(values, 0)])
    tool = np.array([[0.0, -0.0, 1e-17, 0.0, 0.0, 0.0, 1.0]] * 3)
    names = ("ściana", 'q"uo;te', "new\nline", "back\\slash", "comma, a", "tab\t#", "юг\u2028\x00 ;")
    header = kit.header(
        joint_names=names,
        program_name="odd \udc80 ;\n1, 999.irl",
        cell_name="",
        robot_model='C:\\r"\r\n',
    )
    ticks = np.array([0, 1, 5], dtype=np.int64)
    return JointStream(header, (), ticks, q, np.array([0, 0, 0], dtype=np.int64), tool, True)


def assert_same(first: JointStream, second: JointStream, blocks: bool) -> None:
    assert header_to_plain(first.header) == header_to_plain(second.header)
    for name in ("ticks", "q", "block", "tool", "qd", "qdd", "t"):
        one, other = getattr(first, name), getattr(second, name)
        assert one.dtype == other.dtype
        assert one.tobytes() == other.tobytes(), name
    assert first.complete == second.complete
    assert second.records == (first.records if blocks else ())


@pytest.mark.req("STR-01")
@pytest.mark.req("STR-03")
@pytest.mark.req("STR-04")
@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_round_trip(ending: str, good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / f"a{ending}")
    assert_same(good, read_stream(tmp_path / f"a{ending}"), ending in WITH_BLOCKS)


@pytest.mark.filterwarnings("ignore:overflow encountered:RuntimeWarning")
@pytest.mark.filterwarnings("ignore:invalid value encountered:RuntimeWarning")
@pytest.mark.parametrize("ending", [".irdata", ".npz", ".parquet"])
def test_awkward_values_and_names(ending: str, gantry_kit, tmp_path: Path) -> None:
    stream = awkward(gantry_kit)
    write_stream(stream, tmp_path / f"a{ending}")
    assert_same(stream, read_stream(tmp_path / f"a{ending}"), True)


@pytest.mark.filterwarnings("ignore:overflow encountered:RuntimeWarning")
@pytest.mark.filterwarnings("ignore:invalid value encountered:RuntimeWarning")
@pytest.mark.parametrize("ending", [".csv", ".jsonl", ".rosbag"])
def test_awkward_names_where_rates_are_stated(ending: str, gantry_kit, tmp_path: Path) -> None:
    odd = awkward(gantry_kit)
    q = np.where(np.abs(odd.q) > 1e20, 1e-320, odd.q)
    stream = JointStream(odd.header, (), odd.ticks, q, odd.block, odd.tool, False)
    write_stream(stream, tmp_path / f"a{ending}")
    assert_same(stream, read_stream(tmp_path / f"a{ending}"), False)
    with pytest.raises(StreamError, match=r"IRL708.*rates"):
        write_stream(odd, tmp_path / f"b{ending}")
    assert not (tmp_path / f"b{ending}").exists()


@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_incomplete_and_empty_streams(ending: str, good: JointStream, tmp_path: Path) -> None:
    for rows in (0, 1, 7):
        part = JointStream(
            good.header, (), good.ticks[:rows], good.q[:rows], good.block[:rows], good.tool[:rows], False
        )
        write_stream(part, tmp_path / f"a{ending}")
        assert_same(part, read_stream(tmp_path / f"a{ending}"), True)


@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_same_stream_same_bytes(ending: str, good: JointStream, tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_stream(good, tmp_path / f"{name}{ending}")
    assert content_of(tmp_path / f"a{ending}") == content_of(tmp_path / f"b{ending}")


@pytest.mark.req("STR-04")
def test_npz_keys_and_meta(good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz", allow_pickle=False) as file:
        assert set(file) == {"t", "q", "qd", "qdd", "tool", "block", "joint_names", "meta"}
        assert file["joint_names"].tolist() == list(good.header.joint_names)
        assert np.array_equal(file["qdd"], good.qdd)
        meta = json.loads(str(file["meta"]))
    assert meta["ticks"] == [[0, len(good.ticks)]]
    assert meta["complete"] is True
    assert meta["header"]["limits"]["speed_upper"][0] == "inf"


def test_csv_is_plain_to_others(good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / "a.csv")
    table = np.genfromtxt(tmp_path / "a.csv", delimiter=",", comments="#", skip_header=14, encoding="utf-8")
    assert np.array_equal(table[1:, 3:10], good.q)
    lines = (tmp_path / "a.csv").read_text().splitlines()
    assert lines[13].startswith("# weights") or lines[14].startswith("tick,t,block,q_rail,q_ось_x")


@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
@pytest.mark.parametrize(
    ("where", "code"), [("missing/a", "IRL003"), ("folder", "IRL003"), ("nul\0", "IRL003")]
)
def test_unwritable(ending: str, where: str, code: str, good: JointStream, tmp_path: Path) -> None:
    (tmp_path / f"folder{ending}").mkdir()
    with pytest.raises(StreamError) as caught:
        write_stream(good, tmp_path / f"{where}{ending}")
    assert caught.value.reason.code == code
    assert [path.name for path in tmp_path.iterdir()] == [f"folder{ending}"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root writes everywhere")
@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_read_only_folder(ending: str, good: JointStream, tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(StreamError) as caught:
            write_stream(good, tmp_path / f"a{ending}")
    finally:
        tmp_path.chmod(0o700)
    assert caught.value.reason.code == "IRL003"


@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_full_disk_leaves_nothing(
    ending: str, good: JointStream, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if ending in FOLDERS:
        write_stream(good, tmp_path / f"a{ending}")
    else:
        (tmp_path / f"a{ending}").write_text("before")
    before = content_of(tmp_path / f"a{ending}")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(StreamError) as caught:
        write_stream(good, tmp_path / f"a{ending}")
    assert "no space left" in str(caught.value)
    assert [content_of(path) for path in tmp_path.iterdir()] == [before]


@pytest.mark.req("STR-05")
@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_content_is_stored_before_it_has_its_name_and_the_name_after(
    ending: str, good: JointStream, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So that after a loss of power a file under its name is whole."""
    path = tmp_path / f"a{ending}"
    stored: list[tuple[int, bool]] = []

    def store(descriptor: int) -> None:
        stored.append((os.fstat(descriptor).st_ino, path.exists()))

    monkeypatch.setattr(os, "fsync", store)
    write_stream(good, path)
    made = [path, *path.iterdir()] if ending in FOLDERS else [path]
    before = {number for number, named in stored if not named}
    assert before >= {file.stat().st_ino for file in made}
    assert stored[-1] == (tmp_path.stat().st_ino, True)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_failing_write_is_coded(tmp_path: Path) -> None:
    file = AtomicFile(tmp_path / "a")
    file.handle.close()
    file.handle = open("/dev/full", "wb")  # noqa: SIM115
    with pytest.raises(StreamError, match="IRL003"):
        file.write(b"x" * 100_000)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_unreadable(ending: str, good: JointStream, tmp_path: Path) -> None:
    write_stream(good, tmp_path / f"weld{ending}")
    (tmp_path / f"folder{ending}").mkdir()
    of_folder = "IRL701" if ending in FOLDERS else "IRL007"
    for name, code in (
        (f"wled{ending}", "IRL001"),
        (f"folder{ending}", of_folder),
        (f"\0{ending}", "IRL002"),
    ):
        with pytest.raises(StreamError) as caught:
            read_stream(tmp_path / name)
        assert caught.value.reason.code == code
        if code == "IRL001":
            assert f"did you mean 'weld{ending}'?" in str(caught.value)


def test_unknown_endings(good: JointStream, tmp_path: Path) -> None:
    with pytest.raises(StreamError, match="IRL004"):
        write_stream(good, tmp_path / "a.txt")
    with pytest.raises(StreamError, match="IRL707"):
        read_stream(tmp_path / "a")
    write_stream(good, tmp_path / "A.NPZ")
    assert read_stream(tmp_path / "A.NPZ").complete


def test_a_link_is_followed(good: JointStream, tmp_path: Path) -> None:
    (tmp_path / "real.csv").write_text("x")
    (tmp_path / "link.csv").symlink_to(tmp_path / "real.csv")
    write_stream(good, tmp_path / "link.csv")
    assert (tmp_path / "link.csv").is_symlink()
    assert read_stream(tmp_path / "real.csv").complete


def test_whether_a_path_is_writable_is_known_beforehand(tmp_path: Path) -> None:
    check_writable(tmp_path / "a.irdata")
    assert not list(tmp_path.iterdir())
    with pytest.raises(StreamError, match="IRL003"):
        check_writable(tmp_path / "missing" / "a.irdata")


@pytest.mark.req("QA-09")
@pytest.mark.parametrize("ending", [".csv", ".npz", ".rosbag"])
def test_what_a_killed_process_of_this_number_has_left_is_in_nobodys_way(
    ending: str, good: JointStream, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In a container most processes have the same few numbers."""
    monkeypatch.setattr(atomic, "_NUMBERS", count(1))
    left = tmp_path / f".irlx-{os.getpid()}-1.part{ending}"
    left.write_text("left")
    write_stream(good, tmp_path / f"a{ending}")
    assert read_stream(tmp_path / f"a{ending}").complete
    assert sorted(entry.name for entry in tmp_path.iterdir()) == [left.name, f"a{ending}"]
    assert left.read_text() == "left"
