"""Runs in Python work linear algebra out on one thread, whatever the process has, and leave that as it is."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import scipy.linalg  # noqa: F401  # what is not loaded has no threads
from threadpoolctl import ThreadpoolController, threadpool_limits

import irlx
from irlx.one_thread import one_thread, worked_out_on_one_thread

pytestmark = pytest.mark.req("QA-09")

CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 50\n'
PROGRAM = "PROGRAM p;\nBEGIN\n  MOVE_INC LIN (0, 0, -20);\n  MOVE_INC LIN (0, 0, 20);\nENDPROGRAM\n"


def threads() -> set[int]:
    """How many threads the libraries of linear algebra have."""
    return {pool["num_threads"] for pool in ThreadpoolController().info() if pool["user_api"] == "blas"}


@pytest.fixture(autouse=True)
def two() -> Iterator[None]:
    """Two threads, as a process has that was told nothing."""
    with threadpool_limits(2, user_api="blas"):
        if threads() != {2}:
            pytest.skip("the libraries here have one thread")
        yield


@pytest.fixture
def program(tmp_path):
    (tmp_path / "p.irl").write_text(PROGRAM)
    (tmp_path / "p.toml").write_text(CELL)
    return tmp_path / "p.irl"


def test_one_while_it_lasts_and_as_many_as_before_behind_it() -> None:
    with one_thread():
        assert threads() == {1}
    assert threads() == {2}
    with pytest.raises(ZeroDivisionError), one_thread():
        raise ZeroDivisionError
    assert threads() == {2}


def test_items_are_made_on_one_and_taken_on_two() -> None:
    found = [(seen, threads()) for seen in worked_out_on_one_thread(threads() for _ in range(3))]
    assert found == 3 * [({1}, {2})]


def test_ticks_are_solved_on_one_thread(program, monkeypatch) -> None:
    from irlx.pacing.pacer import Pacer

    seen, carry_out = [], Pacer.carry_out

    def watched(self: Pacer, blocks):
        seen.append(threads())
        return carry_out(self, blocks)

    monkeypatch.setattr(Pacer, "carry_out", watched)
    irlx.run(program)
    samples = [threads() for _ in irlx.stream(program)]
    corrected = [threads() for _ in irlx.stream(program, correct=lambda sample: None)]
    assert seen == len(seen) * [{1}]
    assert min(len(seen), len(samples), len(corrected)) > 1
    assert samples + corrected == (len(samples) + len(corrected)) * [{2}]
