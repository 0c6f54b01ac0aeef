"""Diagnostics and the errors that hold them."""

import pytest

from irlx.diagnostics import CATALOGUE, IrlxError, Severity, report
from irlx.diagnostics.diagnostic import near_matches


def test_report_fills_message_and_help():
    found = report("IRL104", word="THEN", head="IF")
    assert found.message == "missing THEN after the condition of IF"
    assert found.help == "write IF condition THEN"
    assert found.severity is Severity.WARNING
    assert not found.is_error
    assert str(found) == "warning IRL104: missing THEN after the condition of IF"


def test_report_refuses_unknown_codes_and_missing_data():
    with pytest.raises(KeyError):
        report("IRL999")
    with pytest.raises(KeyError):
        report("IRL104")


@pytest.mark.req("LANG-71")
def test_near_matches():
    assert near_matches("SPED", ["SPEED", "ACC"]) == "; did you mean 'SPEED'?"
    assert near_matches("zzz", ["SPEED"]) == ""


def test_error_holds_all_and_names_the_first_error():
    warning, error = report("IRL105"), report("IRL115")
    raised = IrlxError((warning, error))
    assert raised.reason is error
    assert raised.diagnostics == (warning, error)


def test_codes_are_in_the_catalogue_once():
    assert all(code == entry.id for code, entry in CATALOGUE.items())
