"""PAUSE: goes on at once, after a given time, or when whoever reads the samples answers."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import irlx
from irlx.blocks import PauseBlock
from irlx.blocks.codec import block_from_plain, block_to_plain
from irlx.streams import read_stream
from kept_runs import kept_run

pytestmark = pytest.mark.req("LANG-40")

CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 10\n'
TEXT = """PROGRAM p;
VAR POSITION: store := (440, 260, 325);
BEGIN
  PAUSE;
  MOVE LIN store;
  PAUSE;
  MOVE LIN store - POSITION(0, 50, 0);
  PAUSE;
ENDPROGRAM
"""


@pytest.fixture
def path(tmp_path):
    """A program with pauses at its start, between moves, and at its end; its cell beside it."""
    (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
    (tmp_path / "p.irl").write_text(TEXT, encoding="utf-8")
    return tmp_path / "p.irl"


def pauses(stream):
    return [record for record in stream.records if isinstance(record.block, PauseBlock)]


def rows_of(stream, block):
    return np.flatnonzero(stream.block == block.id)


def failed(stream, path):
    run = replace(kept_run(path, path.with_suffix(".toml")), stream=stream)
    return {check.name for check in irlx.verify(run, path).failed}


@pytest.mark.parametrize(
    ("seconds", "ticks"), [(0.0, 0), (0.01, 1), (0.0101, 2), (0.25, 25), (1e-9, 0), (0.3000000001, 30)]
)
def test_a_pause_lasts_as_long_as_given(path, seconds, ticks):
    """Whole ticks, rounded up, beside what is rounding; the rest of the stream is that of a run without."""
    run, plain = irlx.run(path, pause_s=seconds), kept_run(path, path.with_suffix(".toml"))
    assert [len(rows_of(run.stream, record.block)) for record in pauses(run.stream)] == [ticks] * 3
    stands = np.isin(run.block, [record.block.id for record in pauses(run.stream)])
    np.testing.assert_array_equal(run.q[~stands], plain.q)
    assert run.summary.duration == pytest.approx(plain.summary.duration + 3 * ticks * 0.01)
    assert irlx.verify(run, path).passed


def test_a_pause_stands_still(path):
    run = irlx.run(path, pause_s=0.1)
    for record in pauses(run.stream):
        rows = rows_of(run.stream, record.block)
        before = np.broadcast_to(run.q[record.tick], run.q[rows].shape)
        np.testing.assert_array_equal(run.q[rows], before)
        assert not run.qd[rows].any()


@pytest.mark.parametrize("ending", ["irdata", "npz"])
def test_pauses_survive_their_file(path, tmp_path, ending):
    run = irlx.run(path, pause_s=0.05)
    run.save(tmp_path / f"out.{ending}")
    assert [record.block.duration for record in pauses(read_stream(tmp_path / f"out.{ending}"))] == [0.05] * 3
    assert irlx.verify(tmp_path / f"out.{ending}", path).passed


def test_a_pause_from_before_it_had_a_time(path):
    plain = block_to_plain(pauses(irlx.run(path).stream)[0].block)
    del plain["duration"]
    assert block_from_plain(plain).duration == 0.0


def test_the_verifier_sees_a_pause_that_moves_or_is_too_short(path):
    stream = irlx.run(path, pause_s=0.1).stream
    first = rows_of(stream, pauses(stream)[1].block)
    moved = stream.q.copy()
    moved[first[3], 2] += 1e-12
    assert "waits still" in failed(replace(stream, q=moved), path)
    longer = tuple(
        replace(record, block=replace(record.block, duration=0.2)) if record in pauses(stream) else record
        for record in stream.records
    )
    assert "waiting time" in failed(replace(stream, records=longer), path)
    infinite = tuple(
        replace(record, block=replace(record.block, duration=np.inf)) if record in pauses(stream) else record
        for record in stream.records
    )
    assert "blocks" in failed(replace(stream, records=infinite), path)


def test_the_verifier_sees_a_pause_that_is_no_pause_of_the_program(path, tmp_path):
    (tmp_path / "q.irl").write_text(TEXT.replace("  PAUSE;\n  MOVE LIN store;", "  MOVE LIN store;", 1))
    stream = irlx.run(path, pause_s=0.1).stream
    report = irlx.verify(replace(irlx.run(path), stream=stream), tmp_path / "q.irl", tmp_path / "p.toml")
    assert "block 1, line 4: type is PauseBlock in the stream, MoveBlock from the program" in str(
        report["program"].detail
    )


def test_the_command(path, capsys, monkeypatch):
    from irlx.cli.main import main

    monkeypatch.chdir(path.parent)
    assert main(["run", "p.irl", "--pause", "0.25", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["summary"]["duration"] == pytest.approx(irlx.run(path).summary.duration + 0.75)
    assert told["verified"] == {"p.irdata": True}
    for bad, shown in (("-1", "-1"), ("nan", "nan"), ("inf", "inf")):
        assert main(["run", "p.irl", f"--pause={bad}"]) == 2
        assert f"IRL006: --pause {shown}: a pause lasts a number" in capsys.readouterr().err
    assert main(["run", "p.irl", "--pause", "0.01", "--explain-tick", "1"]) == 0
    assert "PAUSE" in capsys.readouterr().out
    assert main(["run", "p.irl", "--pause", "1e9"]) == 1
    assert "IRL425" in capsys.readouterr().err


def test_a_stream_waits_for_its_answer(path):
    """The samples before a pause are all there when it asks, and none after it."""
    seen, asked = [], []
    for sample in irlx.stream(path, on_pause=lambda place: asked.append((place.line, len(seen)))):
        seen.append(sample)
    run = irlx.run(path)
    assert asked == [(record.block.origin.line, record.tick + 1) for record in pauses(run.stream)]
    assert [line for line, _ in asked] == [4, 6, 8]
    np.testing.assert_array_equal([sample.q for sample in seen], run.q)


def test_an_answer_may_be_a_time(path):
    answers = iter([0.05, None, 0])
    samples = list(irlx.stream(path, pause_s=0.02, on_pause=lambda _: next(answers)))
    assert len(samples) == len(irlx.run(path).t) + 5 + 2
    run = irlx.run(path)
    np.testing.assert_array_equal([sample.q for sample in samples[7 + len(run.t) - 1 :]], run.q[-1:])


@pytest.mark.parametrize("answer", [-1, "yes", True, float("nan"), float("inf"), [1.0]])
def test_an_answer_that_is_no_time(path, answer):
    with pytest.raises(irlx.IrlxError) as caught:
        list(irlx.stream(path, on_pause=lambda _: answer))
    reason = caught.value.reason
    assert (reason.code, reason.place.line) == ("IRL505", 4)
    assert repr(answer) in reason.message


def test_what_the_one_who_answers_raises_comes_out(path):
    class Enough(Exception):
        pass

    def refuse(place):
        raise Enough(place.line)

    samples = irlx.stream(path, on_pause=refuse)
    assert next(samples).tick == 0
    with pytest.raises(Enough, match=r"^4$"):
        next(samples)


def test_blocks_and_the_interpreter_go_on_at_once(path):
    from irlx.blocks.text import block_text
    from irlx.job import prepare
    from irlx.pipeline import Execution

    first = next(Execution(prepare(path)).blocks())
    assert block_text(first, ["rad"] * 7) == "1 PAUSE line 4"
    blocks = Execution(prepare(path, pause_s=1.5)).blocks()
    assert block_text(next(blocks), ["rad"] * 7) == "1 PAUSE 1.5 s line 4"
