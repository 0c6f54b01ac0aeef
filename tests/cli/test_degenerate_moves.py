"""Moves at the edge of what has a meaning: each becomes a verified stream or a coded refusal."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import irlx
from long_run import first

HOME = "MOVE LIN POSITION(441, 200, 324);"


def run(folder: Path, statements: str, robot: str = "arm7", first: str = HOME) -> irlx.Run:
    """The verified run of statements behind a common start."""
    (folder / "p.toml").write_text(f'[robot]\nmodel = "{robot}"\n')
    (folder / "p.irl").write_text(f"PROGRAM p;\nBEGIN\n{first}\n{statements}\nENDPROGRAM;\n")
    found = irlx.run(folder / "p.irl")
    assert irlx.verify(found, program=folder / "p.irl", cell=folder / "p.toml").passed
    return found


def codes(found: irlx.Run) -> list[str]:
    return [one.code for one in found.diagnostics]


@pytest.mark.req("MOT-04")
@pytest.mark.parametrize(
    "statements",
    [
        "MOVE LIN POSITION(441, 200, 324);",
        "MOVE_INC LIN POSITION(0, 0, 0);",
        "MOVE_INC LIN POSITION(0, 0, 1E-10);",
        "MOVE LIN POSITION(441, 200, 324) C_CP := 10;",
        "MOVE LIN PATH (POSITION(441, 200, 324), POSITION(441, 200, 324));",
        "MOVE PTP POSITION(441, 200, 324) C_PTP := 50;",
    ],
)
def test_what_is_there_already_takes_no_tick(tmp_path, statements) -> None:
    found = run(tmp_path, statements)
    assert set(found.block.tolist()) <= {0, 1}


@pytest.mark.req("MOT-01")
def test_a_nanometre_is_a_move_of_one_tick(tmp_path) -> None:
    """Just above the 1e-9 m below which nothing moves; a tick, and the one that holds."""
    found = run(tmp_path, "MOVE_INC LIN POSITION(0, 0, 1.5E-6);")
    assert int(np.count_nonzero(found.block == 2)) == 2
    assert found.tool[-1, 2] - found.tool[found.block == 1][-1, 2] == pytest.approx(1.5e-9, rel=1e-4)


@pytest.mark.req("MOT-01")
@pytest.mark.parametrize(
    ("statements", "code"),
    [
        ("MOVE CIRCLE POSITION(441, 150, 324), POSITION(441, 100, 324);", "IRL428"),
        ("MOVE CIRCLE POSITION(441, 200, 324), POSITION(441, 100, 324);", "IRL427"),
        ("MOVE SPLINE PATH (POSITION(441, 100, 324), POSITION(441, 100, 324));", "IRL434"),
        ("MOVE SPLINE PATH (POSITION(441, 100, 324), POSITION(441, 200, 324));", "IRL435"),
        ("MOVE LIN POSITION(441, 100, 324) TIME := 0.01;", "IRL421"),
        (
            "MOVE LIN POSITION(441, 100, 324) C_CP := 5 TIME := 0.01; MOVE LIN POSITION(541, 100, 324);",
            "IRL421",
        ),
        ("MOVE_INC LIN POSE(POSITION(0, 0, 0), ORIVANG((0, 0, 1), 180));", "IRL422"),
        ("MOVE_INC LIN POSITION(10000000, 0, 0);", "IRL425"),
        ("MOVE_INC LIN POSITION(10000000, 0, 0) SPEED := 1E5, ACC := 1E5;", "IRL520"),
        ("MOVE_INC LIN POSITION(1E200, 0, 0);", "IRL425"),
    ],
)
def test_what_has_no_meaning_is_refused_at_its_place(tmp_path, statements, code) -> None:
    with pytest.raises(irlx.RunError) as caught:
        run(tmp_path, statements)
    assert caught.value.reason.code == code
    assert caught.value.reason.place is not None
    assert caught.value.reason.place.line == 4


@pytest.mark.req("MOT-06")
def test_a_reversal_stops_with_a_note(tmp_path) -> None:
    found = run(tmp_path, "MOVE LIN POSITION(441, 100, 324) C_CP := 20; MOVE LIN POSITION(441, 200, 324);")
    assert codes(found) == ["IRL432"]
    corner = found.tool[found.block == 2][-1, :3]
    np.testing.assert_allclose(corner, [0.441, 0.1, 0.324], atol=1e-6)


@pytest.mark.req("MOT-01")
def test_a_full_circle_ends_where_it_began(tmp_path) -> None:
    found = run(tmp_path, "MOVE CIRCLE POSITION(441, 150, 374), POSITION(441, 100, 324) ANGLE := 360;")
    np.testing.assert_allclose(found.tool[-1, :3], found.tool[found.block == 1][-1, :3], atol=1e-12)
    way = np.diff(found.tool[found.block == 2, :3], axis=0)
    assert np.sum(np.linalg.norm(way, axis=1)) == pytest.approx(2 * np.pi * 0.05, rel=1e-2)


@pytest.mark.req("MOT-22")
@pytest.mark.parametrize("beyond", first(1, [1.0, 100.0]))
def test_a_path_that_leaves_the_workspace_is_refused_with_what_is_missing(tmp_path, beyond) -> None:
    """`planar3` reaches 1 m, stretched."""
    target = f"(({1000.0 + beyond}, 0, 0), ORIZYX(0, 0, 0))"
    with pytest.raises(irlx.RunError) as caught:
        run(tmp_path, f"MOVE LIN {target};", "planar3", "")
    reason = caught.value.reason
    assert reason.code == "IRL521"
    assert f"leaves {beyond:g} mm" in reason.message
    # What was done until then is kept, and at rest on the way.
    assert not caught.value.run.complete


@pytest.mark.req("MOT-22")
def test_a_path_to_the_edge_of_the_workspace_is_run(tmp_path) -> None:
    found = run(tmp_path, "MOVE LIN ((999, 0, 0), ORIZYX(0, 0, 0));", "planar3", "")
    np.testing.assert_allclose(found.tool[-1, :3], [0.999, 0.0, 0.0], atol=1e-6)


@pytest.mark.req("LANG-54")
def test_an_output_fires_at_the_tick_nearest_to_the_corner(tmp_path) -> None:
    declared = "MOVE LIN POSITION(441, 100, 324) C_CP := 30; OUT_1 := TRUE; MOVE LIN POSITION(541, 100, 324);"
    found = run(tmp_path, declared)
    (signal,) = found.signals
    nearest = int(np.argmin(np.linalg.norm(found.tool[:, :3] - [0.441, 0.1, 0.324], axis=1)))
    assert abs(signal.tick - nearest) <= 1


@pytest.mark.req("LANG-54")
@pytest.mark.parametrize(
    ("between", "lost"),
    [
        ("x := x + 1;", False),
        ("FOR i := 1 TO 3 DO x := FLOAT(i); ENDFOR;", False),
        ("q := FK(j);", False),
        ("OUT_2 := TRUE;", False),
        ("WAIT 0.1 SEC;", True),
        ("PAUSE;", True),
        ("j := R_JOINT_ACT.M_JOINT;", True),
        ("x := R_MOVE_TIME;", True),
        ("IF IN_1 THEN x := 1; ENDIF;", True),
        ("WRITELN('here');", True),
        ("R_TOOL.POS.Z := 10;", True),
        ("FREEZESTART 1; FREEZEEND;", True),
    ],
)
def test_what_is_transparent_and_what_stops(tmp_path, between, lost) -> None:
    (tmp_path / "p.toml").write_text(
        '[robot]\nmodel = "arm7"\n[signals.inputs]\nIN_1 = [[0.0, true]]\n', encoding="utf-8"
    )
    (tmp_path / "p.irl").write_text(
        f"PROGRAM p;\nVAR INT: i := 0; REAL: x := 0; MAIN_JOINT: j; POSE: q;\n"
        f"BEGIN\nj := R_JOINT_ACT.M_JOINT;\n{HOME}\n"
        f"MOVE LIN POSITION(441, 100, 324) C_CP := 20;\n{between}\nMOVE LIN POSITION(541, 100, 324);\n"
        "WRITELN(x, i);\nENDPROGRAM;\n"
    )
    found = irlx.run(tmp_path / "p.irl")
    notes = [one for one in found.diagnostics if one.code == "IRL432"]
    assert bool(notes) is lost
    nearest = float(np.min(np.linalg.norm(found.tool[:, :3] - [0.441, 0.1, 0.324], axis=1)))
    assert (nearest < 1e-6) is lost
    for note in notes:
        assert note.place is not None
        assert note.place.line == 6
        assert note.related[0].place.line == 7
