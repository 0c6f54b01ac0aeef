"""Damaged input: a quick part of the campaigns, every case that ever failed, and the campaign itself."""

from __future__ import annotations

import logging
import os
import signal
import time
import warnings
from pathlib import Path
from random import Random

import pytest

from fuzzing import language, limits
from fuzzing.campaign import Campaign, LastCase, Portion, judged, key_of
from fuzzing.case import Case, Fault, Outcome
from fuzzing.language import LanguageJudge
from fuzzing.minimise import smallest
from fuzzing.readers import ReadersJudge
from fuzzing.stream_readers import StreamReader
from fuzzing.tally import Tally
from irlx.streams import KNOWN_ENDINGS

CORPUS = Path(__file__).parent / "corpus"
JUDGES = {"language": LanguageJudge, "readers": ReadersJudge}
KEPT = sorted(path for path in CORPUS.rglob("*") if path.is_file() and path.parts[-3] in JUDGES)
QUICK = 10**6
"""Number of the portions of the quick part: far from those of a campaign, which begin with sound files."""
PROGRAMS, FILES, STREAMS = 600, 120, 30


@pytest.fixture(scope="module")
def readers(tmp_path_factory):
    return ReadersJudge(tmp_path_factory.mktemp("readers"))


def told(tally):
    """What is wrong, for the message of a test that failed."""
    return {key: (found["kind"], bytes.fromhex(found["content"])) for key, found in tally.crashes.items()}


@pytest.mark.req("QA-06", "QA-08")
def test_damaged_programs(tmp_path):
    """For long: `tests/campaigns/fuzz_language.py`."""
    tally = Portion(1, QUICK, PROGRAMS).run(LanguageJudge(tmp_path), LastCase())
    assert not tally.crashes, told(tally)
    assert tally.inputs == PROGRAMS
    assert PROGRAMS // 50 < tally.accepted < PROGRAMS // 2
    assert len(set(tally.codes) & set(language.CODES)) > 55


@pytest.mark.req("QA-06")
def test_damaged_files(readers):
    """For long: `tests/campaigns/fuzz_readers.py`."""
    tally = Portion(1, QUICK, FILES).run(readers, LastCase())
    assert not tally.crashes, told(tally)
    assert len(tally.kinds) > 10
    assert FILES // 20 < tally.accepted < FILES * 19 // 20
    assert len(set(tally.codes) & set(readers.expected_codes)) > 20


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_damaged_streams(readers, ending):
    """A coded error or a correct reading, whatever the bytes: see `fuzzing.stream_readers`."""
    chance, codes = Random(ending), []
    reader = next(
        one for one in readers.readers.values() if isinstance(one, StreamReader) and one.ending == ending
    )
    for _ in range(STREAMS):
        case = Case(reader.kind, reader.damaged(reader.sound[0], chance))
        codes += judged(readers, case, thorough=False).codes
    assert codes.count("IRL701") > STREAMS // 10


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("path", KEPT, ids=lambda path: path.name)
def test_what_once_failed(path, tmp_path):
    """Smallest cases of all that campaigns have found and that has been mended since."""
    judge = JUDGES[path.parts[-3]](tmp_path)
    judged(judge, Case(path.parts[-2], path.read_bytes()), thorough=True)


def test_there_are_kept_cases():
    assert {path.parts[-3] for path in KEPT} == JUDGES.keys()


class Odd:
    """Stands for something to be fuzzed: what a case says happens."""

    area = "odd"
    promises = "odd codes"
    expected_codes = ("IRL101", "IRL999")

    def __init__(self, folder):
        self.endings = {"odd": ".txt"}

    def beginnings(self):
        return [lambda word=word: Case("odd", word) for word in WORDS]

    def draw(self, chance, pool):
        return Case("odd", b"fine %d" % chance.randrange(10**9))

    def patience(self, kind):
        return 1.0

    def judge(self, case, thorough=None):
        for word, happens in WORDS.items():
            if word in case.content:
                happens()
        codes = frozenset({"IRL101"} if b"7" in case.content else ())
        return Outcome(not codes, codes, frozenset([case.content[:6]]))


def endless():
    while True:
        pass


def recursive():
    return recursive() + 1


def large():
    assert bytes(10**12)


WORDS = {
    b"raise": lambda: {}["x"],
    b"warn": lambda: warnings.warn("careful", stacklevel=1),
    b"loop": endless,
    b"deep": recursive,
    b"large": large,
    b"die": lambda: os.kill(os.getpid(), signal.SIGKILL),
    b"speak": lambda: logging.getLogger("odd").warning("look at this"),
    b"stop": lambda: (_ for _ in ()).throw(Fault("a promise", "IRL101")),
}


@pytest.fixture
def quick_bounds(monkeypatch):
    monkeypatch.setattr(limits, "SECONDS", 0.2)


@pytest.mark.parametrize(
    ("word", "key"),
    [
        (b"raise", "KeyError"),
        (b"warn", "UserWarning"),
        (b"loop", "too long"),
        (b"deep", "RecursionError"),
        (b"large", "MemoryError"),
        (b"speak", "a library speaks on the terminal odd: look at this"),
        (b"stop", "a promise IRL101"),
        (b"fine", ""),
    ],
)
def test_what_counts_as_a_fault(word, key, quick_bounds, tmp_path):
    found = key_of(Odd(tmp_path), Case("odd", b"a\n" + word + b"\nb"))
    assert found.startswith(key)
    assert bool(found) == bool(key)


def test_time_is_the_computing_time_of_one_case(quick_bounds, tmp_path):
    time.sleep(0.3)
    assert key_of(Odd(tmp_path), Case("odd", b"fine")) == ""


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_campaign_counts_saves_and_goes_on(quick_bounds, tmp_path):
    said = []
    campaign = Campaign(Odd, tmp_path / "corpus", said.append)
    state, tally = tmp_path / "deep" / "state.json", Tally(seed=3)
    campaign.run(tally, state, inputs=60, size=20, seconds=60.0)
    assert (tally.inputs, tally.portions, tally.crashed, len(tally.crashes)) == (60, 3, 8, 8)
    assert tally.accepted + tally.codes["IRL101"] == 52
    saved = {Path(found["case"]).read_bytes() for found in tally.crashes.values()}
    assert saved == set(WORDS)
    assert any("process ended by signal" in key for key in tally.crashes)
    lines = "\n".join(tally.lines(Odd.expected_codes, Odd.promises))
    assert "inputs      60" in lines
    assert "not reached IRL999" in lines
    assert "crashes     8, 8 distinct" in lines
    again = Tally.load(state)
    assert again == tally
    campaign.run(again, state, inputs=80, size=20, seconds=60.0)
    assert (again.inputs, again.portions, again.crashed) == (80, 4, 8)


def test_a_portion_is_the_same_wherever_it_is_repeated(tmp_path):
    judge = LanguageJudge(tmp_path)
    drawn = [list(Portion(5, 9, 30).cases(judge, [])) for _ in range(2)]
    assert drawn[0] == drawn[1]
    assert drawn[0] != list(Portion(5, 10, 30).cases(judge, []))


def test_cases_are_made_smaller():
    def breaks(case):
        return b"(" in case.content and b"bad" in case.content

    long = b"\n".join(b"line %d (of) many" % number for number in range(300)) + b" bad end\n" * 20
    assert smallest(Case("odd", long), breaks).content in (b"(bad", b"bad(")
