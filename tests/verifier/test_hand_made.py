"""A stream that nothing of irlx has made passes; with one fault it fails under the name of that fault."""

import ast
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import hand_made
import irlx
from irlx.cli.main import main
from irlx.streams import read_stream

pytestmark = pytest.mark.usefixtures("read_once")

SCRIPT = Path(hand_made.__file__)
NUMBER = re.compile(r"-?\d+\.\d+(?:e[+-]\d+)?")

ONE_CHECK = {
    "speed": ("speed limits", 0.06 * (1 + 1e-8)),
    "goal": ("goal position", 2e-6),
    "joint goal": ("joint goal", 2e-9),
    "closure": ("cyclic closure", 2e-6),
    "sample": ("path position", 2e-6),
    "frozen": ("frozen joints", None),
    "drift": ("reconfiguration position", 2e-6),
    "tick": ("ticks", None),
    "hold": ("stops", None),
    "tool": ("tool position", 2e-9),
    "names": ("robot", None),
    "robot": ("robot", None),
}
"""Faults that exactly one check is to find: its name, and the worst value where it is known."""

CUT = {"stops", "goal position", "path position", "path progress", "programmed acceleration"}
"""What a corner that is cut without a stop offends; the second line does not begin at rest."""

AT_LEAST = {
    "unit": {"position limits", "speed limits", "acceleration limits", "joint goal", "goal orientation"},
    "order": {"joint goal", "goal position", "path position"},
}
"""Checks that gross faults must offend among others."""


