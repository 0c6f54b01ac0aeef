"""Events and lines of runs made by hand, and a page that cannot be made."""

import numpy as np
import pytest

from irlx.blocks import InputBlock, Origin, Port, SignalKind, WaitBlock
from irlx.cell.load import own_cell
from irlx.diagnostics import report
from irlx.report.events import LimitActive, Slowed
from irlx.report.outcome import Outcome
from irlx.report.replay import data
from irlx.report.replay import gathering as gathering_module
from irlx.report.replay.events import replay_events
from irlx.report.replay.gathering import Gathering
from irlx.report.replay.source import ReplaySource
from irlx.report.replay.writer import PageWriter
from irlx.report.segment import Segment
from irlx.robot.limits import JointLimits
from irlx.streams.joint_stream import FORMAT_VERSION, BlockRecord, StreamHeader

pytestmark = pytest.mark.req("REP-04")

LIMITS = JointLimits.unlimited(2).with_pair("position", np.array([-1.0, -0.2]), np.array([1.0, 0.5]))
NARROW = LIMITS.with_pair("speed", np.array([-2.0, -0.1]), np.array([2.0, 0.1]))
HEADER = StreamHeader(
    FORMAT_VERSION, "1", "p.irl", "", "p.toml", "r", "r", "", "tcp", ("turn", "slide"), ("rad", "m"),
    10_000_000, LIMITS, (1.0, 1.0),
)  # fmt: skip


