"""What a run needs, loaded and checked against each other: a program, its cell, and what the caller gives."""

from __future__ import annotations

import hashlib
import os
import platform
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import distribution
from math import inf
from pathlib import Path
from typing import IO

from irlx._version import __version__
from irlx.cell.cell import Cell
from irlx.cell.find import is_file
from irlx.cell.load import load_cell
from irlx.cell.made_constraints import constrained
from irlx.diagnostics import IrlxError, report
from irlx.diagnostics.whole_file import whole_file
from irlx.given_inputs import InputsGiven, inputs_of
from irlx.given_values import check_count, check_kind, check_number
from irlx.interpreter.channels.pieces import InputGiven
from irlx.interpreter.channels.setup import ChannelSetup
from irlx.interpreter.interpret import MAX_STEPS
from irlx.pacing.inputs import Inputs
from irlx.pacing.pauses import PauseFunction, Pauses, is_time
from irlx.program import Program, ProgramError, cell_path, check_fits, load
from irlx.promises import LONGEST_TICK, SHORTEST_TICK
from irlx.recorded import Recorded, cell_of, check_joints, is_recorded, recorded
from irlx.robot.kinematics import Kinematics
from irlx.streams.joint_stream import FORMAT_VERSION, StreamHeader
from irlx.streams.making import Making

PathLike = str | os.PathLike[str]
CellGiven = Cell | PathLike | None
"""A cell that has been loaded, the path of its file, or None where it is found beside the program."""

_VERSION_LINE = re.compile(r"^Version: *(\S+)", re.MULTILINE)
LEAST_TICK_MS = SHORTEST_TICK * 1e3
LONGEST_TICK_MS = LONGEST_TICK * 1e3


@dataclass(frozen=True)
class Job:
    """A program, or a recorded execution, and the cell it runs in, checked against each other; tick in ns.

    A move may take `max_slow` times as long as programmed, the program may execute `max_steps` statements;
    `inputs` are the cell's with those of the caller; `channels` what the program may read and write; `pauses`
    say how long each PAUSE lasts; `making` is what the stream will say of all this.
    """

    program: Program | Recorded
    cell: Cell
    tick_ns: int
    max_slow: float = inf
    max_steps: int = MAX_STEPS
    inputs: Inputs = field(default_factory=Inputs)
    channels: ChannelSetup = field(default_factory=ChannelSetup)
    pauses: Pauses = field(default_factory=Pauses)
    making: Making = field(default_factory=Making)


def prepare(
    program: Program | Recorded | PathLike,
    cell: CellGiven = None,
    tick_ms: float | None = None,
    max_slow: float | None = None,
    max_steps: int | None = None,
    inputs: InputsGiven = None,
    files: PathLike | None = None,
    input: InputGiven = None,
    output: IO[str] | None = None,
    pause_s: float = 0.0,
    on_pause: PauseFunction | None = None,
) -> Job:
    """Load what a run needs; `files`, `input` and `output` as in `run`.

    `cell` None: the file that SYSTEM SPECIFICATION names, else the program's own name with .toml; a Cell is
    taken as it is, whatever its file says. A stream file in the place of a program is replayed, at its own
    tick.
    Raises ProgramError, CellError, or IrlxError: IRL006 for a number out of range, IRL649 for a value that is
    given to an input which nobody has.
    """
    check_kind("cell=", cell, (Cell, str, os.PathLike), "a path, or a cell that has been loaded")
    if not isinstance(program, Program | Recorded):
        program = recorded(Path(program)) if is_recorded(Path(program)) else _loaded(program, cell)
    loaded = _loaded_cell(program, cell)
    if isinstance(program, Recorded):
        without = {
            "--max-steps": max_steps,
            "--files": files,
            "--pause": pause_s or None,
            "on_pause=": on_pause,
        }
        _refuse(without)
    cause = "a move cannot be faster than programmed: at least 1"
    check_number("--max-slow", max_slow, cause, lambda times: times >= 1.0)
    check_count("--max-steps", max_steps, 1)
    check_number("--pause", pause_s, "a pause lasts a number of seconds, 0 or more", is_time)
    slowest = inf if max_slow is None else max_slow
    said = inputs_of(program, loaded, inputs)
    steps = MAX_STEPS if max_steps is None else max_steps
    more = _channels(program, loaded, files, input, output), Pauses(pause_s, on_pause)
    untold = _untold(
        inputs=inputs, input=input, files=files, on_pause=on_pause, made_cell=isinstance(cell, Cell)
    )
    making = Making(
        cell_sha256="" if isinstance(cell, Cell) else sha256_of(Path(loaded.file)),
        max_slow=None if max_slow is None else float(max_slow),
        max_steps=max_steps,
        pause=float(pause_s),
        **_inputs_told(inputs),
        software=software(),
        given=untold,
        replay_of=program.stream_sha256 if isinstance(program, Recorded) else "",
    )
    return Job(program, loaded, _tick_ns(tick_ms, program, loaded), slowest, steps, said, *more, making)


def _tick_ns(tick_ms: float | None, program: Program | Recorded, cell: Cell) -> int:
    """Duration of a tick, ns. Raises IrlxError, IRL006, for one that is too short or too long."""
    if tick_ms is None:
        return program.header.tick_ns if isinstance(program, Recorded) else cell.tick_ns
    cause = f"a tick lasts {LEAST_TICK_MS:g} to {LONGEST_TICK_MS:g} ms"
    check_number("--tick", tick_ms, cause, lambda given: LEAST_TICK_MS <= given <= LONGEST_TICK_MS)
    return round(tick_ms * 1e6)


