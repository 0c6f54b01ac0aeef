"""What embedding users import: `irlx.load`, `check`, `run`, `stream`, `verify` and their errors."""

import itertools
import subprocess
import sys

import numpy as np
import pytest

import irlx


@pytest.fixture
def short_run(folder):
    """A run of the folder's program."""
    return irlx.run(folder / "p.irl")


def test_the_public_names():
    assert dir(irlx) == sorted(irlx.__all__)
    for name in irlx.__all__:
        assert getattr(irlx, name) is not None
    with pytest.raises(AttributeError, match="module 'irlx' has no attribute 'fly'"):
        _ = irlx.fly
    assert {"load", "check", "run", "stream", "verify", "ProgramError", "RunError"} <= set(dir(irlx))


@pytest.mark.req("QA-11")
def test_import_is_light(environment):
    code = "import sys, irlx; dir(irlx); irlx.load; irlx.check; print('numpy' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stdout == "False\n"


def test_load(folder):
    program = irlx.load(folder / "p.irl")
    assert isinstance(program, irlx.Program)
    assert (program.name, program.specification, program.diagnostics) == ("p", None, ())
    assert program.path == folder / "p.irl"
    assert irlx.load(str(folder / "p.irl")).sha256 == program.sha256


def test_load_tells_everything_at_once(folder):
    (folder / "p.irl").write_text("PROGRAM p;\nBEGIN\n  x := 1;\n  CYCLICSTART;\n  y := 2;\nENDPROGRAM")
    with pytest.raises(irlx.ProgramError) as caught:
        irlx.load(folder / "p.irl")
    assert [d.code for d in caught.value.diagnostics] == ["IRL201", "IRL301", "IRL201"]
    assert caught.value.reason.message == "unknown name 'x'"
    assert isinstance(caught.value, irlx.IrlxError)
    with pytest.raises(irlx.ProgramError, match="IRL001"):
        irlx.load(folder / "q.irl")


def test_a_module_does_not_run(folder):
    (folder / "m.irl").write_text("MODULE m; ENDMODULE")
    with pytest.raises(irlx.ProgramError) as caught:
        irlx.load(folder / "m.irl")
    reason = caught.value.reason
    assert (reason.code, reason.message) == ("IRL008", "m is a MODULE, which does not run by itself")


def test_check_raises_nothing(folder):
    assert irlx.check(folder / "p.irl", cell=folder / "p.toml") == []
    assert [d.code for d in irlx.check(folder / "q.irl")] == ["IRL001"]
    assert [d.code for d in irlx.check(folder / "p.irl", cell=folder / "q.toml")] == ["IRL001"]
    (folder / "p.toml").write_text("[robot]\nmodel = 'koch'\n[motion]\nspeed = 0\n")
    finding, other = irlx.check(folder / "p.irl", cell=folder / "p.toml")
    assert str(finding).startswith(f"{folder / 'p.toml'}: motion.speed: error IRL603: ")
    assert (other.code, other.place.key) == ("IRL611", "robot.model")


def test_run(folder, short_run):
    run = short_run
    samples, joints = run.q.shape
    assert (joints, len(run.joint_names)) == (11, 11)
    assert run.t.shape == run.block.shape == (samples,)
    assert run.qd.shape == run.qdd.shape == (samples, joints)
    assert run.tool.shape == (samples, 7)
    np.testing.assert_array_equal(run.t, np.arange(samples) * 50 / 1000)
    np.testing.assert_allclose(np.linalg.norm(run.tool[:, 3:], axis=1), 1.0, atol=1e-14)
    assert set(run.block.tolist()) == {0, 1, 2}
    assert run.complete
    assert run.summary.moves == 2
    assert run.summary.duration == run.t[-1]
    assert run.diagnostics == ()
    assert isinstance(run.events, tuple)


def test_rates_are_backward_differences_from_rest(short_run):
    run = short_run
    np.testing.assert_array_equal(run.qd[0], 0.0)
    np.testing.assert_allclose(run.qd[1:], np.diff(run.q, axis=0) / 0.05, rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.qdd[1:], np.diff(run.qd, axis=0) / 0.05, rtol=0, atol=1e-10)
    np.testing.assert_array_equal(run.qd[-1], 0.0)
    assert (np.abs(run.qdd[:, :9]) <= np.radians(500) * (1 + 1e-9)).all()


