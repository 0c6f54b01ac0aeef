"""Runs that go to files while they go on: the same bytes as from memory, and nothing lost where one fails."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.report import file_recording
from irlx.report.figures import Figures
from irlx.streams import KNOWN_ENDINGS, StreamWriter, read_stream
from irlx.streams.error import cannot_write
from irlx.streams.npz_writer import NpzWriter

pytestmark = pytest.mark.req("STR-05")

CELL = '[robot]\nmodel = "planar3"\n[motion]\ntick_ms = 20\n'
TEXT = """PROGRAM p;
VAR OUTPUT BOOL: gripper AT 1;
  MAIN_JOINT_SPEED_MIN: slow := (-60., -60., -60.);
  MAIN_JOINT_SPEED_MAX: fast := (60., 60., 60.);
BEGIN
  MOVE PTP MAIN_JOINT(30, 60, -40);
  CYCLICSTART;
  JOINTSPEEDLIMIT slow, fast;
  MOVE_INC LIN POSITION(60, 40, 0) C_CP := 10;
  gripper := TRUE;
  MOVE_INC LIN POSITION(0, -80, 0);
  WAIT 0.05 SEC;
  MOVE_INC LIN POSITION(-60, 40, 0);
  CYCLICEND;
ENDPROGRAM;
"""


@pytest.fixture
def program(tmp_path: Path) -> Path:
    (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
    path = tmp_path / "p.irl"
    path.write_text(TEXT, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> irlx.Run:
    """The run of the program in memory."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "p.toml").write_text(CELL, encoding="utf-8")
    (folder / "p.irl").write_text(TEXT, encoding="utf-8")
    return irlx.run(folder / "p.irl")


