"""Verification of a stream against its cell and program: what `irlx.verify` and `irlx verify` do."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from irlx.blocks import (
    AskAvoidingPosture,
    AskClearance,
    AskInput,
    AskInputChange,
    AskJointBounds,
    AskLastMove,
    AskManipulability,
    AskNearestPosture,
    AskPause,
    AskPose,
    AskPosture,
    AskPostureOf,
    AskStandstill,
    Block,
    InputBlock,
    PauseBlock,
    ToolBlock,
    WaitBlock,
)
from irlx.cell.cell import Cell
from irlx.cell.find import is_file
from irlx.cell.load import load_cell
from irlx.cell.named import robot_names
from irlx.cell.schema import RobotSection
from irlx.cell.setting import setting_of
from irlx.diagnostics import IrlxError, report
from irlx.given_values import check_count
from irlx.interpreter.channels.channels import Channels
from irlx.interpreter.channels.unanswered_files import UnansweredFiles
from irlx.interpreter.interpret import MAX_STEPS, interpret
from irlx.program import Program, cell_path, load
from irlx.robot.description import RobotDescription
from irlx.streams.error import StreamError
from irlx.streams.formats import format_of, scan_stream
from irlx.streams.joint_stream import StreamHeader
from irlx.streams.scan import scan_of
from irlx.verifier import Reference, Report, verify_scans
from irlx.verifier.findings.finding import FAILED, OK, Check
from irlx.verifier.judges.program_blocks import Unanswerable, blocks_differ
from irlx.verifier.outline import Outline, Scans

if TYPE_CHECKING:
    # Not imported: a run brings along all that made it, of which nothing is wanted here.
    from irlx.report.run import Run

PathLike = str | os.PathLike[str]


def verify(
    run_or_file: Run | PathLike,
    program: Program | PathLike | None = None,
    cell: Cell | PathLike | None = None,
    max_steps: int | None = None,
) -> Report:
    """Check a run, or a stream file, independently of what made it.

    The robot is that of `cell`; without one it is looked up: the cell of `program`, the cell file of the
    recorded name beside the stream or in the working folder, then the robot of the recorded name. With
    `program` the stream must come from that very text, and its blocks must be those that the text gives;
    `max_steps` is for programs that were run with it. Both may be given as they have been loaded.
    A damaged file fails the check 'file'. Raises StreamError where there is no file to
    read, CellError for a `cell` that cannot be used, ProgramError for a program that cannot, IrlxError with
    IRL006 for what is no run, no path or no number of statements.
    """
    check_count("--max-steps", max_steps, 1)
    given_cell = cell if cell is None or isinstance(cell, Cell) else load_cell(Path(cell))
    text = program if program is None or isinstance(program, Program) else load(program, cell)
    if isinstance(run_or_file, str | os.PathLike):
        scans: Scans = partial(scan_stream, run_or_file)
        name, beside, from_file = Path(run_or_file).name, Path(run_or_file).parent, True
        may_lack_blocks = not format_of(run_or_file).carries_blocks
    elif not hasattr(run_or_file, "stream"):
        cause = "a run, or the path of a stream"
        raise IrlxError(report("IRL006", option="run_or_file=", value=repr(run_or_file), cause=cause))
    else:
        stream = run_or_file.stream
        scans, name = partial(scan_of, stream), stream.header.program_name
        beside, from_file = Path.cwd(), False
        may_lack_blocks = False
    header = _header(scans)
    of_program = None if text is None else given_cell or _cell_of(text)
    reference = None
    strict = given_cell
    if of_program is not None and header is not None and Path(of_program.file).name == header.cell_name:
        strict = of_program
    if strict is not None:
        reference = Reference(strict.robot, strict.limits, strict.start, strict.relations, strict.scene)
    elif header is not None:
        reference = looked_up(header, beside, of_program)
    compare = (
        None
        if text is None
        else partial(_program_check, text, of_program, may_lack_blocks, max_steps or MAX_STEPS)
    )
    return verify_scans(scans, reference, name, compare, from_file, may_lack_blocks)


def _header(scans: Scans) -> StreamHeader | None:
    """Header of a stream, None where it cannot be read; verification says why."""
    with suppress(StreamError):
        for item in scans():
            return item if isinstance(item, StreamHeader) else None
    return None


def _cell_of(program: Program) -> Cell | None:
    try:
        return load_cell(cell_path(program, None))
    except IrlxError:
        return None


def looked_up(header: StreamHeader, beside: Path, of_program: Cell | None) -> Reference | None:
    """What a stream is judged by where no cell is given, None where neither its cell nor its model is found.

    A cell of the right name may be anybody's: only one with the very robot of the stream will do, and its
    limits only count where they are the stream's.
    """
    for cell in _cells(header, beside, of_program):
        if _is_of(header, cell.robot):
            same = _same_limits(header, cell)
            if not same:
                return Reference(cell.robot)
            return Reference(cell.robot, cell.limits, cell.start, cell.relations, cell.scene)
    if header.robot_model in robot_names():
        from irlx.cell.model import load_robot

        # Not suppressed: that a robot's package is missing is worth more than "not made".
        robot = load_robot(RobotSection(model=header.robot_model, tip=header.tip), header.robot_model, beside)
        return Reference(robot) if _is_of(header, robot) else None
    return None


def _cells(header: StreamHeader, beside: Path, of_program: Cell | None) -> Iterator[Cell]:
    if of_program is not None:
        yield of_program
    # A stream is anybody's: only a plain file of that name, here and nowhere else, is looked at.
    if header.cell_name and Path(header.cell_name).name == header.cell_name:
        for path in (beside / header.cell_name, Path.cwd() / header.cell_name):
            with suppress(IrlxError):
                if is_file(path):
                    yield load_cell(path)


def _is_of(header: StreamHeader, robot: RobotDescription) -> bool:
    return robot.fingerprint == header.robot_fingerprint and robot.joint_names == header.joint_names


def _same_limits(header: StreamHeader, cell: Cell) -> bool:
    kinds = ("position", "speed", "acceleration")
    pairs = ((header.limits.pair(kind), cell.limits.pair(kind)) for kind in kinds)
    return all((a == b).all() for own, other in pairs for a, b in zip(own, other, strict=True))


def _program_check(
    program: Program, cell: Cell | None, may_lack_blocks: bool, max_steps: int, outline: Outline
) -> Check:
    """The stream comes from this very text, and its blocks are those that the text gives in this cell."""
    header = outline.header
    findings, unsaid = [], ""
    if program.sha256 != header.program_sha256:
        lists = ", ".join(found.path.name for found in program.data_lists)
        modules = ", ".join(found.path.name for found in program.modules)
        other = f"another text, or other values in {lists}" if lists else "another text"
        other += f", or another text of {modules}" if modules else ""
        findings.append(f"the stream was made from {header.program_name} with {other}")
    if may_lack_blocks and not outline.records:
        unsaid = "its text only: the stream carries no blocks"
    elif cell is None:
        unsaid = "its text only: no cell to run it in is found"
    else:
        words = blocks_differ(outline, _replayed(program, cell, outline, max_steps))
        findings += [words] if words else []
    return Check("program", FAILED if findings else OK, detail="; ".join(findings) or unsaid)


def _no_text() -> str:
    """What a program read from files and STANDARD_IN: no stream tells."""
    raise Unanswerable


_ONLY_OF_THE_MACHINE = (
    AskPostureOf,
    AskNearestPosture,
    AskAvoidingPosture,
    AskClearance,
    AskLastMove,
    AskJointBounds,
)
"""Questions about what only the machine can say."""


def _recorded(question: AskInput | AskInputChange, outline: Outline, done: int) -> tuple[float, ...]:
    """What the stream says of inputs, `done` of its blocks being behind: what was read, how long was waited.

    Raises Unanswerable where the next block is neither.
    """
    block = outline.records[done].block if done < len(outline.records) else None
    if isinstance(question, AskInput) and isinstance(block, InputBlock):
        return (block.value,)
    if isinstance(question, AskInputChange) and isinstance(block, WaitBlock):
        return (block.duration,)
    raise Unanswerable


def _pause(outline: Outline, done: int) -> float:
    """Time that the stream says a PAUSE took; 0 where its next block is none, which differs anyway."""
    block = outline.records[done].block if done < len(outline.records) else None
    return block.duration if isinstance(block, PauseBlock) else 0.0


def _replayed(program: Program, cell: Cell, outline: Outline, max_steps: int) -> Iterator[Block]:
    """Blocks of a program whose questions are answered by the stream: nothing moves."""
    channels = Channels(UnansweredFiles(_no_text), _no_text)
    setting, parts = setting_of(cell), (program.data_lists, program.modules)
    source = interpret(program.tree, program.source, setting, *parts, max_steps, channels)
    reply: tuple[float, ...] | None = None
    done = 0
    while True:
        try:
            item = source.send(reply)
        except StopIteration:
            return
        reply = None
        if isinstance(item, _ONLY_OF_THE_MACHINE):
            # No stream tells.
            raise Unanswerable
        if isinstance(item, AskPosture):
            records = outline.records
            row = records[done].tick if done < len(records) else outline.rows - 1
            reply = outline.posture(row)
        elif isinstance(item, AskPose | AskManipulability):
            reply = _of_posture(item, cell, [record.block for record in outline.records[:done]])
        elif isinstance(item, AskPause):
            reply = (_pause(outline, done),)
        elif isinstance(item, AskStandstill):
            reply = ()
        elif isinstance(item, AskInput | AskInputChange):
            reply = _recorded(item, outline, done)
        else:
            done += 1
            yield item


def _of_posture(
    question: AskPose | AskManipulability, cell: Cell, done: Sequence[Block]
) -> tuple[float, ...]:
    """What the robot's model says of a posture, with the tool that the blocks before have given it."""
    # Imported here: few programs ask, and the model loads a library that verification does without.
    from irlx.pacing.answers import answer_of_posture
    from irlx.robot.kinematics import Kinematics

    kinematics = Kinematics(cell.robot)
    tool = next((block for block in reversed(done) if isinstance(block, ToolBlock)), None)
    if tool is not None:
        kinematics = kinematics.with_tool(tool.position, tool.orientation)
    return answer_of_posture(question, kinematics)