def _loaded_cell(program: Program | Recorded, given: CellGiven) -> Cell:
    if isinstance(given, Cell):
        cell = given
    elif isinstance(program, Program):
        cell = load_cell(cell_path(program, given))
    else:
        cell = load_cell(cell_of(program, None if given is None else Path(given)))
    if isinstance(program, Recorded):
        check_joints(program.header, cell)
    else:
        check_fits(program, cell)
    return cell


def _refuse(given: Mapping[str, object]) -> None:
    """Raises IrlxError, IRL006, for the first of these options that is given for a replay."""
    for option, value in given.items():
        if value is not None:
            cause = "a recorded execution is replayed as it was: only its cell, tick and inputs may be given"
            raise IrlxError(report("IRL006", option=option, value=str(value), cause=cause))


def _channels(
    program: Program | Recorded, cell: Cell, files: PathLike | None, input: InputGiven, output: IO[str] | None
) -> ChannelSetup:
    """What a program may read and write. Raises IrlxError, IRL006, for what is no folder or input."""
    folder = program.path.parent if files is None else Path(files)
    if files is not None and not folder.is_dir():
        raise IrlxError(report("IRL006", option="--files", value=str(files), cause="there is no such folder"))
    if not (input is None or isinstance(input, str) or hasattr(input, "readline")):
        cause = "a text, or a file that is open to be read"
        raise IrlxError(report("IRL006", option="input=", value=repr(input), cause=cause))
    if not (output is None or hasattr(output, "write")):
        cause = "a file that is open to be written"
        raise IrlxError(report("IRL006", option="output=", value=repr(output), cause=cause))
    own = {found.path: "a data list of the program" for found in program.all_lists}
    own |= {module.path: "a module of the program" for module in program.modules}
    own |= {program.path: "the program itself", Path(cell.file): "the cell of the program"}
    return ChannelSetup(folder, own, input, output.write if output is not None else None)


def sha256_of(path: Path) -> str:
    """SHA-256, hexadecimal, of the bytes of a file that has just been read; '' where it is gone by now."""
    try:
        return hashlib.sha256(whole_file(path)).hexdigest()
    except OSError:
        return ""


def _inputs_told(inputs: InputsGiven) -> dict[str, str]:
    """What a stream says of a file of inputs."""
    if not isinstance(inputs, str | os.PathLike):
        return {}
    path = Path(inputs)
    return {"inputs": path.name, "inputs_sha256": sha256_of(path)}


def _untold(
    inputs: InputsGiven, input: InputGiven, files: PathLike | None, on_pause: object, made_cell: bool
) -> tuple[str, ...]:
    """Names of what a caller gave that no stream can hold."""
    told = inputs is None or isinstance(inputs, str | os.PathLike)
    given = {"inputs": not told, "input": isinstance(input, str), "files": files is not None}
    given |= {"on_pause": on_pause is not None, "cell": made_cell}
    return tuple(name for name, holds in given.items() if holds)


@cache
def software() -> tuple[str, ...]:
    """What the numbers of a stream depend on, with versions."""
    names = ("numpy", "scipy", "pin", "proxsuite")
    found = [f"{name} {_version(name)}" for name in names]
    return (f"python {platform.python_version()}", *found, f"machine {platform.machine()}")


def _version(package: str) -> str:
    """Version of an installed package, by the line that tells it: the rest is a long text to parse."""
    installed = distribution(package)
    found = _VERSION_LINE.search(installed.read_text("METADATA") or "")
    return found[1] if found else installed.version


def _loaded(path: PathLike, cell: CellGiven) -> Program:
    """The program; where names are unknown and its cell is at fault, the cell's faults come first."""
    try:
        return load(path, cell)
    except ProgramError as error:
        unknown = any(found.code == "IRL201" for found in error.diagnostics)
        if unknown and not isinstance(cell, Cell):
            likely = Path(cell) if cell is not None else Path(path).with_suffix(".toml")
            if is_file(likely):
                load_cell(likely)
        raise


def kinematics_of(cell: Cell) -> Kinematics:
    """Kinematics of a cell's robot with its constraints.

    Raises CellError as `constrained` does.
    """
    return constrained(Kinematics(cell.robot), cell)


def header_of(job: Job) -> StreamHeader:
    """Provenance of the stream of a job; names of files without their folders."""
    program, cell = job.program, job.cell
    return StreamHeader(
        format_version=FORMAT_VERSION,
        irlx_version=__version__,
        program_name=program.file_name,
        program_sha256=program.sha256,
        cell_name=Path(cell.file).name,
        robot_name=cell.robot.name,
        robot_model=cell.model,
        robot_fingerprint=cell.robot.fingerprint,
        tip=cell.robot.tip,
        joint_names=cell.robot.joint_names,
        joint_units=tuple("m" if axis.is_prismatic else "rad" for axis in cell.robot.axes),
        tick_ns=job.tick_ns,
        limits=cell.limits,
        weights=tuple(float(weight) for weight in cell.weights),
        making=job.making,
    )
