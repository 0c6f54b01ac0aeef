"""Mutation testing: damages the code in small ways, and looks whether the tests of its own folder notice.

Of all damages that `mutations.py` knows some are drawn by a seed, all as likely as each other, so that a
folder gets as many as it has code. Each is judged by those tests of the mirrored folder that execute the
damaged lines, quickest first, in a process of its own: a fork of one that has collected the tests, in which
the damaged function has been given another body. What runs while modules are imported is damaged before they
are, in a fork that has only the libraries. A test that takes far longer than it should notices, too.

    python tests/campaigns/mutants.py --mutants 500 --seed 1 --folder motion
    python tests/campaigns/mutants.py --only motion/arc.py#12 motion/arc.py#40
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import importlib
import os
import random
import signal
import sys
import tempfile
from collections.abc import Callable, Iterable
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import CodeType, FunctionType

import pytest
from _pytest.runner import runtestprotocol
from executed_lines import LEFT_OUT, OPTIONS, ROOT, SOURCE, ExecutedLines
from forked import BROKEN, fork, limited, quiet
from mutations import Mutation, mutated, mutations_of

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    import tomli as tomllib

CHECKS = [
    "checking",
    "lints",
    "names.py",
    "moves.py",
    "switches.py",
    "criteria.py",
    "obstacles.py",
    "labels.py",
]
FOLDERS = {
    "motion": (("motion",), "tests/motion"),
    "transform": (("transform",), "tests/transform"),
    "pacing": (("pacing",), "tests/pacing"),
    "checker": (tuple(f"language/{part}" for part in CHECKS), "tests/language"),
}
"""What is damaged, and the tests that judge; the checker is what in language/ finds mistakes of meaning."""
EQUIVALENT = Path(__file__).with_name("equivalent_mutants.toml")
LIBRARIES = (
    "numpy scipy.interpolate scipy.linalg scipy.optimize scipy.spatial.transform pinocchio coal proxsuite"
)
LIBRARIES += " pydantic orjson hypothesis rich daqp lark ruckig"
PATIENCE = 3.0
"""How many times as long as usual a test may take; the usual was measured while lines were recorded."""
KILLED, SURVIVED, AGAIN = 1, 0, 3
RESULTS = ("killed", "too slow", "survived", "not covered")
"""What may become of a damage; a test that takes far too long has noticed it."""


class Judge:
    """Judges damages of functions in forks of a process that has collected all tests of a folder."""

    def __init__(
        self, work: list[tuple[Mutation, list[str]]], seconds: dict[str, float], told: Callable
    ) -> None:
        self.work, self.seconds, self.told = work, seconds, told

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Tells of each damage how its process ended."""
        gc.unfreeze()
        items = {item.nodeid: item for item in session.items}
        functions = [one for one in gc.get_objects() if isinstance(one, FunctionType)]
        for mutation, tests in self.work:
            self.told(mutation, fork(lambda m=mutation, t=tests: self._damaged(m, t, items, functions)))
        return True

    def _damaged(self, mutation: Mutation, tests: list[str], items: dict, functions: list) -> int:
        quiet()
        place = (str(SOURCE / mutation.path), mutation.defined_at)
        bodies = list(_bodies(compile(mutated(SOURCE, mutation), place[0], "exec"), place[1]))
        found = [one for one in functions if (one.__code__.co_filename, one.__code__.co_firstlineno) == place]
        if len(bodies) != 1 or not found:
            return AGAIN
        for one in found:
            if one.__code__.co_freevars != bodies[0].co_freevars:
                return AGAIN
            one.__code__ = bodies[0]
        return run([items[test] for test in tests], self.seconds)


def _bodies(code: CodeType, first: int) -> Iterable[CodeType]:
    """Code objects of functions that begin in a line, outermost only."""
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            if inner.co_firstlineno == first and not inner.co_name.startswith("<"):
                yield inner
            else:
                yield from _bodies(inner, first)


