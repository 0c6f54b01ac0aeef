"""Benchmarks that guard: comparison with stored counts, the marks, exponents, programs that are measured."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from irlx.language.analysis import analyse
from irlx.language.source import source_text

ROOT = Path(__file__).resolve().parents[1]
BENCHMARKS = ROOT / "benchmarks"


@pytest.fixture(scope="module", autouse=True)
def benchmarks():
    """Scripts of the folder find each other while the module is tested."""
    sys.path.insert(0, str(BENCHMARKS))
    yield
    sys.path.remove(str(BENCHMARKS))


def compared(found, stored=None, now=None, then=None):
    from stored_counts import Comparison, Counts

    before = None if stored is None else Counts(then or {"numpy": "2"}, stored)
    return Comparison(before, Counts(now or {"numpy": "2"}, found))


# ---- comparison with stored counts


@pytest.mark.req("BEN-04")
def test_two_per_cent_may_be_lost_and_no_more():
    stored = {"a": 1_000_000, "b": 1_000_000, "c": 1_000_000}
    result = compared({"a": 1_020_000, "b": 1_020_001, "c": 500_000}, stored)
    assert result.over == ["b"]
    assert result.verdict() == ["more than 2% over the stored count: b"]
    b, c = result.table()[2:4]
    assert b.split() == ["b", "1,000,000", "1,020,001", "+2.00%", "over"]
    assert c.split() == ["c", "1,000,000", "500,000", "-50.00%"]


def test_nothing_to_say_where_nothing_grew():
    result = compared({"a": 990}, {"a": 1000, "gone": 5})
    assert result.verdict() == []
    assert len(result.table()) == 2


@pytest.mark.parametrize("stored", [None, {"b": 10}])
def test_a_count_without_a_stored_one_fails(stored):
    result = compared({"a": 10}, stored)
    assert result.verdict() == ["no stored count: a (--update stores it)"]
    assert result.table()[1].split() == ["a", "-", "10"]


def test_other_versions_are_told_and_compared_all_the_same():
    now, then = {"numpy": "3", "cpu": "x"}, {"numpy": "2", "pin": "4"}
    result = compared({"a": 1030}, {"a": 1000}, now, then)
    assert result.other_versions == ["numpy 2, now 3", "pin 4, now none", "cpu none, now x"]
    assert result.table()[-1].endswith("numpy 2, now 3; pin 4, now none; cpu none, now x")
    assert result.over == ["a"]


def test_what_was_not_counted_stays_stored():
    assert compared({"a": 9}, {"a": 8, "b": 7}).updated.instructions == {"a": 9, "b": 7}
    assert compared({"a": 9}).updated.instructions == {"a": 9}


def test_counts_come_back_from_their_file(tmp_path):
    from stored_counts import Counts

    counts = Counts({"python": "3"}, {"a": 7})
    counts.write(tmp_path / "counts.json")
    assert Counts.read(tmp_path / "counts.json") == counts


@pytest.mark.req("BEN-04")
def test_every_piece_of_work_has_a_stored_count():
    from instructions import LIBRARIES
    from workloads import GROUPS

    stored = json.loads((BENCHMARKS / "instructions.json").read_text(encoding="utf-8"))
    names = [name for pieces in GROUPS.values() for name in pieces]
    assert sorted(stored["instructions"]) == sorted([*names, "irlx --help", "irlx run"])
    assert set(LIBRARIES) <= set(stored["made_with"])


def test_without_valgrind_there_is_one_line():
    command = [sys.executable, str(BENCHMARKS / "instructions.py"), "--check"]
    done = subprocess.run(command, capture_output=True, text=True, env={"PATH": "/nowhere"}, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "valgrind, which counts instructions, is not installed: apt install valgrind\n"


def test_marks_do_nothing_outside_of_valgrind():
    from callgrind_marks import Marks

    try:
        marks = Marks()
    except RuntimeError as other_machine:
        pytest.skip(str(other_machine))
    with marks.counted("nothing"):
        pass


# ---- growth


@pytest.mark.req("BEN-05")
@pytest.mark.parametrize("power", [0.0, 1.0, 2.0, 1.5])
def test_the_exponent_is_that_of_the_upper_part(power):
    from growth import exponent

    curve = [(1, 50.0), (10, 60.0), *((x, 3.0 * x**power) for x in (100, 1000, 5000))]
    assert exponent(curve) == pytest.approx(power, abs=1e-12)


@pytest.mark.req("BEN-05")
def test_the_document_has_what_is_stored_and_reasons_for_what_is_worse_than_linear():
    from growth import DOCUMENT, STORED, exponent, with_table

    stored = json.loads(STORED.read_text(encoding="utf-8"))
    text = DOCUMENT.read_text(encoding="utf-8")
    assert with_table(text, stored["curves"]) == text
    for kind, curves in stored["curves"].items():
        for name, curve in curves.items():
            assert stored["exponents"][kind][name] == round(exponent(curve), 2)
            # What is measured once more on another day may be off by a little.
            assert exponent(curve) < (2.0 if kind == "joints" else 1.25), (kind, name)


def test_programs_that_are_measured_have_no_errors_and_their_lines():
    from growth_programs import of_lines, of_routines

    for lines in (10, 100, 1000):
        for moves in (False, True):
            source = source_text("p.irl", of_lines(lines, moves))
            assert [d for d in analyse(source, lints=True).diagnostics if d.is_error] == []
            assert lines <= source.text.count("\n") <= max(lines, 19)
    assert [d for d in analyse(source_text("p.irl", of_routines(20))).diagnostics if d.is_error] == []
