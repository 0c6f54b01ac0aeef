"""The codes of records; docs/reference/irdata.md says what each one means."""

from __future__ import annotations

FORMAT = 100
SOFTWARE = 101
PROGRAM = 110
CELL = 120
MAKING = 130
ROBOT = 200
CLOCK = 201
JOINT = 210
SAMPLE = 900
END = 999

BLOCK_CODES = {
    "MoveBlock": 300,
    "ReconfigureBlock": 310,
    "PauseBlock": 380,
    "HaltBlock": 390,
    "LimitSwitchBlock": 410,
    "FreezeBlock": 420,
    "CyclicBlock": 430,
    "CriterionBlock": 440,
    "ObstacleBlock": 445,
    "ToolBlock": 450,
    "WeightsBlock": 460,
    "SignalBlock": 500,
    "InputBlock": 510,
    "WaitBlock": 520,
}
"""Code of each kind of function block."""

BLOCK_OF_CODE = {code: name for name, code in BLOCK_CODES.items()}