def visible(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def test_files_are_those_of_a_run_in_memory(program: Path, whole: irlx.Run, tmp_path: Path) -> None:
    outputs = [tmp_path / f"out{ending}" for ending in KNOWN_ENDINGS]
    outcome = irlx.record(program, outputs)
    assert outcome.files == tuple(outputs)
    assert outcome.summary == whole.summary
    assert outcome.events == whole.events
    assert outcome.complete
    assert outcome.joint_names == whole.joint_names
    for path in outputs:
        other = tmp_path / f"memory{path.suffix}"
        whole.save(other)
        one, two = (read_stream(found) for found in (path, other))
        assert np.array_equal(one.q, two.q)
        if path.is_file():
            assert path.read_bytes() == other.read_bytes()
    assert irlx.verify(outputs[0], program).passed


def test_a_run_that_ends_in_an_error_leaves_partial_files(
    program: Path, whole: irlx.Run, tmp_path: Path
) -> None:
    text = TEXT.replace("CYCLICEND;", "MOVE LIN POSITION(900, 700, 0);")
    program.write_text(text, encoding="utf-8")
    with pytest.raises(irlx.RunError) as caught:
        irlx.record(program, [tmp_path / "a.irdata", tmp_path / "a.csv"])
    assert caught.value.run.files == (tmp_path / "a.partial.irdata", tmp_path / "a.partial.csv")
    assert visible(tmp_path) == ["a.partial.csv", "a.partial.irdata", "p.irl", "p.toml"]
    stream = read_stream(tmp_path / "a.partial.irdata")
    assert not stream.complete
    assert not caught.value.run.complete
    assert np.array_equal(stream.q, whole.q)


def test_a_run_in_which_nothing_moved_leaves_no_file(program: Path, tmp_path: Path) -> None:
    text = "PROGRAM p;\nBEGIN\n  MOVE LIN POSITION(900, 700, 0);\nENDPROGRAM;\n"
    program.write_text(text, encoding="utf-8")
    with pytest.raises(irlx.RunError) as caught:
        irlx.record(program, tmp_path / "a.irdata")
    assert caught.value.run.files == ()
    assert visible(tmp_path) == ["p.irl", "p.toml"]


@pytest.mark.req("QA-08")
def test_a_disk_that_is_full_for_one_file_costs_no_other(
    program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    samples, full = StreamWriter.samples, []

    def fail(writer: StreamWriter, ticks: np.ndarray, *rest: np.ndarray) -> None:
        if writer.path.suffix == ".csv" and ticks[0] > 30:
            full.append(int(ticks[0]))
            writer.abort()
            raise cannot_write(writer.path, OSError(28, "No space left on device"))
        samples(writer, ticks, *rest)

    monkeypatch.setattr(StreamWriter, "samples", fail)
    with pytest.raises(irlx.RunError, match="IRL003") as caught:
        irlx.record(program, [tmp_path / "a.irdata", tmp_path / "a.csv"])
    assert visible(tmp_path) == ["a.partial.irdata", "p.irl", "p.toml"]
    assert caught.value.run.files == (tmp_path / "a.partial.irdata",)
    assert read_stream(tmp_path / "a.partial.irdata").ticks[-1] + 1 >= full[0]


def test_output_that_cannot_be_written_leaves_nothing(program: Path, tmp_path: Path) -> None:
    with pytest.raises(irlx.StreamError, match="IRL003"):
        irlx.record(program, [tmp_path / "a.irdata", tmp_path / "missing" / "a.csv"])
    with pytest.raises(irlx.StreamError, match="IRL004"):
        irlx.record(program, [tmp_path / "a.irdata", tmp_path / "a.foo"])
    assert visible(tmp_path) == ["p.irl", "p.toml"]


def test_an_input_is_no_output(program: Path, tmp_path: Path) -> None:
    inputs, stream = tmp_path / "in.csv", tmp_path / "a.irdata"
    inputs.write_text("time,input,value\n", encoding="utf-8")
    with pytest.raises(irlx.StreamError, match=r"IRL005: outputs= .*in.csv would overwrite an input"):
        irlx.record(program, [stream, inputs], inputs=inputs)
    assert inputs.read_text(encoding="utf-8") == "time,input,value\n"
    irlx.record(program, stream)
    before = stream.read_bytes()
    with pytest.raises(irlx.StreamError, match="IRL005"):
        irlx.record(stream, stream)
    assert stream.read_bytes() == before


def test_a_program_does_not_write_its_own_stream(program: Path, tmp_path: Path) -> None:
    text = "PROGRAM p;\nVAR FILE: f;\nBEGIN\n  OPEN(f, 'a.csv', 'WRITE');\nENDPROGRAM;\n"
    program.write_text(text, encoding="utf-8")
    with pytest.raises(irlx.IrlxError, match="a stream of this run"):
        irlx.record(program, tmp_path / "a.csv")


@pytest.mark.req("QA-08")
@pytest.mark.parametrize("number", [0, 1, 3, 5])
def test_an_interrupt_while_rows_are_written_leaves_whole_rows(
    number: int, program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C in the middle of a portion: it is written to its end in every file, and then the run stops."""
    take, count = Figures.take, iter(range(100))

    def interrupted(figures: Figures, segment: object) -> None:
        if next(count) == number:
            os.kill(os.getpid(), signal.SIGINT)
        take(figures, segment)  # type: ignore[arg-type]

    monkeypatch.setattr(Figures, "take", interrupted)
    if number == 0:
        # Before anything has moved there is nothing to keep.
        with pytest.raises(KeyboardInterrupt):
            irlx.record(program, tmp_path / "a.irdata")
        assert visible(tmp_path) == ["p.irl", "p.toml"]
        return
    with pytest.raises(irlx.RunInterrupted) as caught:
        irlx.record(program, [tmp_path / "a.irdata", tmp_path / "a.jsonl"])
    one, two = (read_stream(path) for path in caught.value.run.files)
    assert np.array_equal(one.q, two.q)
    assert len(one.q) == caught.value.run.summary.samples
    assert not one.complete


def test_memory_that_runs_out_at_the_very_end_leaves_nothing_behind(
    program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file before is there, the others are as if they had never been asked for."""

    def scarce(writer: NpzWriter, complete: bool) -> None:
        raise MemoryError

    monkeypatch.setattr(NpzWriter, "_put_end", scarce)
    with pytest.raises(MemoryError):
        irlx.record(program, [tmp_path / "a.csv", tmp_path / "a.npz", tmp_path / "a.jsonl"])
    assert visible(tmp_path) == ["a.csv", "p.irl", "p.toml"]


def test_names_of_partial_files() -> None:
    assert file_recording.partial_name(Path("x/a.irdata")) == Path("x/a.partial.irdata")
