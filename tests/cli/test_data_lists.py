"""Data lists as files beside a program: run, check, verify, and every way to go wrong with them."""

import hashlib

import pytest

import irlx
from irlx.cli.main import main

pytestmark = pytest.mark.req("LANG-13")

POINTS = """DATALIST points;
  POSITION: near := (11400, 1000, 3500), home := near + POSITION(100, 0, 0);
  REAL: pace := 500;
ENDDATALIST
"""
PROGRAM = """PROGRAM p;
IMPORT DATALIST points;
BEGIN
  MOVE LIN near SPEED := pace;
  pace := 2 * pace;
  MOVE LIN home SPEED := pace;
ENDPROGRAM
"""


@pytest.fixture
def listed(folder):
    """The folder with a program that imports a list."""
    (folder / "p.irl").write_text(PROGRAM, encoding="utf-8")
    (folder / "points.dat").write_text(POINTS, encoding="utf-8")
    return folder


def test_check_run_and_blocks(inside, listed):
    done = inside("check", "p.irl", "points.dat")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "p.irl: 0 errors, 0 warnings\npoints.dat: 0 errors, 0 warnings\n"
    done = inside("blocks", "p.irl")
    assert [line.split(" acc ")[0] for line in done.stdout.splitlines()] == [
        "1 MOVE LIN to (11400 1000 3500) kept in R_BASE speed 500 mm/s",
        "2 MOVE LIN to (11500 1000 3500) kept in R_BASE speed 1000 mm/s",
    ]
    assert [line.rsplit(" ", 1)[1] for line in done.stdout.splitlines()] == ["4", "6"]
    done = inside("run", "p.irl")
    assert (done.returncode, done.stderr) == (0, "")


def test_python_interface(listed):
    program = irlx.load(listed / "p.irl")
    (found,) = program.data_lists
    assert found.path == listed / "points.dat"
    assert found.sha256 == hashlib.sha256(POINTS.encode()).hexdigest()
    assert found.source.text == POINTS
    assert found.tree.name.name == "points"
    run = irlx.run(program)
    assert run.stream.header.program_sha256 == program.sha256
    assert irlx.verify(run, program=listed / "p.irl").passed
    assert irlx.check(listed / "p.irl") == []


def sha256(text):
    return hashlib.sha256(text.encode()).hexdigest()


def test_the_digest_covers_program_and_lists_in_order(listed):
    two = PROGRAM.replace("points;", "points;\nIMPORT DATALIST more;")
    more = "DATALIST more; ENDDATALIST\n"
    (listed / "more.dat").write_text(more)
    assert irlx.load(listed / "p.irl").sha256 == sha256(f"{sha256(PROGRAM)}\n{sha256(POINTS)}\n")
    (listed / "p.irl").write_text(two)
    lines = "".join(f"{sha256(text)}\n" for text in (two, POINTS, more))
    assert irlx.load(listed / "p.irl").sha256 == sha256(lines)
    plain = "PROGRAM p; BEGIN ENDPROGRAM"
    (listed / "p.irl").write_text(plain)
    assert irlx.load(listed / "p.irl").sha256 == sha256(plain)


def test_verify_tells_an_edited_list(inside, listed):
    assert inside("run", "p.irl", "--quiet").returncode == 0
    done = inside("verify", "p.irdata", "--program", "p.irl")
    assert done.returncode == 0
    # The values stay what they are: that the text is another one is enough.
    (listed / "points.dat").write_text(POINTS + "{ edited }\n")
    done = inside("verify", "p.irdata", "--program", "p.irl")
    assert done.returncode == 1
    assert "made from p.irl with another text, or other values in points.dat" in done.stdout
    (listed / "points.dat").write_text(POINTS.replace("11400", "11401"))
    done = inside("verify", "p.irdata", "--program", "p.irl")
    assert done.returncode == 1
    assert "target.position.1 is 11.4 in the stream, 11.401 from the program" in done.stdout
    assert inside("verify", "p.irdata").returncode == 0


