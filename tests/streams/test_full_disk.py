"""Disks that are full, for every format: a coded error, nothing left behind, what was there before stays."""

import resource
from contextlib import contextmanager
from pathlib import Path

import pytest

from irlx.streams import KNOWN_ENDINGS, JointStream, StreamError, read_stream, write_stream
from stream_files import content_of, data_file

pytestmark = pytest.mark.req("QA-09")


@contextmanager
def no_file_beyond(size: int):
    """Files of this process may not grow beyond `size` bytes; Python ignores the signal that comes of it."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("share", [0.0, 0.001, 0.5, 0.999])
@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_a_disk_that_is_full_at_some_byte(
    ending: str, share: float, good: JointStream, tmp_path: Path
) -> None:
    path = tmp_path / f"a{ending}"
    write_stream(good, path)
    before = content_of(path)
    size = int(share * data_file(path).stat().st_size)
    with no_file_beyond(size), pytest.raises(StreamError, match=r"IRL003.*file too large"):
        write_stream(good, path)
    with no_file_beyond(size), pytest.raises(StreamError, match="IRL003"):
        write_stream(good, tmp_path / f"new{ending}")
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]
    assert content_of(path) == before
    assert read_stream(path).complete
