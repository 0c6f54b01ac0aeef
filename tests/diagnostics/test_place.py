"""Spans, lines and columns."""

import pytest

from irlx.diagnostics import Place, SourceText, Span

TEXT = SourceText("t.irl", "one\n  zwö\r\n\nlast")


@pytest.mark.parametrize(
    ("offset", "line", "column"),
    [(0, 1, 1), (3, 1, 4), (4, 2, 1), (6, 2, 3), (11, 3, 1), (12, 4, 1), (16, 4, 5), (99, 4, 5)],
)
def test_line_and_column(offset, line, column):
    assert TEXT.line_and_column(offset) == (line, column)


def test_line_text_has_no_end_of_line():
    assert [TEXT.line_text(n) for n in range(1, TEXT.line_count + 1)] == ["one", "  zwö", "", "last"]


def test_empty_text_has_one_line():
    empty = SourceText("e.irl", "")
    assert empty.line_count == 1
    assert empty.line_and_column(0) == (1, 1)
    assert empty.line_text(1) == ""


def test_spans_join():
    assert Span(3, 5).to(Span(9, 12)) == Span(3, 12)
    assert Span(9, 12).to(Span(3, 5)) == Span(3, 12)


@pytest.mark.parametrize(("start", "end"), [(-1, 0), (2, 1)])
def test_span_refuses_what_is_no_range(start, end):
    with pytest.raises(ValueError, match="a span needs"):
        Span(start, end)


def test_place_in_words():
    assert str(Place.in_text(TEXT, Span(6, 9))) == "t.irl:2:3"
    assert str(Place("c.toml", key="robot.limits")) == "c.toml: robot.limits"
    assert str(Place("c.toml")) == "c.toml"
    assert Place("c.toml").line is None
