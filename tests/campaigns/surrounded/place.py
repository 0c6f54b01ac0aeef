"""A folder in which commands are disturbed, and what has to hold in it afterwards."""

from __future__ import annotations

import hashlib
import os
import shutil
from dataclasses import dataclass, field
from pathlib import Path

from irlx.streams import StreamError, read_stream

CELL = '[robot]\nmodel = "planar3"\n[motion]\ntick_ms = 4\n'
PROGRAM = """PROGRAM p;
VAR INT: i;
BEGIN
  MOVE PTP MAIN_JOINT(30, 60, -40);
  FOR i := 1 TO {rounds} DO
    MOVE_INC LIN POSITION(60, 40, 0) C_CP := 10;
    MOVE_INC LIN POSITION(0, -80, 0);
    WAIT 0.05 SEC;
    MOVE_INC LIN POSITION(-60, 40, 0);
  ENDFOR;
ENDPROGRAM
"""
STREAMS = (".irdata", ".csv", ".jsonl", ".npz", ".parquet", ".rosbag")
OTHERS = (".html", ".svg")
CUT = {"IRL705"}
"""Codes of a file that was cut before its header was whole."""


@dataclass
class Trial:
    """One disturbed command: what it was, how it ended, and what it broke."""

    what: str
    code: object = 0
    faults: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Place:
    """A folder with programs p.irl and q.irl (shorter), a cell of each, and p.irdata, the stream of p."""

    folder: Path
    whole: dict[str, str]

    @classmethod
    def made(cls, folder: Path) -> Place:
        """Make the files, and what an undisturbed run writes in every form."""
        from irlx.cli.main import main

        for name, rounds in (("p", 3), ("q", 2)):
            (folder / f"{name}.irl").write_text(PROGRAM.format(rounds=rounds))
            (folder / f"{name}.toml").write_text(CELL)
        place = cls(folder, {})
        os.chdir(folder)
        for name in ("p", "q"):
            outputs = [word for ending in STREAMS for word in ("-o", f"{name}{ending}")]
            code = main(["run", f"{name}.irl", *outputs, "--html", f"{name}.html", "--quiet"])
            code |= main(["plot", f"{name}.irdata", "-o", f"{name}.svg"])
            if code:
                raise SystemExit("an undisturbed run went wrong")
            for ending in STREAMS + OTHERS:
                path = folder / f"{name}{ending}"
                place.whole[path.name] = digest(path)
                if path.name != "p.irdata":
                    shutil.rmtree(path) if path.is_dir() else path.unlink()
        return place

    def cleared(self) -> None:
        """Remove whatever a trial has left."""
        for path in self.folder.iterdir():
            if path.name in ("p.irl", "q.irl", "p.toml", "q.toml", "p.irdata"):
                continue
            shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()

    def faults(self, asked: str, old: str | None, leftovers: bool, ending: str | None = None) -> list[str]:
        """What is wrong with the name `asked`, which held what has the digest `old` or nothing.

        `leftovers`: whether temporary files may be there, as behind a process that was killed.
        """
        path, found = self.folder / asked, []
        suffix = ending or path.suffix
        if path.exists() or path.is_symlink():
            now = digest(path)
            if now not in (old, self.whole[f"p{suffix}"], self.whole[f"q{suffix}"]):
                found.append(f"{asked} is neither whole nor what it was")
        elif old is not None and not (leftovers and suffix == ".rosbag"):
            found.append(f"{asked} is gone")
        for left in self.folder.iterdir():
            if left.name.startswith(".irlx-"):
                found += [f"{left.name} is left"] if not leftovers else unreadable(left)
            elif ".partial" in left.name and left.suffix in STREAMS:
                found += unreadable(left, must=True)
        return found


def digest(path: Path) -> str:
    """SHA-256 of a file, or of all files of a folder with their names; '' for what cannot be read."""
    found = hashlib.sha256()
    try:
        files = sorted(path.iterdir()) if path.is_dir() else [path]
        for file in files:
            found.update(file.name.encode() if path.is_dir() else b"")
            found.update(file.read_bytes())
    except OSError:
        return ""
    return found.hexdigest()


def unreadable(path: Path, must: bool = False) -> list[str]:
    """What is wrong with a file that was not ended, or that `must` be a stream marked incomplete."""
    if path.suffix not in STREAMS or (path.suffix in (".npz", ".parquet") and not must):
        return []
    try:
        stream = read_stream(path)
    except StreamError as error:
        cut = error.reason.code in CUT or (path.suffix == ".rosbag" and error.reason.code == "IRL701")
        return [] if cut and not must else [f"{path.name}: {error}"]
    # A whole file that was killed between its end and its new name is no fault.
    return [f"{path.name} says it is complete"] if stream.complete and must else []


def told(code: object, output: str, codes: tuple[object, ...], memory: bool = False) -> list[str]:
    """What is wrong with how a command ended and what it said."""
    found = []
    if code not in codes:
        found.append(f"exit code {code}")
    if "Traceback" in output or "Exception ignored" in output:
        found.append(f"a traceback: {output[-300:]!r}")
    if "internal error" in output and not (memory and "memory" in output):
        found.append(f"an internal error: {output[-300:]!r}")
    return found
