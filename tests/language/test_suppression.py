"""Comments that make irlx ignore a warning."""

import pytest

import irlx
from irlx.language.analysis import analyse
from irlx.language.source import source_text


def codes(body, declarations=""):
    text = f"PROGRAM t; {declarations}\nBEGIN\n{body}\nENDPROGRAM"
    return [d.code for d in analyse(source_text("t.irl", text)).diagnostics]


@pytest.mark.req("LANG-02")
@pytest.mark.parametrize(
    "comment",
    [
        "{ irlx: ignore IRL205 }",
        "{irlx:ignore irl205}",
        "(* IRLX : Ignore IRL205 *)",
        "(*irlx: ignore\n IRL205*)",
        "{ irlx: ignore IRL205 } { irlx: ignore IRL205 }",
    ],
)
def test_a_warning_is_ignored(comment):
    assert codes("OUT_3 := TRUE;") == ["IRL205"]
    assert codes(f"OUT_3 := TRUE; {comment}") == []
    assert codes(f"{comment} OUT_3 := TRUE;") == ([] if "\n" not in comment else ["IRL140", "IRL205"])


@pytest.mark.req("LANG-02")
def test_several_codes_in_one_comment():
    body = "IF IN_1 = TRUE  { irlx: ignore IRL104, IRL205 }\nOUT_2 := TRUE; ENDIF;"
    assert codes(body) == ["IRL205"]
    assert codes(body.replace(", IRL", " IRL")) == ["IRL205"]


@pytest.mark.req("LANG-02")
@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("{ irlx: ignore IRL205 }\nOUT_3 := TRUE;", ["IRL140", "IRL205"]),
        ("HALT; { irlx: ignore IRL205, IRL104 }", ["IRL140", "IRL140"]),
        ("x := 1; { irlx: ignore IRL201 }", ["IRL201", "IRL141"]),
        ("OUT_3 := TRUE; { irlx: ignore IRL206, IRL205, IRL2 }", ["IRL141", "IRL142"]),
        ("HALT; { irlx: ignore }", ["IRL143"]),
        ("HALT; { irlx: please be quiet }", ["IRL143"]),
        ("HALT; { irlx ignores nothing here }", []),
        ("HALT; { what irlx: ignore IRL205 means }", []),
        ("OUT_3 := TRUE; { irlx: ignore IRL205 ", ["IRL110", "IRL205"]),
        ("HALT; { irlx: ignore IRL140 }", ["IRL140"]),
    ],
)
def test_what_cannot_be_ignored_is_told(body, expected):
    assert sorted(codes(body)) == sorted(expected)


@pytest.mark.req("LANG-02")
def test_nothing_is_unused_where_text_was_left_out():
    assert codes("x := := 1; OUT_3 := TRUE; { irlx: ignore IRL205, IRL301 }") == ["IRL101"]


@pytest.mark.req("LANG-02")
def test_what_only_the_check_finds_is_ignored_there(tmp_path):
    file = tmp_path / "p.irl"
    file.write_text("PROGRAM p;\nVAR SEMAPHORE: s;  { irlx: ignore IRL591, IRL281 }\nBEGIN\nENDPROGRAM\n")
    assert irlx.check(file) == []
    assert irlx.load(file).diagnostics == ()
    file.write_text("PROGRAM p;\nBEGIN\n  HALT;  { irlx: ignore IRL591 }\nENDPROGRAM\n")
    assert [(d.code, d.place.line_and_column) for d in irlx.check(file)] == [("IRL140", (3, 25))]
    assert irlx.load(file).diagnostics == ()


@pytest.mark.req("LANG-02")
def test_a_comment_in_a_data_list(tmp_path):
    (tmp_path / "points.dat").write_text(
        "DATALIST pts; { irlx: ignore IRL243 }\nREAL: x := 1;\nENDDATALIST\n"
    )
    file = tmp_path / "p.irl"
    file.write_text("PROGRAM p;\nIMPORT DATALIST points;\nBEGIN\n  HALT;\nENDPROGRAM\n")
    assert irlx.check(file) == []
    assert irlx.check(tmp_path / "points.dat") == []
