"""What a target cannot play is refused by code, with the reason, and leaves no file."""

import os
from pathlib import Path

import numpy as np
import pytest

import irlx
from arm_streams import arm_stream, there_and_back
from irlx.exporters import TARGETS
from irlx.exporters.krl import KrlWriter
from irlx.exporters.program_writer import ProgramWriter
from irlx.exporters.rapid import RapidWriter
from irlx.exporters.urscript import UrScriptWriter
from irlx.streams import JointStream, StreamError

MOVING = there_and_back(6)[:20]
BY_TARGET = [(name, target.ending, 2.0 if name == "urscript" else 10.0) for name, target in TARGETS.items()]


def refusal(stream: JointStream, target: str, folder: Path, **more: object) -> tuple[str, str]:
    """Code and message of what a target refuses; what was at the path before has to be there still."""
    path = folder / f"weld{TARGETS[target].ending}"
    path.write_text("before")
    with pytest.raises(StreamError) as caught:
        irlx.convert(stream, path, target, **more)
    assert [(entry.name, entry.read_text()) for entry in folder.iterdir()] == [(path.name, "before")]
    reason = caught.value.reason
    assert str(reason.place) == str(path)
    assert reason.help
    return reason.code, reason.message


@pytest.mark.req("STR-04")
@pytest.mark.parametrize(
    ("target", "units", "found"),
    [
        ("urscript", "rrrrr", "URScript moves 6 turning joints; this stream has 5 turning joints"),
        ("urscript", "rrrrrrr", "URScript moves 6 turning joints; this stream has 7 turning joints"),
        ("rapid", "rrrrr", "6 to 7 turning joints and up to 6 slides, 12 in all; this stream has 5 turning"),
        ("rapid", "rrrrrrrr", "this stream has 8 turning joints"),
        ("rapid", "mmmmmmmrrrrrr", "this stream has 6 turning joints and 7 slides"),
        ("rapid", "mmmmmmrrrrrrr", "this stream has 7 turning joints and 6 slides"),
        (
            "krl",
            "m",
            "KRL moves 1 to 12 turning joints and up to 6 slides, 12 in all; this stream has 0",
        ),
        ("krl", "rmmmmmmm", "this stream has 1 turning joint and 7 slides"),
        ("krl", "rrrrrrrrrrrrr", "this stream has 13 turning joints"),
        ("robodk", "rrrrrrrrrrrrr", "this stream has 13 turning joints"),
        ("robodk", "", "this stream has 0 turning joints"),
    ],
)
def test_joints(target: str, units: str, found: str, tmp_path: Path) -> None:
    rows = there_and_back(len(units)) if units else np.zeros((3, 0))
    code, message = refusal(arm_stream(units, 2.0, rows), target, tmp_path)
    assert code == "IRL710"
    assert found in message


def test_slides(tmp_path: Path) -> None:
    code, message = refusal(arm_stream("rrrrrm", 2.0), "urscript", tmp_path)
    assert (code, message) == ("IRL711", "URScript has no slides, and joint 'A6' is one")


@pytest.mark.parametrize(
    ("target", "tick_ms", "wanted"),
    [
        ("urscript", 10.0, "URScript takes a tick of 2 ms and no other; this stream has one of 10 ms"),
        ("urscript", 2.000001, "this stream has one of 2.000001 ms"),
        ("urscript", 1.0, "this stream has one of 1 ms"),
        ("rapid", 9.999999, "RAPID takes a tick of 10 ms or more; this stream has one of 9.999999 ms"),
    ],
)
def test_ticks(target: str, tick_ms: float, wanted: str, tmp_path: Path) -> None:
    code, message = refusal(arm_stream("rrrrrr", tick_ms), target, tmp_path)
    assert code == "IRL712"
    assert wanted in message


@pytest.mark.parametrize(
    ("ticks", "found"),
    [
        ([1, 2, 3], "tick 1 follows the beginning"),
        ([0, 2, 3], "tick 2 follows 0"),
        ([0, 1, 9], "tick 9 follows 1"),
    ],
)
def test_gaps(ticks: list[int], found: str, tmp_path: Path) -> None:
    stream = arm_stream("rrrrrr", 2.0, np.zeros((3, 6)), ticks=ticks)
    code, message = refusal(stream, "urscript", tmp_path)
    assert code == "IRL713"
    assert found in message


