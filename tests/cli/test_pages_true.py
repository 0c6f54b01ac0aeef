"""The pages of the codes of command line, types, pacing, run and cell: what they show is what irlx says."""

import re
from pathlib import Path

import pytest

import irlx
from irlx.cli.main import main
from irlx.diagnostics.codes.cell import CELL
from irlx.diagnostics.codes.clearance import CLEARANCE
from irlx.diagnostics.codes.command import COMMAND
from irlx.diagnostics.codes.data_lists import DATA_LISTS
from irlx.diagnostics.codes.files import FILES
from irlx.diagnostics.codes.pacing import PACING
from irlx.diagnostics.codes.run import RUN
from irlx.diagnostics.codes.types import TYPES

PAGES = Path(__file__).parents[2] / "docs" / "diagnostics"
CODES = [
    code.id for group in (COMMAND, TYPES, DATA_LISTS, PACING, CLEARANCE, RUN, FILES, CELL) for code in group
]
ELSEWHERE = {"IRL010", "IRL011", "IRL014", "IRL015", "IRL018", "IRL019"}
"""Codes whose example takes streams, folders, a port, or a missing package: tests of commands have them."""
IN_WORDS = {
    "IRL012",
    "IRL440",
    "IRL442",
    "IRL515",
    "IRL090",
    "IRL229",
    "IRL241",
    "IRL264",
    "IRL265",
    "IRL513",
    "IRL523",
    "IRL525",
    "IRL614",
} | {
    "IRL550",
    "IRL564",
    "IRL553",
    "IRL574",
    "IRL641",
    "IRL642",
    "IRL645",
}
"""Codes that no small program for the packaged robot brings about: their pages say so in words."""
IN_PYTHON = {"IRL438", "IRL580", "IRL581", "IRL582", "IRL583", "IRL584", "IRL585", "IRL586", "IRL587"}
"""Codes of what is given in Python: their pages show that."""

PLAIN_PROGRAM = "PROGRAM demo;\nBEGIN\n  MOVE LIN POSITION(11400, 1000, 3500);\nENDPROGRAM\n"
PLAIN_CELL = """[robot]
model = "koch11"
[robot.limits]
position = [180, [-150, 0], [-180, 0], [0, 180], [-180, 0], [-180, 0], 180, 60, 180, 500, [-20, 60]]
speed = [100, 100, 100, 100, 100, 100, 100, 100, 100, 1000, 100]
acceleration = [500, 500, 500, 500, 500, 500, 500, 500, 500, 5000, 500]
[motion]
tick_ms = 100
"""
FINE = {"IRL436"}
"""Codes of what ticks of 50 ms would not show."""
LONG_TICK = 100.0
"""Of cells on pages that name no tick, ms: what they show does not depend on it, what it costs does."""
STEPS = 100_000
"""More than any page needs: endless loops end sooner than by default."""


def page_of(code):
    return (PAGES / f"{code}.md").read_text(encoding="utf-8")


def section(code, title):
    found = re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", page_of(code), re.MULTILINE | re.DOTALL)
    return found[1] if found else ""


def fence(text, kind):
    found = re.search(rf"^```{kind}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    return found[1] if found else None


def diagnostics_of(folder, text, motion=False, fine=False):
    """What check, with its dry run for `motion`, and run say of program and cell in a section of a page."""
    plain = PLAIN_CELL.replace("tick_ms = 100", "tick_ms = 20") if fine else PLAIN_CELL
    program, cell = folder / "demo.irl", folder / "demo.toml"
    if fence(text, "dat"):
        (folder / "points.dat").write_text(fence(text, "dat"), encoding="utf-8")
    program.write_text(fence(text, "irl") or PLAIN_PROGRAM, encoding="utf-8")
    cell.write_text(fence(text, "toml") or plain, encoding="utf-8")
    found = list(irlx.check(program, cell=cell, motion=motion))
    tick = None if "tick_ms" in cell.read_text("utf-8") else LONG_TICK
    try:
        found += irlx.run(program, cell=cell, tick_ms=tick, max_steps=STEPS).diagnostics
    except irlx.IrlxError as error:
        found += error.diagnostics
    return found


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize("code", CODES)
def test_page(code):
    page = page_of(code)
    assert page.startswith(f"# {code}: ")
    assert len(page.splitlines()) <= 50
    shown = bool(section(code, "Bad") and section(code, "Repaired"))
    assert shown or section(code, "Example")
    assert shown or "```console" in page or code in IN_WORDS | IN_PYTHON


IN_DRY_RUNS = {"IRL445", "IRL446", "IRL447"}
"""What only `irlx check --motion` says."""
SHOWN = [code for code in CODES if section(code, "Bad")]


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize("code", SHOWN)
def test_bad_is_reported_and_repaired_is_clean(tmp_path, code):
    bad = diagnostics_of(tmp_path, section(code, "Bad"), code in IN_DRY_RUNS, code in FINE)
    assert code in {d.code for d in bad}
    # Nothing else is wrong there, apart from what the same mistake makes the check say.
    companions = {"IRL590", "IRL591", "IRL621"} | ({"IRL520"} if code == "IRL447" else set())
    companions |= {"IRL609"} if code == "IRL008" else set()
    assert {d.code for d in bad if d.is_error} <= {code, *companions}
    repaired = diagnostics_of(tmp_path, section(code, "Repaired"), code in IN_DRY_RUNS, code in FINE)
    assert [str(d) for d in repaired] == []


CONSOLE = [code for code in CODES if "```console" in page_of(code) and code not in ELSEWHERE]


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize("code", CONSOLE)
def test_examples_on_the_command_line(tmp_path, monkeypatch, capsys, code):
    monkeypatch.chdir(tmp_path)
    for name in ("p.irl", "p.csv", "lonely.irl"):
        (tmp_path / name).write_text(PLAIN_PROGRAM, encoding="utf-8")
    (tmp_path / "p.toml").write_text(PLAIN_CELL, encoding="utf-8")
    example = section(code, "Example")
    if fence(example, "irl"):
        (tmp_path / "p.irl").write_text(fence(example, "irl"), encoding="utf-8")
    (tmp_path / "inputs.csv").write_text(fence(example, "csv") or "time,input,value\n", encoding="utf-8")
    before = sorted(tmp_path.iterdir())
    command, *expected = fence(example, "console").splitlines()
    assert command.startswith("$ irlx ")
    assert code in expected[0]
    assert main(command.split()[2:]) == 2
    assert capsys.readouterr().err.splitlines()[: len(expected)] == expected
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize("code", sorted(IN_PYTHON))
def test_examples_in_python(tmp_path, monkeypatch, code):
    monkeypatch.chdir(tmp_path)
    text = section(code, "Example")
    (tmp_path / "p.irl").write_text(fence(text, "irl") or PLAIN_PROGRAM, encoding="utf-8")
    (tmp_path / "p.toml").write_text(fence(text, "toml") or PLAIN_CELL, encoding="utf-8")
    if code == "IRL587":
        known = {"irlx": irlx}
        exec(fence(text, "python"), known)
        assert {found.code for found in known["stream"].warnings} == {code}
        return
    with pytest.raises(irlx.IrlxError) as caught:
        exec(fence(text, "python"), {"irlx": irlx})
    assert [found.code for found in caught.value.diagnostics] == [code]
