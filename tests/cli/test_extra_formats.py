"""Parquet files and ROS 2 bags through the command line."""

import json
import sys

import pytest

from irlx.streams.formats import read_stream, write_stream

OUTPUTS = ["-o", "a.irdata", "-o", "a.parquet", "-o", "a.rosbag"]


def content(folder):
    """Bytes of every file in a folder and in those in it, by name."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.req("STR-04")
@pytest.mark.req("QA-09")
def test_a_run_writes_and_verifies_both(inside, folder, names):
    done = inside("run", "p.irl", *OUTPUTS)
    assert (done.returncode, done.stderr) == (0, "")
    assert [line.split()[1] for line in done.stdout.splitlines() if line.startswith("written")] == OUTPUTS[
        1::2
    ]
    assert names(folder) == ["a.irdata", "a.parquet", "a.rosbag", "p.irl", "p.toml"]
    passed = {line.split()[1]: line.split()[4] for line in done.stdout.splitlines() if "passed" in line}
    # The others state rates, which is one check more.
    assert int(passed["a.parquet"]) == int(passed["a.rosbag"]) == int(passed["a.irdata"]) + 1
    first = content(folder)
    assert inside("run", "p.irl", *OUTPUTS).returncode == 0
    assert content(folder) == first
    wanted = read_stream(folder / "a.irdata")
    for name in ("a.parquet", "a.rosbag"):
        found = read_stream(folder / name)
        assert (found.q.tobytes(), found.records) == (wanted.q.tobytes(), wanted.records)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("name", ["a.parquet", "a.rosbag"])
def test_verify(name, inside, folder):
    inside("run", "p.irl", "-o", name, "--no-verify")
    done = inside("verify", name, "--program", "p.irl", "--json")
    checks = {check["name"]: check["status"] for check in json.loads(done.stdout)["checks"]}
    assert done.returncode == 0
    assert {checks[name] for name in ("file", "blocks", "program", "written rates")} == {"ok"}
    file = folder / name / "stream.mcap" if name == "a.rosbag" else folder / name
    data = bytearray(file.read_bytes())
    data[-9] ^= 255
    file.write_bytes(data)
    done = inside("verify", name)
    assert done.returncode == 1
    assert "file: IRL701: this is no valid" in done.stdout


@pytest.mark.req("STR-04")
def test_converted_there_and_back(inside, folder):
    inside("run", "p.irl", *OUTPUTS, "--no-verify")
    first = content(folder)
    assert inside("convert", "a.irdata", "-o", "b.parquet", "-o", "b.rosbag").returncode == 0
    assert inside("convert", "b.rosbag", "-o", "c.parquet", "-o", "c.irdata").returncode == 0
    assert inside("convert", "b.parquet", "-o", "c.rosbag", "-o", "d.irdata").returncode == 0
    found = content(folder)
    for name in ("b.parquet", "c.parquet"):
        assert found[name] == first["a.parquet"]
    for name in ("c.irdata", "d.irdata"):
        assert found[name] == first["a.irdata"]
    for name in ("stream.mcap", "metadata.yaml"):
        assert found[f"b.rosbag/{name}"] == found[f"c.rosbag/{name}"] == first[f"a.rosbag/{name}"]
    assert inside("convert", "a.rosbag", "-o", "a.rosbag").stderr.startswith("error IRL005: ")


@pytest.mark.parametrize("joint", ["velocity", "position"])
def test_what_a_bag_states_is_judged(joint, inside, folder, monkeypatch):
    """A writer that made velocities of its own, with all checksums right, is found out."""
    from irlx.streams.rosbag.messages import RowForm

    inside("run", "p.irl", "-o", "a.irdata", "--no-verify")
    stream = read_stream(folder / "a.irdata")
    right = RowForm.records

    def wrong(form, ticks, q, qd, block, tool):
        values = {"velocity": qd, "position": q}
        values[joint] = values[joint] * (1 + 1e-6)
        return right(form, ticks, values["position"], values["velocity"], block, tool)

    monkeypatch.setattr(RowForm, "records", wrong)
    write_stream(stream, folder / "a.rosbag")
    monkeypatch.undo()
    done = inside("verify", "a.rosbag", "--cell", "p.toml", "--json")
    failed = {check["name"] for check in json.loads(done.stdout)["checks"] if check["status"] == "failed"}
    assert done.returncode == 1
    assert "written rates" in failed
    assert "file" not in failed


@pytest.mark.parametrize(
    ("ending", "module", "words"),
    [
        ("parquet", "pyarrow.parquet", "Parquet needs pyarrow: pip install 'irlx[parquet]'"),
        ("rosbag", "rosbags.typesys", "a ROS 2 bag needs rosbags: pip install 'irlx[ros]'"),
    ],
)
def test_a_missing_extra_is_told_before_anything_moves(
    ending, module, words, inside, folder, names, monkeypatch
):
    monkeypatch.setitem(sys.modules, module, None)
    done = inside("run", "p.irl", "-o", f"a.{ending}")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"error IRL720: a.{ending}: {words}\n"
    assert names(folder) == ["p.irl", "p.toml"]


def test_verify_without_the_extra(inside, folder, monkeypatch):
    inside("run", "p.irl", "-o", "a.parquet", "--no-verify")
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    done = inside("verify", "a.parquet")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error IRL720: a.parquet: ")


def test_folders_of_others_are_left_alone(inside, folder):
    (folder / "a.rosbag").mkdir()
    (folder / "a.rosbag" / "notes.txt").write_text("mine")
    done = inside("run", "p.irl", "-o", "a.rosbag")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error IRL003: cannot write a.rosbag: it is a folder, and no ROS 2 bag")
    assert content(folder / "a.rosbag") == {"notes.txt": b"mine"}


def test_an_input_inside_the_folder_is_not_overwritten(inside, folder):
    (folder / "b.rosbag").mkdir()
    (folder / "p.toml").rename(folder / "b.rosbag" / "p.toml")
    done = inside("run", "p.irl", "--cell", "b.rosbag/p.toml", "-o", "b.rosbag")
    assert done.returncode == 2
    assert done.stderr.startswith("error IRL005: -o b.rosbag would overwrite an input")


def test_a_run_that_ends_early_keeps_a_partial_bag(inside, folder, names):
    text = (
        (folder / "p.irl")
        .read_text()
        .replace("MOVE LIN home;", "MOVE LIN POSITION(1 / (R_ACC - R_ACC), 0, 0);")
    )
    (folder / "p.irl").write_text(text)
    done = inside("run", "p.irl", "-o", "a.rosbag", "-o", "a.parquet")
    assert done.returncode == 1
    assert names(folder) == ["a.partial.parquet", "a.partial.rosbag", "p.irl", "p.toml"]
    for name in ("a.partial.parquet", "a.partial.rosbag"):
        assert not read_stream(folder / name).complete
