"""Commands in forks of this process, which has everything loaded: full disks, kills, two at once."""

from __future__ import annotations

import os
import random
import resource
import select
import signal
import sys
import time
import traceback
from collections.abc import Iterator, Sequence

from surrounded.place import OTHERS, STREAMS, Place, Trial, digest, told

KILLED = (-signal.SIGKILL,)
DONE = (0,)
BESIDE = ("-o", "beside.irdata")


class Forked:
    """A command of irlx in a fork; `file_size` is the longest file it may write."""

    def __init__(self, arguments: Sequence[str], file_size: int | None = None) -> None:
        self._output, own = os.pipe()
        sys.stdout.flush()
        self.process = os.fork()
        if not self.process:
            self._carry_out(arguments, own, file_size)
        os.close(own)

    def _carry_out(self, arguments: Sequence[str], output: int, file_size: int | None) -> None:
        code = 99
        try:
            # Python keeps half of a module's bytecode where there is no room for all of it.
            sys.dont_write_bytecode = True
            os.dup2(output, 1)
            os.dup2(output, 2)
            if file_size is not None:
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (file_size, file_size))
            from irlx.cli.main import entry_point

            sys.argv = ["irlx", *arguments]
            entry_point()
        except SystemExit as ended:
            code = int(ended.code or 0)
        except BaseException:
            traceback.print_exc()
        finally:
            sys.stdout.flush()
            os._exit(code)

    def ended(self) -> tuple[int, str]:
        """Exit code, negative for a signal, and what it said."""
        said = b""
        while select.select([self._output], [], [], 60)[0] and (piece := os.read(self._output, 1 << 16)):
            said += piece
        os.close(self._output)
        _, status = os.waitpid(self.process, 0)
        return os.waitstatus_to_exitcode(status), said.decode(errors="replace")


def command_for(ending: str, out: str, dice: random.Random) -> list[str]:
    """A command that writes a file of this kind."""
    if ending == ".html":
        return ["run", "p.irl", *BESIDE, "--html", out, "--no-verify"]
    if ending == ".svg":
        return ["plot", "p.irdata", "-o", out]
    if ending in OTHERS or dice.random() < 0.4:
        return ["convert", "p.irdata", "-o", out]
    return ["run", "p.irl", "-o", out]


def _old(place: Place, name: str, dice: random.Random) -> str | None:
    """Maybe something of an earlier run under this name; its digest."""
    if dice.random() < 0.5:
        return None
    code, said = Forked(command_for(os.path.splitext(name)[1], name, random.Random(0))).ended()
    if code:
        raise SystemExit(f"an undisturbed command went wrong: {said}")
    return digest(place.folder / name)


def disk(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Files that may not grow beyond a random size, as on a disk that is full."""
    kinds = [*STREAMS, *OTHERS, "fmt", "new"]
    for number in range(count):
        place.cleared()
        ending = kinds[number % len(kinds)]
        if ending in ("fmt", "new"):
            yield _small(place, ending, dice)
            continue
        name = f"out{ending}"
        old = _old(place, name, dice)
        size = int(10 ** dice.uniform(0, 5.5))
        command = command_for(ending, name, dice)
        code, said = Forked(command, size).ended()
        trial = Trial(f"{' '.join(command)}, {size} bytes", code, told(code, said, (0, 2)))
        if code == 2 and "IRL003" not in said:
            trial.faults.append(f"IRL003 is missing: {said[-200:]!r}")
        if code == 0 and digest(place.folder / name) != place.whole[f"p{ending}"]:
            trial.faults.append("it says that all is well")
        trial.faults += place.faults(name, old, leftovers=False)
        yield trial


def _small(place: Place, kind: str, dice: random.Random) -> Trial:
    """A program formatted in place, or files made by irlx new."""
    size = dice.randrange(0, 300)
    path = place.folder / ("messy.irl" if kind == "fmt" else "first.irl")
    before = (place.folder / "p.irl").read_text().replace(" := ", ":=")
    if kind == "fmt":
        path.write_text(before)
    command = ["fmt", path.name] if kind == "fmt" else ["new", "first", "--robot", "planar3", "--tip", "tool"]
    code, said = Forked(command, size).ended()
    trial = Trial(f"{' '.join(command)}, {size} bytes", code, told(code, said, (0, 2)))
    if kind == "fmt" and code and path.read_text() != before:
        trial.faults.append("the program is not what it was")
    if kind == "new" and path.exists() and not path.read_text().rstrip().endswith("ENDPROGRAM"):
        trial.faults.append("half a program")
    trial.faults += [f"{left.name} is left" for left in place.folder.glob(".irlx-*")]
    return trial


def kills(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """SIGKILL, SIGTERM and SIGINT at a random moment."""
    took: dict[tuple[str, str], float] = {}
    for number in range(count):
        place.cleared()
        ending = STREAMS[number % len(STREAMS)]
        name = f"out{ending}"
        old = _old(place, name, dice)
        command = command_for(ending, name, dice)
        kind = command[0], ending
        if kind not in took:
            began = time.monotonic()
            Forked([*command[:-1], f"first{ending}"]).ended()
            took[kind] = time.monotonic() - began
        which = dice.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
        at = dice.uniform(0.0, 1.1 * took[kind])
        forked = Forked(command)
        time.sleep(at)
        os.kill(forked.process, which)
        code, said = forked.ended()
        # Before the handlers are there, a signal ends the process as ever.
        codes = (0, -which) if which == signal.SIGKILL else (0, 128 + which, -which)
        trial = Trial(f"{' '.join(command)}, {which.name} at {at:.3f} s", code, told(code, said, codes))
        trial.faults += place.faults(name, old, leftovers=which == signal.SIGKILL or code == -which)
        yield trial


def twice(place: Place, dice: random.Random, count: int) -> Iterator[Trial]:
    """Two commands that write under the same name at once, of different programs."""
    for number in range(count):
        place.cleared()
        ending = (*STREAMS, ".html")[number % (len(STREAMS) + 1)]
        name = f"out{ending}"
        old = _old(place, name, dice)
        option = (
            ["--html", name, "-o", "/dev/shm/irlx-surroundings.irdata"] if ending == ".html" else ["-o", name]
        )
        order = ["p.irl", "q.irl"] if dice.random() < 0.5 else ["q.irl", "p.irl"]
        wait = dice.uniform(0.0, 0.15)
        first = Forked(["run", order[0], *option, "--no-verify"])
        time.sleep(wait)
        second = Forked(["run", order[1], *option, "--no-verify"])
        ended = [first.ended(), second.ended()]
        codes = tuple(code for code, _ in ended)
        trial = Trial(f"{' and '.join(order)} to {name}, {wait:.3f} s apart", codes)
        for code, said in ended:
            trial.faults += told(code, said, DONE)
        trial.faults += place.faults(name, old, leftovers=False)
        if (
            digest(place.folder / name) == old
            and old is not None
            and codes == (0, 0)
            and old not in place.whole.values()
        ):
            trial.faults.append("neither has written")
        yield trial
