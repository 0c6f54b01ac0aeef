"""Runs the conformance cases, and looks whether they use the whole grammar and are what they should be."""

import shutil
from pathlib import Path

import pytest

from compiled_grammar import build_grammar
from irlx.cli.main import main
from irlx.conformance import find_cases, run_case, update_case
from irlx.language.lexing import lex
from irlx.language.parser import parse
from irlx.language.source import decode_source

ROOT = Path(__file__).parent
CASES = find_cases(ROOT)
UNEXERCISED = frozenset()
"""Rules of the grammar that no conformance program uses, because no program can yet."""


@pytest.mark.req("QA-02")
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_case(case):
    outcome = run_case(case)
    assert outcome.passed, outcome.reason


@pytest.mark.req("QA-02")
def test_there_are_enough_of_both_kinds():
    must_fail = sum(case.must_fail for case in CASES)
    assert len(CASES) >= 150
    assert 3 * must_fail >= len(CASES)


@pytest.mark.req("QA-02")
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_every_program_says_what_it_shows_and_is_small(case):
    text = (case.folder / "program.irl").read_text(encoding="utf-8")
    assert text.startswith("{ ")
    assert text.index("}") > 10
    assert len(text.splitlines()) <= 40
    if case.must_fail:
        assert (case.folder / "error.txt").read_text(encoding="utf-8").strip()


def rules_used(texts):
    """Names of the grammar's rules that a parser reduces by over all texts; and those of all rules."""
    grammar = build_grammar()
    used = set()

    def noting(rule, build):
        def reduce(children):
            used.add(rule.origin.name)
            return build(children)

        return reduce

    def parser():
        interactive = grammar.parse_interactive()
        conf = interactive.parser_state.parse_conf
        conf.callbacks = {rule: noting(rule, build) for rule, build in plain.items()}
        return interactive

    plain = dict(grammar.parse_interactive().parser_state.parse_conf.callbacks)
    for source in texts:
        interactive = parser()
        for token in lex(source).tokens:
            interactive.feed_token(token)
        interactive.feed_eof()
    names = {rule.origin.name for rule in grammar.rules if not rule.origin.name.startswith("__")}
    return used, names


@pytest.mark.req("QA-03")
def test_every_rule_of_the_grammar_is_used():
    files = sorted([*ROOT.rglob("*.irl"), *ROOT.rglob("*.dat")])
    sources = [decode_source(path.name, path.read_bytes()) for path in files]
    sound = [source for source in sources if not parse(source).findings]
    used, names = rules_used(sound)
    assert names - used == UNEXERCISED


@pytest.fixture
def copied(tmp_path):
    """A folder with one accepted and one must-fail case."""
    root = tmp_path / "cases"
    for name in ("types/records_are_values", "types/index_outside"):
        shutil.copytree(ROOT / name, root / name)
    shutil.copy(ROOT / "cell.toml", root)
    return root


@pytest.mark.req("QA-02")
def test_an_accepted_program_that_must_fail_fails(copied, capsys):
    good = copied / "types/records_are_values"
    (good / "blocks.txt").rename(good / "error.txt")
    assert main(["conformance", str(copied)]) == 1
    told = capsys.readouterr().out
    assert "FAILED types/records_are_values: must fail, but is accepted" in told
    assert told.endswith("2 cases, 2 of them must fail: 1 failed\n")
    # Updating does not make it right.
    assert main(["conformance", str(copied), "--update"]) == 1


@pytest.mark.req("QA-02")
def test_a_failing_program_that_must_be_accepted_fails(copied, capsys):
    bad = copied / "types/index_outside"
    (bad / "error.txt").rename(bad / "blocks.txt")
    before = (bad / "blocks.txt").read_text()
    assert main(["conformance", str(copied), "--update"]) == 1
    assert "must be accepted, but fails" in capsys.readouterr().out
    assert (bad / "blocks.txt").read_text() == before


@pytest.mark.req("QA-02")
def test_differences_are_shown_and_update_writes(copied, capsys):
    path = copied / "types/records_are_values/blocks.txt"
    sound = path.read_text()
    path.write_text(sound.replace("(9 2 3)", "(8 2 3)"))
    assert main(["conformance", str(copied)]) == 1
    told = capsys.readouterr().out
    assert "-2 MOVE LIN to (8 2 3)" in told
    assert "+2 MOVE LIN to (9 2 3)" in told
    assert main(["conformance", str(copied), "--update"]) == 0
    assert path.read_text() == sound


def test_folders_that_are_no_cases(copied, tmp_path, capsys):
    assert main(["conformance", str(tmp_path / "none")]) == 2
    assert "no cases below" in capsys.readouterr().err
    (copied / "types/index_outside/check.txt").touch()
    (case,) = [case for case in find_cases(copied) if case.name == "types/index_outside"]
    assert "needs one of" in run_case(case).reason
    assert not update_case(case)


def test_one_area_has_the_cell_of_all():
    whole = {case.folder: case.cell for case in CASES if case.name.startswith("lexical/")}
    assert {case.folder: case.cell for case in find_cases(ROOT / "lexical")} == whole
