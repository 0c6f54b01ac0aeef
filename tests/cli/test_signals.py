"""Inputs, outputs and waits, from the text to the verified stream."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import irlx
from irlx.blocks import WaitBlock
from irlx.cell.errors import CellError
from irlx.cell.input_file import read_input_file
from irlx.cli.main import main
from irlx.streams import BlockRecord, read_stream

CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 10\n[signals.inputs]\n'
TENDING = """PROGRAM tending;
VAR
  INPUT BOOL: part AT 3, ready AT 4;
  INPUT INT: kind AT 1;
  OUTPUT BOOL: grip AT 1, start AT 2;
  OUTPUT REAL: spindle AT 1;
  OUTPUT BOOL: alarm AT 9;
  POSITION: store := (440, 260, 325), machine_tool := (440, 200, 380);
PROCEDURE take;
BEGIN
  grip := TRUE;
  WAIT 0.25 SEC;
ENDPROC;
BEGIN
  WAIT FOR part TIMEOUT 2 SEC;
  IF NOT part THEN
    alarm := TRUE;
    HALT;
  ENDIF;
  MOVE LIN store;
  take;
  MOVE LIN machine_tool;
  CASE kind OF
    WHEN 1: spindle := 100;
    WHEN 2, 3: spindle := 201.5;
    DEFAULT: alarm := TRUE;
  ENDCASE;
  grip := FALSE;
  start := TRUE;
  WAIT FOR ready;
  start := FALSE;
ENDPROGRAM
"""


LOOK = """
PROCEDURE look;
VAR ANALOG INPUT: inside AT 8;
BEGIN
  WRITELN(inside);