@pytest.mark.parametrize(("target", "ending", "tick_ms"), BY_TARGET)
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300, -1.1e6])
def test_values(target: str, ending: str, tick_ms: float, value: float, tmp_path: Path) -> None:
    rows = there_and_back(6)
    rows[17, 3] = value
    code, message = refusal(arm_stream("rrrrrr", tick_ms, rows), target, tmp_path)
    assert code == "IRL714"
    assert f"joint 'A4' is {value:g} rad at tick 17" in message


@pytest.mark.parametrize(("target", "ending", "tick_ms"), BY_TARGET)
def test_a_writer_by_itself_leaves_nothing_either(
    target: str, ending: str, tick_ms: float, tmp_path: Path
) -> None:
    stream = arm_stream("rrrrrr", tick_ms)
    parts = (stream.ticks, stream.q, stream.block, stream.tool)
    for wrong in (stream.q + np.inf, stream.q[:, :5]):
        writer = TARGETS[target].writer(tmp_path / f"a{ending}", stream.header)
        assert len(list(tmp_path.iterdir())) == 1
        with pytest.raises(StreamError, match=r"IRL714|IRL708"):
            writer.samples(parts[0], wrong, *parts[2:])
        assert not list(tmp_path.iterdir())
    writer = TARGETS[target].writer(tmp_path / f"a{ending}", stream.header)
    writer.samples(*parts)
    with pytest.raises(StreamError, match="IRL716"):
        writer.close(complete=False)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("target", "ending", "tick_ms"), BY_TARGET)
def test_speed_at_the_end(target: str, ending: str, tick_ms: float, tmp_path: Path) -> None:
    stream = arm_stream("rrrrrr", tick_ms, MOVING)
    if target == "robodk":
        assert irlx.convert(stream, tmp_path / "weld.csv", target) == ()
        return
    step = MOVING[-1] - MOVING[-2]
    joint = int(np.argmax(np.abs(step)))
    code, message = refusal(stream, target, tmp_path)
    assert code == "IRL715"
    speed = step[joint] / (tick_ms / 1000)
    assert f"ends at tick 19 while joint 'A{joint + 1}' still moves at {speed:.3g} rad/s" in message


def test_the_slowest_motion_at_the_end_counts(tmp_path: Path) -> None:
    rows = np.ones((3, 6))
    rows[2, 4] = np.nextafter(1.0, 2.0)
    code, message = refusal(arm_stream("rrrrrr", 2.0, rows), "urscript", tmp_path)
    assert code == "IRL715"
    assert "joint 'A5'" in message


@pytest.mark.parametrize(("target", "ending", "tick_ms"), BY_TARGET)
def test_incomplete(target: str, ending: str, tick_ms: float, tmp_path: Path) -> None:
    stream = arm_stream("rrrrrr", tick_ms, complete=False)
    assert refusal(stream, target, tmp_path)[0] == "IRL716"
    assert irlx.convert(stream, tmp_path / f"weld{ending}", target, incomplete=True) == ()


@pytest.mark.parametrize(("target", "ending", "tick_ms"), BY_TARGET)
def test_no_points(target: str, ending: str, tick_ms: float, tmp_path: Path) -> None:
    code, message = refusal(arm_stream("rrrrrr", tick_ms, np.zeros((0, 6))), target, tmp_path)
    assert code == "IRL717"
    assert message.endswith("this stream has none")


