"""Records 445: obstacles switched on and off, in every format that carries blocks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from irlx.blocks import ObstacleBlock
from irlx.streams import JointStream, StreamError, read_stream, write_stream

pytestmark = [pytest.mark.req("STR-01"), pytest.mark.req("STR-03")]
START = np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1])

NAMES = ["ściana_1", 'q"uo;te', "new\nline", "", "none", "445"]


@pytest.fixture
def stream(gantry_kit) -> JointStream:
    maker = gantry_kit.Maker(START)
    for name in NAMES:
        maker.record(ObstacleBlock, name=name, active=True)
    maker.lin((0.7, 0.25, 0.4))
    for name in NAMES:
        maker.record(ObstacleBlock, name=name, active=False)
    made: JointStream = maker.stream()
    return made


@pytest.mark.parametrize("ending", [".irdata", ".npz", ".jsonl"])
def test_nothing_of_them_is_lost(stream: JointStream, ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"a{ending}"
    write_stream(stream, path)
    assert read_stream(path).records == stream.records


def test_the_record_is_the_one_of_the_reference(stream: JointStream, tmp_path: Path) -> None:
    path = tmp_path / "a.irdata"
    write_stream(stream, path)
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if ", 445, " in line]
    assert len(lines) == 2 * len(NAMES)
    assert lines[0].endswith('robot="default", process="main", name="ściana_1", active=true ;')
    assert lines[-1].endswith('name="445", active=false ;')


@pytest.mark.parametrize(
    ("good", "bad", "why"),
    [
        ("active=true", "active=1", "active: needs a bool, found 1"),
        (", active=true", "", "active: missing"),
        ('name="ściana_1"', "name=none", "name: needs a str, found None"),
        ('name="ściana_1"', 'name="ściana_1", margin=0.02', "margin: a ObstacleBlock has no such field"),
    ],
)
def test_what_breaks_the_form_is_told(
    stream: JointStream, good: str, bad: str, why: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.irdata"
    write_stream(stream, path)
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace(good, bad, 1), encoding="utf-8")
    with pytest.raises(StreamError, match="IRL70") as caught:
        read_stream(path)
    assert why in str(caught.value)
