"""Random programs for robots that are asked for fewer than six coordinates, judged by the verifier.

A program may be refused for a way out of reach, never for a target that was made to be met in all; what runs
passes every check. PTPs do not run into moves of the tool here: that is for other campaigns.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import irlx
from long_run import first

pytestmark = pytest.mark.req("TRF-21")

ROBOTS = {
    "five axes": 'model = "irb6"',
    "five axes, pitch": 'model = "irb6"\nfree = ["rx", "rz"]',
    "five axes, position": 'model = "irb6"\ntask = ["x", "y", "z"]\nfree = ["rx", "ry", "rz"]',
    "drill on a rail": 'model = "rail6"\nfree = ["rx"]',
    "position": 'model = "arm7"\ntask = ["x", "y", "z"]\nfree = ["rx", "ry", "rz"]',
    "plane, turn free": 'model = "planar4"\ntask = ["x", "y"]\nfree = ["rz"]',
}
PLACES = {
    "irb6": ((600, -350, 850), (700, 350, 1000)),
    "rail6": ((600, -200, 400), (800, 500, 700)),
    "arm7": ((350, -200, 400), (550, 300, 600)),
    "planar4": ((300, 300, 0), (600, 600, 0)),
}
REFUSALS = {"IRL428", "IRL520", "IRL521", "IRL522"}
QUICK, LONG = 1, 12


def target(rng: np.random.Generator, model: str) -> str:
    """A place, with an orientation or without; for five axes one that leans to no side."""
    x, y, z = rng.uniform(*PLACES[model])
    place = f"({x:.6f}, {y:.6f}, {z:.6f})"
    if rng.random() < 0.4:
        return place
    a, b, c = rng.uniform((-20, 50, -40), (20, 90, 40))
    if model == "irb6":
        a, b, c = (
            np.degrees(np.arctan2(y, x)),
            rng.uniform(0, 60),
            rng.choice([0.0, 90.0, rng.uniform(-90, 90)]),
        )
    if model == "planar4":
        b = c = 0.0
    return f"({place}, ORIZYX({a:.7f}, {b:.6f}, {c:.6f}))"


def move(rng: np.random.Generator, model: str) -> str:
    t = [target(rng, model) for _ in range(3)]
    blend = f" C_CP := {rng.integers(1, 40)}" if rng.random() < 0.4 else ""
    around = " CIRC_ORI := 'VIA'" if rng.random() < 0.5 else ""
    dx, dy, dz = rng.integers(-30, 31, 3)
    return str(
        rng.choice(
            [
                f"MOVE LIN {t[0]}{blend};",
                f"MOVE PTP {t[0]};",
                f"MOVE CIRCLE {t[0]}, {t[1]}{blend}{around};",
                f"MOVE SPLINE PATH ({t[0]}, {t[1]}, {t[2]}){blend};",
                f"MOVE LIN PATH ({t[0]}, {t[1]}){blend};",
                f"MOVE_INC LIN ({dx}, {dy}, {0 if model == 'planar4' else dz});",
            ]
        )
    )


def judged(folder: Path, robot: str, seed: int) -> str:
    """Code of the refusal of a program that passes as far as it goes, '' where it is not refused."""
    rng = np.random.default_rng(seed)
    model = robot.split('"')[1]
    moves = "\n".join(move(rng, model) for _ in range(4))
    cell = f"[robot]\n{robot}\n[motion]\ntick_ms = 20\nspeed = 300\nacc = 1500\n"
    (folder / "p.toml").write_text(cell, encoding="utf-8")
    (folder / "p.irl").write_text(f"PROGRAM p;\nBEGIN\n{moves}\nENDPROGRAM\n", encoding="utf-8")
    said = f"seed {seed}, {robot}:\n{moves}\n"
    code = ""
    try:
        run = irlx.run(folder / "p.irl")
    except irlx.RunError as error:
        code, run, said = error.reason.code, error.run, f"{said}{error}"
    assert code in {"", *REFUSALS}, said
    if run is not None:
        report = irlx.verify(run, program=folder / "p.irl", cell=folder / "p.toml")
        failed = {check.name for check in report.checks if check.status == "failed"}
        assert failed <= ({"complete"} if code else set()), f"{said}{report}"
    return code


@pytest.mark.parametrize("name", first(4, sorted(ROBOTS, key=lambda name: name.endswith("position"))))
def test_what_runs_passes(name: str, tmp_path: Path) -> None:
    for seed in range(QUICK):
        judged(tmp_path, ROBOTS[name], seed)


@pytest.mark.slow
@pytest.mark.parametrize("name", ROBOTS)
def test_what_runs_passes_at_length(name: str, tmp_path: Path) -> None:
    codes = [judged(tmp_path, ROBOTS[name], seed) for seed in range(QUICK, QUICK + LONG)]
    # Most of it is no refusal, or nothing would have been judged.
    assert codes.count("") > LONG // 3, codes