def test_the_tool_is_where_the_program_wants_it(short_run):
    corner = np.flatnonzero(short_run.block == 1)[-1]
    np.testing.assert_allclose(short_run.tool[0, :3], [11.5, 1.0, 3.5], atol=1e-6)
    np.testing.assert_allclose(short_run.tool[corner, :3], [11.4, 1.0, 3.5], atol=1e-6)
    np.testing.assert_allclose(short_run.tool[-1, :3], [11.5, 1.0, 3.5], atol=1e-6)


def test_tick_and_cell_are_arguments(folder, short_run):
    run = irlx.run(irlx.load(folder / "p.irl"), cell=folder / "p.toml", tick_ms=25)
    assert run.t[1] == 0.025
    assert abs(run.t[-1] - short_run.t[-1]) <= 0.1
    with pytest.raises(irlx.IrlxError, match="IRL006"):
        irlx.run(folder / "p.irl", tick_ms=0)


@pytest.mark.req("QA-06")
@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"max_steps": 2.5}, "--max-steps 2.5: a whole number, at least 1"),
        ({"max_steps": "3"}, "--max-steps '3': a whole number, at least 1"),
        ({"max_steps": True}, "--max-steps True: a whole number, at least 1"),
        ({"max_steps": 0}, "--max-steps 0: a whole number, at least 1"),
        ({"tick_ms": "10"}, "--tick '10': a tick lasts 0.25 to 1000 ms"),
        ({"tick_ms": 10**400}, "a tick lasts 0.25 to 1000 ms"),
        ({"tick_ms": float("nan")}, "--tick nan: a tick lasts 0.25 to 1000 ms"),
        ({"max_slow": "2"}, "--max-slow '2': a move cannot be faster"),
        ({"max_slow": 10**400}, "a move cannot be faster"),
        ({"pause_s": "1"}, "--pause '1': a pause lasts a number of seconds"),
        ({"pause_s": 10**400}, "a pause lasts a number of seconds"),
        ({"pause_s": float("inf")}, "--pause inf: a pause lasts a number of seconds"),
        ({"explain_tick": 2.5}, "explain_tick= 2.5: a whole number, at least 0"),
        ({"explain_tick": -1}, "explain_tick= -1: a whole number, at least 0"),
        ({"cell": 3}, "cell= 3: a path, or a cell that has been loaded"),
        ({"output": 3}, "output= 3: a file that is open to be written"),
    ],
    ids=str,
)
def test_arguments_that_cannot_be_used_are_told_with_what_is_expected(folder, given, told) -> None:
    with pytest.raises(irlx.IrlxError) as caught:
        irlx.run(folder / "p.irl", **given)
    assert [found.code for found in caught.value.diagnostics] == ["IRL006"]
    assert told in str(caught.value)


def test_numbers_of_numpy_are_numbers(folder, short_run) -> None:
    run = irlx.run(
        folder / "p.irl", tick_ms=np.float32(25.0), max_steps=np.int64(1000), max_slow=np.float64(3.0)
    )
    assert run.t[1] == 0.025


@pytest.mark.req("QA-06")
def test_what_is_no_run_is_not_verified(folder, short_run) -> None:
    for wrong, told in (
        ((3,), "run_or_file= 3: a run, or the path"),
        ((short_run, None, None, 0), "at least 1"),
    ):
        with pytest.raises(irlx.IrlxError, match="IRL006") as caught:
            irlx.verify(*wrong)
        assert told in str(caught.value)


@pytest.mark.req("STR-04")
@pytest.mark.parametrize("ending", ["npz", "csv", "irdata"])
def test_save_and_verify(folder, short_run, ending):
    path = folder / f"out.{ending}"
    short_run.save(path)
    assert path.stat().st_size > 1000
    report = irlx.verify(path, program=folder / "p.irl", cell=folder / "p.toml")
    assert report.passed
    assert report.failed == ()


