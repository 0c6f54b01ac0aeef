"""What the text of a criterion tells: parameters that stand there twice."""

from __future__ import annotations

from irlx.diagnostics import Diagnostic, Place, SourceText, report
from irlx.language import tree

__all__ = ["check_criterion"]


def check_criterion(node: tree.CriterionStart | tree.WithCriterion, source: SourceText) -> list[Diagnostic]:
    """Findings on one CRITERION or WITH CRITERION."""
    findings = []
    seen: set[str] = set()
    for param in node.params:
        if param.name.key in seen:
            place = Place.in_text(source, param.name.span)
            findings.append(report("IRL306", place, name=param.name.name, criterion=node.name.name))
        seen.add(param.name.key)
    return findings
