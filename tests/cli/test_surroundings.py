"""Inputs that are no files, too little memory, and settings around a run that change no byte."""

import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest

import irlx
from irlx.cli import main as entry
from irlx.cli import output
from irlx.cli.little_memory import expect_little_memory
from irlx.cli.main import _NO_MEMORY, main
from irlx.diagnostics.fault import fault
from irlx.report.figures import Figures
from irlx.streams import KNOWN_ENDINGS
from stream_files import content_of

pytestmark = pytest.mark.req("QA-09")

SHORT = """PROGRAM p;
BEGIN
  MOVE PTP MAIN_JOINT(30, 60, -40);
  MOVE_INC LIN POSITION(60, 40, 0);
ENDPROGRAM
"""
NO_TEXT = os.fsdecode(b"p\xff")
"""A name that is no UTF-8, as any bytes may be one."""
PLANAR = '[robot]\nmodel = "planar3"\n[motion]\ntick_ms = 10\n'
STRANGE = {
    "fifo": os.mkfifo,
    "device": lambda path: path.symlink_to("/dev/zero"),
    "folder": lambda path: path.mkdir(),
    "circle": lambda path: path.symlink_to(path.name),
    "dangling": lambda path: path.symlink_to("nowhere"),
    "sparse": lambda path: (path.touch(), os.truncate(path, 1 << 33)),
    "nothing": lambda path: path.touch(),
}
INPUTS = [
    ["check", "x.irl"],
    ["run", "p.irl", "--cell", "x.toml"],
    ["run", "p.irl", "--inputs", "x.csv"],
    ["robots", "--check", "x.urdf"],
    *(["verify", f"x{ending}"] for ending in KNOWN_ENDINGS),
]


@pytest.mark.parametrize("arguments", INPUTS, ids=lambda words: words[-1])
def test_inputs_that_are_no_files(inside, folder, names, arguments):
    path = folder / arguments[-1]
    for make in STRANGE.values():
        make(path)
        done = inside(*arguments)
        assert done.returncode in (1, 2)
        assert "error IRL" in done.stderr or "FAILED" in done.stdout
        path.rmdir() if path.is_dir() and not path.is_symlink() else path.unlink()
    assert names(folder) == ["p.irl", "p.toml"]


@pytest.mark.parametrize("text", ["MODULE", "DATALIST", "robot", "mesh"])
def test_a_fifo_that_a_file_of_a_stranger_names(inside, folder, text):
    """It would hold the command for ever."""
    os.mkfifo(folder / "x.irl")
    os.mkfifo(folder / "x.dat")
    os.mkfifo(folder / "x.urdf")
    os.mkfifo(folder / "x.stl")
    if text == "MODULE":
        (folder / "p.irl").write_text("PROGRAM p; FROM x IMPORT y; BEGIN y; ENDPROGRAM")
    elif text == "DATALIST":
        (folder / "p.irl").write_text("PROGRAM p; IMPORT DATALIST x; BEGIN ENDPROGRAM")
    elif text == "robot":
        (folder / "p.toml").write_text('[robot]\nmodel = "x.urdf"\n')
    else:
        mesh = '[[obstacle]]\nname = "x"\nshape = "mesh"\nfile = "x.stl"\n'
        (folder / "p.toml").write_text((folder / "p.toml").read_text() + mesh)
    done = inside("run", "p.irl")
    assert done.returncode in (1, 2)
    assert "error IRL" in done.stderr


def test_too_little_memory(folder, names, monkeypatch, capsys):
    """A message, and nothing that could be taken for a whole stream; no fault of irlx, and told as none."""
    take, count = Figures.take, iter(range(100))

    def scarce(figures, segment):
        if next(count) == 2:
            raise MemoryError
        take(figures, segment)

    monkeypatch.setattr(Figures, "take", scarce)
    monkeypatch.chdir(folder)
    assert main(["run", "p.irl"]) == 2
    told = capsys.readouterr().err
    assert "error IRL090: internal error: the memory that this process may use is used up\n" in told
    assert "fault of irlx" not in told
    assert "p.irdata" not in names(folder)


def test_too_little_memory_for_a_message(folder, monkeypatch, capsys):
    """What a message is made of is loaded only when there is one."""

    def nothing_left(*_):
        raise MemoryError

    monkeypatch.setattr(output, "print_diagnostics", nothing_left)
    monkeypatch.chdir(folder)
    assert main(["check", "nowhere.irl"]) == 2
    assert capsys.readouterr().err == f"{_NO_MEMORY}\n"