def test_npz_keys(folder, short_run):
    short_run.save(folder / "out.npz")
    with np.load(folder / "out.npz") as found:
        assert {"t", "q", "qd", "qdd", "tool", "block", "joint_names", "meta"} <= set(found.files)
        np.testing.assert_array_equal(found["qdd"], short_run.qdd)


def test_verify_takes_a_run(folder, short_run, monkeypatch):
    monkeypatch.chdir(folder)
    assert irlx.verify(short_run).passed


def test_save_where_one_cannot(folder, short_run):
    with pytest.raises(irlx.StreamError, match="IRL003"):
        short_run.save(folder / "no" / "out.csv")
    with pytest.raises(irlx.StreamError, match=r"IRL707|IRL004"):
        short_run.save(folder / "out.foo")


def test_stream_is_the_run_bit_for_bit(folder, short_run):
    samples = list(irlx.stream(folder / "p.irl"))
    assert all(isinstance(sample, irlx.Sample) for sample in samples)
    assert [sample.tick for sample in samples] == list(range(len(short_run.t)))
    for name in ("t", "q", "qd", "qdd", "tool", "block"):
        streamed = np.array([getattr(sample, name) for sample in samples])
        np.testing.assert_array_equal(streamed, getattr(short_run, name))


def test_samples_may_be_changed(folder, short_run):
    """Whoever turns a sample into degrees in place does not move the robot, nor what follows."""
    before = {name: [] for name in ("q", "qd", "qdd", "tool")}
    for sample in irlx.stream(folder / "p.irl"):
        for name, rows in before.items():
            rows.append(getattr(sample, name).copy())
            getattr(sample, name)[:] = 57.3
    for name, rows in before.items():
        np.testing.assert_array_equal(np.array(rows), getattr(short_run, name))


@pytest.mark.parametrize("ticks", [0, 1, 5, 20])
def test_stream_stops_anywhere(folder, short_run, ticks):
    stream = irlx.stream(folder / "p.irl", cell=folder / "p.toml")
    first = list(itertools.islice(stream, ticks))
    stream.close()
    np.testing.assert_array_equal([sample.q for sample in first] or np.empty((0, 11)), short_run.q[:ticks])


def test_stream_goes_no_further_than_asked(folder):
    text = (
        (folder / "p.irl")
        .read_text()
        .replace("MOVE LIN home;", "MOVE LIN POSITION(1 / (R_ACC - R_ACC), 0, 0);")
    )
    (folder / "p.irl").write_text(text)
    stream = irlx.stream(folder / "p.irl")
    assert next(stream).tick == 0
    assert next(stream).block == 1
    with pytest.raises(irlx.IrlxError, match="IRL502"):
        list(stream)


def test_run_error_holds_what_was_executed(folder, short_run):
    text = (
        (folder / "p.irl")
        .read_text()
        .replace("MOVE LIN home;", "MOVE LIN POSITION(1 / (R_ACC - R_ACC), 0, 0);")
    )
    (folder / "p.irl").write_text(text)
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(folder / "p.irl")
    error = caught.value
    assert (error.reason.code, error.reason.place.line) == ("IRL502", 5)
    assert isinstance(error, irlx.IrlxError)
    assert not error.run.complete
    assert error.run.summary.moves == 1
    np.testing.assert_array_equal(error.run.q, short_run.q[: len(error.run.q)])
    assert len(error.run.q) > 2


def test_cell_errors(folder):
    (folder / "p.toml").unlink()
    with pytest.raises(irlx.CellError) as caught:
        irlx.run(folder / "p.irl")
    assert caught.value.reason.code == "IRL609"
    assert str(folder / "p.toml") in caught.value.reason.message


UNUSED = {"IRL281"}
FRAME = "[frames]\nFixture = { xyz = [11400, 1000, 3500] }\n"


