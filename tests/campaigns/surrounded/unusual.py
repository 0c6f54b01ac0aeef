"""The same bytes whatever is set around a run; inputs that are no files; channels that are closed or full."""

from __future__ import annotations

import os
import random
import resource
import shutil
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from surrounded.outside import done, environment
from surrounded.place import STREAMS, Place, Trial, digest, told

LOCALES = (("tr_TR", "UTF-8"), ("tr_TR", "ISO-8859-9"), ("de_DE", "UTF-8"), ("ja_JP", "EUC-JP"))
ASKED = [word for ending in STREAMS for word in ("-o", f"out{ending}")]
WRITTEN = (".npz", ".irdata", ".html")
"""What every program of the repository is written to."""
ROOT = Path(__file__).resolve().parents[3]


@dataclass
class Setting:
    """What is set around a run: variables, options of Python, what its process does first, its folder."""

    what: str
    variables: dict[str, str | None] = field(default_factory=dict)
    python: tuple[str, ...] = ()
    prepare: Callable[[], None] | None = None
    elsewhere: bool = False


def all_settings(locales: Path) -> list[Setting]:
    """Every setting that is tried; locales that the system can make are made in a folder."""
    found = [Setting("nothing")]
    for name, charset in LOCALES:
        made = subprocess.run(
            ["localedef", "-i", name, "-f", charset, str(locales / f"{name}.{charset}")],
            capture_output=True, check=False,
        ) if shutil.which("localedef") else None  # fmt: skip
        if made is not None and (locales / f"{name}.{charset}").exists():
            variables = {"LC_ALL": f"{name}.{charset}", "LOCPATH": str(locales)}
            found.append(Setting(f"{name}.{charset}", {**variables, "PYTHONUTF8": "0"}))
    plain = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    found += [
        Setting("C", plain),
        Setting("POSIX, ascii", {**plain, "LC_ALL": "POSIX", "PYTHONIOENCODING": "ascii"}),
    ]
    found += [Setting("LC_NUMERIC", {"LC_NUMERIC": "de_DE.UTF-8", "LC_ALL": None, "LOCPATH": str(locales)})]
    found += [
        Setting(f"TZ={zone}", {"TZ": zone}) for zone in ("Asia/Tokyo", "nonsense", ":", "XXX-99:99", "")
    ]
    found += [Setting(f"PYTHONHASHSEED={seed}", {"PYTHONHASHSEED": seed}) for seed in ("0", "1", "random")]
    found += [Setting(f"OPENBLAS_NUM_THREADS={n}", {"OPENBLAS_NUM_THREADS": n}) for n in ("1", "2", "4")]
    found += [Setting(f"OMP_NUM_THREADS={n}", {"OMP_NUM_THREADS": n}) for n in ("1", "4")]
    found += [Setting("no HOME", {"HOME": None}), Setting("HOME=/proc", {"HOME": "/proc"})]
    found += [Setting("no TMPDIR", {"TMPDIR": "/nonexistent"}), Setting("another folder", elsewhere=True)]
    found += [
        Setting(" ".join(words), python=words)
        for words in (("-O",), ("-OO",), ("-W", "error"), ("-X", "dev"))
    ]
    found += [Setting("COLUMNS=1", {"COLUMNS": "1", "LINES": "1"}), Setting("TERM=dumb", {"TERM": "dumb"})]
    found += [Setting("20 open files", prepare=limited(resource.RLIMIT_NOFILE, 20))]
    return [*found, Setting("a stack of 512 KB", prepare=limited(resource.RLIMIT_STACK, 1 << 19))]


def limited(what: int, most: int) -> Callable[[], None]:
    """What sets a limit of the process that calls it."""
    return lambda: resource.setrlimit(what, (most, most))


