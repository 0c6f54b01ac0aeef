"""Time of whole runs and speed of the front end: what their benchmarks count, and over what they divide."""

import json
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
# Two moves that any arm7 makes.
PROGRAM = """PROGRAM short;
BEGIN
  MOVE_INC LIN POSITION(0, 0, 10);
  MOVE_INC LIN POSITION(0, 10, 0);
ENDPROGRAM;
"""
# Starts late, computes nothing, and says what irlx says at the end.
SLEEPER = 'import time; time.sleep(0.3); print(\'{"summary": {"duration": 6.0}}\')'


@pytest.fixture(scope="module", autouse=True)
def benchmarks():
    """Scripts of the folder find each other while the module is tested."""
    sys.path.insert(0, str(BENCHMARKS))
    yield
    sys.path.remove(str(BENCHMARKS))


@dataclass(frozen=True)
class Told:
    """A case whose process is told by its text."""

    text: str
    name: str = "told"

    def command(self, csv):
        return [sys.executable, "-c", self.text]


@pytest.mark.req("BEN-02")
def test_time_of_a_run_begins_with_its_process(tmp_path):
    from run_time import run

    found = run(Told(SLEEPER), tmp_path)
    # 0.3 s are slept before anything else: start-up counts by the clock, sleeping not for the processor.
    assert found["wall_s"] > 0.3
    assert found["cpu_s"] < found["wall_s"]
    assert found["simulated_s"] == 6.0


@pytest.mark.req("BEN-02")
def test_simulated_time_is_that_of_the_rows(tmp_path):
    from run_time import Case, run

    (tmp_path / "short.irl").write_text(PROGRAM, encoding="utf-8")
    (tmp_path / "arm.toml").write_text('[robot]\nmodel = "arm7"\n', encoding="utf-8")
    found = run(Case("short", tmp_path / "short.irl", tmp_path / "arm.toml", 20.0), tmp_path)
    lines = (tmp_path / "out.csv").read_text("utf-8").splitlines()
    ticks = [int(line.split(",")[0]) for line in lines if line[:1].isdigit()]
    assert ticks == list(range(len(ticks)))
    assert found["simulated_s"] == pytest.approx(0.02 * ticks[-1], abs=1e-9)
    assert found["memory_mb"] > 10.0


@pytest.mark.req("BEN-02")
def test_shares_are_clock_and_processor_for_a_simulated_second():
    from run_time import HEADINGS, rows

    rounds = [
        {"wall_s": wall, "cpu_s": 2.0, "memory_mb": 90.0 + wall, "simulated_s": 60.0} for wall in (9, 4, 5)
    ]
    assert rows({"cases": {"a": rounds}}) == [
        HEADINGS,
        ("a", "60.00", "5.00", "1/12.0", "2.00", "1/30.0", "99"),
    ]


@pytest.mark.req("BEN-02")
def test_a_run_that_fails_is_no_measurement(tmp_path):
    from run_time import run

    with pytest.raises(SystemExit, match=r"told: exit code 1\n(?s:.*)no such robot"):
        run(Told("raise SystemExit('no such robot')"), tmp_path)


@pytest.mark.req("BEN-03")
def test_lines_of_a_second_by_stage(monkeypatch, capsys):
    import front_end

    # Stage by stage, a warming round first: a second each there, a half and a quarter afterwards.
    taken = iter([1.0] * 5 + [0.5] * 5 + [0.25] * 5)
    worked = []
    monkeypatch.setattr(front_end, "seconds", lambda work: (worked.append(work()), next(taken))[1])
    monkeypatch.setattr(front_end, "cold_check", lambda folder: 0.25)
    monkeypatch.setattr(sys, "argv", ["front_end.py", "--lines", "300", "--rounds", "2", "--json"])
    front_end.main()
    figures = json.loads(capsys.readouterr().out)
    stages = ["lex", "parse", "analysis", "with lints", "formatter"]
    assert figures["lines"] >= 300
    assert list(figures["lines_per_s"]) == stages
    for row in figures["lines_per_s"].values():
        assert row == {"best": 4 * figures["lines"], "median": round(figures["lines"] / 0.375)}
    assert figures["cold_s"] == {"best": 0.25, "median": 0.25}
    # Every stage does its work on the whole program.
    assert len(worked) == 3 * len(stages)
    assert all(result is not None for result in worked)