def with_frame(folder, statement, declarations=""):
    """Let p.toml hold a frame, and p.irl a statement on line 4."""
    (folder / "p.toml").write_text((folder / "p.toml").read_text() + FRAME)
    text = (folder / "p.irl").read_text().replace("MOVE LIN near;", statement)
    (folder / "p.irl").write_text(text.replace("PROGRAM p;", f"PROGRAM p; {declarations}"))


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("MOVE LIN fixture;", []),
        ("fixture := ((1, 2, 3), (1, 0, 0, 0));", ["IRL211"]),
        ("fixture.pos.x := 3;", ["IRL211"]),
        ("MOVE LIN fixture(1);", ["IRL209"]),
        ("MOVE LIN fixtur;", ["IRL201"]),
    ],
)
def test_names_of_frames_are_constants(folder, statement, expected):
    with_frame(folder, statement)
    for cell in (None, folder / "p.toml"):
        found = irlx.check(folder / "p.irl", cell=cell)
        assert [d.code for d in found if d.code not in UNUSED] == expected
    if expected:
        with pytest.raises(irlx.ProgramError, match=expected[0]):
            irlx.load(folder / "p.irl")
    else:
        assert irlx.load(folder / "p.irl").diagnostics == ()


@pytest.mark.req("CELL-01")
def test_a_declaration_hides_a_frame(folder):
    with_frame(folder, "fixture.x := 11450; MOVE LIN fixture;", "VAR POSITION: fixture := (1, 1000, 3500);")
    run = irlx.run(folder / "p.irl")
    assert run.tool[np.flatnonzero(run.block == 1)[-1], 0] == pytest.approx(11.45)


@pytest.mark.req("CELL-01")
def test_frames_of_a_cell_elsewhere(folder):
    with_frame(folder, "MOVE LIN fixture;")
    cell = folder / "other.toml"
    (folder / "p.toml").rename(cell)
    assert [d.code for d in irlx.check(folder / "p.irl") if d.code not in UNUSED] == ["IRL201"]
    run = irlx.run(folder / "p.irl", cell=cell)
    assert irlx.verify(run, program=folder / "p.irl", cell=cell).passed
    assert irlx.run(irlx.load(folder / "p.irl", cell=cell), cell=cell).complete


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize(
    ("text", "found", "given"),
    [
        (b"[frames\n", ["IRL601"], ["IRL601"]),
        (b"\xff", ["IRL601"], ["IRL601"]),
        (b"frames = 3\n", [], ["IRL603", "IRL610"]),
        (b"frames = [1]\n", [], ["IRL603", "IRL610"]),
    ],
)
def test_a_broken_cell_is_told_once(folder, text, found, given):
    (folder / "p.toml").write_bytes(text)
    assert [one.code for one in irlx.check(folder / "p.irl")] == found
    assert [one.code for one in irlx.check(folder / "p.irl", cell=folder / "p.toml")] == given


@pytest.mark.req("CELL-01")
def test_frames_of_the_cell_are_poses_of_the_program(folder):
    with (folder / "p.toml").open("a") as file:
        file.write("[frames]\nfixture = { xyz = [11400, 1000, 3500] }\n")
    text = (folder / "p.irl").read_text().replace("MOVE LIN near;", "MOVE LIN fixture;")
    (folder / "p.irl").write_text(text)
    assert irlx.run(folder / "p.irl").complete


@pytest.mark.parametrize(
    "statement",
    [
        "MOVE LIN POSITION(1E308 / (R_ACC - R_ACC + 0.01), 0, 0);",
        "MOVE LIN POSITION(1E307 * 9, 0, 0);",
        "MOVE LIN POSITION(1E30, 0, 0);",
        "MOVE LIN near SPEED := 1E-300;",
        "MOVE LIN near SPEED := 5E-324;",
        "MOVE LIN near ACC := 5E-324;",
        "MOVE LIN near TIME := 1E300;",
        "MOVE LIN near SPEED := 0.0001;",
    ],
)
def test_moves_without_measure_are_located_errors(folder, statement):
    text = (folder / "p.irl").read_text().replace("MOVE LIN near;", statement)
    (folder / "p.irl").write_text(text)
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(folder / "p.irl")
    assert caught.value.reason.place.line == 4


def test_joints_without_position_limits(folder):
    (folder / "p.toml").write_text("[robot]\nmodel = 'koch11'\n[robot.limits]\nposition = false\n")
    assert irlx.run(folder / "p.irl", tick_ms=50).complete
