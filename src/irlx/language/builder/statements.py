"""Reductions of statements other than motion."""

from __future__ import annotations

from irlx.language import tree
from irlx.language.builder.children import Children, nodes_of, span_of
from irlx.language.token import Token


def _expressions_and_block(children: Children) -> tuple[list[tree.Expression], tuple[tree.Statement, ...]]:
    expressions = [child for child in children if not isinstance(child, (Token, tuple))]
    block = next(child for child in children if isinstance(child, tuple))
    return expressions, block


def _default_block(children: Children, word: str) -> tuple[tree.Statement, ...] | None:
    """Block of ELSE or DEFAULT, or None without one."""
    found = False
    for child in children:
        if found and isinstance(child, tuple):
            return child
        found = found or (isinstance(child, Token) and child.type == word)
    return None


class StatementBuilder:
    """Methods for the rules of statements."""

    def block(self, children: Children) -> tuple[tree.Statement, ...]:
        """Reduce a list of statements; empty statements leave nothing."""
        return nodes_of(children)

    def label(self, children: Children) -> tree.Label:
        """Reduce ``name:``."""
        return tree.Label(span_of(children), children[0])

    def assignment(self, children: Children) -> tree.Assignment:
        """Reduce ``target := value``."""
        return tree.Assignment(span_of(children), children[0], children[2])

    def call(self, children: Children) -> tree.Call:
        """Reduce a call of a procedure."""
        return tree.Call(span_of(children), children[0], nodes_of(children[1:]))

    def formatted_value(self, children: Children) -> tree.FormattedValue:
        """Reduce ``value:width:precision``."""
        precision = children[4] if len(children) > 3 else None
        return tree.FormattedValue(span_of(children), children[0], children[2], precision)

    def goto(self, children: Children) -> tree.Goto:
        """Reduce GOTO."""
        return tree.Goto(span_of(children), children[1])

    def elsif(self, children: Children) -> tree.IfBranch:
        """Reduce ELSIF."""
        end = children[3][-1] if children[3] else children[2]
        return tree.IfBranch(span_of([children[0], end]), children[1], children[3])

    def when(self, children: Children) -> tree.CaseBranch:
        """Reduce WHEN."""
        body = children[-1]
        end = body[-1] if body else children[-2]
        return tree.CaseBranch(span_of([children[0], end]), nodes_of(children[:-1]), body)

    def case(self, children: Children) -> tree.Case:
        """Reduce CASE."""
        branches = tuple([child for child in children if isinstance(child, tree.CaseBranch)])
        return tree.Case(span_of(children), children[1], branches, _default_block(children, "DEFAULT"))

    def repeat(self, children: Children) -> tree.Repeat:
        """Reduce REPEAT."""
        return tree.Repeat(span_of(children), children[1], children[3])

    def exit(self, children: Children) -> tree.Exit:
        """Reduce EXIT."""
        return tree.Exit(span_of(children))

    def halt(self, children: Children) -> tree.Halt:
        """Reduce HALT."""
        return tree.Halt(span_of(children))

    def pause(self, children: Children) -> tree.Pause:
        """Reduce PAUSE."""
        return tree.Pause(span_of(children))

    def wait_time(self, children: Children) -> tree.WaitTime:
        """Reduce WAIT .. SEC."""
        return tree.WaitTime(span_of(children), children[1])

    def wait_for(self, children: Children) -> tree.WaitFor:
        """Reduce WAIT FOR."""
        timeout = children[4] if len(children) > 3 else None
        return tree.WaitFor(span_of(children), children[2], timeout)


# Rules named like words of Python have to be attached by name.
def _return(self: StatementBuilder, children: Children) -> tree.Return:
    """Reduce RETURN."""
    return tree.Return(span_of(children), children[1] if len(children) > 1 else None)


def _if(self: StatementBuilder, children: Children) -> tree.If:
    """Reduce IF."""
    body = children[3]
    end = body[-1] if body else children[2]
    first = tree.IfBranch(span_of([children[0], end]), children[1], body)
    others = tuple([child for child in children if isinstance(child, tree.IfBranch)])
    return tree.If(span_of(children), (first, *others), _default_block(children, "ELSE"))


def _for(self: StatementBuilder, children: Children) -> tree.For:
    """Reduce FOR."""
    expressions, body = _expressions_and_block(children)
    variable, start, stop = expressions[:3]
    step = expressions[3] if len(expressions) > 3 else None
    down = children[4].type == "DOWNTO"
    assert isinstance(variable, tree.Designator)
    return tree.For(span_of(children), variable, start, stop, down, step, body)


def _while(self: StatementBuilder, children: Children) -> tree.While:
    """Reduce WHILE."""
    return tree.While(span_of(children), children[1], children[3])


for _word, _method in (("return", _return), ("if", _if), ("for", _for), ("while", _while)):
    setattr(StatementBuilder, _word, _method)
