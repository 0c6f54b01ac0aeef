"""Verification of a stream against the robot of its cell: what `irlx.verify` and `irlx verify` do."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from irlx.cell.load import load_cell
from irlx.cell.named import robot_names
from irlx.cell.schema import RobotSection
from irlx.diagnostics import IrlxError
from irlx.report.run import Run
from irlx.robot.description import RobotDescription
from irlx.streams.formats import read_stream
from irlx.streams.joint_stream import JointStream
from irlx.verifier import Report, verify_stream
from irlx.verifier.report import FAILED, OK, Check

PathLike = str | os.PathLike[str]


def verify(stream: Run | PathLike, program: PathLike | None = None, cell: PathLike | None = None) -> Report:
    """Check a run, or a stream file, independently of what made it.

    The robot is that of `cell`; without one it is looked up by what the stream says of itself: the
    cell file of that name beside the stream or in the working folder, then the robot of that name. With
    `program` the stream must come from that very text. Raises StreamError for a file that is no
    stream, CellError for a cell that cannot be used, ProgramError for a program that cannot.
    """
    joint_stream = stream.stream if isinstance(stream, Run) else read_stream(stream)
    beside = Path.cwd() if isinstance(stream, Run) else Path(stream).parent
    report = verify_stream(joint_stream, robot_for(joint_stream, beside, cell))
    if program is None:
        return report
    return Report((*report.checks, _program_check(joint_stream, Path(program), cell)))


def robot_for(stream: JointStream, beside: Path, cell: PathLike | None = None) -> RobotDescription | None:
    """Robot that a stream is meant for, None where neither its cell nor its model is found."""
    if cell is not None:
        return load_cell(Path(cell)).robot
    header = stream.header
    candidates = [folder / header.cell_name for folder in (beside, Path.cwd()) if header.cell_name]
    for robot in _guesses(candidates, header.robot_model, header.tip, beside):
        # A file of that name may be anybody's: only the very robot that the stream names will do.
        if robot.fingerprint == header.robot_fingerprint and robot.joint_names == header.joint_names:
            return robot
    return None


def _guesses(candidates: list[Path], model: str, tip: str, beside: Path) -> Iterator[RobotDescription]:
    for path in candidates:
        with suppress(IrlxError):
            yield load_cell(path).robot
    if model in robot_names():
        from irlx.cell.model import load_robot

        # Not suppressed: that a robot's package is missing is worth more than "not made".
        yield load_robot(RobotSection(model=model, tip=tip), model, beside)


def _program_check(stream: JointStream, path: Path, cell: PathLike | None) -> Check:
    from irlx.program import load

    digest = hashlib.sha256(load(path, cell).path.read_bytes()).hexdigest()
    same = digest == stream.header.program_sha256
    detail = "" if same else f"the stream was made from {stream.header.program_name} with another text"
    return Check("program", OK if same else FAILED, detail=detail)
