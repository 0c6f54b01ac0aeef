"""`irlx run --html`: the page beside the streams, what it refuses, and what is left of runs that fail."""

import json
import os
import re
import signal

import pytest

import irlx
from irlx.cell.packaged import packaged_cell, packaged_urdf
from irlx.report.figures import Figures
from irlx.report.replay import writer
from irlx.streams.atomic import AtomicFile
from irlx.streams.error import cannot_write
from page_data import page_data

pytestmark = pytest.mark.req("REP-04")

CELL = '[robot]\nmodel = "planar3"\n[motion]\ntick_ms = 20\n'
TEXT = """PROGRAM p;
BEGIN
  WRITELN('<b>hello</b>');
  MOVE PTP MAIN_JOINT(30, 60, -40);
  MOVE_INC LIN POSITION(60, 40, 0);
ENDPROGRAM;
"""
BEYOND = TEXT.replace("ENDPROGRAM", "  MOVE LIN POSITION(900, 700, 0);\nENDPROGRAM")
FILES = ["p.irl", "p.toml"]


@pytest.fixture
def folder(tmp_path):
    """A folder with p.irl and p.toml, of a robot that is quick to run."""
    folder = tmp_path / "work"
    folder.mkdir()
    (folder / "p.irl").write_text(TEXT, encoding="utf-8")
    (folder / "p.toml").write_text(CELL, encoding="utf-8")
    return folder


