"""Files of strangers: what a program, a cell, a robot model, a mesh or a stream may not do, whatever it says.

What the table in SECURITY.md claims and no other test proves.
"""

import re
import sys
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.cell.packaged import packaged_urdf
from irlx.recorded import cell_beside, text_beside
from irlx.streams import StreamError, read_stream

pytestmark = pytest.mark.req("QA-08")

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = "PROGRAM p;\nBEGIN\n  MOVE PTP MAIN_JOINT(30, 60, -40);\nENDPROGRAM\n"
PLANAR = '[robot]\nmodel = "planar3"\n'
_LEVELS = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, 12))
BOMB = f'<!DOCTYPE x [<!ENTITY e0 "0123456789">{_LEVELS}]>'
FILE = '<!DOCTYPE x [<!ENTITY e11 SYSTEM "file:///etc/passwd">]>'
DAE = (
    '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><contributor>'
    "<author>&e11;</author></contributor><created/><modified/></asset></COLLADA>"
)


@pytest.fixture
def place(tmp_path, monkeypatch):
    """The working folder, with a program and its cell."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.irl").write_text(PROGRAM)
    (tmp_path / "p.toml").write_text(PLANAR)
    return tmp_path


@pytest.mark.parametrize("head", [BOMB, FILE], ids=["growing", "a file"])
def test_entities_of_a_robot_model(place, head):
    """None is fetched, none grows beyond measure."""
    urdf = packaged_urdf("planar3")
    (place / "x.urdf").write_text(head + urdf[urdf.index("<robot") :].replace("</robot>", "&e11;</robot>"))
    (place / "p.toml").write_text('[robot]\nmodel = "x.urdf"\n')
    with pytest.raises(irlx.CellError, match=r"IRL612.*(amplification|undefined entity)"):
        irlx.run("p.irl")


@pytest.mark.parametrize("head", [BOMB, FILE], ids=["growing", "a file"])
def test_entities_of_a_mesh(place, head):
    pytest.importorskip("collada")
    (place / "x.dae").write_text(head + DAE)
    obstacle = '[[obstacle]]\nname = "x"\nshape = "mesh"\nfile = "x.dae"\n'
    (place / "p.toml").write_text(PLANAR + obstacle)
    with pytest.raises(irlx.CellError, match="IRL640") as caught:
        irlx.run("p.irl")
    assert "root:" not in str(caught.value)


def test_a_stream_runs_no_code_of_its_own(place, monkeypatch):
    """Objects that numpy would unpickle."""

    class Code:
        def __reduce__(self):
            return (sys.exit, (77,))

    irlx.run("p.irl").save("p.npz")
    with zipfile.ZipFile("p.npz") as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    np.save("code.npy", np.array([Code()], dtype=object), allow_pickle=True)
    for member in ("meta.npy", "joint_names.npy", "q.npy"):
        with zipfile.ZipFile("x.npz", "w") as archive:
            for name, content in {**members, member: Path("code.npy").read_bytes()}.items():
                archive.writestr(name, content)
        with pytest.raises(StreamError, match="IRL701"):
            read_stream("x.npz")


def test_a_stream_that_is_compressed_to_nothing(place, monkeypatch):
    """Of what is read as a whole no more than a bound, however little it takes on disk."""
    monkeypatch.setattr("irlx.streams.npz_reader._LONGEST_MEMBER", 100_000)
    irlx.run("p.irl").save("p.npz")
    with zipfile.ZipFile("p.npz") as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile("x.npz", "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, content in members.items():
            with archive.open(name, "w", force_zip64=True) as member:
                member.write(content)
                member.write(bytes(1_000_000 if name == "meta.npy" else 0))
    assert Path("x.npz").stat().st_size < 100_000
    with pytest.raises(StreamError, match=r"IRL701.*more than 100,000 bytes"):
        read_stream("x.npz")


@pytest.mark.parametrize("ending", [".irdata", ".csv", ".jsonl"])
def test_a_line_without_end(place, ending, monkeypatch):
    monkeypatch.setattr("irlx.streams.lines.LONGEST_LINE", 100_000)
    irlx.run("p.irl").save(f"p{ending}")
    with open(f"p{ending}", "ab") as file:
        file.write(b"1" * 3_000_000)
    with pytest.raises(StreamError, match=r"IRL002.*a line of more than 100,000 bytes"):
        read_stream(f"p{ending}")


def test_names_in_a_stream_lead_nowhere(place):
    """A stream names its cell and its program: only what is beside it, or in the working folder, is read."""
    header = irlx.run("p.irl").stream.header
    inner = place / "inner"
    inner.mkdir()
    for name in ("p.irl", "p.toml"):
        (inner / name).write_bytes((place / name).read_bytes())
    assert text_beside(place / "x.irdata", header) is not None
    assert cell_beside(inner / "x.irdata", header, None) == inner / "p.toml"
    for folder in ("inner/", "../", f"{inner}/"):
        named = replace(header, program_name=f"{folder}p.irl", cell_name=f"{folder}p.toml")
        assert text_beside(inner / "x.irdata", named) is None
        with pytest.raises(irlx.CellError, match="IRL609"):
            cell_beside(inner / "x.irdata", named, None)


def test_what_security_md_names_is_there():
    """Every test that a claim stands on is a test of this name."""
    text = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
    named = re.findall(r"`(tests/[\w/]+\.py)(?:::(\w+))?`", text)
    assert len(named) > 20
    for file, test in named:
        content = (ROOT / file).read_text(encoding="utf-8")
        assert not test or f"def {test}(" in content, (file, test)
