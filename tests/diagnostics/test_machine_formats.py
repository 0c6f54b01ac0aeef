"""The renderers for other programs: one line each, JSON, SARIF, GitHub annotations."""

import json
from pathlib import Path

import pytest

from irlx.diagnostics import CATALOGUE, Diagnostic, Place, Related, Severity, SourceText, Span, report
from irlx.diagnostics.github import render_github
from irlx.diagnostics.plain import plain_diagnostic
from irlx.diagnostics.rendering import MACHINE_FORMATS
from irlx.diagnostics.sarif import sarif_log

SOURCE = SourceText("my programs/t.irl", "GOTO a;\n{ 😀 } b: x;")


def in_source(start, end):
    return Place.in_text(SOURCE, Span(start, end))


LABEL = report(
    "IRL215", in_source(5, 6), related=(Related("the label", in_source(14, 15)),), name="a", near=""
)
KEY = report("IRL601", Place("/cells/100 %.toml", key="robot.model"), cause="x\ny")
BARE = report("IRL006", option="--tick", value=0, cause="no")
LONG = report("IRL205", in_source(5, 15), name="b")
ALL = [LABEL, KEY, BARE, LONG]


@pytest.mark.req("LANG-75")
def test_concise():
    assert MACHINE_FORMATS["concise"](ALL).splitlines() == [
        "my programs/t.irl:1:6: error IRL215 unknown label 'a'",
        "/cells/100 %.toml: robot.model: error IRL601 the cell file is not TOML: x y",
        "error IRL006 --tick 0: no",
        "my programs/t.irl:1:6: warning IRL205 port 'b' is not declared",
    ]


@pytest.mark.req("LANG-75")
def test_json_is_one_array_of_one_shape():
    found = json.loads(MACHINE_FORMATS["json"](ALL))
    assert [one["code"] for one in found] == ["IRL215", "IRL601", "IRL006", "IRL205"]
    assert {tuple(one) for one in found} == {tuple(plain_diagnostic(BARE))}
    assert found[0] == {
        "code": "IRL215",
        "severity": "error",
        "message": "unknown label 'a'",
        "help": "write 'name:' before the statement to jump to",
        "place": "my programs/t.irl:1:6",
        "file": "my programs/t.irl",
        "line": 1,
        "column": 6,
        "end_line": 1,
        "end_column": 7,
        "key": None,
        "related": [
            {
                "message": "the label",
                "place": "my programs/t.irl:2:7",
                "file": "my programs/t.irl",
                "line": 2,
                "column": 7,
                "end_line": 2,
                "end_column": 8,
                "key": None,
            }
        ],
    }
    assert (found[1]["key"], found[1]["line"]) == ("robot.model", None)
    assert (found[2]["file"], found[2]["place"]) == (None, "")
    assert MACHINE_FORMATS["json"]([]) == "[]"


@pytest.mark.req("LANG-75")
def test_github_escapes():
    assert render_github(LABEL) == (
        "::error file=my programs/t.irl,line=1,col=6,endColumn=7,title=IRL215::"
        "unknown label 'a'%0Awrite 'name:' before the statement to jump to"
    )
    assert render_github(KEY) == (
        "::error file=/cells/100 %25.toml,title=IRL601::robot.model: the cell file is not TOML: x%0Ay"
    )
    assert render_github(BARE) == "::error title=IRL006::--tick 0: no"
    assert render_github(LONG).startswith("::warning file=my programs/t.irl,line=1,endLine=2,title=IRL205::")
    odd = Diagnostic("IRL205", Severity.INFO, "50 %\r\n", Place("a,b:c.irl"))
    assert render_github(odd) == "::notice file=a%2Cb%3Ac.irl,title=IRL205::50 %25%0D%0A"


@pytest.mark.req("LANG-75")
def test_sarif():
    log = json.loads(MACHINE_FORMATS["sarif"](ALL))
    (run,) = log["runs"]
    assert (log["version"], run["columnKind"]) == ("2.1.0", "utf16CodeUnits")
    rules = run["tool"]["driver"]["rules"]
    assert [rule["id"] for rule in rules] == ["IRL006", "IRL205", "IRL215", "IRL601"]
    assert [rules[one["ruleIndex"]]["id"] for one in run["results"]] == [one.code for one in ALL]
    assert [one["level"] for one in run["results"]] == ["error", "error", "error", "warning"]
    label, key, bare, _ = run["results"]
    assert label["locations"] == [
        {
            "physicalLocation": {
                "artifactLocation": {"uri": "my%20programs/t.irl"},
                "region": {"startLine": 1, "startColumn": 6, "endLine": 1, "endColumn": 7},
            }
        }
    ]
    # The emoji before it takes two units of UTF-16.
    region = label["relatedLocations"][0]["physicalLocation"]["region"]
    assert (region["startLine"], region["startColumn"], region["endColumn"]) == (2, 8, 9)
    assert key["locations"] == [
        {
            "physicalLocation": {"artifactLocation": {"uri": "file:///cells/100%20%25.toml"}},
            "logicalLocations": [{"fullyQualifiedName": "robot.model"}],
        }
    ]
    assert bare["locations"] == []
    assert rules[2]["shortDescription"]["text"] == "unknown label"
    assert rules[2]["help"]["markdown"].startswith("# IRL215: ")


@pytest.mark.req("LANG-75")
@pytest.mark.parametrize("file", ["p.irl", "c:d.irl", "ściana.irl", "a#b?.irl", "bad\udcff.irl", "../p.irl"])
def test_sarif_names_files_by_uri(file):
    from urllib.parse import unquote_to_bytes, urlsplit

    (result,) = sarif_log([report("IRL117", Place(file))])["runs"][0]["results"]
    uri = result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
    parts = urlsplit(uri)
    assert (parts.scheme, parts.netloc, parts.query, parts.fragment) == ("", "", "", "")
    assert unquote_to_bytes(parts.path) == file.encode("utf-8", "surrogateescape")


@pytest.mark.req("LANG-75")
def test_sarif_is_read_by_an_independent_model():
    """Every key is one of SARIF's, and every value of its type."""
    reader = pytest.importorskip("sarif_pydantic", reason="pip install irlx[test]")
    everything = [Diagnostic(code, entry.severity, "m", Place("p.irl")) for code, entry in CATALOGUE.items()]
    for findings in ([], ALL, everything):
        read = reader.Sarif.model_validate_json(MACHINE_FORMATS["sarif"](findings))
        # The model has no columnKind, which SARIF has.
        assert unknown_keys(read) == ["columnKind"]
        assert len(read.runs[0].results) == len(findings)
        assert {one.rule_id for one in read.runs[0].results} == {one.code for one in findings}


def unknown_keys(model):
    """Keys that the independent model does not know, wherever in the log."""
    found = []
    for name, value in model:
        if name in (model.model_extra or {}):
            found.append(name)
        for one in value if isinstance(value, list) else [value]:
            if hasattr(one, "model_extra"):
                found += unknown_keys(one)
    return found


@pytest.mark.req("LANG-70")
def test_every_page_has_a_title():
    from irlx.diagnostics.pages import page_text, page_title

    assert all(page_title(code) for code in CATALOGUE)
    assert Path(__file__).parents[2].joinpath("docs/diagnostics/IRL203.md").read_text() == page_text("IRL203")
