"""A RECONFIGURATION in a stream: the tool stays, limits and frozen joints hold, and sabotage is found."""

from dataclasses import replace

import numpy as np
import pytest

from irlx.blocks import CyclicBlock, FreezeBlock, JointTarget, MotionLaw, ReconfigureBlock
from irlx.streams import read_stream, write_stream
from irlx.verifier import verify_stream

LAW = MotionLaw(5.0, 20.0, 10.0, 40.0)
START = np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1])
TICKS = 60


def reconfigure(maker, way):
    """The rail moves by `way`, x moves back, both along a quintic."""
    start = maker.rows[-1]
    end = start + np.array([way, -way, 0, 0, 0, 0, 0])
    number = maker.record(ReconfigureBlock, target=JointTarget(tuple(end.tolist())), law=LAW)
    u = np.linspace(0.0, 1.0, TICKS + 1)[1:, None]
    rows = start + u**3 * (10 - 15 * u + 6 * u**2) * (end - start)
    rows[-1] = end
    maker.emit(number, rows)
    return number


@pytest.fixture
def still(gantry_kit):
    maker = gantry_kit.Maker(START.copy())
    maker.record(FreezeBlock, joints=(3,))
    reconfigure(maker, 0.6)
    maker.record(FreezeBlock, joints=())
    maker.lin((0.5, 0.75, 0.4))
    reconfigure(maker, -0.2)
    return maker.stream()


def moved(stream, joint, amount, rows=slice(20, 30)):
    q = stream.q.copy()
    q[rows, joint] += amount
    return replace(stream, q=q)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("ending", ["", ".irdata", ".npz"])
def test_a_good_stream_passes(still, robot, tmp_path, ending):
    if ending:
        write_stream(still, tmp_path / f"a{ending}")
        back = read_stream(tmp_path / f"a{ending}")
        assert back.records == still.records
        still = back
    report = verify_stream(still, robot)
    assert report.passed, str(report)
    assert {check.name for check in report.unchecked} == {"program", "robot limits"}
    assert report["reconfiguration position"].status == "ok"


@pytest.mark.req("STR-06")
@pytest.mark.req("TRF-15")
@pytest.mark.parametrize(
    ("change", "name"),
    [
        (lambda s: moved(s, 0, 2e-6), "reconfiguration position"),
        (lambda s: moved(s, 3, -2e-6, slice(-20, None)), "reconfiguration position"),
        (lambda s: moved(s, 5, 2e-6), "reconfiguration orientation"),
        (lambda s: moved(s, 2, 1e-16, slice(20, 21)), "frozen joints"),
        (lambda s: moved(s, 0, 1e-7, slice(TICKS + 1, TICKS + 2)), "stops"),
    ],
)
def test_sabotage(still, robot, change, name):
    report = verify_stream(change(still), robot)
    assert report[name].status == "failed", str(report)


@pytest.mark.req("STR-06")
def test_limits_hold_in_its_rows(still, robot):
    own = still.header.limits.with_pair("position", np.full(7, -1.0), np.full(7, 0.55))
    report = verify_stream(replace(still, header=replace(still.header, limits=own)), robot)
    assert report["position limits"].status == "failed"
    assert report["position limits"].first.joint == "rail"


def test_rows_without_a_record_and_wrong_counts(still, robot):
    records = still.records[:1] + still.records[2:]
    assert verify_stream(replace(still, records=records), robot)["blocks"].status == "failed"
    short = replace(still.records[1].block, target=JointTarget((0.0,)))
    records = (still.records[0], replace(still.records[1], block=short), *still.records[2:])
    report = verify_stream(replace(still, records=records), robot)
    assert "its posture has 1 values for 7 joints" in report["blocks"].detail


def test_a_return_after_it_is_not_judged(gantry_kit, robot):
    maker = gantry_kit.Maker(START.copy())
    maker.record(CyclicBlock, active=True)
    maker.lin((0.5, 0.75, 0.4))
    reconfigure(maker, 0.3)
    maker.lin((0.5, 0.25, 0.4))
    check = verify_stream(maker.stream(), robot)["cyclic closure"]
    assert check.status == "not checked"
    assert "1 of 1 returns not judged" in check.detail
