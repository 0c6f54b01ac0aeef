"""What a cell file may hold; validated as a whole by pydantic."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, PlainValidator
from pydantic_core import PydanticCustomError

from irlx.cell.limit_entry import Limits, is_number
from irlx.language.builtins import SYSTEM_VARIABLES

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Percent = Annotated[float, Field(gt=0.0, le=100.0)]
Coordinate = Literal["x", "y", "z", "rx", "ry", "rz"]
FreeTurn = Literal["rx", "ry", "rz"]
Vector = Annotated[list[Number], Field(min_length=3, max_length=3)]
PlanePoint = Annotated[list[Number], Field(min_length=2, max_length=2)]


def _frame_name(name: str) -> str:
    if name.casefold() in SYSTEM_VARIABLES:
        raise PydanticCustomError("frame_name", "another name, for this one is a system variable")
    return name


Trace = tuple[tuple[float, float], ...]


def _trace(found: Any) -> Trace:
    """Times and values of a scripted input; true and false count as 1 and 0."""
    entries = found if isinstance(found, list) else [found]
    if not all(_is_entry(entry) for entry in entries):
        raise PydanticCustomError("trace", "a list of pairs [time in s, value], true or false or a number")
    trace = tuple((float(at), float(value)) for at, value in entries)
    if any(later[0] <= earlier[0] for earlier, later in pairwise(trace)):
        raise PydanticCustomError("rising_times", "times that rise")
    return trace


def _is_entry(entry: Any) -> bool:
    if not (isinstance(entry, list) and len(entry) == 2):
        return False
    at, value = entry
    return is_number(at) and at >= 0.0 and (isinstance(value, bool) or is_number(value))


def _scale(found: Any) -> tuple[float, float, float]:
    """What a mesh is scaled by along x, y, z; one number stands for all three."""
    factors = found if isinstance(found, list) else [found] * 3
    if len(factors) != 3 or not all(map(is_number, factors)) or not all(factors):
        raise PydanticCustomError("scale", "a number other than 0, or three of them")
    x, y, z = (float(factor) for factor in factors)
    return x, y, z


def _link_pair(found: Any) -> tuple[str, str]:
    if not (isinstance(found, list) and len(found) == 2 and all(isinstance(name, str) for name in found)):
        raise PydanticCustomError("link_pair", "the names of two links")
    return found[0], found[1]


def _not_empty(found: list[Any]) -> list[Any]:
    if not found:
        raise PydanticCustomError("not_empty", "at least one table with time and xyz")
    return found


InputTrace = Annotated[Any, PlainValidator(_trace)]
LinkPair = Annotated[Any, PlainValidator(_link_pair)]
Scale = Annotated[Any, PlainValidator(_scale)]
FrameName = Annotated[str, AfterValidator(_frame_name)]


class Section(BaseModel):
    """Base of all tables: unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", strict=True)


class LimitsSection(Section):
    """Limits that replace those of the model: one entry a joint, or false for none at all.

    A number is +- that number, a pair is [lower, upper], false is no limit; deg | mm, s.
    """

    position: Limits | None = None
    speed: Limits | None = None
    acceleration: Limits | None = None


class SelfCollisionSection(Section):
    """Links that are kept off each other: `margin` and `influence` in mm, pairs that may touch.

    `srdf` is a file that names more such pairs. `active` by default where there are any.
    """

    active: bool | None = None
    may_touch: list[LinkPair] = Field(default_factory=list)
    srdf: str | None = None
    margin: NotNegative = 5.0
    influence: NotNegative = 30.0


class OriginSection(Section):
    """Where a joint sits in its parent link instead of where the URDF has it: mm, deg about fixed x, y, z."""

    xyz: Vector | None = None
    rpy: Vector | None = None


