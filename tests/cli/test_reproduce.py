"""`irlx run --reproduce`: the same bytes of what a file says, and why not where it is not so."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.cli.main import main
from irlx.streams import KNOWN_ENDINGS, StreamWriter

pytestmark = pytest.mark.req("STR-02")

CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 10\n'
TEXT = """PROGRAM p;
VAR INPUT BOOL: part AT 3;
BEGIN
  MOVE LIN (500, 200, 325);
  PAUSE;
  IF part THEN MOVE LIN (500, 240, 325); ENDIF;
ENDPROGRAM;
"""
INPUTS = "time,input,value\n0,IN_3,TRUE\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("p.toml").write_text(CELL, encoding="utf-8")
    Path("p.irl").write_text(TEXT, encoding="utf-8")
    Path("in.csv").write_text(INPUTS, encoding="utf-8")
    return tmp_path


def run(*more: str) -> None:
    arguments = ["run", "p.irl", "--inputs", "in.csv", "--pause", "0.05", "--tick", "4", "--max-slow", "3"]
    assert main([*arguments, "--quiet", "--no-verify", *more]) == 0


@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_every_format_is_made_again(ending: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run("-o", f"p{ending}")
    assert main(["run", "--reproduce", f"p{ending}"]) == 0
    out = capsys.readouterr().out
    # A bag is a folder.
    words = "the same header, blocks and samples" if Path(f"p{ending}").is_dir() else "the same bytes"
    assert out.startswith(f"reproduced  p{ending}: {words}")
    assert irlx.reproduce(f"p{ending}").same_bytes is Path(f"p{ending}").is_file()
    left = {path.name for path in folder.iterdir()}
    assert left == {"p.toml", "p.irl", "in.csv", f"p{ending}"}


def test_files_that_lie_elsewhere_are_named(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run("-o", "p.irdata")
    (folder / "old").mkdir()
    for name in ("p.irl", "p.toml", "in.csv"):
        Path(name).rename(folder / "old" / name)
    assert main(["run", "--reproduce", "p.irdata"]) == 2
    assert "IRL001" in capsys.readouterr().err
    arguments = ["run", "--reproduce", "p.irdata", "old/p.irl", "--cell", "old/p.toml"]
    assert main([*arguments, "--inputs", "old/in.csv", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found == {"reproduced": True, "same_bytes": True, "differences": [], "software": ""}


@pytest.mark.parametrize("name", ["p.irl", "p.toml", "in.csv"])
def test_what_has_changed_since_is_named(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run("-o", "p.irdata")
    Path(name).write_text(Path(name).read_text() + "\n", encoding="utf-8")
    assert main(["run", "--reproduce", "p.irdata"]) == 1
    err = capsys.readouterr().err
    assert f"p.irdata: error IRL730: it was not made from {name} as it is: its SHA-256 is " in err
    assert err.count("IRL730") == 1


def test_a_stream_that_comes_out_otherwise(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    run("-o", "p.irdata", "-o", "p.npz")
    samples = StreamWriter.samples

    def changed(writer, ticks, q, block, tool):
        q = np.where((ticks[:, None] == 7) & (np.arange(q.shape[1]) == 2), np.nextafter(q, 9.0), q)
        samples(writer, ticks, q, block, tool)

    monkeypatch.setattr(StreamWriter, "samples", changed)
    for name in ("p.irdata", "p.npz"):
        assert main(["run", "--reproduce", name]) == 1
        err = capsys.readouterr().err
        assert f"{name}: error IRL732: made again, the stream differs: joint joint_3 at tick 7 by " in err
    found = irlx.reproduce("p.irdata")
    assert not found.reproduced
    assert len(found.differences) == 1


def test_other_versions_are_told_and_are_no_difference(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    run("-o", "p.irdata")
    monkeypatch.setattr("irlx.job.software", lambda: ("python 9.9",))
    assert main(["run", "--reproduce", "p.irdata"]) == 0
    out = capsys.readouterr().out
    assert "the same header, blocks and samples; made with python 3." in out
    assert "(here python 9.9)" in out


def test_a_run_that_ended_in_an_error_is_made_again(folder: Path) -> None:
    text = TEXT.replace("ENDPROGRAM", "  MOVE LIN (500, 200 / (R_ACC - R_ACC), 325);\nENDPROGRAM")
    Path("p.irl").write_text(text, encoding="utf-8")
    assert main(["run", "p.irl", "--inputs", "in.csv", "-o", "p.irdata"]) == 1
    assert irlx.reproduce("p.partial.irdata").same_bytes


def test_a_replay_is_made_again(folder: Path) -> None:
    run("-o", "p.irdata")
    assert main(["run", "p.irdata", "--quiet"]) == 0
    assert irlx.reproduce("p.replay.irdata").same_bytes
    Path("p.irdata").write_bytes(Path("p.replay.irdata").read_bytes())
    with pytest.raises(irlx.IrlxError, match="IRL730"):
        irlx.reproduce("p.replay.irdata")


def test_what_no_file_can_tell(folder: Path) -> None:
    irlx.run("p.irl", inputs={"IN_3": [(0.0, 1.0)]}, input="x").save("p.irdata")
    with pytest.raises(irlx.IrlxError, match="inputs that Python gave, the text for STANDARD_IN") as caught:
        irlx.reproduce("p.irdata")
    assert caught.value.reason.code == "IRL731"


def test_text_for_standard_in_is_given_again(folder: Path) -> None:
    lines = TEXT.replace("BEGIN", " INT: n;\nBEGIN\n  READ(n);\n  WAIT n / 100 SEC;")
    Path("p.irl").write_text(lines, encoding="utf-8")
    irlx.run("p.irl", inputs="in.csv", input="7").save("p.irdata")
    with pytest.raises(irlx.IrlxError, match=r"IRL731: .* with: the text for STANDARD_IN that Python gave"):
        irlx.reproduce("p.irdata")
    assert irlx.reproduce("p.irdata", input="7").same_bytes
    assert not irlx.reproduce("p.irdata", input="9").reproduced


@pytest.mark.parametrize(
    "option",
    [["-o", "x.csv"], ["--html", "x.html"], ["--tick", "5"], ["--explain-tick", "3"], ["--write-data"]],
)
def test_options_that_the_file_answers(
    option: list[str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run("-o", "p.irdata")
    assert main(["run", "--reproduce", "p.irdata", *option]) == 2
    assert f"IRL006: {option[0]}" in capsys.readouterr().err
