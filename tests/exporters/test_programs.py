"""Programs of controllers: what is written reads back as what the stream does, by readers of their own."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import irlx
from arm_streams import arm_stream, there_and_back
from controller_programs import SyntaxFault, read_krl, read_rapid, read_robodk, read_urscript
from irlx.exporters import TARGETS
from irlx.streams import JointStream
from long_run import first

GOLDEN = Path(__file__).parent / "golden"
CLOSE = 1e-9
ENDINGS = {name: target.ending for name, target in TARGETS.items()}
READERS = {"urscript": read_urscript, "krl": read_krl, "rapid": read_rapid, "robodk": read_robodk}


def exported(stream: JointStream, target: str, folder: Path, **more: object) -> bytes:
    path = folder / f"weld{ENDINGS[target]}"
    irlx.convert(stream, path, target, **more)
    return path.read_bytes()


def in_si(values: list[float], slides: list[bool]) -> np.ndarray:
    """Values of a program in deg and mm -> rad and m."""
    return np.where(slides, np.array(values) / 1000.0, np.radians(values))


def rows_of(points, tick_s: float) -> list[int]:
    """For every tick of a timed program the number of the point where the robot is."""
    places, clock = [], 0.0
    for number, point in enumerate(points):
        clock += point.seconds
        assert round(clock / tick_s) == len(places)
        stands = round(point.wait / tick_s)
        assert stands * tick_s == pytest.approx(point.wait, abs=1e-12)
        places += [number] * (1 + stands)
        clock += point.wait
    return places


@pytest.mark.req("STR-04")
def test_urscript_has_a_servoj_for_every_tick(tmp_path: Path) -> None:
    stream = arm_stream()
    played = read_urscript(exported(stream, "urscript", tmp_path))
    assert played.name == "weld"
    values = np.array([point.values for point in played.points])
    assert len(values) == len(stream.q) + 1
    assert np.abs(values[:-1] - stream.q).max() < CLOSE
    assert (values[-1] == values[-2]).all()


@pytest.mark.req("STR-04")
@pytest.mark.parametrize("tick_ms", [10.0, 12.5, 50.0])
@pytest.mark.parametrize("units", ["rrrrrr", "mrrrrrr", "rrrrrrr", "rrrmrrr", "rrmrrrrr", "mmmmmmrrrrrr"])
def test_rapid_plays_every_row_at_its_time(units: str, tick_ms: float, tmp_path: Path) -> None:
    stream = arm_stream(units, tick_ms)
    played = read_rapid(exported(stream, "rapid", tmp_path))
    turning = [k for k, unit in enumerate(units) if unit == "r"]
    # The third of seven axes is the one that ABB counts as the seventh.
    external = [turning.pop(2)] if len(turning) == 7 else []
    order = [*turning, *external, *(k for k, unit in enumerate(units) if unit == "m")]
    places = rows_of(played.points, tick_ms / 1000)
    assert len(places) == len(stream.q)
    slides = [units[k] == "m" for k in order]
    for place, row in zip(places, stream.q, strict=True):
        assert np.abs(in_si(played.points[place].values, slides) - row[order]).max() < CLOSE
    # It stops where the stream does and nowhere else.
    stops = [number for number, point in enumerate(played.points) if not point.passes]
    assert stops == [0, 40, 80]
    assert [played.points[number].wait for number in stops] == [0.0, tick_ms / 1000, 7 * tick_ms / 1000]


@pytest.mark.req("STR-04")
@pytest.mark.parametrize(
    "units", ["rrrrrr", "mrrrrrr", "rrrrrrr", "rr", "rrmr", "rrrrrrrrrrmr", "rrrrrrmmmmmm"]
)
def test_krl_has_every_posture_in_order(units: str, tmp_path: Path) -> None:
    stream = arm_stream(units, 50.0)
    played = read_krl(exported(stream, "krl", tmp_path))
    order = sorted(range(len(units)), key=lambda k: (units[k] == "m", k))
    arm = min(units.count("r"), 6)
    assert played.axes == [f"A{k + 1}" for k in range(arm)] + [f"E{k + 1}" for k in range(len(units) - arm)]
    told = [f"{axis} is A{joint + 1}" for axis, joint in zip(played.axes, order, strict=True)]
    assert [line for line in played.comments if " is A" in line] == told
    slides = [units[k] == "m" for k in order]
    rows = []
    for point in played.points:
        rows += [in_si(point.values, slides)] * (1 + round(point.wait / 0.05))
    assert np.abs(np.array(rows) - stream.q[:, order]).max() < CLOSE
    assert [k for k, point in enumerate(played.points) if not point.passes] == [0, 40, 80]
    assert any("Time is not kept" in line for line in played.comments)


@pytest.mark.req("STR-04")
@pytest.mark.parametrize("units", ["rrrrrr", "mrrrrrr", "m", "rrrrrrrrrrmr"])
def test_robodk_has_joints_and_time(units: str, tmp_path: Path) -> None:
    stream = arm_stream(units, 4.0)
    played = read_robodk(exported(stream, "robodk", tmp_path))
    order = sorted(range(len(units)), key=lambda k: (units[k] == "m", k))
    slides = [units[k] == "m" for k in order]
    rows = np.array([in_si(point.values, slides) for point in played.points])
    assert np.abs(rows - stream.q[:, order]).max() < CLOSE
    assert [point.seconds for point in played.points] == stream.t.tolist()


@pytest.mark.parametrize("target", ["krl", "rapid", "robodk"])
def test_gaps_are_time(target: str, tmp_path: Path) -> None:
    rows = np.zeros((4, 6))
    rows[1:, 0] = (1.0, 2.0, 2.0)
    stream = arm_stream("rrrrrr", 10.0, rows, ticks=np.array([0, 2, 7, 12]))
    played = READERS[target](exported(stream, target, tmp_path))
    if target == "robodk":
        assert [point.seconds for point in played.points] == [0.0, 0.02, 0.07, 0.12]
    else:
        assert [point.wait for point in played.points] == [0.0, 0.0, 0.05]
    if target == "rapid":
        assert [point.seconds for point in played.points] == [0.0, 0.02, 0.05]


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("seed", first(2, range(6)))
def test_any_values_read_back(target: str, seed: int, tmp_path: Path) -> None:
    print("seed", seed)
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(3000, 6)) * 10.0 ** rng.integers(-17, 2, (3000, 6))
    rows[rng.integers(3000, size=900), rng.integers(6, size=900)] = -0.0
    # Halves of the last digit, where rounding decides.
    rows[:200] = (rng.integers(-9, 9, (200, 6)) + 0.5) * 1e-10
    again = rng.integers(1, 2999, size=400)
    rows[again] = rows[again - 1]
    rows[-1] = rows[-2]
    tick_ms = 2.0 if target == "urscript" else 10.0
    played = READERS[target](exported(arm_stream("rrrrrr", tick_ms, rows), target, tmp_path))
    factor = 1.0 if target == "urscript" else np.pi / 180
    values = [np.array(point.values) * factor for point in played.points]
    if target == "urscript":
        values.pop()
    if target in ("krl", "rapid"):
        waits = [round(point.wait / 0.01) for point in played.points]
        values = [row for row, wait in zip(values, waits, strict=True) for _ in range(1 + wait)]
    assert np.abs(np.array(values) - rows).max() < CLOSE


@pytest.mark.parametrize("target", ["krl", "rapid"])
def test_no_move_goes_nowhere(target: str, tmp_path: Path) -> None:
    rows = np.ones((60, 6))
    rows[:, 1] += np.arange(60) * 3e-11
    rows[-1] = rows[-2]
    played = READERS[target](exported(arm_stream("rrrrrr", 10.0, rows), target, tmp_path))
    written = [point.values for point in played.points]
    assert len(written) in (10, 11)
    assert all(one != other for one, other in pairwise(written))
    waits = [round(point.wait / 0.01) for point in played.points]
    values = np.radians([row for row, wait in zip(written, waits, strict=True) for _ in range(1 + wait)])
    assert np.abs(values - rows).max() < CLOSE


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("hold", [1, 2, 5])
def test_one_posture(target: str, hold: int, tmp_path: Path) -> None:
    tick_ms = 2.0 if target == "urscript" else 10.0
    stream = arm_stream("rrrrrr", tick_ms, np.ones((hold, 6)))
    played = READERS[target](exported(stream, target, tmp_path))
    wanted = {"urscript": hold + 1, "robodk": hold}.get(target, 1)
    assert len(played.points) == wanted
    if target in ("krl", "rapid"):
        assert played.points[0].wait == pytest.approx(0.01 * (hold - 1))


@pytest.mark.parametrize("target", TARGETS)
def test_how_rows_are_cut_into_portions_does_not_matter(target: str, tmp_path: Path) -> None:
    from irlx.streams.joint_stream import StreamHeader

    stream = arm_stream("rrrrrr", 2.0 if target == "urscript" else 10.0)
    whole = exported(stream, target, tmp_path)
    assert isinstance(stream.header, StreamHeader)
    for size in (1, 2, 3, 41, 42, 43):
        path = tmp_path / f"weld{ENDINGS[target]}"
        with TARGETS[target].writer(path, stream.header) as writer:
            for start in range(0, len(stream.q), size):
                part = slice(start, start + size)
                writer.samples(stream.ticks[part], stream.q[part], stream.block[part], stream.tool[part])
        assert path.read_bytes() == whole


@pytest.mark.parametrize("target", TARGETS)
def test_odd_names_stay_in_comments(target: str, tmp_path: Path) -> None:
    odd = ("ściana", 'q"uo;te', "new\nline\rhere", "back\\slash", "FOLD ! # ;", "юг\u2028\x00" * 200)
    stream = arm_stream(
        "rrrrrr",
        2.0 if target == "urscript" else 10.0,
        joint_names=odd,
        program_name="odd \udc80 ;\nEND\n",
        robot_name="\tFOLD\n",
        cell_name="",
    )
    played = READERS[target](exported(stream, target, tmp_path))
    assert len(played.points) > 80


@pytest.mark.parametrize("target", TARGETS)
def test_where_it_comes_from_and_whether_it_is_whole(target: str, tmp_path: Path) -> None:
    tick_ms = 2.0 if target == "urscript" else 10.0
    whole = READERS[target](exported(arm_stream("rrrrrr", tick_ms), target, tmp_path))
    part = READERS[target](
        exported(arm_stream("rrrrrr", tick_ms, complete=False), target, tmp_path, incomplete=True)
    )
    if target == "robodk":
        assert not whole.comments + part.comments
        return
    told = "\n".join(whole.comments)
    for word in ("program weld.irl", "ab" * 32, "robot arm", "irlx 0.1.0", f"{tick_ms:g} ms"):
        assert word in told
    assert whole.comments[-1] == "end of the stream: 89 samples, complete"
    assert part.comments[-1] == "end of the stream: 89 samples, not complete: the run did not come to its end"


@pytest.mark.parametrize("target", TARGETS)
def test_golden(target: str, tmp_path: Path) -> None:
    rows = np.array(
        [[0, 1, 2, 3, 4, 5], [0.1, 1, 2, 3, 4, 5], [0.2, 1, 2, 3, 4, -0.5], [0.2, 1, 2, 3, 4, -0.5]]
    )
    units = "rrrrrr" if target == "urscript" else "mrrrrrr"
    if target != "urscript":
        rows = np.column_stack([[0.5, 0.6, 0.7, 0.7], rows])
    data = exported(arm_stream(units, 2.0 if target == "urscript" else 20.0, rows), target, tmp_path)
    # With the line ends of this machine's text files; those of the target are the readers' business.
    assert data.decode().replace("\r\n", "\n") == (GOLDEN / f"weld{ENDINGS[target]}").read_text()


BREAKS = {
    "urscript": [
        (b"servoj([", b"servoj(["[:-1]),
        (b", gain=300)", b", gain=50)"),
        (b"\nend", b"\n"),
        (b"-", b"--"),
    ],
    "krl": [(b", A2 ", b", A1 "), (b"} C_PTP", b" C_PTP"), (b"\r\nEND", b"\r\n"), (b"PTP {A1", b"PTP {B1")],
    "rapid": [(b"9E9,9E9", b"9E9"), (b"tool0;", b"tool0"), (b"ENDPROC", b""), (b"\\T:=0.01, ", b", ")],
    "robodk": [(b"\n", b", 1\n"), (b", 0.01\n", b", nan\n"), (b", 0.02\n", b", 0.01\n")],
}


@pytest.mark.parametrize(
    ("target", "place"), [(name, k) for name, all in BREAKS.items() for k in range(len(all))]
)
def test_the_readers_find_faults(target: str, place: int, tmp_path: Path) -> None:
    data = exported(arm_stream("rrrrrr", 2.0 if target == "urscript" else 10.0), target, tmp_path)
    old, new = BREAKS[target][place]
    assert old in data
    with pytest.raises(SyntaxFault):
        READERS[target](data.replace(old, new, 1))


def test_the_rows_of_these_tests_stop_where_they_should() -> None:
    rows = there_and_back(6)
    same = (rows[1:] == rows[:-1]).all(axis=1)
    assert np.flatnonzero(same).tolist() == [40, 81, 82, 83, 84, 85, 86, 87]
