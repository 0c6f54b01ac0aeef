"""Every form that the monograph's listings use."""

from pathlib import Path

import pytest

from irlx.language import tree
from irlx.language.analysis import analyse
from irlx.language.source import decode_source


@pytest.mark.req("LANG-68")
def test_forms_give_warnings_only():
    path = Path(__file__).parent / "data" / "forms.irl"
    analysis = analyse(decode_source("forms.irl", path.read_bytes()))
    assert [str(d) for d in analysis.diagnostics] == [
        "forms.irl:51:14: warning IRL103: missing ';' after the CYCLICSTART",
        "forms.irl:60:23: warning IRL103: missing ';' after the OBSTACLEEND",
        "forms.irl:65:52: warning IRL103: missing ';' after the MOVE",
    ]
    assert isinstance(analysis.tree, tree.Program)
    assert len(analysis.tree.body) == 29
    circle = next(n for n in tree.walk(analysis.tree) if isinstance(n, tree.Move) and n.kind == "CIRCLE")
    assert len(circle.targets) == 2
    assert [len(clause.targets) for clause in circle.clauses] == [2]
    assert len(analysis.types) == 7
