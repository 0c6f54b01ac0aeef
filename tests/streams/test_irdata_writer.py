"""The streaming writer: batches, refusals, what it leaves behind."""

from pathlib import Path

import numpy as np
import pytest

from irlx.streams import BlockRecord, IrdataWriter, JointStream, StreamError, read_irdata, write_stream


def rows(stream: JointStream, start: int, stop: int) -> tuple[np.ndarray, ...]:
    return tuple(getattr(stream, name)[start:stop] for name in ("ticks", "q", "block", "tool"))


@pytest.mark.req("STR-05")
def test_batches_of_any_size_give_the_same_bytes(good: JointStream, tmp_path: Path) -> None:
    whole = JointStream(good.header, (), good.ticks, good.q, good.block, good.tool, True)
    write_stream(whole, tmp_path / "whole.irdata")
    with IrdataWriter(tmp_path / "parts.irdata", good.header) as writer:
        for start in range(0, len(good.ticks), 13):
            writer.samples(*rows(good, start, start + 13))
        writer.samples(*rows(good, 0, 0))
    assert (tmp_path / "parts.irdata").read_bytes() == (tmp_path / "whole.irdata").read_bytes()


@pytest.mark.req("STR-05")
def test_nothing_appears_before_close(good: JointStream, tmp_path: Path) -> None:
    path = tmp_path / "a.irdata"
    writer = IrdataWriter(path, good.header)
    writer.samples(*rows(good, 0, 5))
    assert not path.exists()
    writer.close(complete=False)
    writer.close()
    assert [p.name for p in tmp_path.iterdir()] == ["a.irdata"]
    assert not read_irdata(path).complete


def interrupted(stream: JointStream, path: Path, keep: bool) -> None:
    with IrdataWriter(path, stream.header) as writer:
        writer.samples(*rows(stream, 0, 5))
        if keep:
            writer.close(complete=False)
        raise KeyboardInterrupt


def test_an_exception_removes_the_file(good: JointStream, tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        interrupted(good, tmp_path / "a.irdata", keep=False)
    assert not list(tmp_path.iterdir())


def test_a_partial_stream_survives_an_interruption(good: JointStream, tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        interrupted(good, tmp_path / "a.irdata", keep=True)
    assert len(read_irdata(tmp_path / "a.irdata").ticks) == 5


def refused(stream: JointStream, path: Path, batch: tuple[np.ndarray, ...]) -> str:
    writer = IrdataWriter(path, stream.header)
    writer.samples(*rows(stream, 0, 3))
    with pytest.raises(StreamError, match="IRL708") as caught:
        writer.samples(*batch)
    assert not list(path.parent.iterdir())
    return str(caught.value)


def test_refusals(good: JointStream, tmp_path: Path) -> None:
    path = tmp_path / "a.irdata"
    ticks, q, block, tool = rows(good, 3, 6)
    bad = q.copy()
    bad[1, 2] = np.nan
    assert "tick 4 is not finite" in refused(good, path, (ticks, bad, block, tool))
    assert "do not rise from 2" in refused(good, path, (ticks - 1, q, block, tool))
    assert "do not rise" in refused(good, path, (ticks[[0, 2, 1]], q, block, tool))
    assert "(3, 6)" in refused(good, path, (ticks, q[:, :6], block, tool))


def test_block_ticks_never_fall(good: JointStream, tmp_path: Path) -> None:
    block = good.records[0].block
    writer = IrdataWriter(tmp_path / "a", good.header)
    writer.block(BlockRecord(5, block))
    with pytest.raises(StreamError, match="IRL708"):
        writer.block(BlockRecord(4, block))
