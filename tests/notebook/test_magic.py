"""`%%irl` in a shell of IPython: the run as a result, and mistakes without a traceback.

That irlx itself does not import IPython, `tests/cli/test_plot.py` looks at.
"""

import pytest

import irlx
from irlx.diagnostics import report
from irlx.notebook.findings import Findings
from irlx.notebook.not_begun import NotBegun

pytest.importorskip("IPython", reason="IPython is not installed: pip install 'irlx[test]'")
from IPython.core.error import UsageError
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from traitlets.config import Config

GOOD = "PROGRAM down;\nBEGIN\n  WRITELN('hello');\n  MOVE_INC LIN (0, 0, -20);\nENDPROGRAM;\n"
WRONG = "PROGRAM down;\nBEGIN\n  MOVE LIN p2 <;\nENDPROGRAM;\n"
ARM = "%%irl --robot arm7 --tick 40"


@pytest.fixture(scope="module")
def shell():
    config = Config()
    config.HistoryManager.enabled = False
    found = InteractiveShell.instance(config=config)
    found.run_line_magic("load_ext", "irlx")
    yield found
    InteractiveShell.clear_instance()


@pytest.fixture
def cell(shell, tmp_path, monkeypatch):
    """Runs a cell in a folder of its own: its result, text on stdout and stderr, and what it displays."""
    monkeypatch.chdir(tmp_path)

    def run_cell(text):
        with capture_output() as told:
            done = shell.run_cell(text)
        assert done.error_in_exec is None or isinstance(done.error_in_exec, UsageError | NotBegun)
        assert done.success == (done.error_in_exec is None)
        assert "Traceback" not in told.stdout + told.stderr
        return done.result, told.stdout, told.stderr, told.outputs

    return run_cell


def test_a_program_runs_and_its_run_is_the_result_and_a_variable(shell, cell):
    run, stdout, _, _ = cell(f"{ARM} --name down\n{GOOD}")
    assert isinstance(run, irlx.Run)
    assert run.complete
    assert shell.user_ns["down"] is run
    assert shell.user_ns["_"] is run
    assert stdout.startswith("hello\n")
    assert run.output == "hello\n"
    assert run.header.tick_ns == 40_000_000
    assert run.header.robot_model == "arm7"
    assert run.tool[-1, 2] == pytest.approx(run.tool[0, 2] - 0.02, abs=1e-9)
    assert irlx.verify(run).passed


def test_a_run_is_shown_as_its_summary_and_a_replay(shell, cell):
    run, *_ = cell(f"{ARM} --name down\n{GOOD}")
    text = shell.display_formatter.format(run)[0]["text/plain"]
    assert text.startswith("notebook.irl: complete, ")
    html = shell.display_formatter.format(run)[0]["text/html"]
    assert "<caption" in html
    assert "srcdoc" in html
    assert repr(run).startswith(f"<Run of notebook.irl: complete, {run.t[-1]:.6g} s, ")


def test_a_mistake_is_shown_with_line_as_the_notebook_counts_and_caret(cell):
    run, text, _, outputs = cell(f"{ARM}\n{WRONG}")
    assert (run, outputs) == (None, [])
    # Line 1 of the cell is that of the magic.
    assert "notebook.irl:4:16: \x1b[1;31merror IRL101\x1b[0m" in text
    assert " 4 |   MOVE LIN p2 <;\n   |                ^" in text


@pytest.mark.parametrize("option", ["--name down", "--check"])
def test_a_mistake_fails_the_cell_and_leaves_the_variable(shell, option):
    shell.user_ns["down"] = before = object()
    with capture_output():
        done = shell.run_cell(f"{ARM} {option}\n{WRONG}")
    assert not done.success
    assert done.error_in_exec.reason.code == "IRL101"
    assert shell.user_ns["down"] is before


def test_a_run_that_ends_in_an_error_leaves_what_was_executed(shell, cell):
    run, _, _, outputs = cell(f"{ARM} --name far\n{GOOD.replace('-20', '-20 / (R_ACC - R_ACC)')}")
    assert not run.complete
    assert shell.user_ns["far"] is run
    assert "error IRL5" in outputs[0].data["text/plain"]
    assert "^^^" in outputs[0].data["text/plain"]


