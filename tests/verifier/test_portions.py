"""The stream is judged in portions: neither their size nor the length of the stream makes a difference."""

import subprocess
import sys
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.streams import scan_of, write_stream
from irlx.streams.error import StreamError
from irlx.streams.formats import scan_stream
from irlx.streams.scan import RowBatch
from irlx.verifier import Reference, remembered, rows, verify_scans, verify_stream
from irlx.verifier.outline import outline_of


@cache
def busy(kit):
    """Everything that carries something from row to row, made once: PTP, lines, half turns, arcs of several
    rounds, switches, clauses, frozen joints, a closed cyclic path, a move that moves nothing."""
    maker = kit.Maker(np.array([0.1, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]))
    maker.ptp(np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1]))
    maker.record(kit.FreezeBlock, joints=(1,))
    maker.lin((0.5, 0.25, 0.3))
    maker.record(kit.FreezeBlock, joints=())
    maker.record(kit.CyclicBlock, active=True)
    maker.lin((1.0, 0.25, 0.4), (0.3, -0.2, 0.5))
    maker.circle((0.8, 0.25), 1.0, 2.0, angle=14.0, turn=(0.0, 0.4, 0.1), ticks=400)
    maker.lin((0.5, 0.25, 0.3), tuple(back_to_start(maker)))
    maker.record(kit.CyclicBlock, active=False)
    maker.switch(kit.LimitKind.SPEED, np.full(7, 9.0))
    clause = kit.LimitClause(kit.LimitKind.SPEED, kit.both(np.full(7, 8.0)), kit.Origin("weld.irl", 5, 9, 7))
    maker.lin((0.6, 0.3, 0.3), (0.0, 0.0, -np.pi), limits=(clause,), ticks=300)
    return maker.stream()


def back_to_start(maker) -> np.ndarray:
    """Rotation vector from the present orientation to that of the posture where the cyclic option began."""
    here, there = (Rotation.from_euler("ZYX", q[4:7]) for q in (maker.rows[-1], maker.rows[41]))
    return (here.inv() * there).as_rotvec()


@pytest.fixture(scope="module")
def kit():
    import gantry

    return gantry


def damaged(stream, number: int):
    """One of several kinds of damage, so that failed checks are compared as well."""
    q = stream.q.copy()
    rng = np.random.default_rng(number)
    row = int(rng.integers(3, len(q) - 3))
    q[row:, rng.integers(7)] += 3e-6
    return replace(stream, q=q)


@pytest.fixture(scope="module")
def judged(kit):
    """`judged(damage)`: the busy stream, damaged or not, and the report on it as a whole."""

    @cache
    def found(damage):
        stream = busy(kit) if damage is None else damaged(busy(kit), damage)
        return stream, verify_stream(stream, kit.ROBOT)

    return found


@pytest.mark.req("STR-06")
@pytest.mark.parametrize(
    ("size", "damage"),
    # Rows one by one, and two by two, cost most by far.
    [pytest.param(1, damage, marks=pytest.mark.slow) for damage in (1, None, 2, 3)]
    + [
        # Each of the others with one damage, or none.
        pytest.param(size, damage, marks=pytest.mark.slow if size == 2 or (i + j) % 4 else ())
        for i, size in enumerate((2, 3, 7, 100, 333))
        for j, damage in enumerate((None, 1, 2, 3))
    ],
)
def test_portions_of_any_size_give_the_same_report(size, damage, judged, kit, monkeypatch):
    stream, whole = judged(damage)
    assert whole.passed is (damage is None), whole
    monkeypatch.setattr(rows, "PORTION", size)
    portioned = verify_stream(stream, kit.ROBOT)
    assert [(c.name, c.status) for c in portioned.checks] == [(c.name, c.status) for c in whole.checks]
    for one, other in zip(portioned.checks, whole.checks, strict=True):
        for found, due in ((one.first, other.first), (one.worst, other.worst)):
            assert (found is None) is (due is None)
            if found is not None:
                assert found.value == pytest.approx(due.value, rel=1e-9, abs=1e-14), one.name
                assert found.allowed == due.allowed
        if one.first is not None:
            assert one.first.tick == other.first.tick