ENDPROC;
"""


def ran(folder: Path, text: str, traces: str = "", **given) -> irlx.Run:
    (folder / "p.toml").write_text(CELL + traces, encoding="utf-8")
    (folder / "p.irl").write_text(text, encoding="utf-8")
    run = irlx.run(folder / "p.irl", **given)
    report = irlx.verify(run, program=folder / "p.irl", cell=folder / "p.toml")
    assert report.passed, str(report)
    return run


def program(body: str, declarations: str = "VAR INPUT BOOL: go AT 1; OUTPUT BOOL: lamp AT 1;") -> str:
    return f"PROGRAM p; {declarations}\nBEGIN\n{body}\nENDPROGRAM\n"


def outputs(run: irlx.Run) -> list[tuple[float, str, object]]:
    return [(round(s.time, 9), s.port, s.value) for s in run.signals if not s.is_input]


@pytest.mark.req("LANG-41")
@pytest.mark.req("LANG-43")
def test_a_machine_is_tended(tmp_path: Path) -> None:
    """Times by hand: the part comes at 1.234 s, seen at the tick of 1.24 s; the moves last what they last."""
    traces = "part = [[0, false], [1.234, true]]\nAIN_1 = [[0, 2]]\nready = [[30, true]]\n"
    run = ran(tmp_path, TENDING, traces)
    moves = [
        np.flatnonzero(run.block == r.block.id) for r in run.stream.records if hasattr(r.block, "target")
    ]
    store, tool = (float(run.t[rows[-1]]) for rows in moves)
    assert run.t[moves[0][0]] == pytest.approx(1.25)
    assert outputs(run) == [
        (round(store, 9), "OUT_1", True),
        (round(tool, 9), "AOUT_1", 201.5),
        (round(tool, 9), "OUT_1", False),
        (round(tool, 9), "OUT_2", True),
        (30.0, "OUT_2", False),
    ]
    assert run.t[moves[1][0]] - store == pytest.approx(0.26)
    assert run.complete


@pytest.mark.req("LANG-41")
def test_a_part_that_does_not_come_ends_in_the_alarm(tmp_path: Path) -> None:
    run = ran(tmp_path, TENDING, "part = [[0, false]]\nAIN_1 = [[0, 2]]\nready = [[30, true]]\n")
    assert outputs(run) == [(2.0, "OUT_9", True)]
    assert run.complete
    assert len(np.unique(run.q, axis=0)) == 1


@pytest.mark.req("LANG-43")
def test_values_that_python_gives(tmp_path: Path) -> None:
    """A function is asked at every tick while the program waits; a mapping stands for traces."""
    asked = []

    def said(name: str, time: float) -> float | None:
        asked.append((name, time))
        return float(time >= 0.5) if name == "go" else None

    text = program("  WAIT FOR go;\n  lamp := go;")
    run = ran(tmp_path, text, inputs=said)
    assert outputs(run) == [(0.5, "OUT_1", True)]
    times = [time for name, time in asked if name == "go"]
    np.testing.assert_allclose(times[:51], np.arange(51) * 0.01, atol=1e-7)
    run = ran(tmp_path, text, inputs={"IN_1": [(0, 0), (0.3, 1)]})
    assert outputs(run) == [(0.3, "OUT_1", True)]


@pytest.mark.req("LANG-43")
@pytest.mark.parametrize(
    ("said", "words"),
    [
        ({"IN_1": [(1, True), (0, False)]}, "inputs= IN_1: pairs of a time in s, 0 or more and rising, and"),
        ({"IN_1": [(-1, True)]}, "inputs= IN_1: pairs of a time"),
        ({"IN_1": True}, "inputs= IN_1: pairs of a time"),
        ({"IN_1": "on"}, "inputs= IN_1: pairs of a time"),
        ({"IN_1": [(0, float("nan"))]}, "inputs= IN_1: pairs of a time"),
        (3, "inputs= 3: a path, a function of name and time, or traces by name"),
    ],
)
def test_values_of_python_that_say_nothing(tmp_path: Path, said: Any, words: str) -> None:
    with pytest.raises(irlx.IrlxError, match=f"IRL006: {words}"):
        ran(tmp_path, program("  lamp := go;"), inputs=said)


@pytest.mark.req("LANG-43")
def test_values_of_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = program("  WAIT FOR go;\n  lamp := TRUE;")
    (tmp_path / "in.csv").write_text("time,input,value\n0,go,FALSE\n0.75,go,TRUE\n", encoding="utf-8")
    run = ran(tmp_path, text, "go = [[9, true]]\n", inputs=tmp_path / "in.csv")
    assert outputs(run) == [(0.75, "OUT_1", True)]
    arguments = [str(tmp_path / "p.irl"), "--inputs", str(tmp_path / "in.csv"), "-o", str(tmp_path / "o.npz")]
    assert main(["run", *arguments]) == 0
    stream = read_stream(tmp_path / "o.npz")
    assert len(stream.q) == 76
    capsys.readouterr()
    assert main(["blocks", *arguments[:3]]) == 0
    _, *told = capsys.readouterr().out.splitlines()
    assert told == ["2 WAIT 0.75 s for go line 3", "3 READ IN_1: TRUE line 3", "4 SET OUT_1 to TRUE line 4"]
    (tmp_path / "in.csv").write_text("time,input,value\n0,go\nx,go,1\n1,go,1\n1,go,0\n", encoding="utf-8")
    capsys.readouterr()
    assert main(["run", *arguments]) == 2
    told = capsys.readouterr().err
    assert [f"line {n}" in told for n in (2, 3, 4, 5)] == [True, True, False, True]
    assert "expected a time after 1 s for go, found 1" in told


BOTH = "VAR INPUT BOOL: part AT 3, other AT 4; OUTPUT BOOL: a AT 1, b AT 2;"
COPIES = program("  a := part;\n  b := other;", BOTH)


@pytest.mark.req("LANG-43")
@pytest.mark.parametrize("name", ["part", "in_3", "PART"])
def test_what_is_given_for_an_input_counts_by_each_of_its_names_and_others_stay(
    tmp_path: Path, name: str
) -> None:
    """The cell names the input as the program does, what is given may name its port."""
    cell = "part = [[0, true]]\nIN_4 = [[0, true]]\n"
    run = ran(tmp_path, COPIES, cell, inputs={name: [(0.0, 0.0)]})
    assert outputs(run) == [(0.0, "OUT_1", False), (0.0, "OUT_2", True)]


def refused(folder: Path, text: str, given: Any) -> list[irlx.Diagnostic]:
    (folder / "p.toml").write_text(CELL + "Spare = [[0, 1]]\n", encoding="utf-8")
    (folder / "p.irl").write_text(text, encoding="utf-8")
    with pytest.raises(irlx.IrlxError) as caught:
        irlx.run(folder / "p.irl", inputs=given)
    return list(caught.value.diagnostics)


@pytest.mark.req("LANG-43")
def test_every_name_that_nothing_has_is_told_at_its_line(tmp_path: Path) -> None:
    lines = "time,input,value\n0,part,1\n0,prat,1\n0,spare,1\n1,prat,0\n0,AIN_3,1\n0,In_4,1\n"
    (tmp_path / "in.csv").write_text(lines, encoding="utf-8")
    found = refused(tmp_path, COPIES, tmp_path / "in.csv")
    assert [(one.code, one.place.key, one.data["name"]) for one in found if one.place] == [
        ("IRL649", "line 3", "prat"),
        ("IRL649", "line 6", "AIN_3"),
    ]
    assert found[0].message.endswith("has an input 'prat'; did you mean 'part'?")
    assert "inputs are part, IN_3, other, IN_4, spare;" in found[0].help
    (one,) = refused(tmp_path, COPIES, {"prat": [(0.0, 1.0)]})
    assert (one.code, one.place) == ("IRL649", None)
    assert main(["check", str(tmp_path / "p.irl"), "--motion", "--inputs", str(tmp_path / "in.csv")]) == 2


def test_names_of_ports_that_only_a_run_knows_are_let_pass(tmp_path: Path) -> None:
    """As those of modules, of ports used by their names, and of routines' own inputs are known."""
    module = "EXPORT show;\nVAR INPUT INT: level AT 7;\nPROCEDURE show;\nBEGIN\n  WRITELN(level);\nENDPROC;"
    (tmp_path / "m.irl").write_text(f"MODULE m;\n{module}\nENDMODULE\n", encoding="utf-8")
    declared = "FROM m IMPORT show; CONST INT: n := 5; VAR INPUT BOOL: part AT n + 1; OUTPUT BOOL: lamp AT 1;"
    text = program("  lamp := IN_9;\n  IF part THEN look; show; ENDIF;", declared + LOOK)
    given = {"IN_6": 1, "level": 2, "AIN_7": 2, "in_9": 0, "inside": 1, "AIN_8": 1.5}
    found = refused(tmp_path, text, {name: [(0.0, value)] for name, value in given.items()} | {"AIN_6": ()})
    assert [(one.code, one.data.get("name")) for one in found] == [("IRL649", "AIN_6")]


