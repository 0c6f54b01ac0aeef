"""Formats that need an extra: told in one line where it is missing, never imported before they are used."""

import subprocess
import sys
from pathlib import Path

import pytest

from irlx.streams import JointStream, StreamError, open_writer, read_stream, scan_stream, write_stream
from irlx.streams.formats import FORMATS

pytestmark = pytest.mark.req("STR-04")

WITHOUT = {
    ".parquet": ("pyarrow.parquet", "Parquet needs pyarrow: pip install 'irlx[parquet]'"),
    ".rosbag": ("rosbags.typesys", "a ROS 2 bag needs rosbags: pip install 'irlx[ros]'"),
}


@pytest.mark.parametrize("ending", WITHOUT)
def test_a_missing_package_is_told(
    ending: str, good: JointStream, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    module, words = WITHOUT[ending]
    path = tmp_path / f"a{ending}"
    monkeypatch.setitem(sys.modules, module, None)
    for attempt in (
        lambda: write_stream(good, path),
        lambda: open_writer(path, good.header),
        lambda: FORMATS[ending].check(path),
    ):
        with pytest.raises(StreamError) as caught:
            attempt()
        assert str(caught.value) == f"error IRL720: {path}: {words}"
    assert not list(tmp_path.iterdir())


def test_reading_parquet_needs_pyarrow_at_once(
    good: JointStream, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_stream(good, tmp_path / "a.parquet")
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    with pytest.raises(StreamError, match="IRL720"):
        scan_stream(tmp_path / "a.parquet")


def test_reading_bags_needs_nothing(
    good: JointStream, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_stream(good, tmp_path / "a.rosbag")
    for name in [name for name in sys.modules if name.partition(".")[0] == "rosbags"]:
        monkeypatch.setitem(sys.modules, name, None)
    assert read_stream(tmp_path / "a.rosbag").q.tobytes() == good.q.tobytes()


def test_the_other_formats_import_no_extra(tmp_path: Path) -> None:
    code = (
        "import sys, irlx.streams as s\n"
        "try: s.read_stream('a.csv')\n"
        "except s.StreamError: pass\n"
        "print([name for name in ('pyarrow', 'rosbags', 'ruamel') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, check=True)
    assert done.stdout.decode().strip() == "[]"
