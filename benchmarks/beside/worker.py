"""A process in which something is measured, asked over pipes, so that all take turns."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

from beside.environments import clean

BENCHMARKS = Path(__file__).resolve().parents[1]


class Worker:
    """Runs a module of this folder with a Python of its own; `versions` are what it says of itself."""

    def __init__(self, name: str, python: Path, module: str, folder: Path, *paths: Path) -> None:
        self.name = name
        command = [str(python), "-m", f"beside.{module}", str(folder)]
        self._process = subprocess.Popen(
            command,
            env=clean(BENCHMARKS, *paths),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.versions: dict[str, str] = self._read()["versions"]

    def ask(self, **request: Any) -> dict[str, Any]:
        """Have one round done. Raises SystemExit where it failed."""
        print(json.dumps(request), file=self._process.stdin, flush=True)
        told = self._read()
        if "failed" in told:
            self.close()
            raise SystemExit(f"{self.name}, {request['case']}, {request['dt'] * 1e3:g} ms: {told['failed']}")
        return told

    def close(self) -> None:
        """End the process."""
        if self._process.stdin is not None:
            self._process.stdin.close()
        self._process.wait()

    def _read(self) -> dict[str, Any]:
        line = "" if self._process.stdout is None else self._process.stdout.readline()
        if not line:
            raise SystemExit(f"{self.name} has ended by itself, exit code {self._process.wait()}")
        told: dict[str, Any] = json.loads(line)
        return told
