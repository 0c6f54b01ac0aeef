"""Short ways to write a program and to look at its tree."""

import pytest

from irlx.language.analysis import analyse
from irlx.language.source import source_text


@pytest.fixture
def analysed():
    """Analyse a whole text."""

    def run(text):
        return analyse(source_text("t.irl", text))

    return run


@pytest.fixture
def body_of(analysed):
    """The main statements of a program that parses without a finding of the syntax group."""

    def run(statements):
        analysis = analysed(f"PROGRAM t; BEGIN {statements} ENDPROGRAM")
        assert not [d for d in analysis.diagnostics if d.code.startswith("IRL1")], statements
        return analysis.tree.body

    return run


@pytest.fixture
def statement_of(body_of):
    """The one statement of a program."""

    def run(statement):
        (found,) = body_of(statement)
        return found

    return run


@pytest.fixture
def declarations_of(analysed):
    """The declarations of a program that parses without a finding of the syntax group."""

    def run(text):
        analysis = analysed(f"PROGRAM t; {text} BEGIN ENDPROGRAM")
        assert not [d for d in analysis.diagnostics if d.code.startswith("IRL1")], text
        return analysis.tree.declarations

    return run


@pytest.fixture
def told_of():
    """Code, message and marked text of every finding on a text; `lints` adds those that are no mistakes."""

    def run(text, *, lints=False, **more):
        found = analyse(source_text("t.irl", text), lints=lints, **more).diagnostics
        return [
            (d.code, d.message, d.place.text.text[d.place.span.start : d.place.span.end].strip())
            for d in found
        ]

    return run
