"""Folders that take nothing or are gone, names that are no text, clocks that jump, inputs beyond measure."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from surrounded.outside import done
from surrounded.place import STREAMS, Place, Trial, told

Words = Sequence[str | bytes]

WITHOUT_POWER = ("setpriv", "--bounding-set=-dac_override,-dac_read_search,-fowner,-linux_immutable")
"""Before a command of root: it may no more than anybody else."""
READ_ONLY = 'mount --bind . . && mount -o remount,ro,bind . && cd . && exec "$@"'
CALLS: tuple[tuple[str, ...], ...] = (
    ("run", "p.irl", *(word for ending in STREAMS for word in ("-o", f"out{ending}")), "--html", "out.html"),
    ("run", "p.irl"),
    ("run", "p.irl", "--write-data"),
    ("run", "writes.irl"),
    ("check", "p.irl"),
    ("check", "p.irl", "--cell", "p.toml"),
    ("fmt", "messy.irl"),
    ("new", "first", "--robot", "planar3", "--tip", "tool"),
    ("plot", "p.irdata", "-o", "out.svg"),
    ("convert", "p.irdata", "-o", "out.csv"),
    ("verify", "p.irdata"),
    ("blocks", "p.irl"),
    ("robots",),
    ("robots", "--check", "planar3"),
    ("explain", "IRL003"),
    ("completion", "bash"),
)
WRITES = """PROGRAM p;
VAR FILE: f;
BEGIN
  OPEN(f, 'told.txt', 'WRITE');
  WRITELN(f, 'x');
  CLOSE(f);
ENDPROGRAM
"""
LIBRARIES = ("/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1", "/usr/lib/faketime/libfaketimeMT.so.1")


def places(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Read-only folders and mounts, files that nobody may read or replace, no HOME, a folder that is gone."""
    tried = [(kind, call) for kind in KINDS for call in CALLS]
    for kind, call in dice.sample(tried, min(count, len(tried))):
        _filled(place)
        try:
            ended = KINDS[kind](place.folder, call)
        finally:
            _released(place.folder)
        yield _judged(f"{kind}: irlx {' '.join(call)}", ended)


def _filled(place: Place) -> None:
    place.cleared()
    text = (place.folder / "p.irl").read_text()
    (place.folder / "messy.irl").write_text(text.replace(" := ", ":="))
    (place.folder / "writes.irl").write_text(WRITES)
    shutil.copy(place.folder / "p.toml", place.folder / "writes.toml")


def _judged(what: str, ended: subprocess.CompletedProcess[bytes]) -> Trial:
    said = (ended.stdout + ended.stderr).decode(errors="backslashreplace")
    trial = Trial(what, ended.returncode, told(ended.returncode, said, (0, 1, 2)))
    if ended.returncode and "IRL" not in said:
        trial.faults.append(f"no code: {said[-200:]!r}")
    return trial


def _released(folder: Path) -> None:
    """Let everything be removed again."""
    subprocess.run(["chattr", "-R", "-i", str(folder)], capture_output=True, check=False)
    for path in (folder, *folder.iterdir()):
        if not path.is_symlink():
            path.chmod(0o755 if path.is_dir() else 0o644)


def _read_only(folder: Path, call: Words) -> subprocess.CompletedProcess[bytes]:
    folder.chmod(0o555)
    for path in folder.iterdir():
        path.chmod(0o444)
    return done(call, cwd=folder, before=WITHOUT_POWER)


def _mounted(folder: Path, call: Words) -> subprocess.CompletedProcess[bytes]:
    return done(call, cwd=folder, before=("unshare", "-m", "sh", "-c", READ_ONLY, "sh"))


def _unreadable(folder: Path, call: Words) -> subprocess.CompletedProcess[bytes]:
    for path in folder.iterdir():
        path.chmod(0o000)
    return done(call, cwd=folder, before=WITHOUT_POWER)


def _untouchable(folder: Path, call: Words) -> subprocess.CompletedProcess[bytes]:
    """What is asked for is there and can be neither written nor replaced."""
    for ending in (*STREAMS, ".html", ".svg"):
        (folder / f"out{ending}").touch()
    (folder / "first.irl").touch()
    files = [str(path) for path in folder.iterdir()]
    subprocess.run(["chattr", "+i", *files], capture_output=True, check=False)
    return done(call, cwd=folder)


def _gone(folder: Path, call: Words) -> subprocess.CompletedProcess[bytes]:
    """The working folder is removed before the command begins; its files are elsewhere, or were in it."""
    words = [str(folder / word) if (folder / str(word)).is_file() else word for word in call]
    code = 'mkdir gone && cd gone && rmdir ../gone && exec "$@"'
    return done(words, cwd=folder, before=("sh", "-c", code, "sh"))


def _homeless(folder: Path, call: Words) -> subprocess.CompletedProcess[bytes]:
    """Nothing is set at all."""
    kept = [f"PYTHONPATH={os.environ.get('PYTHONPATH') or Path(__file__).parents[3] / 'src'}"]
    return done(call, cwd=folder, before=("env", "-i", *kept))


