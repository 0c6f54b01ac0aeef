"""Blocks and headers with numbers that nobody would write: always a report, never an exception."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from irlx.blocks.codec import BlockFormError, block_from_plain, block_to_plain
from irlx.verifier import verify_stream
from long_run import first

VALUES = [1e308, float("nan"), 0.0, -1.0, "inf", -0.0, -1e308, 5e-324, "-inf", 1e-9]


def leaves(plain, path=()):
    """Paths of all numbers in a plain form."""
    if isinstance(plain, dict):
        for name, part in plain.items():
            yield from leaves(part, (*path, name))
    elif isinstance(plain, list):
        for number, part in enumerate(plain):
            yield from leaves(part, (*path, number))
    elif isinstance(plain, float) or plain in ("inf", "-inf"):
        yield path


def planted(plain, path, value):
    """Copy of a plain form with another value at a path."""
    if not path:
        return value
    copy = dict(plain) if isinstance(plain, dict) else list(plain)
    copy[path[0]] = planted(copy[path[0]], path[1:], value)
    return copy


@pytest.fixture(scope="module")
def kit():
    import gantry

    return gantry


@pytest.fixture(scope="module")
def stream(kit):
    """Small moves of every kind: what counts here are their blocks."""
    maker = kit.Maker(np.array([0.1, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]))
    maker.ptp(np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1]), ticks=8)
    maker.switch(kit.LimitKind.POSITION, np.full(7, 9.0))
    maker.record(kit.CyclicBlock, active=True)
    clause = kit.LimitClause(kit.LimitKind.SPEED, kit.both(np.full(7, 90.0)), kit.Origin("weld.irl", 5, 9, 7))
    maker.lin((0.6, 0.3, 0.3), (0.1, 0.0, 0.2), limits=(clause,), ticks=8)
    maker.circle((0.5, 0.3), 1.0, 2.0, angle=7.0, turn=(0.0, 0.4, 0.1), ticks=30)
    return maker.stream()


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("value", first(2, VALUES), ids=str)
def test_any_number_of_a_block(value, stream, kit):
    tried, checks = 0, len(verify_stream(stream, kit.ROBOT).checks)
    for number, record in enumerate(stream.records):
        plain = block_to_plain(record.block)
        for path in leaves(plain):
            try:
                block = block_from_plain(planted(plain, path, value))
            except BlockFormError:
                continue
            records = list(stream.records)
            records[number] = replace(record, block=block)
            report = verify_stream(replace(stream, records=tuple(records)), kit.ROBOT)
            assert len(report.checks) == checks
            assert str(report)
            tried += 1
    assert tried > 40


@pytest.mark.req("QA-06")
def test_a_rate_that_is_no_number(stream, kit):
    """It would pass for no limit at all: nothing is above it."""
    for number, record in enumerate(stream.records):
        for path in leaves(plain := block_to_plain(record.block)):
            if path[0] == "law":
                block = block_from_plain(planted(plain, path, float("nan")))
                records = list(stream.records)
                records[number] = replace(record, block=block)
                report = verify_stream(replace(stream, records=tuple(records)), kit.ROBOT)
                assert f"its {path[1]} is nan" in report["blocks"].detail


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("value", first(2, [1e308, 5e-324, 1e155, -1e200]), ids=str)
@pytest.mark.parametrize("what", ["q", "tool"])
def test_any_number_of_a_row(value, what, stream, kit):
    table = getattr(stream, what).copy()
    for row, column in product((0, 5, len(table) - 1), range(table.shape[1])):
        changed = table.copy()
        changed[row, column] = value
        report = verify_stream(replace(stream, **{what: changed}), kit.ROBOT)
        # Next to nothing is next to where a column of zeros was anyway.
        assert value == 5e-324 or not report.passed
        assert str(report)


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("tick_ns", [1, 2**62])
@pytest.mark.parametrize("bound", [np.nan, np.inf, -np.inf, 0.0, 1e308])
def test_any_header(tick_ns, bound, stream, kit):
    for kind in ("position", "speed", "acceleration"):
        limits = kit.limits().with_pair(kind, np.full(7, bound), np.full(7, bound))
        header = replace(stream.header, limits=limits, tick_ns=tick_ns)
        report = verify_stream(replace(stream, header=header), kit.ROBOT)
        assert report["ticks"].status == "failed"
        assert str(report)


@pytest.mark.req("QA-06")
def test_any_order_of_blocks(stream, kit):
    """Rows that go from block to block as nobody recorded it."""
    rng = np.random.default_rng(5)
    for _ in range(40):
        block = stream.block.copy()
        rows = rng.integers(0, len(block), 4)
        block[rows] = rng.choice([0, 1, 2, 4, 5, 77, 2**52], 4)
        report = verify_stream(replace(stream, block=block), kit.ROBOT)
        same = np.array_equal(block, stream.block)
        assert report.passed is same
        assert same or report["blocks"].status == "failed"