class RobotSection(Section):
    """The robot: model, tool frame, other hands, locked joints, origins of joints, task, posture, weights.

    `task` are coordinates of the tool pose in the frame of the link `task_frame`, by default the tool's own;
    `free` are turns that are left to the joints.
    """

    model: str | None = None
    tip: str | None = None
    locked: dict[str, Number] = Field(default_factory=dict)
    origins: dict[str, OriginSection] = Field(default_factory=dict)
    task: Annotated[list[Coordinate], Field(min_length=1)] | None = None
    task_frame: str | None = None
    free: list[FreeTurn] = Field(default_factory=list)
    start: list[Number] | None = None
    weights: list[Positive] | None = None
    status_joints: list[str] = Field(default_factory=list)
    hands: list[str] | None = None
    limits: LimitsSection = Field(default_factory=LimitsSection)
    self_collision: SelfCollisionSection = Field(default_factory=SelfCollisionSection)


class MotionSection(Section):
    """Defaults of the R_ variables: mm/s, mm/s2, deg/s, deg/s2, %, mm/s3, mm; the tick in ms."""

    tick_ms: Annotated[float, Field(ge=0.25, le=1000.0)] = 10.0
    speed: Positive = 250.0
    acc: Positive = 1000.0
    speed_ori: Positive = 90.0
    acc_ori: Positive = 180.0
    speed_ptp: Percent = 100.0
    acc_ptp: Percent = 100.0
    jerk: NotNegative = 0.0
    c_cp: NotNegative = 0.0
    c_ptp: Annotated[float, Field(ge=0.0, le=100.0)] = 0.0
    c_pass: bool = False
    profile: Literal["TRAPEZOID", "S_CURVE"] = "TRAPEZOID"
    override: Percent = 100.0


class FrameSection(Section):
    """A named pose: mm, and degrees about the fixed x, y, z axes; of a `link` of the robot, in its frame."""

    xyz: Vector = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    rpy: Vector = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    link: str | None = None


class SignalsSection(Section):
    """Scripted inputs: by the name of a port or of the program, pairs of a time in s and a value."""

    inputs: dict[str, InputTrace] = Field(default_factory=dict)


class ConstraintSection(Section):
    """A condition that holds beside the tool pose.

    `joints`: a factor for each joint that takes part; sum of factor times joint value = `value` (deg | mm),
    by default that of the start posture. `use` instead: the name of a constraint registered in Python.
    `axis` instead: a vector in the frame of `link` that points along `direction`, a vector in the root frame.
    `path` instead: points x, y (mm, in the root frame) of a curve, `closed` or not, on which the origin of
    `link` stays, seen from above; with `heading` its x axis points along the curve.
    """

    name: Annotated[str, Field(min_length=1)]
    joints: Annotated[dict[str, Number], Field(min_length=1)] | None = None
    value: Number | None = None
    use: str | None = None
    link: str | None = None
    axis: Vector | None = None
    direction: Vector | None = None
    path: list[PlanePoint] | None = None
    closed: bool = False
    heading: bool = False


class WaypointSection(Section):
    """Where an obstacle that moves lies at a time (s) of the run: mm, degrees as for frames."""

    time: NotNegative
    xyz: Vector
    rpy: Vector = Field(default_factory=lambda: [0.0, 0.0, 0.0])


class ObstacleSection(Section):
    """An obstacle, or a group of them: a shape with the sizes that go with it, mm, and a place in `frame`."""

    name: str
    shape: str
    size: Annotated[list[Positive], Field(min_length=3, max_length=3)] | None = None
    radius: Positive | None = None
    length: Positive | None = None
    file: str | None = None
    scale: Scale = (1.0, 1.0, 1.0)
    members: list[str] | None = None
    frame: str | None = None
    xyz: Vector = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    rpy: Vector = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    trajectory: Annotated[list[WaypointSection], AfterValidator(_not_empty)] | None = None
    margin: NotNegative = 10.0
    influence: NotNegative = 200.0


class CellFile(Section):
    """A whole cell file."""

    robot: RobotSection = Field(default_factory=RobotSection)
    motion: MotionSection = Field(default_factory=MotionSection)
    frames: dict[FrameName, FrameSection] = Field(default_factory=dict)
    constraint: list[ConstraintSection] = Field(default_factory=list)
    obstacle: list[ObstacleSection] = Field(default_factory=list)
    signals: SignalsSection = Field(default_factory=SignalsSection)
