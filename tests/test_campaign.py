"""Random programs on the 11-joint robot: every promise holds in what comes out, or a coded refusal names why.

The long part (`-m slow`) runs the same with many more seeds.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import irlx
from long_run import portions

QUICK, LONG = range(6), range(1000, 1400)
REFUSALS = {"IRL345", "IRL421", "IRL422", "IRL520", "IRL521", "IRL523"}
SPEED_DEG = np.array([60.0] * 9 + [600.0] + [40.0])


def number(value: float) -> str:
    return f"{value:.6f}"


def write_program(folder: Path, rng: np.random.Generator) -> None:
    """Program and cell: six lines near the start, options switched at random, limits of random size."""
    speeds = SPEED_DEG * rng.uniform(0.4, 3.0, 11)
    accelerations = speeds * rng.uniform(2.0, 20.0)
    tick = rng.choice([1, 4, 10, 50])
    limits = [f"speed = [{', '.join(map(number, speeds))}]"] if rng.random() < 0.7 else []
    if rng.random() < 0.6:
        limits.append(f"acceleration = [{', '.join(map(number, accelerations))}]")
    (folder / "drawn.toml").write_text(
        "\n".join(
            [
                "[robot]",
                'model = "koch11"',
                "[robot.limits]",
                *limits,
                "[robot.self_collision]",
                "active = false",
                "[motion]",
                f"tick_ms = {tick}",
                f"speed = {number(rng.uniform(100, 1500))}",
                f"acc = {number(rng.uniform(200, 4000))}",
            ]
        )
    )
    statements = []
    at = np.array([11500.0, 1000.0, 3500.0])
    switches = ["CYCLICSTART;", "CYCLICEND;", "FREEZESTART 2, 3;", "FREEZESTART 11;", "FREEZEEND;"]
    for _ in range(4):
        if rng.random() < 0.5:
            statements.append(str(rng.choice(switches)))
        # Tiny, repeated and ordinary ways mixed.
        way = rng.choice([0.0, 1e-7, 1e-3, 100.0, 800.0]) * rng.normal(size=3)
        turn = rng.choice([0.0, 1e-9, 5.0, 40.0]) * rng.normal(size=3)
        target = at + way
        statements.append(
            f"MOVE LIN (({', '.join(map(number, target))}), ORIZYX({', '.join(map(number, turn))}));"
        )
    (folder / "drawn.irl").write_text("PROGRAM drawn;\nBEGIN\n" + "\n".join(statements) + "\nENDPROGRAM;\n")


def assert_promises_hold(run: irlx.Run, seed: int) -> None:
    limits, dt = run.stream.header.limits, run.stream.dt
    unit = float(np.spacing(np.max(np.abs(run.q))))
    assert np.all(run.q >= limits.position_lower), seed
    assert np.all(run.q <= limits.position_upper), seed
    speeds = np.diff(run.q, axis=0, prepend=run.q[:1]) / dt
    accelerations = np.diff(speeds, axis=0, prepend=0 * speeds[:1]) / dt
    assert np.all(np.abs(speeds) <= limits.speed_upper * (1 + 1e-9) + 2 * unit / dt), seed
    assert np.all(np.abs(accelerations) <= limits.acceleration_upper * (1 + 1e-9) + 4 * unit / dt**2), seed
    report = irlx.verify(run)
    assert report.passed, (seed, [check.text for check in report.failed])
    assert {check.name for check in report.unchecked} <= {"program", "robot limits"}, seed
    assert run.summary.path_position_error <= 1e-6, seed


def one_case(seed: int, folder: Path) -> bool:
    """Run the case of a seed; True where it ran to its end."""
    write_program(folder, np.random.default_rng(seed))
    try:
        run = irlx.run(folder / "drawn.irl")
    except irlx.RunError as error:
        refused = error
    else:
        assert_promises_hold(run, seed)
        return True
    assert refused.reason.code in REFUSALS, (seed, str(refused))
    assert refused.reason.place.line is not None, seed
    if len(refused.run.t) > 1:
        assert np.all(refused.run.qd[-1] == 0.0), seed
    return False


@pytest.mark.req("QA-05")
@pytest.mark.req("MOT-20")
def test_promises_hold_or_the_refusal_names_why(tmp_path) -> None:
    finished = [one_case(seed, tmp_path) for seed in QUICK]
    assert sum(finished) >= 3, finished


@pytest.mark.slow
@pytest.mark.req("QA-05")
@pytest.mark.parametrize("seeds", portions(LONG), ids=str)
def test_promises_hold_in_the_long_campaign(tmp_path, seeds: range) -> None:
    for seed in seeds:
        print("seed", seed)
        one_case(seed, tmp_path)