def long_stream(kit, rounds: int):
    maker = kit.Maker(np.array([0.1, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]))
    for _ in range(rounds):
        maker.lin((0.6, 0.3, 0.3), (0.0, 0.0, 0.1), ticks=750)
        maker.circle((0.5, 0.3), 1.0, 2.0, angle=-2 * np.pi, ticks=750)
        maker.ptp(np.array([0.1, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]), ticks=750)
    return maker.stream()


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("ending", [".irdata", ".npz", pytest.param(".csv", marks=pytest.mark.slow)])
def test_memory_does_not_grow_with_the_stream(ending, kit, tmp_path, monkeypatch):
    import tracemalloc

    monkeypatch.setattr(remembered, "MOST", 1 << 18)
    monkeypatch.setattr(rows, "PORTION", 512)
    monkeypatch.setattr("irlx.streams.scan._PORTION", 512)
    monkeypatch.setattr("irlx.streams.npz_reader._PORTION", 512)
    peaks = []
    for rounds in (2, 4):
        path = tmp_path / f"{rounds}{ending}"
        write_stream(long_stream(kit, rounds), path)
        tracemalloc.start()
        report = verify_scans(
            partial(scan_stream, path), Reference(kit.ROBOT), "long", None, True, ending == ".csv"
        )
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert report.passed, report
    # 4,500 rows more are 500 kB of joint values and tool poses alone.
    assert peaks[1] - peaks[0] < 4e5, peaks


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("most", [0, 10_000, 1 << 30])
@pytest.mark.parametrize("cut", [False, True])
def test_a_stream_is_read_once_where_it_can_be_kept(most, cut, kit, tmp_path, monkeypatch):
    """However often it is read, the report is the same, also that of a file that was cut."""
    path = tmp_path / "busy.irdata"
    write_stream(busy(kit), path)
    if cut:
        path.write_bytes(path.read_bytes()[:-30])
    begun = []

    def scans():
        begun.append(path)
        return scan_stream(path)

    monkeypatch.setattr(remembered, "MOST", most)
    report = verify_scans(scans, Reference(kit.ROBOT), "busy", None, True)
    assert len(begun) == (1 if most > 1 << 20 else 2)
    assert report.passed is not cut
    assert str(report) == str(
        verify_scans(partial(scan_stream, path), Reference(kit.ROBOT), "busy", None, True)
    )


@pytest.mark.parametrize("most", [10_000, 1 << 30])
def test_a_scan_that_was_given_up_is_not_taken_for_a_whole_one(most, kit, monkeypatch):
    monkeypatch.setattr(remembered, "MOST", most)
    scans = remembered.Remembered(partial(scan_of, busy(kit)))
    next(scans())
    for _ in range(2):
        assert sum(len(item[0]) for item in scans() if isinstance(item, RowBatch)) == len(busy(kit).ticks)


def test_damage_is_met_again_behind_the_rows_before_it(kit, tmp_path):
    path = tmp_path / "busy.csv"
    write_stream(busy(kit), path)
    path.write_bytes(path.read_bytes()[:-30] + b"\n")
    scans = remembered.Remembered(partial(scan_stream, path))
    first, again = [], []
    with pytest.raises(StreamError) as read:
        first.extend(scans())
    with pytest.raises(StreamError) as kept:
        again.extend(scans())
    assert read.value.reason == kept.value.reason
    assert [type(item) for item in first] == [type(item) for item in again]
    assert len(first) > 1


def test_an_outline_has_what_the_stream_has(kit):
    stream = busy(kit)
    outline = outline_of(partial(scan_of, stream))
    assert outline.rows == len(stream.ticks)
    assert outline.largest == float(np.abs(stream.q).max())
    for number, (identity, first, last) in enumerate(outline.segments()):
        assert (stream.block[first : last + 1] == identity).all()
        np.testing.assert_array_equal(outline.ends[number], stream.q[last])
        assert outline.posture(last) == tuple(stream.q[last])
    assert int(outline.lasts[-1]) == outline.rows - 1


LOADED = """
import sys
from pathlib import Path
import irlx
report = irlx.verify(sys.argv[1])
assert "path position" in [check.name for check in report.made], report
makers = ("motion", "transform", "pacing", "pipeline")
loaded = [name.split(".") for name in sys.modules]
print([name for name in loaded if name[0] == "irlx" and set(name[1:2]) & set(makers)])
print([name for name in loaded if name[0] in ("pinocchio", "proxsuite", "scipy")])
"""


@pytest.mark.req("STR-06")
def test_nothing_of_what_makes_streams_is_loaded(tmp_path):
    import irlx

    source = Path(irlx.__file__).parents[1]
    (tmp_path / "a.toml").write_text('[robot]\nmodel = "rail6"\n[motion]\ntick_ms = 20\n', encoding="utf-8")
    text = "PROGRAM a;\nBEGIN\n  MOVE_INC LIN (0, 30, -20);\nENDPROGRAM;\n"
    (tmp_path / "a.irl").write_text(text, encoding="utf-8")
    irlx.run(tmp_path / "a.irl").save(tmp_path / "a.irdata")
    done = subprocess.run(
        [sys.executable, "-c", LOADED, str(tmp_path / "a.irdata")],
        cwd=tmp_path,
        env={"PYTHONPATH": str(source), "PATH": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stderr == ""
    assert done.stdout.splitlines() == ["[]", "[]"]