def test_names_that_are_no_texts(tmp_path: Path) -> None:
    (found,) = refused(tmp_path, COPIES, {3: [(0.0, 1.0)]})
    assert found.code == "IRL006"


@pytest.mark.parametrize("end", ["\r", "\r\n", "\n"])
def test_lines_of_a_file_end_in_any_way(tmp_path: Path, end: str) -> None:
    (tmp_path / "in.csv").write_bytes(end.join(["time,input,value", "0,go,FALSE", "0.5,go,TRUE"]).encode())
    assert read_input_file(tmp_path / "in.csv").traces == {"go": ((0.0, 0.0), (0.5, 1.0))}


def test_a_field_that_no_csv_holds(tmp_path: Path) -> None:
    (tmp_path / "in.csv").write_text(f"time,input,value\n0,go,1\n1,{'x' * 200_000},1\n", encoding="utf-8")
    with pytest.raises(CellError) as caught:
        read_input_file(tmp_path / "in.csv")
    assert (caught.value.reason.code, caught.value.reason.place.key) == ("IRL618", "line 3")


@pytest.mark.req("LANG-43")
def test_ports_by_their_own_names_and_media(tmp_path: Path) -> None:
    declared = "VAR DIGITAL INPUT: d AT 2; ANALOG INPUT: a AT 2; ANALOG OUTPUT: b AT 5;"
    text = program(
        "  IF IN_7 AND d THEN OUT_7 := TRUE; ENDIF;\n  b := a + 0.5;\n  AOUT_1 := AIN_9;", declared
    )
    run = ran(tmp_path, text, "IN_7 = [[0, true]]\nd = [[0, true]]\nAIN_2 = [[0, 2.25]]\nAIN_9 = [[0, 4]]\n")
    assert outputs(run) == [(0.0, "OUT_7", True), (0.0, "AOUT_5", 2.75), (0.0, "AOUT_1", 4.0)]
    assert {d.code for d in run.diagnostics} == {"IRL205"}


@pytest.mark.req("LANG-41")
@pytest.mark.parametrize(
    ("seconds", "ticks"), [("0", 0), ("0.01", 1), ("0.0100001", 2), ("0.999", 100), ("1", 100)]
)
def test_a_wait_takes_whole_ticks(tmp_path: Path, seconds: str, ticks: int) -> None:
    run = ran(tmp_path, program(f"  WAIT {seconds} SEC;\n  lamp := TRUE;"))
    assert len(run.q) == 1 + ticks
    assert np.array_equal(run.q, np.tile(run.q[0], (1 + ticks, 1)))