def test_a_page_beside_the_stream_and_of_its_replay(inside, folder, names):
    done = inside("run", "p.irl", "-o", "p.irdata", "--html", "p.html")
    assert (done.returncode, done.stderr) == (0, "")
    assert "\nwritten     p.irdata  43 samples, 27 checks passed\npage        p.html\n" in done.stdout
    assert names(folder) == ["p.html", "p.irdata", *FILES]
    data = page_data(folder / "p.html")
    assert data["program"]["text"] == TEXT
    assert data["summary"]["text"].split("\n", 1)[1] in done.stdout
    assert [event["text"] for event in data["events"] if event["kind"] == "message"] == ["<b>hello</b>"]

    done = inside("run", "p.irdata", "-o", "again.csv", "--html", "again.html", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    again = page_data(folder / "again.html")
    assert again["frames"] == data["frames"]
    assert again["program"]["text"] == TEXT
    (folder / "p.irl").write_text(BEYOND, encoding="utf-8")
    assert inside("run", "p.irdata", "-o", "again.csv", "--html", "again.html").returncode == 0
    assert page_data(folder / "again.html")["program"] == {**data["program"], "text": None}


def test_json_tells_the_page(inside, folder):
    done = inside("run", "p.irl", "--html", "p.html", "--json")
    found = json.loads(done.stdout)
    assert (found["page"], found["files"]) == ("p.html", ["p.irdata"])
    assert json.loads(inside("run", "p.irl", "--json").stdout)["page"] is None
    (folder / "p.irl").write_text(BEYOND, encoding="utf-8")
    found = json.loads(inside("run", "p.irl", "--html", "p.html", "--json").stdout)
    assert (found["page"], found["files"]) == ("p.partial.html", ["p.partial.irdata"])
    (folder / "p.irl").write_text("PROGRAM", encoding="utf-8")
    found = json.loads(inside("run", "p.irl", "--html", "p.html", "--json").stdout)
    assert (found["page"], found["files"], found["summary"]) == (None, [], None)


REFUSED = [
    (
        ["--html", "p.irl"],
        "error IRL013: --html p.irl: the name of a page ends with .html\n",
        "--html p.html",
    ),
    (["--html", "page"], "error IRL013: --html page: the name of a page ends with .html\n", "page.html"),
    (["--html", "link.html"], "error IRL005: --html link.html would overwrite an input of this run", ""),
    (
        ["--html", "no/p.html"],
        "error IRL003: cannot write no/p.html: no such file or directory",
        "name another file with --html\n",
    ),
    (["--html", "folder.html"], "error IRL003: cannot write folder.html: ", ""),
    (["--html", "twin.html", "-o", "twin.csv"], "error IRL012: --html twin.html is also a stream", ""),
    (["--html", "a.html", "--html", "b.html"], "error IRL006: --html b.html: one page a run\n", ""),
    (["-o", "p.html"], "error IRL004: -o p.html: no format has the ending '.html'; known: ", "--html"),
]


@pytest.mark.parametrize(("options", "words", "helps"), REFUSED)
def test_pages_that_cannot_be(inside, folder, names, options, words, helps):
    (folder / "link.html").symlink_to("p.irl")
    (folder / "twin.html").symlink_to("twin.csv")
    (folder / "folder.html").mkdir()
    done = inside("run", "p.irl", *options)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(words)
    assert helps in done.stderr
    assert names(folder) == ["folder.html", "link.html", *FILES, "twin.html"]


def test_what_python_asks_for_is_looked_at_as_well(folder, names):
    with pytest.raises(irlx.StreamError, match="IRL003"):
        irlx.record(folder / "p.irl", [folder / "p.html", folder / "no" / "p.csv"])
    with pytest.raises(irlx.StreamError, match="IRL003"):
        irlx.record(folder / "p.irl", [folder / "p.csv", folder / "no" / "p.html"])
    with pytest.raises(irlx.IrlxError, match="IRL006"):
        irlx.record(folder / "p.irl", [folder / "p.html", folder / "q.html"])
    assert names(folder) == FILES


def test_the_program_cannot_write_over_its_page(inside, folder):
    text = "PROGRAM p;\nVAR FILE: f;\nBEGIN\n  OPEN(f, '{}', 'WRITE');\nENDPROGRAM;\n"
    for name in ("p.html", "p.partial.html"):
        (folder / "p.irl").write_text(text.format(name), encoding="utf-8")
        assert "IRL551" in inside("run", "p.irl", "--html", "p.html").stderr


def test_of_a_run_that_ends_in_an_error_a_partial_page_appears(inside, folder, names):
    (folder / "p.irl").write_text(BEYOND, encoding="utf-8")
    (folder / "p.html").write_text("earlier", encoding="utf-8")
    done = inside("run", folder / "p.irl", "-o", "p.csv", "--html", "p.html")
    assert done.returncode == 1
    assert names(folder) == ["p.html", *FILES[:1], "p.partial.csv", "p.partial.html", "p.toml"]
    assert "irlx: p.html is left as it was, from an earlier run\n" in done.stderr
    assert "irlx: a page of what was executed: p.partial.html\n" in done.stderr
    assert (folder / "p.html").read_text(encoding="utf-8") == "earlier"
    data = page_data(folder / "p.partial.html")
    assert data["complete"] is False
    assert str(folder) in done.stderr
    assert str(folder) not in json.dumps(data), "a page tells where its maker keeps files"
    (stop,) = (event for event in data["events"] if event["kind"] == "stop")
    assert stop["first"] == data["frames"]["tick"][-1] > 0
    assert stop["label"].startswith("ended by IRL5")
    assert stop["line"] == 6
    assert any(stop["text"].startswith(line.split("\n")[0]) for line in data["diagnostics"])
    assert any("\n  help: " in line for line in data["diagnostics"])
    # It names a tick that was planned: the page and the verdict say that the run did not come so far.
    end, planned = re.search(r"rests at (\S+) s, what was planned up to (\S+) s", stop["text"]).groups()
    assert float(end) == pytest.approx(stop["first"] * data["tick_s"])
    assert float(end) < float(planned)
    assert float(planned) / data["tick_s"] == pytest.approx(
        int(re.search(r"\(tick (\d+)\)", stop["text"])[1])
    )
    assert f"at line 6, which would come at {planned} s\n" in done.stderr


def test_of_a_run_in_which_nothing_moved_no_page_appears(inside, folder, names):
    text = "PROGRAM p;\nBEGIN\n  MOVE LIN POSITION(900, 700 / (R_ACC - R_ACC), 0);\nENDPROGRAM;\n"
    (folder / "p.irl").write_text(text, encoding="utf-8")
    assert inside("run", "p.irl", "--html", "p.html").returncode == 1
    assert names(folder) == FILES


def test_after_an_interrupt_a_partial_page_appears(inside, folder, names, monkeypatch):
    take, count = Figures.take, iter(range(100))

    def interrupted(figures, segment):
        if next(count) == 2:
            os.kill(os.getpid(), signal.SIGINT)
        take(figures, segment)

    monkeypatch.setattr(Figures, "take", interrupted)
    done = inside("run", "p.irl", "-o", "p.csv", "--html", "p.html")
    assert done.returncode == 130
    assert names(folder) == ["p.irl", "p.partial.csv", "p.partial.html", "p.toml"]
    assert page_data(folder / "p.partial.html")["complete"] is False


def test_a_disk_that_is_full_for_the_page_costs_no_stream(inside, folder, names, monkeypatch):
    def full(file, data):
        file.discard()
        raise cannot_write(file.path, OSError(28, "No space left on device"))

    class Full(AtomicFile):
        write = full

    monkeypatch.setattr(writer, "AtomicFile", Full)
    done = inside("run", "p.irl", "-o", "p.csv", "--html", "p.html")
    assert done.returncode == 2
    assert "error IRL003: cannot write p.html: no space left on device" in done.stderr
    assert names(folder) == ["p.csv", *FILES]
    # The run is complete, and told of as ever.
    assert "\np.irl: complete, verified, " in done.stdout
    assert re.search(r"^written +p.csv +\d+ samples, \d+ checks passed", done.stdout, re.MULTILINE)
    assert "page" not in done.stdout
    found = json.loads(inside("run", "p.irl", "-o", "p.csv", "--html", "p.html", "--json").stdout)
    assert (found["files"], found["page"], found["verified"]) == (["p.csv"], None, {"p.csv": True})
    assert [one["code"] for one in found["diagnostics"]] == ["IRL003"]


def test_a_link_that_cannot_be_drawn_is_told_and_costs_no_run(inside, folder):
    model = packaged_urdf("planar3")
    shape = re.search(r"<visual>.*?<geometry>(.*?)</geometry>", model, re.DOTALL)[1]
    drawn = model.replace(shape, '<mesh filename="lost.stl"/>', 1)
    (folder / "arm.urdf").write_text(drawn, encoding="utf-8")
    own = packaged_cell("planar3").decode().replace("[robot]", '[robot]\nmodel = "arm.urdf"')
    (folder / "p.toml").write_text(own, encoding="utf-8")
    done = inside("run", folder / "p.irl", "--html", "p.html", "-o", "p.csv", "--tick", "20")
    assert done.returncode == 0
    assert f"{folder}/p.toml: robot.model: warning IRL721: link '" in done.stderr
    assert "there is no mesh lost.stl" in done.stderr
    (words,) = page_data(folder / "p.html")["diagnostics"]
    assert words.startswith("p.toml: robot.model: warning IRL721: link '")


@pytest.mark.req("QA-08")
def test_names_that_mean_something_to_html(inside, folder):
    name = "<img src=x onerror=alert(1)>&.irl"
    (folder / "p.irl").rename(folder / name)
    assert inside("run", name, "--cell", "p.toml", "-o", "p.csv", "--html", "p.html").returncode == 0
    assert page_data(folder / "p.html")["title"] == name
    assert "<img src=x" not in (folder / "p.html").read_text(encoding="utf-8")
