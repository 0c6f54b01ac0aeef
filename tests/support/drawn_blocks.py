"""Blocks of every kind, drawn by hypothesis: whatever a record must be able to hold."""

from __future__ import annotations

from hypothesis import strategies as st

from irlx.blocks import (
    ArcCourse,
    Blend,
    CriterionBlock,
    CriterionChoice,
    CriterionClause,
    CriterionParam,
    CyclicBlock,
    FreezeBlock,
    HaltBlock,
    InputBlock,
    JointIncrement,
    JointRange,
    JointTarget,
    LimitClause,
    LimitKind,
    LimitSwitchBlock,
    LinkFrame,
    MotionLaw,
    MoveBlock,
    MoveKind,
    ObstacleBlock,
    Origin,
    PathCourse,
    PauseBlock,
    Port,
    PoseIncrement,
    PoseTarget,
    Profile,
    ReconfigureBlock,
    SignalBlock,
    SignalKind,
    ToleranceClause,
    ToolBlock,
    WaitBlock,
    WeightsBlock,
)

numbers = st.floats(allow_nan=False)
vectors = st.lists(numbers, max_size=4).map(tuple)
origins = st.builds(Origin, st.text(), st.integers(0, 9), st.integers(9, 99), st.integers(1, 99))
ranges = st.builds(JointRange, vectors, vectors)
kinds = st.sampled_from(LimitKind)
common = {"id": st.integers(1, 99), "origin": origins, "robot": st.text(), "process": st.text()}
laws = st.builds(
    MotionLaw,
    *[numbers] * 6,
    st.none() | numbers,
    st.sampled_from(Profile),
    st.none() | numbers,
    numbers,
)
places, turns = st.tuples(numbers, numbers, numbers), st.tuples(numbers, numbers, numbers, numbers)
poses = st.builds(
    PoseTarget,
    st.tuples(numbers, numbers, numbers),
    st.none() | st.tuples(numbers, numbers, numbers, numbers),
    st.text(),
)
increments = st.builds(PoseIncrement, places, st.none() | turns, st.text())
joints = st.builds(JointTarget, vectors)
targets = poses | joints | increments | st.builds(JointIncrement, vectors)
criteria = st.builds(
    CriterionChoice,
    st.text(),
    numbers,
    st.lists(st.builds(CriterionParam, st.text(), numbers), max_size=2).map(tuple),
)
postures = st.none() | st.builds(JointTarget, vectors)
courses = st.builds(ArcCourse, targets, st.none() | numbers, st.booleans(), postures) | st.builds(
    PathCourse,
    st.lists(targets, max_size=3).map(tuple),
    st.lists(joints, max_size=3).map(tuple),
)
frames = st.none() | st.builds(LinkFrame, st.text(), st.text(), places, turns)
ports = st.builds(Port, st.text(), st.sampled_from(SignalKind))
blends = st.builds(Blend, st.none() | numbers, st.none() | numbers)
blocks = st.one_of(
    st.builds(HaltBlock, **common),
    st.builds(PauseBlock, duration=numbers, **common),
    st.builds(WaitBlock, duration=numbers, condition=st.text(), **common),
    st.builds(SignalBlock, port=ports, value=numbers, **common),
    st.builds(InputBlock, port=ports, value=numbers, **common),
    st.builds(ToolBlock, position=places, orientation=turns, **common),
    st.builds(WeightsBlock, weights=vectors, **common),
    st.builds(FreezeBlock, joints=st.lists(st.integers(1, 9)).map(tuple), **common),
    st.builds(CyclicBlock, active=st.booleans(), **common),
    st.builds(LimitSwitchBlock, kind=kinds, range=st.none() | ranges, **common),
    st.builds(ObstacleBlock, name=st.text(), active=st.booleans(), **common),
    st.builds(CriterionBlock, name=st.text(), choice=st.none() | criteria, **common),
    st.builds(ReconfigureBlock, target=joints, law=laws, frame=frames, **common),
    st.builds(
        MoveBlock,
        kind=st.sampled_from(MoveKind),
        target=targets,
        law=laws,
        limits=st.lists(st.builds(LimitClause, kinds, ranges, origins), max_size=2).map(tuple),
        course=st.none() | courses,
        reconfiguration=postures,
        criteria=st.lists(st.builds(CriterionClause, criteria, origins), max_size=2).map(tuple),
        blend=st.none() | blends,
        frame=frames,
        tolerance=st.none() | st.builds(ToleranceClause, st.tuples(*[numbers] * 6), origins),
        **common,
    ),
)