def lists_folder(listed):
    (listed / "points.dat").unlink()
    (listed / "points.dat").mkdir()


def lists_content(content):
    return lambda listed: (listed / "points.dat").write_bytes(content)


FAULTS = {
    "missing": (
        lambda listed: (listed / "points.dat").rename(listed / "Points1.dat"),
        "p.irl:2:17: error IRL240: no data list 'points': there is no file points.dat; "
        "did you mean 'Points1.dat'?\n 2 | IMPORT DATALIST points;\n",
    ),
    "folder": (
        lists_folder,
        "p.irl:2:17: error IRL241: the data list 'points' cannot be read from points.dat: it is a folder",
    ),
    "latin-1": (
        lists_content(b"DATALIST points; { \xfc }"),
        "points.dat: byte 19: error IRL130: not UTF-8 text: byte 0xFC at offset 19",
    ),
    "binary": (
        lists_content(b"\0DATALIST points;"),
        "points.dat: byte 0: error IRL131: not a text file: NUL byte at offset 0",
    ),
    "empty": (
        lists_content(b""),
        "points.dat:1:1: error IRL242: expected a data list, found an empty text\n 1 | \n   | ^\n"
        "  p.irl:2:17: imported here\n 2 | IMPORT DATALIST points;\n",
    ),
    "syntax": (
        lists_content(
            b"DATALIST points;\n  POSITION near := (1, 2, 3);\n  POSITION: home; REAL: pace;\nENDDATALIST"
        ),
        "points.dat:2:11: error IRL120: missing ':' before the name 'near'\n"
        " 2 |   POSITION near := (1, 2, 3);\n   |           ^\n",
    ),
}


@pytest.mark.req("QA-09")
@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("verb", ["check", "run", "blocks"])
def test_lists_that_cannot_be_read(inside, listed, names, verb, fault):
    spoil, words = FAULTS[fault]
    spoil(listed)
    before = names(listed)
    done = inside(verb, "p.irl")
    assert done.returncode == 1
    assert done.stderr.startswith(words)
    # No name of the program is called unknown for that.
    assert done.stderr.count("error") == 1
    assert names(listed) == before


def test_values_that_go_wrong_in_a_run_are_told_in_the_list(inside, listed):
    (listed / "points.dat").write_text(POINTS.replace("11400, 1000, 3500", "11400, 1000"))
    done = inside("run", "p.irl")
    assert done.returncode == 1
    assert done.stderr.startswith(
        "points.dat:2:21: error IRL223: POSITION takes 3 values, found 2\n"
        " 2 |   POSITION: near := (11400, 1000), home := near + POSITION(100, 0, 0);\n"
    )


def test_names_of_the_list_are_offered(inside, listed):
    (listed / "p.irl").write_text(PROGRAM.replace("LIN near", "LIN naer"))
    done = inside("check", "p.irl")
    assert done.stderr.startswith("p.irl:4:12: error IRL201: unknown name 'naer'; did you mean 'near'?\n")


@pytest.mark.parametrize("verb", ["run", "blocks"])
def test_a_list_does_not_run(inside, listed, verb):
    done = inside(verb, "points.dat")
    assert done.returncode == 2
    assert done.stderr.startswith(
        "points.dat:1:10: error IRL008: points is a DATALIST, which does not run by itself\n"
    )
    assert "help: run a PROGRAM that imports from it" in done.stderr


def test_a_list_is_never_overwritten(inside, listed):
    (listed / "points.csv").symlink_to(listed / "points.dat")
    done = inside("run", "p.irl", "-o", "points.csv")
    assert done.returncode == 2
    assert "IRL005" in done.stderr
    assert (listed / "points.dat").read_text() == POINTS


def test_lists_lie_beside_the_program_wherever_one_stands(listed, monkeypatch, capsys):
    monkeypatch.chdir(listed.parent)
    assert main(["check", str(listed / "p.irl")]) == 0
    assert capsys.readouterr().err == ""
