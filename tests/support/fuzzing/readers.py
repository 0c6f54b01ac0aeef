"""All readers of files but programs, and what a campaign draws for each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from random import Random

from fuzzing.case import Case, Outcome
from fuzzing.cell_readers import CellReader, InputsReader
from fuzzing.reader import Reader
from fuzzing.replays import ReplayReader
from fuzzing.robot_readers import MeshReader, SrdfReader, UrdfReader
from fuzzing.stream_readers import stream_readers
from irlx.diagnostics.codes.cell import CELL
from irlx.diagnostics.codes.robot_model import ROBOT_MODEL
from irlx.diagnostics.codes.stream import STREAM
from mesh_files import WRITERS

_THOROUGH = 25
"""One case of so many is looked at from all sides."""
_POOL_EACH = 60


class ReadersJudge:
    """Gives each case to the reader of its kind."""

    area = "readers"
    promises = "codes of cells, robots and streams"
    expected_codes = tuple(code.id for group in (CELL, ROBOT_MODEL, STREAM) for code in group)

    def __init__(self, folder: Path) -> None:
        def inside(name: str) -> Path:
            (folder / name).mkdir()
            return folder / name

        found: list[Reader] = [CellReader(inside("cell")), InputsReader(inside("inputs"))]
        found += [UrdfReader(inside("urdf")), SrdfReader(inside("srdf"))]
        found += [MeshReader(inside(ending), ending) for ending in WRITERS]
        found += stream_readers(inside("streams"))
        found += [ReplayReader(inside(f"replay{ending[1:]}"), ending) for ending in (".irdata", ".jsonl")]
        self.readers = {reader.kind: reader for reader in found}
        self.endings = {reader.kind: reader.ending for reader in found}

    def beginnings(self) -> Sequence[Callable[[], Case]]:
        """Files without damage, and damage that is gone through from beginning to end."""
        readers = self.readers.values()
        sound = [partial(Case, reader.kind, content) for reader in readers for content in reader.sound]
        return [
            *sound,
            *(partial(_made, reader.kind, make) for reader in readers for make in reader.systematic()),
        ]

    def draw(self, chance: Random, pool: Sequence[Case]) -> Case:
        """A damaged file of one kind."""
        readers = list(self.readers.values())
        (reader,) = chance.choices(readers, [reader.share for reader in readers])
        own = [case.content for case in pool[-_POOL_EACH:] if case.kind == reader.kind]
        content = chance.choice(own if own and chance.random() < 0.3 else reader.sound)
        return Case(reader.kind, reader.damaged(content, chance))

    def patience(self, kind: str) -> float:
        """How many times as long as others a reader may take."""
        return self.readers[kind].patience

    def judge(self, case: Case, thorough: bool | None = None) -> Outcome:
        """What came of a case."""
        if thorough is None:
            thorough = int(case.digest, 16) % _THOROUGH == 0
        return self.readers[case.kind].judge(case, thorough)


def _made(kind: str, make: Callable[[], bytes]) -> Case:
    return Case(kind, make())
