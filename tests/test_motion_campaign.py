"""Random programs of every kind of move, joined and not, on three robots: verified, or refused with a code.

The long part (`-m slow`) runs the same with many more seeds.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

import irlx
from drawn_programs import KINDS, MIXED, write_program
from long_run import first, portions

QUICK, LONG = range(24), range(1000, 2000)
REFUSALS = {
    "IRL345",
    "IRL421",
    "IRL422",
    "IRL424",
    "IRL427",
    "IRL428",
    "IRL429",
    "IRL434",
    "IRL435",
    "IRL520",
    "IRL521",
    "IRL522",
    "IRL523",
    "IRL524",
}


def outcome(folder: Path, seed: int, kinds: tuple[str, ...] = KINDS) -> tuple[str, int]:
    """Run and verify a program; the code of its refusal or '', how many corners pass between PTP and path."""
    write_program(folder, seed, kinds)
    code = refused = ""
    try:
        run = irlx.run(folder / "drawn.irl")
    except irlx.RunError as error:
        run, code = error.run, error.reason.code
        refused = str(error)
    assert not code or code in REFUSALS, refused
    report = irlx.verify(run, program=folder / "drawn.irl", cell=folder / "drawn.toml")
    failed = [f"{check.name}: {check.text}" for check in report.failed if check.name != "complete"]
    assert failed == [], failed
    return code, sum(note.code == "IRL436" for note in run.diagnostics)


@pytest.mark.req("QA-05")
@pytest.mark.parametrize("seed", first(2, QUICK))
def test_drawn_programs(tmp_path, seed) -> None:
    outcome(tmp_path, seed)


@pytest.mark.slow
@pytest.mark.parametrize("seeds", portions(LONG), ids=str)
def test_many_drawn_programs(tmp_path, seeds) -> None:
    for seed in seeds:
        print("seed", seed)
        outcome(tmp_path, seed)


@pytest.fixture(scope="module")
def joined(tmp_path_factory) -> Callable[[int], int]:
    """Corners between PTP and path that the program of a seed passes, each program run once."""
    return cache(lambda seed: outcome(tmp_path_factory.mktemp("mixed"), seed, MIXED)[1])


@pytest.mark.req("MOT-06")
@pytest.mark.parametrize("seed", first(2, QUICK))
def test_drawn_programs_of_ptps_beside_paths(joined, seed) -> None:
    assert joined(seed) >= 0


@pytest.mark.req("MOT-06")
@pytest.mark.slow
def test_some_of_them_are_joined(joined) -> None:
    assert sum(joined(seed) for seed in list(QUICK)[:6]) > 1


@pytest.mark.slow
@pytest.mark.parametrize("seeds", portions(LONG), ids=str)
def test_many_drawn_programs_of_ptps_beside_paths(tmp_path, seeds) -> None:
    for seed in seeds:
        print("seed", seed)
        outcome(tmp_path, seed, MIXED)
