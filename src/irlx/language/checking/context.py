"""What every part of the type check works with: names in view, findings, references."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeAlias

from irlx.diagnostics import Diagnostic, Place, Related, SourceText, report
from irlx.language import tree
from irlx.language.checking.names import Constant, Entry, Names
from irlx.language.references import Reference
from irlx.language.types import UNKNOWN, Type


class Typed(NamedTuple):
    """Type of an expression, and its value where the text alone tells it."""

    type: Type
    value: Constant | None = None


NOTHING = Typed(UNKNOWN)
"""What is known of an expression that is wrong already or cannot be known."""

_WHOLE_NUMBERS = "ROUND and TRUNC make whole numbers, DIV divides them"

Settled: TypeAlias = "Constant | Entry | None"
"""A value that the text tells, or the variable that holds it."""


@dataclass
class Facts:
    """What lints need to know of a program, gathered on the way: values at limits and targets of moves."""

    limits: list[tuple[tree.LimitSwitch | tree.WithLimit, Settled, Settled]] = field(default_factory=list)
    files: list[tuple[str, Entry, tree.Name]] = field(default_factory=list)
    """What is done with variables of type FILE: a word such as OPEN, the variable, its name there."""
    standard: set[str] = field(default_factory=set)
    """Directions of the standard channels that are used, IN or OUT."""
    targets: dict[int, tuple[Type, Settled]] = field(default_factory=dict)
    """Types and values of the targets of the main MOVEs, by the identity of their nodes."""


class Context:
    """Base of the parts of the type check; they are put together in `TypeCheck`."""

    def __init__(self, source: SourceText, names: Names) -> None:
        self.source = source
        self.names = names
        self.findings: list[Diagnostic] = []
        self.lints: list[Diagnostic] = []
        self.references: list[Reference] = []
        self.facts = Facts()
        self.announced: dict[str, str] = {}
        """Names declared further down, and what to say to whoever uses them already."""

    def typed(self, node: tree.Argument) -> Typed:
        """Type of an expression of which no type is expected."""
        raise NotImplementedError

    def fitted(self, node: tree.Argument, expected: Type) -> Typed:
        """Type of an expression where one is expected; another one is a finding, IRL222."""
        raise NotImplementedError

    def one_of(self, node: tree.Expression, candidates: tuple[Type, ...]) -> Typed:
        """Type of an expression that must be of exactly one of several types."""
        raise NotImplementedError

    def function_call(self, node: tree.FunctionCall) -> Typed:
        """Type of a call."""
        raise NotImplementedError

    def part(self, type: Type, node: tree.Designator) -> Type:
        """Type of the part of a value that the selectors of a designator lead to."""
        raise NotImplementedError

    def add(self, code: str, node: tree.Node, *, related: tuple[Related, ...] = (), **data: Any) -> None:
        """Add a finding at a node."""
        self.findings.append(report(code, self.place(node), related=related, **data))

    def lint(self, code: str, node: tree.Node, *, related: tuple[Related, ...] = (), **data: Any) -> None:
        """Add a finding that is no mistake by itself."""
        self.lints.append(report(code, self.place(node), related=related, **data))

    def status(self, type: Type, node: tree.Node, found: Typed) -> None:
        """The value of the field STATUS of a ROBTARGET; one other than 0 says more than is looked at."""
        is_number = isinstance(found.value, int) and not isinstance(found.value, bool)
        if type is self.names.types.get("robtarget") and is_number and found.value != 0:
            self.lint("IRL312", node, status=found.value)

    def mismatch(self, node: tree.Node, expected: str, found: str, help: str = "") -> None:
        """Add the finding on a value of another type than is expected, with what helps."""
        help = _WHOLE_NUMBERS if (expected, found) == ("INT", "REAL") else help
        self.findings.append(report("IRL222", self.place(node), help=help, expected=expected, found=found))

    def place(self, node: tree.Node) -> Place:
        """Place of a node."""
        return Place.in_text(self.source, node.span)

    def declared_here(self, entry: Entry) -> tuple[Related, ...]:
        """Where a name is declared, to stand with a finding on its use."""
        if entry.symbol is None or entry.symbol.source is not None:
            return ()
        return (Related("declared here", self.place(entry.symbol.name)),)

    def text(self, node: tree.Node) -> str:
        """What a program writes for a node."""
        return self.source.text[node.span.start : node.span.end]

    def trial(self, attempt: Callable[[], Typed]) -> Trial:
        """What an attempt finds, kept apart from the findings so far."""
        kept = self.findings, self.lints, self.references
        self.findings, self.lints, self.references = [], [], []
        try:
            return Trial(attempt(), self.findings, self.lints, self.references)
        finally:
            self.findings, self.lints, self.references = kept

    def keep(self, trial: Trial) -> Typed:
        """Take over what an attempt found."""
        self.findings += trial.findings
        self.lints += trial.lints
        self.references += trial.references
        return trial.typed


class Trial(NamedTuple):
    """The outcome of an attempt to give an expression a type."""

    typed: Typed
    findings: list[Diagnostic]
    lints: list[Diagnostic]
    references: list[Reference]