def settings(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Every setting gives the same streams, page and messages."""
    with tempfile.TemporaryDirectory() as locales:
        chosen = all_settings(Path(locales))
        first: str | None = None
        for setting in [chosen[0], *dice.sample(chosen[1:], min(count, len(chosen)) - 1)]:
            place.cleared()
            (place.folder / "sub").mkdir()
            up = "../" if setting.elsewhere else ""
            asked = [f"{up}{word}" if word.startswith("out") else word for word in ASKED]
            ended = done(
                ["run", f"{up}p.irl", *asked, "--html", f"{up}out.html"],
                setting.variables, setting.python, setting.prepare,
                cwd=place.folder / ("sub" if setting.elsewhere else ""),
            )  # fmt: skip
            said = (ended.stdout + ended.stderr).decode(errors="replace").replace("../", "")
            trial = Trial(setting.what, ended.returncode, told(ended.returncode, said, (0,)))
            first = first or said
            if _squeezed(said) != _squeezed(first):
                trial.faults.append(f"other words: {said!r}")
            for ending in (*STREAMS, ".html"):
                if digest(place.folder / f"out{ending}") != place.whole[f"p{ending}"]:
                    trial.faults.append(f"another {ending}")
            yield trial


def _squeezed(text: str) -> str:
    """Columns are as wide as the longest path in them, which a way to another folder makes longer."""
    return " ".join(text.split())


def inputs(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Folders, FIFOs, devices, sockets, links, sparse and enormous files in the place of every input."""
    made = _strange_files(place)
    commands = {
        ".irl": ["check", "{}"],
        ".toml": ["run", "p.irl", "--cell", "{}"],
        ".urdf": ["robots", "--check", "{}"],
        ".inputs": ["run", "p.irl", "--inputs", "{}"],
        **{ending: ["verify", "{}"] for ending in STREAMS},
    }  # fmt: skip
    tried = [(kind, ending) for ending in commands for kind in made]
    for kind, ending in dice.sample(tried, min(count, len(tried))):
        place.cleared()
        path = place.folder / f"strange{ending}"
        with made[kind](path):
            command = [word.format(path.name) for word in commands[ending]]
            ended = done(command, prepare=limited(resource.RLIMIT_AS, 3 << 30), timeout=120)
        said = (ended.stdout + ended.stderr).decode(errors="replace")
        yield Trial(f"{kind} as {path.name}", ended.returncode, told(ended.returncode, said, (1, 2)))


class _Left:
    """A context that does nothing, or closes what holds a strange file open."""

    def __init__(self, held: socket.socket | None = None) -> None:
        self._held = held

    def __enter__(self) -> None:
        return None

    def __exit__(self, *_: object) -> None:
        if self._held is not None:
            self._held.close()


def _strange_files(place: Place) -> dict[str, Callable[[Path], _Left]]:
    def sparse(path: Path) -> _Left:
        with path.open("wb") as file:
            file.truncate(4 << 30)
        return _Left()

    def headed(path: Path) -> _Left:
        # Begins well, for those that are text.
        path.write_bytes((place.folder / "p.irdata").read_bytes()[:3000])
        os.truncate(path, 4 << 30)
        return _Left()

    def bound(path: Path) -> _Left:
        held = socket.socket(socket.AF_UNIX)
        held.bind(path.name)
        return _Left(held)

    def wrote(content: bytes) -> Callable[[Path], _Left]:
        def write(path: Path) -> _Left:
            path.write_bytes(content)
            return _Left()

        return write

    return {
        "a folder": lambda path: _Left(path.mkdir()),
        "a FIFO": lambda path: _Left(os.mkfifo(path)),
        "/dev/zero": lambda path: _Left(path.symlink_to("/dev/zero")),
        "a dangling link": lambda path: _Left(path.symlink_to("nowhere")),
        "links in a circle": lambda path: _Left(path.symlink_to(path.name)),
        "a socket": bound,
        "a sparse file of 4 GB": sparse,
        "4 GB behind a good beginning": headed,
        "a line of 10 MB": wrote(b"x" * 10_000_000),
        "30 MB of lines": wrote(b"x := 1;\n" * 3_800_000),
        "bytes that are no text": wrote(bytes(range(256)) * 40),
        "nothing": wrote(b""),
    }


CALLS = [
    ["run", "p.irl", "-o", "out.irdata"],
    ["run", "p.irl", "-o", "out.irdata", "--json"],
    ["run", "no.irl"],
    ["check", "p.irl"],
    ["explain", "IRL203"],
    ["--help"],
    ["run", "--help"],
    ["fmt", "--diff", "p.irl"],
    ["fmt", "-"],
    ["blocks", "p.irl"],
    ["plot", "p.irdata"],
    ["verify", "p.irdata"],
    ["convert", "p.irdata", "-o", "out.jsonl"],
    ["robots"],
    ["nonsense"],
    ["completion", "bash"],
]
CHANNELS = (
    "",
    ">/dev/full",
    ">&-",
    "2>&-",
    "<&-",
    "<&- >&- 2>&-",
    "2>/dev/full",
    ">/dev/full 2>/dev/full",
    "| head -c 1",
    "2>&1 | true",
)


def channels(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Stdin, stdout and stderr closed, full, or without a reader: the usual exit code, or one that tells."""
    tried = [(call, channel) for call in CALLS for channel in CHANNELS[1:]]
    usual: dict[str, int] = {}
    for call, channel in dice.sample(tried, min(count, len(tried))):
        place.cleared()
        name = " ".join(call)
        if name not in usual:
            usual[name] = done(call, stdin=(place.folder / "p.irl").open()).returncode
            place.cleared()
        words = " ".join(
            ["exec" if "|" not in channel else "", sys.executable, "-m irlx", *call, "<p.irl", channel]
        )
        ended = subprocess.run(
            ["bash", "-o", "pipefail", "-c", words],
            env=environment(),
            capture_output=True,
            timeout=120,
            check=False,
        )
        said = (ended.stdout + ended.stderr).decode(errors="replace")
        codes: tuple[object, ...] = (usual[name],)
        if ">/dev/full" in channel.replace("2>/dev/full", ""):
            codes = (2,)
        elif name == "fmt -" and "<&-" in channel:
            codes = (1,)
        trial = Trial(f"irlx {name} {channel}", ended.returncode, told(ended.returncode, said, codes))
        for ending in (".irdata", ".jsonl"):
            trial.faults += place.faults(f"out{ending}", None, leftovers=False)
        if (
            call[0] == "run"
            and name != "run no.irl"
            and "-o" in call
            and not (place.folder / "out.irdata").exists()
        ):
            trial.faults.append("no stream")
        yield trial


def programs(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """All programs of the repository: to files with other threads, seeds, folders, and sample by sample."""
    found = sorted((ROOT / "programs").rglob("*.irl"))
    shutil.copytree(ROOT / "programs", place.folder / "programs")
    for path in dice.sample(found, min(count, len(found))):
        inner = place.folder / path.relative_to(ROOT)
        if (
            not inner.read_text().lstrip().upper().startswith(("PROGRAM", "{", "SYSTEM"))
            or "MODULE " in inner.read_text()[:200]
        ):
            continue
        yield _in_two_settings(place.folder, inner, str(path.relative_to(ROOT)))


def _in_two_settings(folder: Path, program: Path, what: str) -> Trial:
    """One program, called from afar with one thread, and beside it with several and another hash seed."""
    variants = (
        ("first", {"PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1"}, folder, program),
        (
            "other",
            {"PYTHONHASHSEED": "1", "OPENBLAS_NUM_THREADS": "2", "OMP_NUM_THREADS": "4"},
            program.parent,
            Path(program.name),
        ),
    )
    ended, said = [], []
    for name, more, cwd, called in variants:
        shutil.rmtree(folder / name, ignore_errors=True)
        (folder / name).mkdir()
        outputs = [str(folder / name / f"out{ending}") for ending in WRITTEN]
        asked = ["-o", outputs[0], "-o", outputs[1], "--html", outputs[2]]
        done_so = done(["run", str(called), *asked], more, cwd=cwd)
        ended.append(done_so)
        words = (done_so.stdout + done_so.stderr).decode(errors="replace")
        # What is not asked to be the same: the way to the program and to the files.
        said.append(_squeezed(words.replace(f"{folder / name}/", "").replace(f"{program.parent}/", "")))
    trial = Trial(what, ended[0].returncode)
    for one, words in zip(ended, said, strict=True):
        trial.faults += told(one.returncode, words, (0, 1))
    if ended[0].returncode != ended[1].returncode:
        trial.faults.append(f"other exit codes: {[one.returncode for one in ended]}")
    if said[0] != said[1]:
        trial.faults.append(f"other words: {said}")
    for ending in WRITTEN:
        if digest(folder / f"first/out{ending}") != digest(folder / f"other/out{ending}"):
            trial.faults.append(f"another {ending}")
    if ended[0].returncode == 0:
        trial.faults += _streamed_otherwise(program, folder / "first/out.npz")
    return trial


def _streamed_otherwise(program: Path, written: Path) -> list[str]:
    """Where the samples of `irlx.stream` are not those of the file, bit for bit."""
    import numpy as np

    import irlx

    with np.load(written) as arrays:
        q, tool, block = arrays["q"], arrays["tool"], arrays["block"]
    samples = list(irlx.stream(program))
    same = (
        np.array_equal(np.array([one.q for one in samples]), q)
        and np.array_equal(np.array([one.tool for one in samples]), tool)
        and [one.block for one in samples] == block.tolist()
    )
    return [] if same else ["irlx.stream gives other samples"]
