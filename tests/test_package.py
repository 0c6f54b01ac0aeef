"""The wheel: it holds what a run needs, and runs from a folder of its own."""

import os
import subprocess
import sys
import zipfile
from importlib.util import cache_from_source, find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PROGRAMS = ROOT / "programs" / "koch"
ROBOTS = sorted(path.name for path in (ROOT / "src" / "irlx" / "cell" / "robots").iterdir())
BUILD = "import sys, hatchling.build; print(hatchling.build.build_wheel(sys.argv[1]))"


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel of the working tree, built without any download."""
    if find_spec("hatchling") is None:
        pytest.skip("hatchling, which builds the wheel, is not installed: pip install irlx[test]")
    folder = tmp_path_factory.mktemp("wheel")
    done = subprocess.run(
        [sys.executable, "-c", BUILD, folder], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return folder / done.stdout.strip().splitlines()[-1]


def test_contents(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    assert {"irlx/grammar/irl.lark", "irlx/py.typed", "irlx/__main__.py"} <= names
    assert {f"irlx/cell/robots/{name}" for name in ROBOTS if name.endswith((".urdf", ".toml"))} <= names
    assert {"koch11.urdf", "koch11.toml"} <= set(ROBOTS)
    pages = {path.name for path in (ROOT / "docs" / "diagnostics").iterdir()}
    assert {f"irlx/docs/diagnostics/{name}" for name in pages} <= names
    beside = {name.split("/")[0] for name in names}
    assert len(beside) == 2
    assert not [name for name in names if name.endswith((".pyc", ".part"))]
    sources = {
        path.relative_to(ROOT / "src").as_posix()
        for path in (ROOT / "src" / "irlx").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert sources <= names


def test_metadata(wheel):
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [name for name in archive.namelist() if name.endswith("/METADATA")]
        (scripts,) = [name for name in archive.namelist() if name.endswith("/entry_points.txt")]
        metadata, entries = (archive.read(entry).decode() for entry in (name, scripts))
    assert "Name: irlx\n" in metadata
    assert "License-Expression: Apache-2.0" in metadata
    assert "irlx = irlx.cli.entry:entry_point" in entries
    assert "[pygments.lexers]\nirl = irlx.language.highlight.pygments_lexer:IrlLexer\n" in entries


def take_bytecode(package):
    """Give unpacked modules the bytecode of sources that are the same: to compile them takes seconds."""
    for path in package.rglob("*.py"):
        source = ROOT / "src" / path.relative_to(package)
        known = Path(cache_from_source(source))
        if known.is_file() and source.read_bytes() == path.read_bytes():
            # Python looks at the size and the time of the source.
            os.utime(path, ns=(source.stat().st_atime_ns, source.stat().st_mtime_ns))
            taken = Path(cache_from_source(path))
            taken.parent.mkdir(exist_ok=True)
            taken.write_bytes(known.read_bytes())


def test_the_unpacked_wheel_runs(wheel, tmp_path):
    package, work, home = tmp_path / "package", tmp_path / "work", tmp_path / "home"
    for folder in (package, work, home):
        folder.mkdir()
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(package)
    take_bytecode(package)
    for ending in ("irl", "toml"):
        (work / f"square.{ending}").write_bytes((PROGRAMS / f"square.{ending}").read_bytes())
    environment = {"PATH": os.environ.get("PATH", ""), "HOME": str(home), "PYTHONPATH": str(package)}
    both = "import irlx.cli.main as m; print(m.__file__); m.main(['explain', 'irl203']); m.entry_point()"
    call = [sys.executable, "-c", both, "run", "square.irl"]
    done = subprocess.run(call, cwd=work, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(package))
    assert "# IRL203: unknown parameter of MOVE" in done.stdout
    assert "square.irl: complete, verified, " in done.stdout
    assert "checks passed" in done.stdout
    assert sorted(path.name for path in work.iterdir()) == ["square.irdata", "square.irl", "square.toml"]
