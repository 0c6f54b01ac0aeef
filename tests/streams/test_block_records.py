"""Blocks of every kind through the records of every format that carries them: nothing of them is lost."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from drawn_blocks import blocks
from irlx.blocks import Block
from irlx.streams import KNOWN_ENDINGS, BlockRecord, JointStream, read_stream, write_stream
from irlx.streams.formats import FORMATS
from irlx.streams.irdata.block import block_of, block_operands
from irlx.streams.irdata.record import parse_record, record_text

pytestmark = pytest.mark.req("STR-03")
WITH_BLOCKS = [ending for ending in KNOWN_ENDINGS if FORMATS[ending].carries_blocks]


@given(blocks, st.integers(0, 2**40))
@settings(max_examples=60, deadline=None)
def test_blocks_survive_their_irdata_record(block: Block, tick: int) -> None:
    survives_its_record(block, tick)


@pytest.mark.slow
@given(blocks, st.integers(0, 2**40))
@settings(max_examples=600, deadline=None)
def test_many_blocks_survive_their_irdata_record(block: Block, tick: int) -> None:
    survives_its_record(block, tick)


def survives_its_record(block: Block, tick: int) -> None:
    text = record_text(7, *block_operands(BlockRecord(tick, block)))
    assert text.count(b"\n") == 1
    back = block_of(parse_record(text))
    assert back == BlockRecord(tick, block)
    # Tells -0.0 from 0.0 and 1 from 1.0.
    assert repr(back) == repr(BlockRecord(tick, block))


@pytest.mark.parametrize("ending", WITH_BLOCKS)
@given(drawn=st.lists(blocks, max_size=4))
@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_blocks_survive_a_file(ending: str, drawn: list[Block], gantry_kit, tmp_path: Path) -> None:
    numbered = [replace(block, id=number) for number, block in enumerate(drawn, 1)]
    records = tuple(BlockRecord(0, block) for block in numbered)
    tool = np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
    counts = np.zeros(1, dtype=np.int64)
    stream = JointStream(gantry_kit.header(), records, counts, np.zeros((1, 7)), counts, tool, True)
    write_stream(stream, tmp_path / f"a{ending}")
    back = read_stream(tmp_path / f"a{ending}").records
    assert back == records
    assert repr(back) == repr(records)
