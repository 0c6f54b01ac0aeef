"""Function blocks: the narrow interface between a program and the machine that runs it.

An interpreter speaks to the rest of irlx only by yielding these blocks and questions, and by
receiving the answers. All of them are frozen, serialisable, in SI units (m, rad, s), with joints
numbered from 1 in the robot's order.
"""

from irlx.blocks.block import Block, HaltBlock, Origin, PauseBlock
from irlx.blocks.criterion import CriterionBlock, CriterionChoice, CriterionClause, CriterionParam
from irlx.blocks.link_frame import LinkFrame
from irlx.blocks.move import ArcCourse, Blend, MotionLaw, MoveBlock, MoveKind, PathCourse, Profile
from irlx.blocks.obstacle import ObstacleBlock
from irlx.blocks.options import (
    CyclicBlock,
    FreezeBlock,
    JointRange,
    LimitClause,
    LimitKind,
    LimitSwitchBlock,
)
from irlx.blocks.questions import (
    AskAvoidingPosture,
    AskClearance,
    AskInput,
    AskInputChange,
    AskJointBounds,
    AskLastMove,
    AskManipulability,
    AskNearestPosture,
    AskPause,
    AskPose,
    AskPosture,
    AskPostureOf,
    AskStandstill,
    MachineQuestion,
    Question,
)
from irlx.blocks.reconfigure import ReconfigureBlock
from irlx.blocks.signal import InputBlock, Port, SignalBlock, SignalKind, WaitBlock
from irlx.blocks.targets import JointIncrement, JointTarget, PoseIncrement, PoseTarget, Target
from irlx.blocks.tolerance import FREE_TURN, ToleranceClause
from irlx.blocks.tool import ToolBlock, WeightsBlock

__all__ = [
    "FREE_TURN",
    "ArcCourse",
    "AskAvoidingPosture",
    "AskClearance",
    "AskInput",
    "AskInputChange",
    "AskJointBounds",
    "AskLastMove",
    "AskManipulability",
    "AskNearestPosture",
    "AskPause",
    "AskPose",
    "AskPosture",
    "AskPostureOf",
    "AskStandstill",
    "Blend",
    "Block",
    "CriterionBlock",
    "CriterionChoice",
    "CriterionClause",
    "CriterionParam",
    "CyclicBlock",
    "FreezeBlock",
    "HaltBlock",
    "InputBlock",
    "JointIncrement",
    "JointRange",
    "JointTarget",
    "LimitClause",
    "LimitKind",
    "LimitSwitchBlock",
    "LinkFrame",
    "MachineQuestion",
    "MotionLaw",
    "MoveBlock",
    "MoveKind",
    "ObstacleBlock",
    "Origin",
    "PathCourse",
    "PauseBlock",
    "Port",
    "PoseIncrement",
    "PoseTarget",
    "Profile",
    "Question",
    "ReconfigureBlock",
    "SignalBlock",
    "SignalKind",
    "Target",
    "ToleranceClause",
    "ToolBlock",
    "WaitBlock",
    "WeightsBlock",
]