def run(items: list[pytest.Item], seconds: dict[str, float]) -> int:
    """Runs tests until one fails."""
    for item in items:
        limited(1.0 + PATIENCE * seconds[item.nodeid])
        try:
            reports = runtestprotocol(item, log=False, nextitem=None)
        except BaseException:
            return KILLED
        if any(report.failed for report in reports):
            return KILLED
    return SURVIVED


class Early:
    """Runs chosen tests of a session that imported a damaged module."""

    def __init__(self, tests: list[str], seconds: dict[str, float]) -> None:
        self.tests, self.seconds = tests, seconds

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Ends the process with what became of them."""
        items = {item.nodeid: item for item in session.items}
        found = [items[test] for test in self.tests if test in items]
        os._exit(run(found, self.seconds) if len(found) == len(self.tests) else KILLED)


def damaged_early(mutation: Mutation, tests: list[str], seconds: dict[str, float]) -> int:
    """Exit status of a process that imports the damaged module and runs the tests."""
    path, read = str(SOURCE / mutation.path), SourceFileLoader.get_code
    code = compile(mutated(SOURCE, mutation), path, "exec")
    SourceFileLoader.get_code = lambda loader, name: code if loader.path == path else read(loader, name)
    quiet()
    limited(120.0)
    pytest.main(
        [*dict.fromkeys(test.split("::")[0] for test in tests), *OPTIONS], plugins=[Early(tests, seconds)]
    )
    return KILLED


def judge(folder: str, mutations: list[Mutation], most: float) -> dict[Mutation, str]:
    """What became of each damage of a folder: killed, slow, survived or not covered."""
    executions = ExecutedLines(*FOLDERS[folder])
    results: dict[Mutation, str] = {}
    numbers = {mutation.id: mutation for mutation in mutations}
    judged = {mutation: executions.judges(mutation, most) for mutation in mutations}
    quick = [(m, tests) for m, (tests, early) in judged.items() if tests and not early]
    with tempfile.TemporaryDirectory() as made:
        told = Path(made) / "told"
        told.touch()

        def tell(mutation: Mutation, status: int) -> None:
            with told.open("a", encoding="utf-8") as file:
                print(mutation.id, status, file=file)
            print(".SX"[0 if status not in (SURVIVED, AGAIN) else 1 + (status == AGAIN)], end="", flush=True)

        if quick:
            collecting = [FOLDERS[folder][1], *OPTIONS, *(f"--ignore={one}" for one in LEFT_OUT)]
            fork(lambda: pytest.main(collecting, plugins=[Judge(quick, executions.seconds, tell)]))
        for line in told.read_text(encoding="utf-8").splitlines():
            number, status = line.split()
            if int(status) != AGAIN:
                results[numbers[number]] = _called(int(status))
    for mutation, (tests, _) in judged.items():
        if mutation not in results:
            status = (
                fork(lambda m=mutation, t=tests: damaged_early(m, t, executions.seconds))
                if tests
                else SURVIVED
            )
            results[mutation] = _called(status) if tests else "not covered"
            print("." if status != SURVIVED else "S", end="", flush=True)
    print()
    return results


def _called(status: int) -> str:
    if status == BROKEN:
        raise SystemExit("a damaged process could not be run")
    if -status in {signal.SIGPROF, signal.SIGALRM}:
        return "too slow"
    return "survived" if status == SURVIVED else "killed"


def equivalent() -> dict[tuple[str, str, str, str], str]:
    """Why nothing can notice a damage, by its place and what it does."""
    entries = tomllib.loads(EQUIVALENT.read_text(encoding="utf-8")).get("mutant", [])
    return {(e["file"], e["function"], e["old"], e["new"]): e["reason"] for e in entries}


def shown(mutation: Mutation) -> str:
    """A damage for people."""
    place = f"src/irlx/{mutation.path.as_posix()}:{mutation.line}"
    return (
        f"{mutation.id}  {place}  {mutation.function or 'module'}  ({mutation.kind})\n"
        f"    - {mutation.old}\n    + {mutation.new}"
    )


def all_mutations() -> dict[str, list[Mutation]]:
    """All damages of the code, by folder."""
    found: dict[str, list[Mutation]] = {}
    for folder, (parts, _) in FOLDERS.items():
        files = [file for part in parts for file in sorted((SOURCE / part).rglob("*.py")) or [SOURCE / part]]
        found[folder] = [one for file in files for one in mutations_of(SOURCE, file.relative_to(SOURCE))]
    return found


def chosen(options: argparse.Namespace) -> dict[str, list[Mutation]]:
    """The damages that the command line asks for, by folder; a sample of all, then those of the folder."""
    known = all_mutations()
    names = options.only or options.show
    flat = [one for some in known.values() for one in some]
    if names:
        drawn = [one for one in flat if one.id in names]
        if unknown := set(names) - {one.id for one in drawn}:
            raise SystemExit(f"no such mutant: {', '.join(sorted(unknown))}")
    else:
        drawn = random.Random(options.seed).sample(flat, min(options.mutants, len(flat)))
    taken = {one.id for one in drawn}
    wanted = options.folder or list(FOLDERS)
    return {
        folder: [one for one in some if one.id in taken] for folder, some in known.items() if folder in wanted
    }


def command_line() -> argparse.Namespace:
    """What is asked for."""
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=form)
    parser.add_argument("--mutants", type=int, default=500, metavar="N", help="how many are drawn (500)")
    parser.add_argument("--seed", type=int, default=1, help="which ones (1)")
    parser.add_argument("--folder", nargs="+", choices=FOLDERS, help="of those drawn only these folders'")
    parser.add_argument(
        "--most",
        type=float,
        default=20.0,
        metavar="S",
        help="processor time of the tests that judge one (20)",
    )
    parser.add_argument("--only", nargs="+", metavar="ID", help="these instead of a sample")
    parser.add_argument("--list", action="store_true", help="show what is drawn, judge nothing")
    parser.add_argument("--show", nargs="+", metavar="ID", help="show these, judge nothing")
    return parser.parse_args()


def prepared() -> None:
    """Heavy libraries are imported once; random tests draw the same examples for each damage."""
    os.chdir(ROOT)
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Forks leave folders behind, which would fill the memory.
    os.environ.setdefault("PYTEST_DEBUG_TEMPROOT", tempfile.gettempdir())
    sys.dont_write_bytecode = True
    for name in LIBRARIES.split():
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    from hypothesis import Phase, settings

    phases = (Phase.explicit, Phase.generate)
    settings.register_profile("mutants", database=None, derandomize=True, deadline=None, phases=phases)
    settings.load_profile("mutants")


def main() -> int:
    """Draws, judges and tells; 0 whatever survives."""
    options = command_line()
    drawn, reasons = chosen(options), equivalent()
    if options.list or options.show:
        print("\n".join(shown(one) for some in drawn.values() for one in some))
        return 0
    prepared()
    begin, rows, alive = os.times(), [], []
    for folder, mutations in drawn.items():
        same = [m for m in mutations if (m.path.as_posix(), m.function, m.old, m.new) in reasons]
        results = judge(folder, [m for m in mutations if m not in same], options.most) if mutations else {}
        counts = [sum(one == word for one in results.values()) for word in RESULTS]
        rows.append((folder, len(mutations), *counts, len(same)))
        alive += [(m, word) for m, word in results.items() if word in RESULTS[2:]]
        for mutation, word in results.items():
            if word in RESULTS[2:]:
                print(f"{word}: {shown(mutation)}", flush=True)
    rows.append(("all", *(sum(row[k] for row in rows) for k in range(1, 7))))
    print(f"\n{'':12}{'mutants':>12}" + "".join(f"{word:>12}" for word in (*RESULTS, "equivalent")))
    for name, *numbers in rows:
        print(f"{name:12}" + "".join(f"{number:12}" for number in numbers))
    judged, end = rows[-1][1] - rows[-1][-1], os.times()
    print(f"{len(alive)} of {judged} survive, {100 * len(alive) / max(judged, 1):.1f} %; seed {options.seed}")
    used = sum(end[:4]) - sum(begin[:4])
    print(f"{used / 60:.1f} min of processor time")
    return 0


if __name__ == "__main__":
    sys.exit(main())
