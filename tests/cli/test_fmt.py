"""`irlx fmt`: files in place, checks, differences, standard input, and what must never happen to a file."""

import io
import os
import stat
import sys

import pytest

from irlx.cli import replacing

UGLY = "program p; { a }\nbegin\nmove lin p1;\nendprogram\n"
PRETTY = "PROGRAM p;  { a }\nBEGIN\n  MOVE LIN p1;\nENDPROGRAM\n"


@pytest.fixture
def ugly(folder):
    (folder / "u.irl").write_text(UGLY)
    return folder / "u.irl"


@pytest.mark.req("LANG-74")
def test_in_place(inside, ugly, folder, names):
    done = inside("fmt", "u.irl", "p.irl")
    assert (done.returncode, done.stdout, done.stderr) == (0, "u.irl: formatted\np.irl: formatted\n", "")
    assert ugly.read_text() == PRETTY
    assert names(folder) == ["p.irl", "p.toml", "u.irl"]
    before = ugly.stat()
    done = inside("fmt", "u.irl", "p.irl")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert ugly.stat().st_mtime_ns == before.st_mtime_ns


@pytest.mark.req("LANG-74")
def test_check_and_diff_write_nothing(inside, ugly):
    done = inside("fmt", "--check", "u.irl")
    assert (done.returncode, done.stdout, done.stderr) == (1, "u.irl: would be formatted\n", "")
    done = inside("fmt", "--diff", "u.irl")
    assert done.returncode == 0
    assert done.stdout.startswith("--- u.irl\n+++ u.irl (formatted)\n@@ -1,4 +1,4 @@\n-program p; { a }\n")
    assert "\n+PROGRAM p;  { a }\n+BEGIN\n" in done.stdout
    assert inside("fmt", "--check", "--diff", "u.irl").returncode == 1
    assert ugly.read_text() == UGLY
    inside("fmt", "u.irl")
    done = inside("fmt", "--check", "--diff", "u.irl")
    assert (done.returncode, done.stdout) == (0, "")


@pytest.mark.req("LANG-74")
def test_standard_input(command, inside, monkeypatch):
    def told(given, *arguments):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(given)))
        return inside("fmt", *arguments)

    done = command("fmt", "-", input=UGLY.encode())
    assert (done.returncode, done.stdout, done.stderr) == (0, PRETTY, "")
    done = told(UGLY.encode(), "--check", "-")
    assert (done.returncode, done.stdout) == (1, "<stdin>: would be formatted\n")
    done = told(b"PROGRAM p; BEGIN x := ; ENDPROGRAM", "-")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("<stdin>:1:23: error IRL101: ")


@pytest.mark.req("LANG-74")
def test_files_with_errors_stay(inside, ugly, folder):
    (folder / "bad.irl").write_text("program b; begin x := ; endprogram")
    (folder / "latin.irl").write_bytes(b"program b; begin { \xfc } endprogram")
    done = inside("fmt", "bad.irl", "latin.irl", "u.irl")
    assert (done.returncode, done.stdout) == (1, "u.irl: formatted\n")
    assert "bad.irl:1:23: error IRL101: " in done.stderr
    assert "latin.irl: byte 19: error IRL130: " in done.stderr
    assert (folder / "bad.irl").read_text() == "program b; begin x := ; endprogram"
    done = inside("fmt", "none.irl", ".")
    assert done.returncode == 2
    assert "IRL001" in done.stderr
    assert "IRL007" in done.stderr


@pytest.mark.req("LANG-74")
def test_links_and_permissions_stay(inside, ugly, folder):
    ugly.chmod(0o640)
    (folder / "link.irl").symlink_to("u.irl")
    assert inside("fmt", "link.irl").returncode == 0
    assert os.readlink(folder / "link.irl") == "u.irl"
    assert ugly.read_text() == PRETTY
    assert stat.S_IMODE(ugly.stat().st_mode) == 0o640


@pytest.mark.req("LANG-74")
def test_a_file_that_cannot_be_written_stays(inside, ugly, folder, names, monkeypatch):
    def full(*arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(replacing.os, "fsync", full)
    done = inside("fmt", "u.irl")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "error IRL003: cannot write u.irl: No space left on device\n"
    assert ugly.read_text() == UGLY
    assert names(folder) == ["p.irl", "p.toml", "u.irl"]


@pytest.mark.req("LANG-74")
def test_a_formatter_that_loses_something_leaves_the_file(inside, ugly, monkeypatch):
    from irlx.language import format as formatter

    text_of = formatter.text_of
    monkeypatch.setattr(formatter, "text_of", lambda rows: text_of(rows).replace("{ a }", ""))
    done = inside("fmt", "u.irl")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("u.irl: error IRL144: the formatter would not keep every comment;")
    assert ugly.read_text() == UGLY


@pytest.mark.req("LANG-44")
def test_the_dialect_is_mended(inside, folder):
    text = "PROGRAM d;\nBEGIN\n  IF IN_1 = TRUE\n    OUT_2 = TRUE\n  ENDIF\nENDPROGRAM\n"
    (folder / "d.irl").write_text(text)
    assert "4 warnings" not in inside("check", "d.irl").stdout
    assert inside("fmt", "d.irl").returncode == 0
    mended = (
        "PROGRAM d;\nVAR\n  INPUT BOOL: IN_1 AT 1;\n  OUTPUT BOOL: OUT_2 AT 2;\n"
        "BEGIN\n  IF IN_1 = TRUE THEN\n    OUT_2 := TRUE;\n  ENDIF;\nENDPROGRAM\n"
    )
    assert (folder / "d.irl").read_text() == mended
    assert "IRL10" not in inside("check", "d.irl").stderr
    assert "IRL205" not in inside("check", "d.irl").stderr
