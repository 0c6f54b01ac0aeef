"""The campaign of mutants: which damages there are; those that nobody can notice are of the code of today."""

from pathlib import Path

import pytest
from mutants import SOURCE, equivalent
from mutations import mutated, mutations_of

MODULE = '''"""A module."""
import math

SCALE = 2.0


def grown(x: float, most: float = 8.0) -> float:
    """A text is no code."""
    if x > most and x < 100:
        raise ValueError(f"{x} is more than {most}")
    y = SCALE * x + 1
    return min(y, most)
'''


@pytest.fixture
def module(tmp_path):
    (tmp_path / "grown.py").write_text(MODULE, encoding="utf-8")
    return tmp_path


@pytest.mark.req("QA-07")
def test_damages_of_a_small_module(module):
    damages = {(one.old, one.new) for one in mutations_of(module, (module / "grown.py").relative_to(module))}
    assert {
        ("if x > most and x < 100:", "if x >= most and x < 100:"),
        ("if x > most and x < 100:", "if x > most or x < 100:"),
        ("y = SCALE * x + 1", "y = SCALE * x - 1"),
        ("y = SCALE * x + 1", "y = SCALE / x + 1"),
        ("return min(y, most)", "return max(y, most)"),
    } <= damages
    told = " ".join(new for _, new in damages)
    assert "more than" not in told.replace('f"{x} is more than {most}"', "")


@pytest.mark.req("QA-07")
def test_each_damage_changes_the_code_in_one_place(module):
    path = (module / "grown.py").relative_to(module)
    whole = compile(MODULE, "grown.py", "exec")
    for damage in mutations_of(module, path):
        assert damage.old != damage.new
        code = compile(mutated(module, damage), "grown.py", "exec")
        assert code.co_code + repr(code.co_consts).encode() != whole.co_code + repr(whole.co_consts).encode()


@pytest.mark.req("QA-07")
def test_damages_that_nobody_can_notice_are_of_the_code_of_today():
    listed = equivalent()
    paths = {Path(file) for file, *_ in listed}
    known = [one for path in paths for one in mutations_of(SOURCE, path)]
    there = {(one.path.as_posix(), one.function, one.old, one.new) for one in known}
    assert sorted(set(listed) - there) == []
    assert all(len(reason) > 10 for reason in listed.values())
