"""The program beside the robot: statements of several lines, and the dots of events."""

import pytest

from made_page import FRAMES, made_data

PROGRAM = """PROGRAM made;
{ Above. }
BEGIN
  x := 1;
  MOVE LIN
    { no end; }
    POSITION(0, 0, 0)

    SPEED := 100;
  { between }
  MOVE LIN p2; y := ';';
  z := 2;
ENDPROGRAM
"""
FIRST, LAST, NEXT = 5, 9, 11
KINDS = ("message", "wait", "slowed", "limit", "signal")


@pytest.fixture(scope="module")
def shown(made, open_page):
    data = made_data()
    lines = [FIRST if tick <= 50 else NEXT for tick in range(FRAMES)]
    event = data["events"][0]
    with open_page(
        made(
            program={**data["program"], "text": PROGRAM},
            frames={**data["frames"], "line": [0, *lines[1:]]},
            events=[{**event, "kind": kind, "line": FIRST} for kind in KINDS],
        ),
        drawn=False,
    ) as page:
        yield page


def lit(shown):
    return shown.page.locator("#program .lit").evaluate_all("all => all.map(row => Number(row.dataset.line))")


def test_all_lines_of_a_statement_are_lit(shown):
    shown.seek(0)
    assert lit(shown) == []
    shown.seek(20)
    assert lit(shown) == list(range(FIRST, LAST + 1))
    assert shown.page.locator("#program [aria-current]").get_attribute("data-line") == str(FIRST)
    shown.seek(60)
    assert lit(shown) == [NEXT]


@pytest.mark.parametrize("line", [FIRST + 1, LAST])
def test_a_press_on_any_line_of_a_statement_seeks_to_it(shown, line):
    shown.seek(60)
    shown.page.locator(f"#program li[data-line='{line}'] > .number").click()
    assert shown.run("() => irlx.frame") == 1


@pytest.mark.parametrize("line", [4, LAST + 1, 12])
def test_a_press_elsewhere_does_nothing(shown, line):
    shown.seek(60)
    shown.page.locator(f"#program li[data-line='{line}'] > .number").click()
    assert shown.run("() => irlx.frame") == 60


def test_dots_stand_beside_the_number(shown):
    dots, number = shown.run(
        """line => {
            const beside = document.querySelector(`#program li[data-line='${line}'] > .number`);
            const range = document.createRange();
            range.selectNodeContents(beside.lastChild);
            const dots = [...beside.querySelectorAll('.mark')].map(dot => dot.getBoundingClientRect().right);
            return [dots, range.getBoundingClientRect().left];
        }""",
        FIRST,
    )
    assert len(dots) == 3
    assert max(dots) < number
