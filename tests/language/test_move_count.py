"""How many moves a program makes by its text: what its blocks say, or nobody knows."""

from __future__ import annotations

from pathlib import Path

import pytest

import irlx
from irlx.blocks import MoveBlock, ReconfigureBlock
from irlx.job import prepare
from irlx.language import tree
from irlx.language.analysis import analyse
from irlx.language.move_count import move_count
from irlx.language.source import decode_source
from irlx.pipeline import Execution

PROGRAMS = Path(__file__).resolve().parents[2] / "programs"
STRAIGHT = (
    "koch/square.irl",
    "koch/reconfiguration.irl",
    "window/window.irl",
    "gantry/gantry.irl",
    "two_arms/two_arms.irl",
)
TARGET = "POSITION(1, 2, 3)"


def count(body: str, declarations: str = "") -> int | None:
    text = f"PROGRAM p;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM;\n"
    root = analyse(decode_source("p.irl", text.encode())).tree
    assert isinstance(root, tree.Program)
    return move_count(root)


@pytest.mark.req("REP-01")
@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("", 0),
        (f"MOVE LIN {TARGET};", 1),
        (f"MOVE LIN {TARGET}, {TARGET}, {TARGET}; MOVE PTP {TARGET};", 4),
        (f"MOVE CIRCLE {TARGET}, {TARGET}, {TARGET}, {TARGET};", 2),
        (f"MOVE LIN PATH ({TARGET}, {TARGET}, {TARGET});", 1),
        ("IF IN_1 THEN WAIT 1 SEC; ENDIF; MOVE_INC LIN POSITION(1, 0, 0);", 1),
        (f"IF IN_1 THEN MOVE LIN {TARGET}; ENDIF;", None),
        (f"FOR i := 1 TO 3 DO MOVE LIN {TARGET}; ENDFOR;", None),
        (f"REPEAT MOVE LIN {TARGET}; UNTIL IN_1;", None),
        (f"MOVE LIN {TARGET}; IF IN_1 THEN HALT; ENDIF; MOVE LIN {TARGET};", None),
        (f"a: MOVE LIN {TARGET}; GOTO a;", None),
    ],
)
def test_of_the_main_statements(body: str, expected: int | None) -> None:
    assert (
        count(body, "VAR INT: i; SIGNAL BOOL: IN_1 := INPUT(1);" if "IN_1" in body else "VAR INT: i;")
        == expected
    )


def test_what_a_routine_moves_nobody_counts() -> None:
    routine = f"PROCEDURE go();\nBEGIN\n  MOVE LIN {TARGET};\nENDPROC;"
    assert count("go();", routine) is None
    assert count(f"MOVE LIN {TARGET};", routine.replace(f"MOVE LIN {TARGET}", "WAIT 1 SEC")) == 1


@pytest.mark.req("REP-01")
@pytest.mark.parametrize("name", STRAIGHT)
def test_straight_programs_make_as_many(name: str) -> None:
    program = irlx.load(PROGRAMS / name)
    blocks = Execution(prepare(program)).blocks()
    moves = [block for block in blocks if isinstance(block, MoveBlock | ReconfigureBlock)]
    assert program.move_count in (None, len(moves))
    assert program.move_count is not None or name.startswith("two_arms")
