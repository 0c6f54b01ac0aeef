import json

import pytest
from hypothesis import HealthCheck, given, settings

from drawn_blocks import blocks
from irlx.blocks import (
    ArcCourse,
    Block,
    JointTarget,
    MotionLaw,
    MoveBlock,
    MoveKind,
    Origin,
    PoseTarget,
)
from irlx.blocks.codec import BLOCK_TYPES, BlockFormError, block_from_plain, block_to_plain


def all_kinds(base: type) -> set[type]:
    return {base for _ in [0]}.union(*(all_kinds(kind) for kind in base.__subclasses__()))


SLOW_TO_DRAW = settings(suppress_health_check=[HealthCheck.too_slow], deadline=None)
"""Both go by the clock, whatever else the machine does."""


@pytest.mark.req("STR-03")
@settings(SLOW_TO_DRAW, max_examples=20)
@given(blocks)
def test_blocks_survive_json(block: Block) -> None:
    survives_json(block)


@pytest.mark.slow
@settings(SLOW_TO_DRAW, max_examples=300)
@given(blocks)
def test_many_blocks_survive_json(block: Block) -> None:
    survives_json(block)


def survives_json(block: Block) -> None:
    text = json.dumps(block_to_plain(block), allow_nan=False)
    back = block_from_plain(json.loads(text))
    assert back == block
    assert repr(back) == repr(block)  # tells -0.0 from 0.0 and 1 from 1.0


def test_every_block_is_known() -> None:
    assert all_kinds(Block) - {Block} == set(BLOCK_TYPES.values())


GOOD = block_to_plain(
    MoveBlock(
        id=1,
        origin=Origin("a.irl", 0, 1, 1),
        kind=MoveKind.LIN,
        target=PoseTarget((1.0, 2.0, 3.0), None),
        law=MotionLaw(1.0, 1.0, 1.0, 1.0),
    )
)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"type": "Nothing"}, "Nothing"),
        ({"kind": "ARC"}, "kind"),
        ({"id": "1"}, "id"),
        ({"id": True}, "id"),
        ({"extra": 1}, "extra"),
        ({"target": None}, "target.type"),
        ({"target": {"type": "PoseTarget"}}, "target.position"),
        ({"law": {**GOOD["law"], "speed": "fast"}}, "law.speed"),
        ({"law": {**GOOD["law"], "speed": 10**400}}, "law.speed"),
        ({"limits": 3}, "limits"),
        ({"limits": [3]}, "limits.1"),
        ({"criteria": 3}, "criteria"),
        ({"criteria": [{"choice": {"name": "A"}, "origin": GOOD["origin"]}]}, "criteria.1.choice.weight"),
        ({"criteria": [{"choice": {"name": "A", "weight": 1.0}}]}, "criteria.1.origin"),
    ],
)
def test_wrong_forms_name_the_key(change: dict[str, object], word: str) -> None:
    with pytest.raises(BlockFormError, match=word.replace(".", r"\.")):
        block_from_plain({**GOOD, **change})


def test_missing_fields_and_other_things() -> None:
    with pytest.raises(BlockFormError, match="law: missing"):
        block_from_plain({key: value for key, value in GOOD.items() if key != "law"})
    with pytest.raises(BlockFormError):
        block_from_plain([])


@pytest.mark.req("STR-03")
def test_what_older_streams_lack_has_its_default() -> None:
    old = {key: value for key, value in GOOD.items() if key not in ("course", "criteria")}
    assert block_from_plain(old) == block_from_plain(GOOD)
    course = {"via": {"type": "JointTarget", "values": [1.0]}, "angle": None, "turns_through_via": True}
    read = block_from_plain({**GOOD, "kind": "CIRCLE", "course": course})
    assert isinstance(read, MoveBlock)
    assert read.course == ArcCourse(JointTarget((1.0,)), None, True, None)


@pytest.mark.parametrize(
    ("course", "word"),
    [
        ({"via": None}, "course.via.type"),
        ({"angle": 1.0}, "course.via"),
        ({"via": {"type": "JointTarget", "values": [1.0]}, "angle": "all"}, "course.angle"),
        ({"via": {"type": "JointTarget", "values": [1.0]}, "turns_through_via": 1}, "turns_through_via"),
        (
            {"via": {"type": "JointTarget", "values": [1.0]}, "via_reconfiguration": {"values": ["a"]}},
            "course.via_reconfiguration.values.1",
        ),
        (3, "course"),
    ],
)
def test_wrong_courses_name_the_key(course: object, word: str) -> None:
    with pytest.raises(BlockFormError, match=word.replace(".", r"\.")):
        block_from_plain({**GOOD, "kind": "CIRCLE", "course": course})
