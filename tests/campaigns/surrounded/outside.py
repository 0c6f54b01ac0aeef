"""Commands as processes of their own: Ctrl-C from the first moment on, terminals, little memory."""

from __future__ import annotations

import os
import pty
import random
import resource
import select
import signal
import subprocess
import sys
import termios
import time
from collections.abc import Callable, Iterator, Mapping, Sequence

from surrounded.place import Place, Trial, told

HUNG = -999
"""What stands for the exit code of a command that has no end."""
IRLX = (sys.executable, "-m", "irlx")


def environment(more: Mapping[str, str | None] | None = None) -> dict[str, str]:
    """Environment of a command, with changes; None takes a variable away."""
    found = {**os.environ, "PYTHONPATH": next(path for path in sys.path if path.endswith("src"))}
    for name, value in (more or {}).items():
        found.pop(name, None)
        if value is not None:
            found[name] = value
    return found


def done(
    arguments: Sequence[str | bytes],
    more: Mapping[str, str | None] | None = None,
    python: Sequence[str] = (),
    prepare: Callable[[], None] | None = None,
    before: Sequence[str] = (),
    **options: object,
) -> subprocess.CompletedProcess[bytes]:
    """A command that has ended, with the code HUNG where it did not.

    `before` are words of another command that carries it out; `prepare` is called in its process first.
    """
    given = {"stdin": subprocess.DEVNULL, "capture_output": True, "timeout": 900, **options}
    call = [*before, sys.executable, *python, "-m", "irlx", *arguments]
    try:
        return subprocess.run(call, env=environment(more), preexec_fn=prepare, check=False, **given)
    except subprocess.TimeoutExpired as late:
        return subprocess.CompletedProcess(call, HUNG, late.stdout or b"", late.stderr or b"")


def _hears(process: subprocess.Popen[bytes]) -> bool:
    """Whether irlx has a say by now: while Python itself comes up, signals end it in their own way."""
    with open(f"/proc/{process.pid}/status") as status:
        caught = next(int(line.split()[1], 16) for line in status if line.startswith("SigCgt"))
    return bool(caught >> (signal.SIGTERM - 1) & 1)


def _interruptible() -> None:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def interrupts(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Ctrl-C at a random moment from the start of the process on, sometimes twice."""
    began = time.monotonic()
    done(["run", "p.irl", "-o", "first.irdata", "-o", "first.csv"])
    took = time.monotonic() - began
    for _ in range(count):
        place.cleared()
        at = dice.uniform(0.0, 1.1 * took)
        process = subprocess.Popen(
            [*IRLX, "run", "p.irl", "-o", "out.irdata", "-o", "out.csv", "--html", "out.html"],
            env=environment(),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            preexec_fn=_interruptible,  # noqa: PLW1509
        )
        time.sleep(at)
        early = process.poll() is None and not _hears(process)
        process.send_signal(signal.SIGINT)
        if again := dice.random() < 0.3:
            time.sleep(dice.uniform(0.0, 0.05))
            process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=120)
        code, said = process.returncode, errors.decode()
        what = f"Ctrl-C {'twice ' if again else ''}at {at:.3f} of {took:.1f} s"
        trial = Trial(what, code, [] if early else told(code, said, (0, 130)))
        if code == 130 and not early and said.count("irlx: interrupted") != 1:
            trial.faults.append(f"not one message: {said!r}")
        for ending in (".irdata", ".csv", ".html"):
            trial.faults += place.faults(f"out{ending}", None, leftovers=code < 0)
        yield trial


def terminal(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Ctrl-C or SIGTERM on a terminal: it is left as it was, its cursor visible."""
    for number in range(count):
        place.cleared()
        master, slave = pty.openpty()
        before = termios.tcgetattr(slave)
        process = subprocess.Popen(
            [*IRLX, "run", "p.irl", "-o", "out.irdata"], env=environment({"TERM": "xterm"}),
            stdin=slave, stdout=slave, stderr=slave, preexec_fn=_interruptible,  # noqa: PLW1509
        )  # fmt: skip
        which = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)[number % 3]
        at = dice.uniform(0.1, 1.6)
        time.sleep(at)
        early = process.poll() is None and not _hears(process)
        process.send_signal(which)
        shown = _shown(master, process)
        code = process.wait(60)
        trial = Trial(f"{which.name} at {at:.3f} s on a terminal", code)
        trial.faults = [] if early else told(code, shown, (0, 128 + which))
        if shown.rfind("\x1b[?25l") > shown.rfind("\x1b[?25h"):
            trial.faults.append("the cursor stays hidden")
        if termios.tcgetattr(slave) != before:
            trial.faults.append("the terminal has other settings")
        os.close(slave)
        os.close(master)
        trial.faults += place.faults("out.irdata", None, leftovers=False)
        yield trial


def _shown(master: int, process: subprocess.Popen[bytes]) -> str:
    shown, end = b"", time.monotonic() + 60
    while time.monotonic() < end:
        if select.select([master], [], [], 0.05)[0]:
            shown += os.read(master, 1 << 16)
        elif process.poll() is not None:
            break
    return shown.decode(errors="replace")


def memory(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Address spaces from too small for the libraries up to what a run needs."""
    for number in range(count):
        place.cleared()
        most = int(1e6 * (60 + 640 * number / max(1, count - 1)))
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (most, most))  # noqa: B023, E731
        ended = done(["run", "p.irl", "-o", "out.npz", "--html", "out.html"], prepare=limit)
        said = (ended.stdout + ended.stderr).decode(errors="replace")
        # OpenBLAS ends the process itself where it gets no memory; Python where it cannot even begin.
        own = "OpenBLAS" in said or "Python runtime state" in said or "irlx" not in said
        trial = Trial(f"{most / 1e6:.0f} MB", ended.returncode)
        hangs = ended.returncode == HUNG
        trial.faults = [] if own and not hangs else told(ended.returncode, said, (0, 2), memory=True)
        for ending in (".npz", ".html"):
            trial.faults += place.faults(f"out{ending}", None, leftovers=ended.returncode < 0)
        yield trial
