"""The clock of the viewer, and the program run again beside the page."""

import threading
import time
from types import SimpleNamespace

import pytest

from irlx.diagnostics import IrlxError, report
from irlx.viewer.player import Player
from irlx.viewer.rerun import Rerun


@pytest.fixture
def player():
    times, changes = [], []
    found = Player(0.3, times.append, lambda: changes.append(found.plays))
    yield found, times, changes
    found.stop()


def wait_for(condition, seconds=5.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it takes too long"
        time.sleep(0.005)


def test_it_plays_to_the_end_and_stands_there(player):
    found, times, changes = player
    begun = time.monotonic()
    found.play()
    wait_for(lambda: not found.plays)
    assert time.monotonic() - begun >= 0.3
    assert found.time == times[-1] == 0.3
    assert times == sorted(times)
    assert changes == [True, False]


def test_speed_and_again_from_the_beginning(player):
    found, times, _ = player
    found.set_speed(10.0)
    found.play()
    wait_for(lambda: not found.plays)
    found.play()
    wait_for(lambda: not found.plays and times.count(0.3) == 2)


def test_it_goes_where_it_is_told_within_the_run(player):
    found, times, _ = player
    for asked, due in ((0.1, 0.1), (-1.0, 0.0), (7.0, 0.3)):
        found.seek(asked)
        assert found.time == times[-1] == due
    assert not found.plays


def test_a_loop_goes_on(player):
    found, times, _ = player
    found.loops = True
    found.set_speed(10.0)
    found.play()
    wait_for(lambda: times.count(0.0) >= 2)
    assert found.plays
    found.pause()
    assert not found.plays


def test_another_run_begins_at_its_beginning(player):
    found, times, _ = player
    found.seek(0.2)
    found.play()
    found.restart(2.0)
    assert (found.time, found.plays, found.duration) == (0.0, False, 2.0)
    assert times[-1] == 0.0


BLOCK = SimpleNamespace(origin=SimpleNamespace(line=7))


def rerun_of(again):
    told = {"going": [], "done": [], "failed": []}
    found = Rerun(
        again, lambda *where: told["going"].append(where), told["done"].append, told["failed"].append
    )
    return found, told


def test_what_a_run_comes_to_is_shown():
    def again(cell, progress):
        progress(BLOCK, 1.5)
        return f"run in {cell}"

    found, told = rerun_of(again)
    assert found.start(lambda: "the cell")
    found.wait(5.0)
    assert told == {"going": [(7, 1.5)], "done": ["run in the cell"], "failed": []}


@pytest.mark.parametrize(
    ("error", "code"),
    [(IrlxError(report("IRL001", path="x", near="")), "IRL001"), (ValueError("a fault"), "IRL090")],
)
def test_why_it_did_not_run_is_told(error, code):
    def again(cell, progress):
        raise error

    found, told = rerun_of(again)
    found.start(lambda: None)
    found.wait(5.0)
    ((reason,),) = told["failed"]
    assert reason.code == code
    assert not told["done"]


def test_one_run_at_a_time_and_none_after_the_end():
    inside, go_on = threading.Event(), threading.Event()

    def again(cell, progress):
        inside.set()
        go_on.wait(5.0)
        progress(BLOCK, 0.0)
        return cell

    found, told = rerun_of(again)
    assert found.start(lambda: 1)
    assert inside.wait(5.0)
    assert not found.start(lambda: 2)
    ending = threading.Thread(target=found.stop)
    ending.start()
    wait_for(lambda: not found.start(lambda: 3))
    go_on.set()
    ending.join(5.0)
    # It ended at its next block, and nobody hears of it.
    assert not found.runs
    assert told == {"going": [], "done": [], "failed": []}
