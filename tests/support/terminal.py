"""What a person at a terminal sees of a command: in a process of its own, or inside this one."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import sys
import termios
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryFile
from unittest import mock

import irlx
from irlx.cli.main import main

_LONGEST = 120.0
_SOURCE = str(Path(irlx.__file__).parents[1])


def seen(
    arguments: Sequence[object],
    folder: Path,
    env: Mapping[str, str] | None = None,
    columns: int = 80,
    piped: bool = False,
) -> tuple[int, str, str]:
    """Run `irlx` in a terminal of so many columns: exit code, what appears there, and stdout if `piped`."""
    master, slave = _terminal(columns)
    environment = _environment(env)
    command = [sys.executable, "-m", "irlx", *map(str, arguments)]
    stdout = subprocess.PIPE if piped else slave
    process = subprocess.Popen(command, cwd=folder, env=environment, stdin=slave, stdout=stdout, stderr=slave)
    os.close(slave)
    told = _read(master, process)
    out = process.stdout.read().decode("utf-8") if process.stdout is not None else ""
    code = process.wait(timeout=_LONGEST)
    os.close(master)
    if process.stdout is not None:
        process.stdout.close()
    return code, told.decode("utf-8"), out


def seen_inside(
    arguments: Sequence[object],
    folder: Path,
    env: Mapping[str, str] | None = None,
    columns: int = 80,
    piped: bool = False,
) -> tuple[int, str, str]:
    """As `seen`, without the start of a process: the terminal takes the place of channels 0 to 2."""
    master, slave = _terminal(columns)
    told: list[bytes] = []
    reader = threading.Thread(target=_drain, args=(master, told))
    before = Path.cwd()
    with TemporaryFile() as out, mock.patch.dict(os.environ, _environment(env), clear=True):
        os.chdir(folder)
        try:
            encoding = os.environ.get("PYTHONIOENCODING", "utf-8")
            with _channels(encoding, slave, out.fileno() if piped else slave, slave):
                os.close(slave)
                reader.start()
                code = main([str(argument) for argument in arguments])
        finally:
            os.chdir(before)
        reader.join(_LONGEST)
        os.close(master)
        out.seek(0)
        return code, b"".join(told).decode("utf-8"), out.read().decode("utf-8")


def _terminal(columns: int) -> tuple[int, int]:
    """Both sides of a new terminal."""
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    return master, slave


def _environment(env: Mapping[str, str] | None) -> dict[str, str]:
    environment = {**os.environ, "PYTHONPATH": _SOURCE, "TERM": "xterm-256color", **(env or {})}
    for name in ("COLUMNS", "LINES", "FORCE_COLOR", *({"NO_COLOR"} - {*(env or {})})):
        environment.pop(name, None)
    return environment


@contextmanager
def _channels(encoding: str, *descriptors: int) -> Iterator[None]:
    """Stdin, stdout and stderr lead there, for Python and for what asks the system."""
    with ExitStack() as stack:
        for number, (name, mode) in enumerate((("stdin", "r"), ("stdout", "w"), ("stderr", "w"))):
            kept = os.dup(number)
            stack.callback(os.close, kept)
            stack.callback(os.dup2, kept, number)
            os.dup2(descriptors[number], number)
            stream = stack.enter_context(open(number, mode, encoding=encoding, closefd=False))
            stack.enter_context(mock.patch.object(sys, name, stream))
        yield


def _drain(master: int, told: list[bytes]) -> None:
    """Everything that appears until nobody has the other side of the terminal open."""
    # Linux reports the end of a terminal as an error.
    with suppress(OSError):
        while piece := os.read(master, 65536):
            told.append(piece)


def _read(master: int, process: subprocess.Popen[bytes]) -> bytes:
    """Everything that appears until the process has ended."""
    told, until = b"", time.monotonic() + _LONGEST
    while time.monotonic() < until:
        ready, _, _ = select.select([master], [], [], 0.2)
        if ready:
            try:
                piece = os.read(master, 65536)
            except OSError:
                break
            if not piece:
                break
            told += piece
        elif process.poll() is not None:
            break
    return told


def bare(text: str) -> str:
    """A text without escape sequences."""
    return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text)
