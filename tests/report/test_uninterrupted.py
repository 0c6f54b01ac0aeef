"""Work that signals wait for: none of them is lost, whatever becomes of the work."""

import os
import signal
import threading

import pytest

from irlx.report.uninterrupted import uninterrupted

pytestmark = pytest.mark.req("QA-09")


def work(done: list[str], fails: bool) -> None:
    with uninterrupted():
        os.kill(os.getpid(), signal.SIGINT)
        done.append("all of it")
        if fails:
            raise ValueError("the disk is full")


@pytest.mark.parametrize("fails", [False, True])
def test_ctrl_c_is_heard_behind_the_work(fails: bool) -> None:
    done: list[str] = []
    with pytest.raises(KeyboardInterrupt) as caught:
        work(done, fails)
    assert done == ["all of it"]
    # What went wrong in the work is not lost either.
    assert isinstance(caught.value.__context__, ValueError) == fails
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_other_signals_that_are_handled(number: int) -> None:
    heard: list[int] = []
    before = signal.signal(number, lambda which, _: heard.append(which))
    try:
        with uninterrupted():
            os.kill(os.getpid(), number)
            assert heard == []
        assert heard == [number]
    finally:
        signal.signal(number, before)


def test_other_threads_are_left_alone() -> None:
    failures: list[BaseException] = []

    def inside() -> None:
        try:
            with uninterrupted():
                pass
        except BaseException as error:
            failures.append(error)

    thread = threading.Thread(target=inside)
    thread.start()
    thread.join()
    assert failures == []
