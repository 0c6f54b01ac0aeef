"""What a person at a terminal sees of a command: a process in a pseudo-terminal."""

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
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import irlx

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
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    environment = {**os.environ, "PYTHONPATH": _SOURCE, "TERM": "xterm-256color", **(env or {})}
    for name in ("COLUMNS", "LINES", "FORCE_COLOR", *({"NO_COLOR"} - {*(env or {})})):
        environment.pop(name, None)
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
