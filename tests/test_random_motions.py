"""The quick part of the random motions, and the findings of the long one (`tests/campaigns/motions.py`).

One program again, with everything said of it: `python tests/campaigns/motions.py --only SEED`.
"""

from __future__ import annotations

import shutil
from itertools import islice
from pathlib import Path

import motions
import numpy as np
import pytest
from drawn.cells import inside
from drawn.coverage import WANTED, noted, rules
from drawn.judging import REFUSALS, judged
from drawn.minimise import kind_of, smaller
from drawn.program import drawn_case
from drawn.robots import KINDS

from compiled_grammar import build_grammar
from irlx.diagnostics.codes import CATALOGUE
from long_run import first

pytestmark = pytest.mark.req("QA-05")

SEEDS = (501, 500, 502)
SAMPLE = range(5000, 5060)
"""Seeds that together use everything."""
ONCE = 4
"""A seed with which a program is run once, not again, in parts, or sample by sample."""
IN_FULL = "reconfiguration_under_override"
"""The short one with which all of that is done in the default run as well."""
UNUSED = frozenset()
"""Rules of the grammar that no drawn program uses."""
CORPUS = sorted((Path(__file__).parent / "corpus" / "motions").iterdir())


def _case(folder: Path, full: bool):
    """A finding; one that is not mended yet says so in open.txt, and fails here when it is mended."""
    marks = [pytest.mark.xfail(strict=True)] if (folder / "open.txt").exists() else []
    marks += [pytest.mark.slow] if full and folder.name != IN_FULL else []
    return pytest.param(folder, full, id=f"{folder.name}{'-full' if full else ''}", marks=marks)


@pytest.fixture(scope="module")
def sample():
    return [drawn_case(seed) for seed in SAMPLE]


@pytest.mark.filterwarnings("ignore:Gimbal lock")
@pytest.mark.parametrize("seed", first(1, SEEDS))
def test_a_drawn_program_is_carried_out_or_refused_at_its_place(tmp_path: Path, seed: int) -> None:
    print(f"again: python tests/campaigns/motions.py --only {seed}")
    drawn_case(seed).write(tmp_path)
    verdict = judged(tmp_path, seed, full=False)
    assert not verdict.finding, verdict.finding


def test_drawn_postures_keep_inside_of_limits_on_either_side() -> None:
    lower, upper = np.array([-2.0, 1.0, -3.0, 0.0, -np.inf]), np.array([2.0, 2.0, -1.0, 0.0, np.inf])
    low, high = inside(lower, upper)
    assert np.all((lower < low) & (high < upper) == [True, True, True, False, False])
    assert np.array_equal([low[3:], high[3:]], [lower[3:], upper[3:]])


def test_a_fault_of_the_campaign_is_a_finding_that_names_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """The programs behind it go on."""
    monkeypatch.setattr(motions, "drawn_case", lambda *_: {}["no such kind"])
    tally = motions.Tally()
    for outcome in islice(motions.outcomes(7, 1), 2):
        tally.add(outcome)
    assert "seed 8 (not drawn): campaign: KeyError('no such kind')" in tally.figures()
    assert "Traceback" in tally.findings[0].verdict.finding


@pytest.mark.parametrize(
    ("folder", "full"),
    [_case(folder, full) for folder in CORPUS for full in (False, True) if full or folder.name != IN_FULL],
)
def test_what_was_found_once_stays_mended(tmp_path: Path, folder: Path, full: bool) -> None:
    """What must hold is in its note: the program runs to its end, and everything about it is true."""
    for file in folder.iterdir():
        shutil.copy(file, tmp_path)
    verdict = judged(tmp_path, 0 if full else ONCE, full)
    assert not verdict.finding, verdict.finding
    assert not verdict.code, verdict.message
    assert (folder / "note.txt").read_text(encoding="utf-8").strip()


@pytest.mark.filterwarnings("ignore:Gimbal lock")
@pytest.mark.req("QA-03")
@pytest.mark.slow
def test_a_sample_uses_every_rule_of_the_grammar(sample) -> None:
    used, names = rules(sample, build_grammar())
    assert names - set(used) == UNUSED


@pytest.mark.filterwarnings("ignore:Gimbal lock")
@pytest.mark.slow
def test_a_sample_uses_every_option_and_kind_of_robot(sample) -> None:
    counts = noted(sample)
    assert [word for word in WANTED if not counts[word]] == []


@pytest.mark.filterwarnings("ignore:Gimbal lock")
@pytest.mark.parametrize("kind", first(3, KINDS))
def test_a_seed_gives_the_same_program(kind: str) -> None:
    assert drawn_case(7, kind).files == drawn_case(7, kind).files


def test_refusals_are_codes() -> None:
    assert CATALOGUE.keys() >= REFUSALS


def test_a_finding_is_made_smaller(tmp_path: Path) -> None:
    """Of a program with an error what is left is little more than the error."""
    files = {
        "program.irl": "PROGRAM p;\nSYSTEM SPECIFICATION cell;\nVAR REAL: x := 1;\nBEGIN\n  x := 2;\n"
        "  IF x > 1 THEN\n    x := nobody;\n  ENDIF;\n  x := 3;\nENDPROGRAM;\n",
        "cell.toml": '[robot]\nmodel = "planar3"\n[motion]\ntick_ms = 10\n',
        "numbers.txt": "1 2 3\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert kind_of(judged(tmp_path, 0).finding) == "check IRL201"
    found = smaller(files, 0)
    assert found.keys() == {"program.irl", "cell.toml"}
    assert len(found["program.irl"].splitlines()) <= 6
    assert "[motion]" not in found["cell.toml"]
