"""`irlx check --format` and `irlx explain`."""

import json
import os
import pty
import subprocess
import sys

import pytest

import irlx
from irlx.diagnostics import CATALOGUE

BAD = (
    "PROGRAM b;\nBEGIN\n  x := 1;\n  OUT_3 := TRUE;\n"
    "  MOVE LIN POSITION(1, 2, 3) WITH CRITERION mine;\nENDPROGRAM\n"
)


@pytest.mark.req("LANG-75")
def test_machine_formats_have_stdout_for_themselves(inside, folder):
    (folder / "a.irl").write_text(BAD)
    (folder / "b.irl").write_text(BAD)
    done = inside("check", "b.irl", "a.irl", "p.irl", "--format", "json")
    assert (done.returncode, done.stderr) == (1, "")
    found = json.loads(done.stdout)
    told = [(one["file"], one["code"]) for one in found]
    each = ["IRL201", "IRL205", "IRL363"]
    assert told == [("b.irl", code) for code in each] + [("a.irl", code) for code in each]
    for name in ("sarif", "concise", "github"):
        done = inside("check", "b.irl", "--format", name)
        assert (done.returncode, done.stderr) == (1, "")
        assert "IRL201" in done.stdout
    done = inside("check", "a.irl", "--format", "text")
    assert done.stdout == "a.irl: 1 error, 2 warnings\n"


@pytest.mark.req("LANG-75")
def test_nothing_found(inside):
    assert inside("check", "p.irl", "--format", "json").stdout == "[]\n"
    assert inside("check", "p.irl", "--format", "concise").stdout == ""
    assert inside("check", "p.irl", "--format", "github").stdout == ""
    log = json.loads(inside("check", "p.irl", "--format", "sarif").stdout)
    assert log["runs"][0]["results"] == []


@pytest.mark.req("LANG-75")
def test_what_programs_share_is_told_once(inside, folder):
    (folder / "p.toml").write_text("[robot]\nmodel = 'koch11'\n")
    (folder / "q.irl").write_text((folder / "p.irl").read_text())
    done = inside("check", "p.irl", "q.irl", "none.irl", "--cell", "p.toml", "--format", "json")
    assert done.returncode == 2
    assert [one["code"] for one in json.loads(done.stdout)] == ["IRL621", "IRL001"]


@pytest.mark.req("LANG-70")
def test_explain(inside):
    done = inside("explain", "irl203")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("# IRL203: unknown parameter of MOVE\n")
    assert inside("explain", "203").stdout == done.stdout


@pytest.mark.req("LANG-70")
def test_explain_lists_all(inside):
    lines = inside("explain").stdout.splitlines()
    assert [line.split()[0] for line in lines] == sorted(CATALOGUE)
    assert "IRL205  warning  port used without a declaration" in lines
    assert inside("explain", "--list").stdout.splitlines() == lines


@pytest.mark.req("LANG-71")
def test_explain_an_unknown_code(inside):
    done = inside("explain", "IRL20")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error IRL006: explain IRL20: there is no such code; did you mean 'IRL")
    assert inside("explain", "nonsense").stderr == "error IRL006: explain nonsense: there is no such code\n"


@pytest.mark.req("LANG-70")
def test_explain_at_a_terminal(folder, environment):
    ours, theirs = pty.openpty()
    call = [sys.executable, "-m", "irlx", "explain", "IRL203"]
    env = {**environment, "TERM": "xterm"}
    subprocess.run(call, cwd=folder, env=env, stdout=theirs, check=True, timeout=60)
    os.close(theirs)
    text = b""
    try:
        while part := os.read(ours, 4096):
            text += part
    except OSError:
        pass  # Linux reports the end of a terminal as an error.
    os.close(ours)
    shown = text.decode()
    assert "IRL203: unknown parameter of MOVE" in shown
    assert "\x1b[" in shown
    assert "```" not in shown


@pytest.mark.req("LANG-02")
def test_ignored_warnings_of_a_run(inside, folder):
    text = (folder / "p.irl").read_text().replace("BEGIN", "BEGIN\n  CYCLICSTART;  { irlx: ignore IRL301 }")
    (folder / "p.irl").write_text(text)
    assert inside("check", "p.irl").stdout == "p.irl: 0 errors, 0 warnings\n"
    done = inside("run", "p.irl", "--quiet")
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.req("LANG-02")
def test_ignored_warnings_of_the_motion(inside, folder):
    """Quiet in a run and in a dry run alike; told in both without the comment."""
    (folder / "m.toml").write_text('[robot]\nmodel = "arm7"\n')
    moves = "MOVE LIN (441, 200, 324) C_CP := 10;{}\n  WAIT 0.1 SEC;\n"
    for comment in ("", "  { irlx: ignore IRL432 }"):
        (folder / "m.irl").write_text(f"PROGRAM m;\nBEGIN\n  {moves.format(comment)}ENDPROGRAM;\n")
        told = [inside("check", "m.irl", "--motion").stderr, inside("run", "m.irl").stderr]
        assert ["IRL432:" in words for words in told] == [not comment] * 2
        assert "IRL140" not in "".join(told)


def test_findings_of_all_stages_come_in_the_order_of_the_text(tmp_path):
    one, other = (f"MOVE LIN POSITION(1, 2, 3) WITH CRITERION {name};" for name in ("mine", "yours"))
    (tmp_path / "p.irl").write_text(
        f"PROGRAM p;\nBEGIN\n  {one}\n  x := 1;\n  {other}\nENDPROGRAM\n", encoding="utf-8"
    )
    assert [finding.code for finding in irlx.check(tmp_path / "p.irl")] == ["IRL363", "IRL201", "IRL363"]
