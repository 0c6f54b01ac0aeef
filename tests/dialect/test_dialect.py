"""Longer programs in a dialect of other controllers: they run as they are, and the formatter mends them."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.blocks import MoveBlock, SignalBlock
from long_run import first

HERE = Path(__file__).parent
CELL = HERE / "cell.toml"
MENDED = {"IRL103", "IRL104", "IRL105", "IRL205"}
"""What the formatter puts right."""
PROGRAMS = {
    "pick_and_place": {"IRL103": 2, "IRL104": 1, "IRL105": 9, "IRL205": 4},
    "nested": {"IRL103": 3, "IRL104": 6, "IRL105": 15, "IRL205": 4},
    "contour": {"IRL105": 3, "IRL205": 1, "IRL313": 1},
}

pytestmark = pytest.mark.req("LANG-44")


@pytest.fixture(scope="module")
def runs():
    return {name: irlx.run(HERE / f"{name}.irl", cell=CELL) for name in PROGRAMS}


def outputs(run):
    """What is set, in order: name of the port and value."""
    blocks = [record.block for record in run.stream.records]
    return [(block.port.name, block.value) for block in blocks if isinstance(block, SignalBlock)]


def told_blocks(run):
    return [(record.tick, type(record.block)) for record in run.stream.records]


@pytest.mark.parametrize("name", PROGRAMS)
def test_each_form_gives_its_warning_and_no_error(name):
    findings = irlx.check(HERE / f"{name}.irl", cell=CELL)
    assert not [str(finding) for finding in findings if finding.is_error]
    assert Counter(finding.code for finding in findings) == PROGRAMS[name]


@pytest.mark.parametrize("name", PROGRAMS)
def test_it_runs_and_the_verifier_agrees(runs, name):
    report = irlx.verify(runs[name], program=HERE / f"{name}.irl", cell=CELL)
    assert runs[name].summary.complete
    assert report.passed, str(report)


@pytest.mark.parametrize("name", first(2, sorted(PROGRAMS)))
def test_the_formatter_mends_it_and_it_does_the_same(runs, name, tmp_path):
    mended = tmp_path / f"{name}.irl"
    mended.write_text(
        irlx.format_source((HERE / f"{name}.irl").read_text(encoding="utf-8")), encoding="utf-8"
    )
    left = {code: n for code, n in PROGRAMS[name].items() if code not in MENDED}
    assert Counter(finding.code for finding in irlx.check(mended, cell=CELL)) == left
    again = irlx.run(mended, cell=CELL)
    assert np.array_equal(again.q, runs[name].q)
    assert told_blocks(again) == told_blocks(runs[name])
    assert outputs(again) == outputs(runs[name])


def test_the_parts_that_are_there_are_placed(runs):
    """The tray's sensor is off for a while: such a place is left out, and the lamp says so."""
    set_to = outputs(runs["pick_and_place"])
    grips = [value for port, value in set_to if port == "OUT_1"]
    assert (set_to[0], set_to[-1]) == (("OUT_2", 1.0), ("OUT_2", 0.0))
    assert grips == [1.0, 0.0] * (len(grips) // 2)
    lamps = [value for port, value in set_to if port == "OUT_3"]
    assert len(grips) // 2 + len(lamps) // 2 == 4
    assert len(lamps) > 0
    moves = [
        record for record in runs["pick_and_place"].stream.records if isinstance(record.block, MoveBlock)
    ]
    assert len(moves) == 6 * (len(grips) // 2)


def test_nested_loops_end_when_the_sensor_has_spoken_twice(runs):
    assert outputs(runs["nested"])[-1] == ("OUT_5", 1.0)
    assert ("OUT_9", 1.0) not in outputs(runs["nested"])


def test_the_contour_of_fifty_points_closes(runs):
    assert runs["contour"].summary.moves == 50
    first, last = (
        next(r.block.target for r in records if isinstance(r.block, MoveBlock))
        for records in (runs["contour"].stream.records, runs["contour"].stream.records[::-1])
    )
    np.testing.assert_allclose(first.position, last.position, rtol=0.0, atol=1e-12)
