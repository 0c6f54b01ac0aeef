"""Files that are no streams, or streams no longer: a coded error or a correct reading, whatever the bytes.

Every case is a file of a known format, damaged in one of many ways; a seed repeats it. Where the sums of a
text format are made right again after the damage, what is behind them is met. What is read must be what the
file says: written again, it reads the same; with its old sums it is the undamaged stream, or its beginning,
marked incomplete.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from gantry import Maker
from irlx.blocks import CyclicBlock, FreezeBlock
from irlx.streams import KNOWN_ENDINGS, JointStream, StreamError, read_stream, write_stream
from irlx.streams.header_plain import header_to_plain

pytestmark = [pytest.mark.req("QA-06"), pytest.mark.filterwarnings("ignore::RuntimeWarning")]

QUICK, LONG = 150, 10_000
OUTCOMES = {"same", "beginning", "other", *(f"IRL70{number}" for number in range(1, 7))}
TOKENS = (
    b"nan",
    b"inf",
    b"-1",
    b"1e999",
    b"9" * 30,
    b"\x00",
    b"\xff",
    b"(",
    b"]",
    b'"',
    b"\n",
    b"none",
    b"{}",
    b";",
)
_SUM = re.compile(rb"[0-9a-f]{64}")
Damage = Callable[[bytes, np.random.Generator], bytes]


def cut(data: bytes, rng: np.random.Generator) -> bytes:
    return data[: int(rng.integers(len(data)))]


def flipped(data: bytes, rng: np.random.Generator) -> bytes:
    damaged = bytearray(data)
    for place in rng.integers(len(data), size=int(rng.integers(1, 20))).tolist():
        damaged[place] ^= 1 << int(rng.integers(8))
    return bytes(damaged)


def noise(data: bytes, rng: np.random.Generator) -> bytes:
    return rng.bytes(int(rng.integers(2000)))


def noise_behind_a_head(data: bytes, rng: np.random.Generator) -> bytes:
    return data[: int(rng.integers(len(data)))] + rng.bytes(int(rng.integers(300)))


def moved(data: bytes, rng: np.random.Generator) -> bytes:
    """A piece is left out, put in twice, or put in elsewhere."""
    first, last, place = sorted(rng.integers(len(data) + 1, size=3).tolist())
    piece = data[first : min(last, first + 200)]
    return data[:place] + piece + data[place + int(rng.integers(2)) * len(piece) :]


def token(data: bytes, rng: np.random.Generator) -> bytes:
    """A number, word or sign becomes another one."""
    found = [match.span() for match in re.finditer(rb"[A-Za-z]+|-?[0-9.e+-]+|[^\sA-Za-z0-9]", data)]
    first, last = found[int(rng.integers(len(found)))] if found else (0, 0)
    return data[:first] + TOKENS[int(rng.integers(len(TOKENS)))] + data[last:]


def lines(data: bytes, rng: np.random.Generator) -> bytes:
    """Lines change places, are left out or come twice."""
    parts = data.splitlines(keepends=True)
    order = list(range(len(parts)))
    at, to = rng.integers(len(order), size=2).tolist()
    change = int(rng.integers(3))
    if change == 0:
        order[at], order[to] = order[to], order[at]
    elif change == 1:
        order.pop(at)
    else:
        order.insert(to, at)
    return b"".join(parts[number] for number in order)


DAMAGES: tuple[Damage, ...] = (cut, flipped, noise, noise_behind_a_head, moved, token, lines)


def summed(data: bytes) -> bytes:
    """A text with the sum of its last line made right."""
    *above, last = data.splitlines(keepends=True) or [b""]
    digest = hashlib.sha256(b"".join(above)).hexdigest().encode()
    return b"".join([*above, _SUM.sub(digest, last)])


def small() -> JointStream:
    maker = Maker(np.array([0.1, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]))
    maker.record(FreezeBlock, joints=(1, 7))
    maker.lin((0.5, 0.1, 0.3), (0.1, 0.2, 0.0), ticks=4)
    maker.record(CyclicBlock, active=True)
    maker.ptp(np.array([0.1, 0.3, -0.1, 0.3, 0.25, -0.3, 0.1]), ticks=3)
    return maker.stream()


def content(stream: JointStream) -> tuple[object, ...]:
    arrays = (array.tobytes() for array in (stream.ticks, stream.q, stream.block, stream.tool))
    return (*arrays, str(header_to_plain(stream.header)), repr(stream.records), stream.complete)


def is_beginning(part: JointStream, whole: JointStream) -> bool:
    rows, blocks = len(part.ticks), len(part.records)
    return (
        not part.complete
        and np.array_equal(part.q, whole.q[:rows])
        and np.array_equal(part.tool, whole.tool[:rows])
        and np.array_equal(part.ticks, whole.ticks[:rows])
        and part.records == whole.records[:blocks]
        and header_to_plain(part.header) == header_to_plain(whole.header)
    )


def the_file(path: Path) -> Path:
    """The file to damage: of a folder the largest in it."""
    if path.is_file():
        return path
    return max(
        (entry for entry in path.rglob("*") if entry.is_file()), key=lambda entry: entry.stat().st_size
    )


def judge(ending: str, seed: int, whole: JointStream, data: bytes, path: Path) -> str:
    """Read one damaged file; what came of it: a code, 'same', 'beginning' or 'other'."""
    rng = np.random.default_rng((seed, KNOWN_ENDINGS.index(ending)))
    damaged = DAMAGES[int(rng.integers(len(DAMAGES)))](data, rng)
    mended = ending not in (".npz", ".parquet", ".rosbag") and rng.random() < 0.5
    the_file(path).write_bytes(summed(damaged) if mended else damaged)
    where = f"{ending}, seed {seed}"
    try:
        stream = read_stream(path)
    except StreamError as error:
        codes = {found.code[:5] for found in error.diagnostics}
        return error.reason.code if codes == {"IRL70"} else f"code {codes}: {where}"
    if content(stream) == content(whole):
        return "same"
    if is_beginning(stream, whole):
        return "beginning"
    # Made right again, it may say something else: then that is what is read.
    assert mended or not stream.complete, where
    again = path.with_name(f"again{ending}")
    write_stream(stream, again)
    assert content(read_stream(again)) == content(stream), where
    return "other"


def campaign(ending: str, seeds: range, folder: Path) -> dict[str, int]:
    path = folder / f"a{ending}"
    write_stream(small(), path)
    whole = read_stream(path)
    data = the_file(path).read_bytes()
    found: dict[str, int] = {}
    for seed in seeds:
        came = judge(ending, seed, whole, data, path)
        found[came] = found.get(came, 0) + 1
    return found


@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_damaged_files(ending: str, tmp_path: Path) -> None:
    found = campaign(ending, range(QUICK), tmp_path)
    assert sum(found.values()) == QUICK
    assert set(found) <= OUTCOMES
    assert found["IRL701"] > QUICK // 10


@pytest.mark.slow
@pytest.mark.parametrize("ending", KNOWN_ENDINGS)
def test_many_damaged_files(ending: str, tmp_path: Path) -> None:
    found = campaign(ending, range(LONG), tmp_path)
    print(ending, found)
    assert sum(found.values()) == LONG
    assert set(found) <= OUTCOMES