def test_the_cell_is_the_one_given_or_that_of_the_specification(cell, tmp_path):
    text = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 50\n[frames]\nhome = { xyz = [500, 0, 500] }\n'
    (tmp_path / "bench.toml").write_text(text)
    for first in (
        "%%irl --cell bench.toml\nPROGRAM p;\n",
        "%%irl\nPROGRAM p;\nSYSTEM SPECIFICATION bench;\n",
    ):
        run, *_ = cell(f"{first}BEGIN\n  WRITELN(home.POS.X);\nENDPROGRAM;\n")
        assert run.complete
        assert run.header.cell_name == "bench.toml"
        assert float(run.output) == 500


def test_faults_of_a_cell_come_before_names_that_it_would_have(cell, tmp_path):
    (tmp_path / "bench.toml").write_text('[robot]\nmodel = "arm8"\n[frames]\nhome = 3\n')
    run, text, *_ = cell("%%irl --cell bench.toml\nPROGRAM p;\nBEGIN\n  MOVE LIN home;\nENDPROGRAM;\n")
    assert run is None
    assert "bench.toml: frames.home: \x1b[1;31merror IRL603" in text


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("%%irl", "write %%irl --robot NAME"),
        ("%%irl --robot arm8", "error IRL611: no robot 'arm8'; did you mean 'arm7'"),
        ("%%irl --cell none.toml", "error IRL001: no such file: none.toml"),
        ("%%irl --robot arm7 --tick 5000", "error IRL006: --tick 5000"),
    ],
)
def test_what_keeps_a_program_from_running(cell, line, told):
    run, text, *_ = cell(f"{line}\n{GOOD}")
    assert run is None
    assert told in text.replace("\x1b[1;31m", "").replace("\x1b[0m", "")


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("%%irl --robot arm7 --cell c.toml", "argument --cell: not allowed with argument --robot"),
        ("%%irl --speed 3", "unrecognized arguments: --speed 3"),
        ("%%irl --name 3p --robot arm7", "%%irl --name 3p: no name of a variable"),
    ],
)
def test_options_that_are_none(cell, line, told):
    _, _, stderr, outputs = cell(f"{line}\n{GOOD}")
    assert "UsageError: " in stderr
    assert told in stderr
    assert not outputs


def test_quiet_has_no_result_but_the_variable(shell, cell):
    run, *_ = cell(f"{ARM} --quiet --name calm\n{GOOD}")
    assert run is None
    assert shell.user_ns["calm"].complete


def test_check_runs_nothing(cell):
    run, stdout, _, outputs = cell(f"%%irl --check --robot arm7\n{GOOD}")
    assert (run, stdout, outputs) == (None, "notebook.irl: 0 errors, 0 warnings\n", [])
    _, _, _, outputs = cell(f"%%irl --check --robot arm7\n{GOOD.replace('BEGIN', 'VAR INT: i; BEGIN')}")
    assert "warning IRL281" in outputs[0].data["text/plain"]


def test_what_a_program_reads_is_typed(cell, monkeypatch):
    typed = iter(["25"])
    monkeypatch.setattr("builtins.input", lambda: next(typed))
    text = "PROGRAM p;\nVAR INT: i;\nBEGIN\n  READ(i);\n  WRITELN(i + 1);\nENDPROGRAM;\n"
    run, stdout, _, _ = cell(f"{ARM}\n{text}")
    assert run.output == "26\n"
    assert stdout.startswith("26\n")


def test_data_lists_are_those_of_the_working_folder(cell, tmp_path):
    (tmp_path / "points.dat").write_text("DATALIST points;\n  INT: size := 7;\nENDDATALIST;\n")
    run, *_ = cell(f"{ARM}\nPROGRAM p;\nIMPORT DATALIST points;\nBEGIN\n  WRITELN(size);\nENDPROGRAM;\n")
    assert run.output == "7\n"


def test_help_has_an_example_that_runs(shell, cell):
    text = shell.find_cell_magic("irl").__doc__
    example = text.partition("example:\n")[2].partition("\n\n")[0]
    run, *_ = cell("\n".join(line.strip() for line in example.splitlines()))
    assert run.complete


def test_what_findings_quote_cannot_be_html():
    shown = Findings([report("IRL001", path="<script>alert(1)</script>", near="")])
    assert "<script>" not in shown._repr_html_()
    assert "<script>" in repr(shown)
