"""Instructions that fixed pieces of work take, counted by Valgrind, beside stored counts.

    python benchmarks/instructions.py            prints a table (--json: an object)
    python benchmarks/instructions.py --check    exits 1 where a count is 2 % over its stored one
    python benchmarks/instructions.py --update   stores the counts in instructions.json
    python benchmarks/instructions.py --twice    counts twice, and prints how far the two differ
    python benchmarks/instructions.py --only text,streams    of the groups text, ticks, streams, commands

Unlike times, counts hardly depend on what else the machine does. They do depend on the versions of Python
and of the libraries and, through kernels that these choose at run time, on the kind of processor; OpenBLAS is
held to one kind of kernel. Stored counts of other versions are compared all the same, and what differs is
told. The pieces of `workloads.py` are counted inside a process, without its start; whole commands from
beginning to end, less a Python that does nothing. Needs `valgrind` on x86-64, and minutes on two cores.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Collection, Sequence
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path

from stored_counts import Comparison, Counts
from workloads import GROUPS, short_program

HERE = Path(__file__).resolve().parent
STORED = HERE / "instructions.json"
LIBRARIES = ("numpy", "scipy", "pin", "proxsuite", "lark", "orjson", "pydantic")
COMMANDS = "commands"
NOTHING = ("-c", "pass")
FIXED = {
    "PYTHONHASHSEED": "0",
    "PYTHONPATH": str(HERE.parent / "src"),
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "OPENBLAS_CORETYPE": "Haswell",
    "LC_ALL": "C.UTF-8",
}
"""The environment of what is counted: bytecode is read from disk there, as that of an installed irlx."""
LEFT = ("PATH", "HOME", "VIRTUAL_ENV")
"""Of the environment as it is, what stays."""


def counted(groups: Collection[str]) -> Counts:
    """Count the pieces of some groups, a process a core at a time."""
    with tempfile.TemporaryDirectory(prefix="irlx") as made:
        folder = Path(made)
        program = short_program(folder)
        commands: dict[str, Sequence[str]] = {
            "irlx --help": ("-m", "irlx", "--help"),
            "irlx run": ("-m", "irlx", "run", str(program), "-o", str(folder / "short.irdata"), "--quiet"),
        }
        if COMMANDS not in groups:
            commands = {}
        inside = {group: (str(HERE / "workloads.py"), group) for group in GROUPS if group in groups}
        with ThreadPoolExecutor(os.cpu_count()) as threads:
            sections = {name: threads.submit(_sections, command, folder) for name, command in inside.items()}
            whole = {name: threads.submit(_whole, command, folder) for name, command in commands.items()}
            nothing = threads.submit(_whole, NOTHING, folder) if commands else None
        found = {name: count for made in sections.values() for name, count in made.result().items()}
        if nothing is not None:
            found |= {name: count.result() - nothing.result() for name, count in whole.items()}
    return Counts(made_with(), found)


def made_with() -> dict[str, str]:
    """What counts depend on beside irlx."""
    valgrind = subprocess.run(["valgrind", "--version"], capture_output=True, text=True, check=True).stdout
    found = {"python": platform.python_version(), **{name: version(name) for name in LIBRARIES}}
    return {**found, "libc": "-".join(platform.libc_ver()), "valgrind": valgrind.strip(), "cpu": processor()}


def processor() -> str:
    """The processor's architecture, and the widest vectors that Valgrind lets libraries see on it."""
    try:
        flags = set(re.findall(r"^flags\s*:(.*)$", Path("/proc/cpuinfo").read_text(), re.M)[0].split())
    except (OSError, IndexError):
        flags = set()
    widest = next((name for name in ("avx2", "avx") if name in flags), "sse")
    return f"{platform.machine()} {widest}"


def _sections(command: Sequence[str], folder: Path) -> dict[str, int]:
    """Counts of a process that marks what is counted, by the names that it gives."""
    out = Path(tempfile.mkdtemp(dir=folder)) / "counts"
    _run(command, out, "--instr-atstart=no")
    found = {}
    for file in sorted(out.parent.glob("counts.*"), key=lambda file: int(file.suffix[1:])):
        text = file.read_text(encoding="utf-8")
        name = re.search(r"^desc: Trigger: Client Request: (.*)$", text, re.M)
        if name is not None:
            found[name[1]] = _total(text)
    return found


def _whole(command: Sequence[str], folder: Path) -> int:
    """Count of a whole process."""
    out = Path(tempfile.mkdtemp(dir=folder)) / "counts"
    _run(command, out)
    return _total(out.read_text(encoding="utf-8"))


def _total(text: str) -> int:
    found = re.search(r"^totals: (\d+)$", text, re.M)
    if found is None:
        raise SystemExit("valgrind wrote no count")
    return int(found[1])


def _run(command: Sequence[str], out: Path, *options: str) -> None:
    """Run Python with arguments, once so that all bytecode is on disk, then in Valgrind."""
    environment = {name: os.environ[name] for name in LEFT if name in os.environ} | FIXED
    plain = [sys.executable, *command]
    valgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", *options, *plain]
    for words in (plain, valgrind):
        done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
        if done.returncode:
            raise SystemExit(f"{' '.join(words)}: exit {done.returncode}\n{done.stderr}")


def difference_of_two(groups: Collection[str]) -> str:
    """Pieces counted twice, and how far the counts differ."""
    first, second = counted(groups).instructions, counted(groups).instructions
    parts = {name: abs(second[name] / first[name] - 1.0) for name in first}
    worst = max(parts, key=lambda name: parts[name])
    lines = [f"{name:26}{first[name]:>16,}{second[name]:>16,}{part:>12.1e}" for name, part in parts.items()]
    return "\n".join([*lines, f"at most {parts[worst]:.1e}, {worst}"])


def main() -> int:
    """Count, and do what is asked; exit code."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--json", action="store_true", help="print an object instead of a table")
    parser.add_argument("--only", default=",".join([*GROUPS, COMMANDS]), help="groups, commas between them")
    asked = parser.add_mutually_exclusive_group()
    asked.add_argument("--check", action="store_true", help="exit 1 where a count is 2 %% over the stored")
    asked.add_argument("--update", action="store_true", help="store the counts")
    asked.add_argument("--twice", action="store_true", help="count twice, and print how far the two differ")
    options = parser.parse_args()
    if shutil.which("valgrind") is None:
        print(
            "valgrind, which counts instructions, is not installed: apt install valgrind",
            file=sys.stderr,
        )
        return 2
    groups = options.only.split(",")
    if not set(groups) <= {*GROUPS, COMMANDS}:
        parser.error(f"--only takes {', '.join([*GROUPS, COMMANDS])}")
    if options.twice:
        print(difference_of_two(groups))
        return 0
    stored = Counts.read(STORED) if STORED.exists() else None
    compared = Comparison(stored, counted(groups))
    if options.json:
        print(json.dumps(compared.found.instructions, indent=2))
    else:
        print("\n".join(compared.table()))
    if options.update:
        # Of a piece that is no more the count goes, too, where all were counted.
        (compared.found if {*GROUPS, COMMANDS} <= set(groups) else compared.updated).write(STORED)
        return 0
    failures = compared.verdict() if options.check else []
    for line in failures:
        print(line, file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
