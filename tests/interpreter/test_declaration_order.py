"""Parts of a program come in any order (LANG-10)."""

from __future__ import annotations

import pytest

import irlx

JOINTS = ", ".join(f"b{number}" for number in range(1, 12))


def run(tmp_path, declarations: str, statements: str):
    (tmp_path / "p.toml").write_text('[robot]\nmodel = "koch11"\n')
    (tmp_path / "p.irl").write_text(f"PROGRAM p;\n{declarations}\nBEGIN\n{statements}\nENDPROGRAM;\n")
    return irlx.run(tmp_path / "p.irl")


@pytest.mark.req("LANG-10")
def test_a_variable_may_stand_before_its_type(tmp_path) -> None:
    declarations = f"VAR MAIN_JOINT: h;\nTYPE RECORD REAL: {JOINTS}; ENDRECORD = MAIN_JOINT;"
    finished = run(
        tmp_path, declarations, "h := R_JOINT_ACT.M_JOINT; h.b1 := h.b1 + 1; MOVE PTP h TIME := 1;"
    )
    assert finished.q[-1, 0] - finished.q[0, 0] == pytest.approx(0.017453292519943295)


@pytest.mark.req("LANG-10")
def test_a_constant_may_give_the_bounds_of_an_array_type(tmp_path) -> None:
    declarations = "VAR line: x;\nCONST INT: last := 3;\nTYPE ARRAY [1..last] OF REAL = line;"
    assert run(tmp_path, declarations, "x[3] := 1; x[2] := x[3];").complete


@pytest.mark.req("LANG-22")
@pytest.mark.parametrize("name", ["POSE", "JOINT", "REAL"])
def test_a_predefined_type_that_means_one_thing_is_not_defined_again(tmp_path, name: str) -> None:
    with pytest.raises(irlx.IrlxError) as caught:
        run(tmp_path, f"TYPE RECORD REAL: a; ENDRECORD = {name};", "")
    assert caught.value.reason.code == "IRL202"