@pytest.mark.req("LANG-41")
def test_a_wait_looks_again_where_a_routine_reads(tmp_path: Path) -> None:
    declared = """VAR INPUT BOOL: one AT 1, two AT 2; OUTPUT BOOL: lamp AT 1;
FUNCTION both: BOOL; BEGIN RETURN one AND two; ENDFCT;"""
    run = ran(
        tmp_path,
        program("  WAIT FOR both();\n  lamp := TRUE;", declared),
        "one = [[0.2, true], [0.4, false], [0.6, true]]\ntwo = [[0.5, true]]\n",
    )
    assert outputs(run) == [(0.6, "OUT_1", True)]


@pytest.mark.req("LANG-43")
def test_what_decides_without_the_right_side_does_not_read_it(tmp_path: Path) -> None:
    declared = "VAR INPUT BOOL: one AT 1, two AT 2; OUTPUT BOOL: lamp AT 1;"
    run = ran(tmp_path, program("  IF one OR two THEN lamp := TRUE; ENDIF;", declared), "one = [[0, true]]\n")
    assert [s.port for s in run.signals] == ["IN_1", "OUT_1"]


@pytest.mark.parametrize(
    ("body", "traces", "code", "line"),
    [
        ("  lamp := go;", "", "IRL530", 3),
        ("  lamp := go;", "go = [[0, 0.5]]", "IRL531", 3),
        ("  lamp := TRUE;\n  WAIT FOR go;", "go = [[0, false], [1, false]]", "IRL532", 4),
        ("  WAIT FOR go;", "go = [[4000, true]]", "IRL533", 3),
        ("  WAIT -1 SEC;", "", "IRL505", 3),
        ("  WAIT FOR go TIMEOUT -1 SEC;", "go = [[4000, true]]", "IRL505", 3),
        ("  go := TRUE;", "", "IRL211", 3),
        ("  WAIT 1E12 SEC;", "", "IRL425", 3),
    ],
)
def test_what_cannot_be(tmp_path: Path, body: str, traces: str, code: str, line: int) -> None:
    (tmp_path / "p.toml").write_text(CELL.replace("tick_ms = 10", "tick_ms = 500") + traces, encoding="utf-8")
    (tmp_path / "p.irl").write_text(program(body), encoding="utf-8")
    with pytest.raises(irlx.IrlxError) as caught:
        irlx.run(tmp_path / "p.irl")
    found = next(d for d in caught.value.diagnostics if d.is_error)
    assert (found.code, found.place.line_and_column[0]) == (code, line)


@pytest.mark.req("STR-06")
def test_waits_that_are_none_fail(tmp_path: Path) -> None:
    """A joint that moves by one bit, a tick too few, and a wait that was to be longer."""
    run = ran(tmp_path, program("  WAIT 0.5 SEC;\n  lamp := TRUE;\n  WAIT 0.2 SEC;"))
    stream, cell = run.stream, tmp_path / "p.toml"

    def failed(changed) -> set[str]:
        return {check.name for check in irlx.verify(replace(run, stream=changed), cell=cell).failed}

    q = stream.q.copy()
    q[20:, 3] = np.nextafter(q[20:, 3], 9.0)
    assert "waits still" in failed(replace(stream, q=q))
    records = tuple(
        BlockRecord(r.tick, replace(r.block, duration=0.52) if isinstance(r.block, WaitBlock) else r.block)
        for r in stream.records
    )
    assert "waiting time" in failed(replace(stream, records=records))
    shorter = tuple(
        BlockRecord(r.tick, replace(r.block, duration=0.1) if isinstance(r.block, WaitBlock) else r.block)
        for r in stream.records
    )
    assert "waiting time" in failed(replace(stream, records=shorter))


@pytest.mark.req("STR-03")
@pytest.mark.parametrize("ending", [".irdata", ".npz", ".jsonl"])
def test_signals_survive_a_file(tmp_path: Path, ending: str) -> None:
    run = ran(tmp_path, TENDING, "part = [[1, true]]\nAIN_1 = [[0, 3]]\nready = [[8, true]]\n")
    run.save(tmp_path / f"s{ending}")
    assert read_stream(tmp_path / f"s{ending}").records == run.stream.records
    report = irlx.verify(tmp_path / f"s{ending}", program=tmp_path / "p.irl", cell=tmp_path / "p.toml")
    assert report.passed, str(report)
    assert report["program"].status == "ok"
    assert report["waiting time"].status == "ok"


def test_streaming_gives_the_same(tmp_path: Path) -> None:
    traces = "part = [[1, true]]\nAIN_1 = [[0, 3]]\nready = [[8, true]]\n"
    run = ran(tmp_path, TENDING, traces)
    samples = list(irlx.stream(tmp_path / "p.irl"))
    np.testing.assert_array_equal(np.array([s.q for s in samples]), run.q)
