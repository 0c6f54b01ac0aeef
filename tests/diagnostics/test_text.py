"""The renderer for people: excerpt and carets."""

import pytest

from irlx.diagnostics import Place, Related, SourceText, Span, report
from irlx.diagnostics.text import render_text


def rendered(text, start, end, **more):
    source = SourceText("t.irl", text)
    return render_text(report("IRL112", Place.in_text(source, Span(start, end)), character="X", **more))


@pytest.mark.req("LANG-75")
@pytest.mark.parametrize(
    ("text", "start", "end", "excerpt"),
    [
        ("x := y;", 5, 6, [" 1 | x := y;", "   |      ^"]),
        ("\tx := yy;", 6, 8, [" 1 |     x := yy;", "   |          ^^"]),
        ("漢 := y;", 5, 6, [" 1 | 漢 := y;", "   |       ^"]),
        ("漢字 := y;", 0, 2, [" 1 | 漢字 := y;", "   | ^^^^"]),
        ("e\u0301x := y;", 3, 5, [" 1 | e\u0301x := y;", "   |   ^^"]),
        ("a\nbc", 4, 4, [" 2 | bc", "   |   ^"]),
        ("a\nbc\n", 5, 5, [" 3 | ", "   | ^"]),
        ("ab\ncd", 1, 5, [" 1 | ab", "   |  ^"]),
    ],
)
def test_excerpt(text, start, end, excerpt):
    assert rendered(text, start, end).split("\n")[1:3] == excerpt


@pytest.mark.req("LANG-75")
def test_whole_rendering():
    source = SourceText("t.irl", "GOTO a;\nb: x;")
    related = Related("the label", Place.in_text(source, Span(8, 9)))
    place = Place.in_text(source, Span(5, 6))
    shown = render_text(report("IRL215", place, related=(related,), name="a", near=""))
    assert shown == (
        "t.irl:1:6: error IRL215: unknown label 'a'\n"
        " 1 | GOTO a;\n"
        "   |      ^\n"
        "  t.irl:2:1: the label\n"
        " 2 | b: x;\n"
        "   | ^\n"
        "  help: write 'name:' before the statement to jump to"
    )
