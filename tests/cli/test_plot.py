"""`irlx plot` and `irlx.plot`: every option, figures and text, failures by their codes."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import irlx
from drawn_streams import DrawnStream, square_and_slow
from irlx.robot.limits import JointLimits
from irlx.streams import write_stream

pytest.importorskip("matplotlib")
pytestmark = pytest.mark.req("REP-03")

QUIET = ("--show", "position", "--joints", "1")
KOCH = Path(__file__).parents[2] / "programs" / "koch"


@pytest.fixture
def streams(folder):
    """a.irdata, the same as a.csv (without blocks) and a.jsonl, and b.npz, shorter and at another tick."""
    stream = square_and_slow()
    for ending in ("irdata", "csv", "jsonl"):
        write_stream(stream, folder / f"a.{ending}")
    made = DrawnStream(tick_ms=25.0)
    made.move(np.column_stack([np.linspace(0.0, 0.8, 40), np.linspace(0.0, 0.1, 40)]))
    write_stream(made.stream(), folder / "b.npz")
    return folder


@pytest.fixture(scope="module")
def run():
    return irlx.run(KOCH / "line.irl", tick_ms=100)


def gids(figure, axes=0):
    return [artist.get_gid() for artist in figure.axes[axes].get_children()]


def test_text_in_the_terminal(inside, streams):
    done = inside("plot", "a.irdata")
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert lines[0] == "drawn.irl, drawer"
    assert max(map(len, lines)) == 80
    assert [line for line in lines if line[:1].isalpha()][1:] == [
        "turn position, deg                       turn speed, deg/s",
        "slide position, mm                       slide speed, mm/s",
        "tool speed, mm/s",
    ]
    # What does not carry blocks is drawn without them.
    assert inside("plot", "a.jsonl").stdout == done.stdout
    assert inside("plot", "a.csv").returncode == 0


def test_colour_where_there_may_be_some(inside, streams, monkeypatch):
    assert "\x1b" not in inside("plot", "a.irdata").stdout
    monkeypatch.setattr("irlx.cli.output.coloured", lambda stream: True)
    assert "\x1b[36m" in inside("plot", "a.irdata").stdout


def test_width_show_and_joints_in_the_terminal(inside, streams):
    done = inside("plot", "a.irdata", "--width", 44, "--show", "acceleration", "--joints", "slide")
    lines = done.stdout.splitlines()
    assert lines[1] == "slide acceleration, mm/s²"
    assert max(map(len, lines)) == 44
    assert len(lines) == 9
    # In the order in which they are named; numbers count from 1.
    done = inside("plot", "a.irdata", "--show", "position", "--joints", "2, turn")
    assert [line for line in done.stdout.splitlines() if " position" in line] == [
        "slide position, mm",
        "turn position, deg",
    ]


def test_a_terminal_that_is_too_narrow(inside, streams, monkeypatch):
    monkeypatch.setenv("COLUMNS", "20")
    assert max(map(len, inside("plot", "a.irdata").stdout.splitlines())) == 20
    monkeypatch.setenv("COLUMNS", "12")
    done = inside("plot", "a.irdata")
    words = "a terminal of 12 columns: needs 20 at least; --width names another width"
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"error IRL006: {words}\n")


def test_which_joint_a_number_means(inside, streams):
    made = DrawnStream(("rail", "joint_1"), ("m", "rad"), JointLimits.unlimited(2))
    made.move(np.zeros((3, 2)))
    write_stream(made.stream(), streams / "r.irdata")
    done = inside("plot", "r.irdata", "--joints", 2, "--show", "position")
    assert done.stderr == "joints      2 is joint_1: numbers count all joints from 1\n"
    assert "joint_1 position" in done.stdout
    assert inside("plot", "r.irdata", "--joints", "1,joint_1", "--show", "position").stderr == ""


def test_from_and_to(inside, streams):
    done = inside("plot", "a.irdata", "--from", 1, "--to", "2.5", "--show", "speed")
    assert done.stdout.splitlines()[8].split() == ["30", "2.5", "s"]


def test_figures(inside, streams, names):
    done = inside("plot", "a.irdata", *QUIET, "-o", "a.svg", "-o", "a.PNG", "-o", "a.pdf")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines() == [f"written     a.{ending}" for ending in ("svg", "PNG", "pdf")]
    heads = {"a.svg": b"<?xml", "a.PNG": b"\x89PNG", "a.pdf": b"%PDF"}
    for name, head in heads.items():
        assert (streams / name).read_bytes().startswith(head)
    first = (streams / "a.svg").read_bytes()
    inside("plot", "a.irdata", *QUIET, "-o", "a.svg", "--width", 254)
    assert (streams / "a.svg").read_bytes() == first
    inside("plot", "a.irdata", *QUIET, "-o", "a.svg", "--width", 200)
    assert (streams / "a.svg").read_bytes() != first
    assert not [name for name in names(streams) if "part" in name]


def test_comparison(inside, streams):
    done = inside("plot", "a.irdata", "b.npz", "--joints", 1, "--show", "position", "-o", "both.svg")
    assert (done.returncode, done.stderr) == (0, "")
    done = inside("plot", "a.irdata", "b.npz", "--joints", 1)
    assert done.stdout.startswith("a.irdata (dashed) and b.npz, drawer\n")


def test_what_needs_the_robot_is_left_out_with_a_note(inside, streams):
    done = inside("plot", "a.irdata", "-o", "a.svg")
    assert (done.returncode, done.stdout) == (0, "written     a.svg\n")
    assert done.stderr.splitlines() == [
        f"a.irdata: warning IRL019: {what} is left out: its robot is not known; --cell names its cell"
        for what in ("singular", "clearance")
    ]
    done = inside("plot", "a.irdata", "--show", "singular")
    assert done.returncode == 2
    assert "IRL006: --show singular: nothing to draw: singular is left out" in done.stderr


def test_robot_by_the_cell_beside_the_stream_or_by_cell(inside, folder, run):
    run.save(folder / "line.irdata")
    asked = ("plot", "line.irdata", "--show", "singular,clearance", "--width", 80)
    done = inside(*asked)
    # Its robot is packaged; obstacles are those of the cell, which is not here.
    assert "smallest singular value" in done.stdout
    assert "IRL019: clearance is left out: the obstacles of its cell are not known" in done.stderr
    by_cell = inside(*asked, "--cell", KOCH / "line.toml")
    assert (by_cell.stdout, by_cell.stderr) == (done.stdout, "")
    done = inside("plot", "line.irdata", "--show", "clearance", "--cell", KOCH / "line.toml")
    assert done.returncode == 2
    assert "nothing to draw: nothing came within the influence of what is kept clear of" in done.stderr
    (folder / "line.toml").write_bytes((KOCH / "line.toml").read_bytes())
    assert inside(*asked).stderr == ""


def test_a_robot_whose_package_is_missing(inside, folder, monkeypatch):
    made = DrawnStream()
    made.move(np.full((5, 2), 0.1))
    write_stream(made.stream(robot_model="panda"), folder / "p.irdata")
    monkeypatch.setattr("irlx.cell.external.robot_data_folder", lambda: None)
    done = inside("plot", "p.irdata", "--show", "position,singular")
    assert done.returncode == 0
    assert "turn position, deg" in done.stdout
    assert done.stderr.startswith("p.irdata: warning IRL019: singular is left out: ")
    assert "example-robot-data" in done.stderr


def test_of_many_joints_the_busiest(inside, folder, run):
    run.save(folder / "line.npz")
    done = inside("plot", "line.npz", "--show", "position")
    assert sum(" position, " in line for line in done.stdout.splitlines()) == 4


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["absent.irdata"], "IRL001: no such file: absent.irdata"),
        (["a.dat"], "IRL707"),
        (["p.irl"], "help: this is a program; irlx run p.irl -o out.irdata writes its stream"),
        (["a.irdata", "-o", "a.jpg"], "IRL004: -o a.jpg: no format has the ending '.jpg'; known: .svg, .png"),
        (["a.irdata", "-o", "gone/a.svg"], "IRL003: cannot write gone/a.svg: no such file or directory"),
        (["a.irdata", "-o", "link.svg"], "IRL005: -o link.svg would overwrite an input"),
        (["b.npz", "a.irdata", "-o", "link.svg"], "IRL005: -o link.svg would overwrite an input"),
        (["a.irdata", "--joints", "trun"], "--joints trun: no such joint; there are 2; did you mean 'turn'?"),
        (["a.irdata", "--joints", "3"], "IRL006: --joints 3: no such joint; there are 2"),
        (["a.irdata", "--joints", "0"], "IRL006: --joints 0"),
        (["a.irdata", "--show", "sped"], "IRL006: --show sped: not one of position, speed,"),
        (["a.irdata", "--show", ""], "IRL006: --show ''"),
        (["a.irdata", "--from", "9"], "--from 9: a.irdata has no sample from there on; it lasts 3.22 s"),
        (
            ["a.irdata", "--from", "1.0001", "--to", "1.0002"],
            "--from 1.0001: a.irdata has no sample from there to 1.0002 s; it lasts 3.22 s",
        ),
        (["a.irdata", "--from", "2", "--to", "1"], "--to 1: the end must lie behind the beginning, 2 s"),
        (["a.irdata", "--width", "9"], "IRL006: --width 9: needs 20 to 1000 columns"),
        (["a.irdata", "--width", "nan"], "IRL006: --width nan"),
        (["a.irdata", "--width", "9", "-o", "x.svg"], "IRL006: --width 9: needs 100 to 2000 mm"),
        (["a.irdata", "--cell", "q.toml"], "IRL001"),
    ],
)  # fmt: skip
def test_failures(inside, streams, arguments, words):
    (streams / "a.dat").write_text("x", encoding="utf-8")
    (streams / "link.svg").symlink_to("a.irdata")
    before = (streams / "a.irdata").read_bytes()
    done = inside("plot", *arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert words in done.stderr
    assert (streams / "a.irdata").read_bytes() == before
    assert not (streams / "x.svg").exists()


@pytest.mark.parametrize(
    ("names", "units", "words"),
    [
        (("turn", "other"), ("rad", "m"), "only a.irdata has slide; only c.irdata has other"),
        (("turn", "slide", "more"), ("rad", "m", "m"), "only c.irdata has more"),
        (("slide", "turn"), ("rad", "m"), "their joints come in another order"),
        (("turn", "slide"), ("rad", "rad"), "slide is in m there and in rad here"),
    ],
)
def test_robots_with_other_joints(inside, streams, names, units, words):
    made = DrawnStream(names, units, JointLimits.unlimited(len(names)), start=(0.0,) * len(names))
    made.move(np.zeros((3, len(names))))
    write_stream(made.stream(), streams / "c.irdata")
    done = inside("plot", "a.irdata", "c.irdata", "-o", "x.svg")
    assert (done.returncode, done.stdout) == (2, "")
    lines = done.stderr.splitlines()
    assert lines[0] == f"error IRL011: a.irdata and c.irdata cannot be drawn over each other: {words}"
    assert not (streams / "x.svg").exists()


def test_a_cell_of_another_robot(inside, streams):
    done = inside("plot", "a.irdata", "--cell", "p.toml")
    assert (done.returncode, done.stdout) == (1, "")
    assert "p.toml: error IRL727" in done.stderr


def test_without_matplotlib(inside, streams, monkeypatch, names):
    before = names(streams)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    done = inside("plot", "a.irdata", "-o", "a.svg")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "error IRL010: irlx plot -o needs matplotlib: pip install 'irlx[plot]'\n"
    assert names(streams) == before
    with pytest.raises(irlx.IrlxError, match=r"IRL010: irlx\.plot needs matplotlib"):
        irlx.plot(streams / "a.irdata")
    # The terminal needs none of it.
    done = inside("plot", "a.irdata")
    assert (done.returncode, done.stderr) == (0, "")


def test_the_terminal_loads_no_matplotlib(environment, streams):
    """Nor is anything of notebooks loaded, there and for runs."""
    code = (
        "import sys, irlx; assert irlx.run; from irlx.cli.main import main; main(['plot', 'a.irdata']); "
        "print([name for name in ('matplotlib', 'PIL', 'IPython') if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=streams, env=environment, capture_output=True, check=True
    )
    assert done.stdout.decode().splitlines()[-1] == "[]"
    assert b"\x1b" not in done.stdout


def test_an_incomplete_stream_is_drawn(inside, streams):
    text = (streams / "a.irdata").read_text().splitlines(keepends=True)
    (streams / "cut.irdata").write_text("".join(text[: len(text) // 2]))
    done = inside("plot", "cut.irdata")
    assert done.returncode == 0
    assert done.stdout.startswith("drawn.irl, drawer, INCOMPLETE\n")


def test_from_python(run):
    figure = irlx.plot(run, joints=["joint_7", 11], show=["position", "speed", "path-speed"])
    assert len(figure.axes) == 5
    (line,) = [found for found in figure.axes[3].lines if found.get_gid() == "curve 0"]
    np.testing.assert_allclose(line.get_ydata(), np.rad2deg(run.qd[:, 10]))
    both = irlx.plot(run, run, joints=[7], show={"position"}, first=0.5, last=1.0, width=150.0)
    assert [gid for gid in gids(both) if str(gid).startswith("curve")] == ["curve 0", "curve 1"]
    assert both.axes[0].get_xlim() == pytest.approx((0.5, 1.0))
    assert both.get_figwidth() == pytest.approx(150.0 / 25.4)


def test_from_python_as_in_the_command(streams):
    listed = irlx.plot(streams / "a.irdata", joints="slide,1", show="position")
    names = [text.get_text() for text in listed.texts]
    assert names[:2] == ["slide, mm", "turn, deg"]
    assert len(irlx.plot(streams / "a.irdata", joints=2, show="position").axes) == 1
    with pytest.raises(irlx.IrlxError, match="IRL006: --width 1: needs 100 to 2000 mm"):
        irlx.plot(streams / "a.irdata", width=1.0)
    # Whoever saves it and shows it, with whatever settings of matplotlib.
    import matplotlib as mpl

    listed.savefig(streams / "one.svg")
    with mpl.rc_context({"svg.fonttype": "none", "font.size": 30.0}):
        listed.savefig(streams / "two.svg")
    assert (streams / "one.svg").read_bytes() == (streams / "two.svg").read_bytes()
    assert listed._repr_png_().startswith(b"\x89PNG")


def test_two_of_the_same_name_are_told_apart(inside, streams, run):
    (streams / "old").mkdir()
    (streams / "old" / "a.irdata").write_bytes((streams / "a.irdata").read_bytes())
    done = inside("plot", "old/a.irdata", "a.irdata", "--joints", "1", "--show", "position")
    assert done.stdout.splitlines()[0] == "old/a.irdata (dashed) and a.irdata, drawer"
    both = irlx.plot(run, run, joints=[7], show=["position"])
    assert [text.get_text() for text in both.legends[0].get_texts()][:2] == [
        "line.irl, first",
        "line.irl, second",
    ]


def test_from_python_what_is_left_out_is_a_warning(streams):
    with pytest.warns(UserWarning, match="IRL019: singular is left out"):
        irlx.plot(str(streams / "b.npz"), show=["position", "singular"])


def test_clearances_of_a_run_and_of_its_file(tmp_path):
    window = KOCH.parent / "window"
    run = irlx.run(window / "window.irl", tick_ms=50)
    told = run.clearances.distance
    assert np.isfinite(told).sum() > 100
    figure = irlx.plot(run, show=["clearance"])
    (line,) = [found for found in figure.axes[0].lines if found.get_gid() == "curve 0"]
    np.testing.assert_allclose(line.get_ydata(), np.where(np.isfinite(told), told * 1e3, np.nan))
    # Of the file the verifier measures them, by other code, in the cell beside it.
    run.save(tmp_path / "window.irdata")
    (tmp_path / "window.toml").write_bytes((window / "window.toml").read_bytes())
    figure = irlx.plot(tmp_path / "window.irdata", show=["clearance"])
    (measured,) = [found for found in figure.axes[0].lines if found.get_gid() == "curve 0"]
    np.testing.assert_allclose(measured.get_ydata()[1:], line.get_ydata()[1:], atol=0.01)
