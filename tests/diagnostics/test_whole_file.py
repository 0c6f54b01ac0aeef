"""Files as a whole: no more than somebody may have written, and nothing that holds or never ends."""

import os
import socket
import sys
from pathlib import Path

import pytest

from irlx.diagnostics.whole_file import open_file, whole_file, whole_text

pytestmark = pytest.mark.req("QA-08")


def test_a_file_and_its_text(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("żółć", encoding="utf-8")
    assert whole_file(tmp_path / "a") == "żółć".encode()
    assert whole_text(tmp_path / "a") == "żółć"
    (tmp_path / "a").write_bytes(b"\xff")
    with pytest.raises(UnicodeDecodeError):
        whole_text(tmp_path / "a")


def test_more_bytes_than_are_taken(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"x" * 101)
    assert len(whole_file(tmp_path / "a", 101)) == 101
    with pytest.raises(OSError, match="it has more than 100 bytes"):
        whole_file(tmp_path / "a", 100)
    with (tmp_path / "sparse").open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(OSError, match="it has more than 16,000,000 bytes"):
        whole_file(tmp_path / "sparse")


def test_what_is_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    os.mkfifo("fifo")
    Path("zero").symlink_to("/dev/zero")
    for name, words in (
        ("fifo", "FIFO"),
        ("zero", "device"),
        ("/dev/null", "device"),
        (".", "Is a directory"),
    ):
        with pytest.raises(OSError, match=words):
            whole_file(Path(name))
    with socket.socket(socket.AF_UNIX) as bound:
        bound.bind("socket")
        with pytest.raises(OSError, match="No such device"):
            whole_file(Path("socket"))
    Path("circle").symlink_to("circle")
    with pytest.raises(OSError, match="symbolic links"):
        whole_file(Path("circle"))


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_nothing_stays_open(tmp_path: Path) -> None:
    before = os.listdir("/proc/self/fd")
    for name in ("/dev/zero", str(tmp_path)):
        with pytest.raises(OSError, match=r"device|directory"):
            open_file(Path(name))
    assert os.listdir("/proc/self/fd") == before


def test_a_pipe_without_a_name_is_read() -> None:
    into, out = os.pipe()
    os.write(out, b"PROGRAM p;")
    os.close(out)
    assert whole_file(Path(f"/dev/fd/{into}")) == b"PROGRAM p;"
    os.close(into)