def arguments(folder: Path, stream: str) -> list[str]:
    cell, program = folder / "cell.toml", folder / "work.irl"
    return ["verify", str(folder / stream), "--cell", str(cell), "--program", str(program)]


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files that the script writes in a process of its own, away from irlx."""
    folder = tmp_path_factory.mktemp("good")
    code = (
        "import runpy, sys; sys.argv = sys.argv[1:]; runpy.run_path(sys.argv[0], run_name='__main__'); "
        "print(*sorted(sys.modules))"
    )
    command = [sys.executable, "-I", "-c", code, str(SCRIPT), str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    loaded = {name.split(".")[0] for name in done.stdout.split()}
    assert "numpy" in loaded
    assert loaded.isdisjoint({"irlx", "scipy", "pinocchio", "proxsuite", "lark"})
    return folder


@pytest.fixture
def judged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Callable[[str], set[str]]:
    """Names of the failed checks in the table of `irlx verify` for a fault; the exit code must be 1."""

    def run(fault: str, stream: str = "work.irdata") -> set[str]:
        hand_made.write(tmp_path, fault, (Path(stream).suffix, ".npz"))
        code = main(arguments(tmp_path, stream))
        table = capsys.readouterr().out
        assert code == 1, table
        return set(re.findall(r"^(\S.*?)\s{2,}(?:FAILED|failed)\b", table, re.MULTILINE))

    return run


def test_the_script_imports_numpy_and_the_standard_library() -> None:
    names = set()
    for node in ast.walk(ast.parse(SCRIPT.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0
            names.add(str(node.module).split(".")[0])
    assert names - set(sys.stdlib_module_names) == {"numpy"}


@pytest.mark.parametrize("ending", [".irdata", ".npz", ".csv"])
def test_the_good_stream_passes(good: Path, ending: str, capsys) -> None:
    assert main(arguments(good, f"work{ending}")) == 0, capsys.readouterr()
    report = irlx.verify(good / f"work{ending}", good / "work.irl", good / "cell.toml")
    assert report.passed
    assert bool(report.unchecked) == (ending == ".csv")


@pytest.mark.parametrize("ending", [".irdata", ".npz", ".csv"])
def test_files_read_back_to_the_bits_that_were_meant(good: Path, ending: str) -> None:
    meant, stream = hand_made.made(), read_stream(good / f"work{ending}")
    assert np.array_equal(stream.q, meant.q)
    assert np.array_equal(stream.tool, hand_made.tool_columns(meant.q))
    assert np.array_equal(stream.block, meant.block)
    assert np.array_equal(stream.ticks, meant.ticks)
    assert tuple(record.tick for record in stream.records) == (() if ending == ".csv" else meant.begins)


def test_both_formats_carry_the_same_header_and_blocks(good: Path) -> None:
    records, arrays = read_stream(good / "work.irdata"), read_stream(good / "work.npz")
    assert records.records == arrays.records
    assert records.header.robot_fingerprint == arrays.header.robot_fingerprint


def described(path: Path) -> list[str]:
    """All records but samples, versions, how it was made and end, without their numbers and ticks.

    The files that are made by hand are of version 1, as programs of others may go on to write.
    """
    found = []
    for line in path.read_text(encoding="utf-8").splitlines():
        _, code, rest = line.split(", ", 2)
        if code not in ("100", "101", "130", "900", "999"):
            found.append(f"{code}, {re.sub('^tick=[0-9]+, ', '', rest)}")
    # Parts of blocks that version 3 has brought.
    return [re.sub(", (tolerance|frame)=none", "", line) for line in found]


def test_header_and_blocks_are_those_of_a_run(good: Path, tmp_path: Path) -> None:
    program, cell = good / "work.irl", good / "cell.toml"
    assert main(["run", str(program), "--cell", str(cell), "-o", str(tmp_path / "run.irdata")]) == 0
    mine, theirs = described(good / "work.irdata"), described(tmp_path / "run.irdata")
    assert [NUMBER.sub("#", line) for line in mine] == [NUMBER.sub("#", line) for line in theirs]
    numbers = [
        [float(number) for line in lines for number in NUMBER.findall(line)] for lines in (mine, theirs)
    ]
    assert numbers[0] == pytest.approx(numbers[1], rel=0.0, abs=1e-15)


def test_every_fault_has_its_test() -> None:
    assert {*ONE_CHECK, *AT_LEAST, "corner", "checksum"} == set(hand_made.FAULTS)


@pytest.mark.parametrize("fault", ONE_CHECK)
def test_a_single_fault_fails_its_check_alone(
    fault: str, judged: Callable[[str], set[str]], tmp_path: Path
) -> None:
    name, worst = ONE_CHECK[fault]
    assert judged(fault) == {name}
    report = irlx.verify(tmp_path / "work.npz", tmp_path / "work.irl", tmp_path / "cell.toml")
    assert [check.name for check in report.failed] == [name]
    if worst is not None:
        assert report[name].worst.value == pytest.approx(worst, rel=1e-3 if worst < 1e-3 else 1e-9)


def test_a_cut_corner_misses_what_lies_in_it(judged: Callable[[str], set[str]], tmp_path: Path) -> None:
    assert judged("corner") == CUT
    report = irlx.verify(tmp_path / "work.npz", tmp_path / "work.irl", tmp_path / "cell.toml")
    # The arc of 50 mm passes the corner at 50 (sqrt 2 - 1) mm, and each line at 50 (1 - sqrt 1/2) mm.
    assert report["goal position"].worst.value == pytest.approx(0.05 * (np.sqrt(2.0) - 1.0), rel=1e-3)
    assert report["path position"].worst.value == pytest.approx(0.05 * (1.0 - np.sqrt(0.5)), rel=1e-3)


@pytest.mark.parametrize("fault", AT_LEAST)
def test_a_gross_fault_fails_many_checks(fault: str, judged: Callable[[str], set[str]]) -> None:
    failed = judged(fault)
    assert failed >= AT_LEAST[fault]
    assert failed.isdisjoint({"robot", "blocks", "ticks", "tool position", "tool orientation"})


@pytest.mark.parametrize("stream", ["work.irdata", "work.csv"])
def test_a_wrong_checksum_fails_the_file(stream: str, judged: Callable[..., set[str]]) -> None:
    assert judged("checksum", stream) == {"file"}


def test_an_unknown_fault_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no fault is called 'rust'"):
        hand_made.write(tmp_path, "rust")