def _crooked(value: str) -> Callable[[Path, Words], subprocess.CompletedProcess[bytes]]:
    def call_there(folder: Path, call: Words) -> subprocess.CompletedProcess[bytes]:
        return done(call, {"HOME": value, "TMPDIR": value, "XDG_CACHE_HOME": value}, cwd=folder)

    return call_there


KINDS: dict[str, Callable[[Path, Words], subprocess.CompletedProcess[bytes]]] = {
    "a read-only folder": _read_only,
    "a read-only mount": _mounted,
    "unreadable files": _unreadable,
    "files that cannot be replaced": _untouchable,
    "a folder that is gone": _gone,
    "nothing set": _homeless,
    "HOME=/proc/none": _crooked("/proc/none"),
    "HOME is a file": _crooked("/etc/passwd"),
}


def names(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Bytes that are no UTF-8, line ends, quotes and more in names of programs, cells, outputs, folders."""
    strange = (
        b"\xff\xfe",
        b"a\nb",
        b"a\x1b[31mb",
        b"a\"b'c",
        b"a b ",
        b"-x",
        b"\xed\xa0\x80",
        b"x" * 200,
        b"%s{}",
    )
    tried = [(name, call, where) for name in strange for call in CALLS for where in ("folder", "files")]
    locales = ({"LC_ALL": "C.UTF-8"}, {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"})
    for name, call, where in dice.sample(tried, min(count, len(tried))):
        _filled(place)
        folder, words = os.fsencode(place.folder), [os.fsencode(word) for word in call]
        if where == "folder":
            os.mkdir(folder + b"/" + name)
            for path in [path for path in place.folder.iterdir() if path.is_file()]:
                shutil.copy(path, folder + b"/" + name + b"/" + os.fsencode(path.name))
            ended = done(words, dice.choice(locales), cwd=folder + b"/" + name)
        else:
            for path in [path for path in place.folder.iterdir() if path.is_file()]:
                shutil.copy(path, folder + b"/" + name + os.fsencode(path.name))
            files = [b"./" + name + word if b"." in word or word == b"first" else word for word in words]
            ended = done(files, dice.choice(locales), cwd=folder)
        yield _judged(f"{name!r} as {where}: irlx {' '.join(call)}", ended)


def clocks(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Clocks that jump, back as well, while a command goes on (needs libfaketime)."""
    library = next((path for path in LIBRARIES if os.path.exists(path)), None)
    if library is None:
        print("clocks: libfaketime is not there", flush=True)
        return
    for number in range(count):
        _filled(place)
        call = CALLS[0] if number % 3 else dice.choice(CALLS)
        with tempfile.TemporaryDirectory() as other:
            said = Path(other) / "time"
            said.write_text(dice.choice(["-20y", "+60y", "-0", "@1970-01-01 00:00:01"]))
            stop = threading.Event()
            jumps = threading.Thread(target=_jump, args=(said, stop, random.Random(dice.random())))
            jumps.start()
            try:
                more = {"LD_PRELOAD": library, "FAKETIME_TIMESTAMP_FILE": str(said), "FAKETIME_NO_CACHE": "1"}
                ended = done(call, more, cwd=place.folder)
            finally:
                stop.set()
                jumps.join()
        trial = _judged(f"a clock that jumps: irlx {' '.join(call)}", ended)
        if call == CALLS[0]:
            for ending in (*STREAMS, ".html"):
                trial.faults += place.faults(f"out{ending}", "", leftovers=False)
            if ended.returncode:
                trial.faults.append("it fails")
        yield trial


def _jump(said: Path, stop: threading.Event, dice: random.Random) -> None:
    while not stop.wait(dice.uniform(0.0, 0.05)):
        beside = said.with_suffix(".new")
        beside.write_text(f"{dice.choice('+-')}{dice.randrange(100_000)}")
        beside.replace(said)


def masses(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Programs, cells and models of 100 MB; a cell with 100,000 obstacles, a program with 100,000 lines."""
    box = '[[obstacle]]\nname = "o{}"\nshape = "box"\nsize = [10, 10, 10]\nxyz = [{}, 5000, 0]\nmargin = 1\n'
    cell = (place.folder / "p.toml").read_text()
    obstacles = cell + "".join(box.format(n, 20 * n) for n in range(100_000))
    asked = ["run", "p.irl", "--cell", "big.toml", "-o", "out.irdata", "--html", "out.html"]
    made: list[tuple[str, str, Words]] = [
        ("big.irl", "PROGRAM p; BEGIN" + " WAIT 0.1 SEC;" * 7_000_000 + "ENDPROGRAM", ["check", "big.irl"]),
        ("big.irl", "{" + "x" * 100_000_000 + "}", ["fmt", "big.irl"]),
        ("big.toml", "# x\n" * 25_000_000, ["run", "p.irl", "--cell", "big.toml"]),
        ("big.urdf", "<robot>" + "<link/>" * 15_000_000 + "</robot>", ["robots", "--check", "big.urdf"]),
        ("big.toml", obstacles, ["check", "p.irl", "--cell", "big.toml"]),
        ("big.toml", obstacles, asked),
    ]  # fmt: skip
    for name, content, call in made[:count]:
        _filled(place)
        (place.folder / name).write_text(content)
        ended = done(call, cwd=place.folder)
        yield _judged(f"{len(content):,} bytes: {' '.join(map(str, call))}", ended)