def rows(first, count, block=0, limits=LIMITS, record=None):
    """Rows in which nothing moves."""
    tool = np.tile([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (count, 1))
    still = np.zeros((count, 2))
    numbers = np.full(count, block)
    return Segment(record, first, still, numbers, tool, np.zeros((count, 2), np.int8), limits)


def wait(number, line, tick, condition="", file="p.irl"):
    origin = Origin(file, 0, 1, line)
    return BlockRecord(tick, WaitBlock(id=number, origin=origin, duration=0.05, condition=condition))


@pytest.fixture
def gathering():
    found = Gathering(HEADER)
    found.take(rows(0, 1))
    return found


def events_of(gathering, told=(), errors=()):
    return replay_events(HEADER, gathering.found, told, errors)


def test_limits_by_what_was_in_force(gathering):
    gathering.take(rows(1, 9))
    gathering.take(rows(10, 10, limits=NARROW))
    told = [
        LimitActive("slide", "position", "upper", 3, 5, 0.03, 0.05),
        LimitActive("turn", "braking", "lower", 2, 2, 0.02, 0.02),
        LimitActive("slide", "speed", "lower", 12, 14, 0.12, 0.14),
    ]
    braking, position, speed = events_of(gathering, told)
    assert (braking["kind"], braking["joint"], braking["first"], braking["last"]) == ("limit", 0, 2, 2)
    assert braking["label"] == "turn before its lower position limit"
    assert braking["text"] == "turn brakes before its lower position limit, -57.3 deg, at 0.02 s"
    assert (position["label"], position["joint"]) == ("slide at its upper position limit", 1)
    assert position["text"] == "slide is held by its upper position limit, 500 mm, 0.03 to 0.05 s"
    assert speed["text"] == "slide is held by its lower speed limit, -100 mm/s, 0.12 to 0.14 s"


@pytest.mark.parametrize("joint", ["slide", ""])
def test_slowed(gathering, joint):
    way = 0.25, 1.0, False, 1.0, 0.5
    limit = (joint, "speed" if joint else "", 0.1 if joint else 0.0)
    event = Slowed(7, 2, 9, 0.02, 0.09, *way, *limit, 0.03, 5 if joint else 7, 7)
    (found,) = events_of(gathering, [event])
    assert (found["kind"], found["line"], found["joint"]) == ("slowed", 7, 1 if joint else None)
    assert found["label"] == ("slowed by slide speed" if joint else "slowed")
    over = " (lines 5 to 7)" if joint else ""
    why = ": slide speed limit 100 mm/s" if joint else ""
    assert found["text"] == (
        f"the tool is slower than programmed{over}, 0.02 to 0.09 s, by 0.03 s; slowest at 250 mm of its way, "
        f"500 of 1000 mm/s{why}"
    )


def test_waits_of_one_statement_are_one(gathering):
    looks = [(1, 5, 0, "IN_1"), (2, 5, 5, "IN_1"), (3, 6, 10, "IN_1"), (4, 7, 15, ""), (5, 7, 20, "")]
    for number, line, tick, condition in looks:
        gathering.take(rows(tick + 1, 5, number, record=wait(number, line, tick, condition)))
    spans = [(event["label"], event["line"], event["first"], event["last"]) for event in events_of(gathering)]
    assert spans == [
        ("WAIT FOR IN_1", 5, 0, 10),
        ("WAIT FOR IN_1", 6, 10, 15),
        ("WAIT 0.05 s", 7, 15, 20),
        ("WAIT 0.05 s", 7, 20, 25),
    ]


def test_inputs_messages_and_the_end(gathering):
    port = Port("AIN_2", SignalKind.REAL)
    block = InputBlock(id=1, origin=Origin("p.irl", 0, 1, 3), port=port, value=0.5)
    gathering.take(rows(1, 0, record=BlockRecord(0, block)))
    gathering.say("one\n")
    gathering.say("two\n")
    gathering.take(rows(1, 4))
    gathering.say("x" * 5000)
    error = report("IRL002", path="p.irl", cause="gone")
    read, message, late, stop = events_of(gathering, errors=[error])
    assert (read["kind"], read["label"], read["text"]) == ("signal", "AIN_2 = 0.5", "AIN_2 says 0.5")
    assert (message["first"], message["label"], message["text"]) == (0, "one", "one\ntwo")
    assert late["first"] == 4
    assert len(late["text"]) < 2100
    assert (stop["kind"], stop["first"], stop["label"]) == ("stop", 4, "ended by IRL002")


def test_messages_have_the_lines_of_their_statements(gathering):
    def at(line, file="p.irl"):
        return Origin(file, 0, 1, line)

    gathering.say("x = ", at(4))
    gathering.say("3\n", at(5))
    gathering.say("loop\n", at(7))
    gathering.say("loop\n", at(7))
    gathering.say("of a module\n", at(2, "m.irl"))
    told = [(event["line"], event["text"]) for event in events_of(gathering)]
    assert told == [(4, "x = 3"), (7, "loop\nloop"), (None, "of a module")]


def test_a_page_lists_the_first_blocks(gathering, monkeypatch):
    monkeypatch.setattr(gathering_module, "MOST_LISTED", 3)
    monkeypatch.setattr(gathering_module, "_RECENT", 2)
    for number in range(1, 6):
        gathering.take(rows(5 * number - 4, 5, number, record=wait(number, 10 + number, 5 * number - 5)))
        gathering.say("x")
    found = gathering.found
    assert (len(found.records), found.blocks, len(found.waits), len(found.messages)) == (3, 5, 3, 3)
    assert found.frames.columns.line[-1] == 15


def test_lines_of_other_files_are_none(gathering):
    gathering.take(rows(1, 5, 1, record=wait(1, 4, 0)))
    gathering.take(rows(6, 5, 2, record=wait(2, 9, 5, file="module.irl")))
    gathering.take(rows(11, 5, 3, record=wait(3, 5, 10)))
    lines = dict(zip(*(column.tolist() for column in gathering.found.frames.columns[:2]), strict=True))
    assert lines == {0: 0, 2: 4, 4: 4, 6: 0, 8: 0, 10: 0, 12: 5, 14: 5, 15: 5}


def test_a_page_that_cannot_be_made_leaves_nothing(tmp_path, monkeypatch):
    def fail(*_):
        raise ZeroDivisionError

    monkeypatch.setattr(data, "replay_json", fail)
    writer = PageWriter(tmp_path / "p.html", HEADER, ReplaySource(own_cell("planar3")))
    assert len(list(tmp_path.iterdir())) == 1
    outcome = Outcome(header=HEADER, summary=None, events=(), diagnostics=())
    with pytest.raises(ZeroDivisionError):
        writer.close(outcome)
    writer.abort()
    assert list(tmp_path.iterdir()) == []
