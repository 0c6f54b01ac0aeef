"""Recorded executions whose blocks say something else under sums that fit: carried out again, or refused."""

from __future__ import annotations

import re
from pathlib import Path
from random import Random

from fuzzing.reader import Reader
from fuzzing.stream_readers import summed
from irlx.diagnostics import Diagnostic, IrlxError
from irlx.running import run

_CELL = """[robot]
model = "arm7"
[motion]
tick_ms = 20
speed = 2000
acc = 8000
speed_ori = 300
acc_ori = 3000
[[obstacle]]
name = "wall"
shape = "box"
size = [20, 1000, 150]
xyz = [2880, 0, 75]
"""
_PROGRAM = """PROGRAM p;
VAR OUTPUT BOOL: lamp AT 1;
BEGIN
  MOVE_INC LIN POSITION(0, 0, 20) C_CP := 2;
  MOVE_INC LIN POSITION(0, 20, 0);
  lamp := TRUE;
  CYCLICSTART;
  MOVE_INC LIN POSITION(0, -5, 0) WITH TOLERANCE (1, 1, 1, 1, 1, 1);
  CYCLICEND;
  OBSTACLE wall;
  FREEZESTART 1;
  MOVE_INC CIRCLE POSITION(0, 5, 5), POSITION(0, 0, 10);
  FREEZEEND;
  R_TOOL := ((0, 0, 10), ORIZYX(0, 0, 5));
  CRITERION MANIPULABILITY WEIGHT := 0.5;
  WAIT 0.05 SEC;
  MOVE_INC PTP (1, 2, -1, 2, 1, 0, 1);
ENDPROGRAM
"""
_NUMBER = re.compile(rb"-?\d[0-9.e+-]*")
_BLOCK = re.compile(rb"\d+, *[345]\d\d\b|\{")
_NUMBERS = (
    *(
        b"0",
        b"1",
        b"-1",
        b"2",
        b"7",
        b"8",
        b"0.0",
        b"-0.5",
        b"0.001",
        b"-3.5",
        b"1e300",
        b"-1e300",
        b"1e-300",
    ),
    *(b"1e12", b"1000000", b"1e5", b"9223372036854775808", b"3.141592653589793"),
)
_ENOUGH = re.compile(rb"duration|override|speed|acc\b|jerk|tick_ns")
"""What makes a motion last: with extreme numbers a replay may rightly take hours."""


class ReplayReader(Reader):
    """Streams of a format with blocks; numbers and words of blocks are exchanged."""

    share = 0.1
    patience = 15.0

    def __init__(self, folder: Path, ending: str) -> None:
        super().__init__(folder)
        self.kind, self.ending = f"replay-{ending[1:]}", ending
        self._path = folder / f"s{ending}"
        self._cell = folder / "cell.toml"
        self._cell.write_text(_CELL, encoding="utf-8")

    def made(self) -> list[bytes]:
        program = self.folder / "p.irl"
        program.write_text(_PROGRAM, encoding="utf-8")
        run(program, cell=self._cell).save(self._path)
        return [self._path.read_bytes()]

    def damaged(self, content: bytes, chance: Random) -> bytes:
        lines = content.splitlines(keepends=True)
        places = [at for at, line in enumerate(lines) if _BLOCK.match(line)]
        for _ in range(chance.choice((1, 1, 2, 4))):
            if places:
                at = chance.choice(places)
                lines[at] = _with_another(lines[at], chance)
        return summed(b"".join(lines))

    def read(self, content: bytes, thorough: bool) -> tuple[bool, list[Diagnostic]]:
        self._path.write_bytes(content)
        try:
            run(self._path, cell=self._cell)
        except IrlxError as error:
            return False, list(error.diagnostics)
        return True, []


def _with_another(line: bytes, chance: Random) -> bytes:
    """A line with one of its numbers replaced, or exchanged with another one of it."""
    found = list(_NUMBER.finditer(line))[2:]
    if not found:
        return line
    one = chance.choice(found)
    new = chance.choice(found)[0] if chance.random() < 0.3 else chance.choice(_NUMBERS)
    before = line[max(one.start() - 25, 0) : one.start()]
    if _ENOUGH.search(before) and float(new) != 0.0 and not 1e-3 < abs(float(new)) < 1e3:
        new = b"0.5"
    return line[: one.start()] + new + line[one.end() :]