def test_bytecode_that_a_full_disk_has_cut():
    found = fault(EOFError("marshal data too short"))
    assert found.code == "IRL090"
    assert "__pycache__" in found.help
    assert "fault of irlx" in fault(EOFError("another one")).help


def test_libraries_for_which_there_is_no_room(monkeypatch):
    """They would end the process themselves, or try for ever: none is loaded then. Other modules are."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    monkeypatch.setattr(sys, "meta_path", [])
    if before[0] == resource.RLIM_INFINITY:
        expect_little_memory()
        assert sys.meta_path == []
    size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + (50 << 20), before[1]))
    try:
        expect_little_memory()
        (keeper,) = sys.meta_path
        assert keeper.find_spec("json", None) is None
        for name in ("numpy", "scipy"):
            with pytest.raises(MemoryError):
                keeper.find_spec(name, None)
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)
    assert keeper.find_spec("numpy", None) is None


def test_what_the_console_entry_sees_to_first(monkeypatch):
    """One thread of linear algebra, whatever is asked for: with two, last bits of programs/snake differ."""
    seen = []

    def command():
        seen.append((os.environ["OPENBLAS_NUM_THREADS"], os.environ["OMP_NUM_THREADS"]))
        return 0

    monkeypatch.setattr(os, "environ", {"OPENBLAS_NUM_THREADS": "2"})
    monkeypatch.setattr(entry, "main", command)
    steps = ("heed_signals", "take_channels", "expect_little_memory", "ignore_signals")
    for name in steps:
        monkeypatch.setattr(entry, name, lambda name=name: seen.append(name))
    with pytest.raises(SystemExit, match="0"):
        entry.entry_point()
    assert seen == [*steps[:3], ("1", "1"), steps[3]]


PLAIN = {"TZ": "nonsense", "LC_ALL": "C", "PYTHONUTF8": "0"}
FEW = {"OPENBLAS_NUM_THREADS": "2", "HOME": "/proc"}
SETTINGS = [
    (["-OO", "-W", "error"], {"PYTHONHASHSEED": "1", **PLAIN, **FEW}),
    pytest.param(["-O", "-X", "dev"], {"PYTHONHASHSEED": "0", **PLAIN}, marks=pytest.mark.slow),
]


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """A program whose name is no text, and what a run inside this process writes of it in every form."""
    folder = tmp_path_factory.mktemp("undisturbed")
    (folder / f"{NO_TEXT}.irl").write_text(SHORT)
    (folder / f"{NO_TEXT}.toml").write_text(PLANAR)
    outputs = [folder / f"p{ending}" for ending in (*KNOWN_ENDINGS, ".html")]
    irlx.record(folder / f"{NO_TEXT}.irl", outputs)
    return folder, {path.name: content_of(path) for path in outputs}


@pytest.mark.parametrize(("python", "variables"), SETTINGS, ids=" ".join)
def test_the_same_bytes_whatever_is_set(undisturbed, environment, tmp_path, python, variables):
    """Another process, folder, locale, zone, seed of hashes, number of threads, and without assert."""
    made, expected = undisturbed
    asked = [word for name in expected for word in ("-o" if name[-4:] != "html" else "--html", name)]
    call = [sys.executable, *python, "-m", "irlx", "run", str(made / f"{NO_TEXT}.irl"), *asked, "--quiet"]
    given = {**environment, **variables, "TMPDIR": "/nonexistent"}
    # Bytecode of -O and -OO may be kept: to compile all libraries anew is most of what such a process costs.
    del given["PYTHONDONTWRITEBYTECODE"]
    done = subprocess.run(call, cwd=tmp_path, env=given, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert {name: content_of(tmp_path / name) for name in expected} == expected


def test_a_figure_of_a_program_whose_name_is_no_text(undisturbed, inside):
    folder, _ = undisturbed
    asked = ("--joints", "1", "--show", "position", "-o", "p.svg")
    assert inside("plot", folder / "p.irdata", *asked).returncode == 0


def test_a_folder_that_is_gone(folder, monkeypatch, capsys):
    (folder / "gone").mkdir()
    monkeypatch.chdir(folder / "gone")
    (folder / "gone").rmdir()
    assert main(["run", "../p.irl", "-o", "p.csv"]) == 2
    assert "error IRL0" in capsys.readouterr().err


def test_samples_one_by_one_are_those_of_the_run(undisturbed):
    folder, _ = undisturbed
    run, samples = irlx.run(folder / f"{NO_TEXT}.irl"), list(irlx.stream(folder / f"{NO_TEXT}.irl"))
    assert [one.q.tobytes() for one in samples] == [row.tobytes() for row in run.q]
    assert [one.tool.tobytes() for one in samples] == [row.tobytes() for row in run.tool]