@pytest.mark.parametrize("writer", [UrScriptWriter, KrlWriter, RapidWriter])
@pytest.mark.parametrize("room", [0, -1])
def test_points(
    writer: type[ProgramWriter], room: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from dataclasses import replace

    stream = arm_stream("rrrrrr", 2.0 if writer is UrScriptWriter else 10.0)
    # Rows that stand still are no points of their own in KRL and RAPID.
    points = len(stream.q) if writer is UrScriptWriter else 81
    monkeypatch.setattr(writer, "profile", replace(writer.profile, most_points=points + room))
    (target,) = [name for name, known in TARGETS.items() if known.writer is writer]
    if room == 0:
        assert irlx.convert(stream, tmp_path / "weld.txt", target) == ()
        return
    code, message = refusal(stream, target, tmp_path)
    assert code == "IRL717"
    assert message.endswith(f"holds 1 to {points - 1} points; this stream has more")


@pytest.mark.parametrize("name", TARGETS)
def test_every_profile_bounds_what_its_target_does(name: str) -> None:
    profile = TARGETS[name].writer.profile
    assert profile.most_joints <= profile.turning[1] + profile.slides[1]
    assert (profile.most_points is None) == (name == "robodk")
    assert (profile.names is None) == (name == "robodk")


@pytest.mark.parametrize(
    ("target", "stem", "name"),
    [
        ("urscript", "weld", "weld"),
        ("urscript", "Weld_2", "Weld_2"),
        ("urscript", "weld-2.v3", "weld_2_v3"),
        ("urscript", "2nd", "p_2nd"),
        ("urscript", "_x", "p__x"),
        ("urscript", "end", "p_end"),
        ("urscript", "End", "End"),
        ("urscript", "zażółć gęślą", "zazolc_gesla"),
        ("urscript", "юг", "p___"),
        ("krl", "END", "p_END"),
        ("krl", "Then", "p_Then"),
        ("krl", "a" * 24, "a" * 24),
        ("krl", "a" * 25, "a" * 24),
        ("krl", "1" * 25, "p_" + "1" * 22),
        ("rapid", "EndModule", "p_EndModule"),
        ("rapid", "tool0", "p_tool0"),
        ("rapid", "b" * 40, "b" * 28),
        ("rapid", "main", "main"),
    ],
)
def test_names(target: str, stem: str, name: str, tmp_path: Path) -> None:
    path = tmp_path / f"{stem}{TARGETS[target].ending}"
    stream = arm_stream("rrrrrr", 2.0 if target == "urscript" else 10.0)
    notes = irlx.convert(stream, path)
    assert [note.code for note in notes] == ([] if name == stem else ["IRL718"])
    form = {"urscript": f"def {name}():", "krl": f"DEF {name}()", "rapid": f"PROC {name}()"}[target]
    text = path.read_text()
    assert form in [line.strip() for line in text.splitlines()]
    if target == "rapid":
        assert text.startswith(f"MODULE {name}_Mod\n")
    for note in notes:
        assert note.message.startswith(f"the program is called {name}, since '{stem}' is no name in ")


@pytest.mark.parametrize(("target", "ending", "tick_ms"), BY_TARGET)
@pytest.mark.parametrize("where", ["missing/a", "folder", "nul\0"])
def test_unwritable(target: str, ending: str, tick_ms: float, where: str, tmp_path: Path) -> None:
    (tmp_path / f"folder{ending}").mkdir()
    with pytest.raises(StreamError) as caught:
        irlx.convert(arm_stream("rrrrrr", tick_ms), tmp_path / f"{where}{ending}", target)
    assert caught.value.reason.code == "IRL003"
    assert [path.name for path in tmp_path.iterdir()] == [f"folder{ending}"]


@pytest.mark.parametrize(("target", "ending", "tick_ms"), BY_TARGET)
def test_full_disk_leaves_nothing(
    target: str, ending: str, tick_ms: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / f"a{ending}").write_text("before")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(StreamError, match="no space left"):
        irlx.convert(arm_stream("rrrrrr", tick_ms), tmp_path / f"a{ending}", target)
    assert [path.read_text() for path in tmp_path.iterdir()] == ["before"]


PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "exporters.md").read_text(encoding="utf-8")


def test_the_reference_has_the_numbers_of_the_profiles() -> None:
    table = [line.strip("| ").split(" | ") for line in PAGE.splitlines() if line.startswith("| ")]
    rows = {cells[0]: cells[1:] for cells in table if len(cells) == 5}
    for place, (name, target) in enumerate(TARGETS.items()):
        profile = target.writer.profile
        told = {what: cells[place] for what, cells in rows.items()}
        assert f"`{target.ending}`, `{name}`" in told["ending, `--to`"]
        assert told["digits behind the point"] == str(profile.digits)
        most = profile.most_points
        assert told["points of a program"] == ("any number" if most is None else f"up to {most}")
        assert (told["must end at rest"] == "yes") == profile.ends_at_rest
        tick = profile.tick_ns or profile.shortest_tick_ns
        assert told["tick"].startswith("any" if tick is None else f"{tick / 1e6:g} ms")
        longest = {"rapid": 32, "robodk": "no name"}.get(name, profile.names and profile.names.longest)
        assert told["longest name"] == str(longest)
        assert str(profile.turning[1]) in told["joints"]
