"""A package that only one command needs, and that is not installed."""

import sys

import pytest

from irlx.diagnostics import IrlxError
from irlx.diagnostics.extra import require_extra


def test_what_is_installed_is_no_error():
    assert require_extra("irlx some", "some", "json", "email.message") is None


def test_a_missing_package_is_told_in_one_line(monkeypatch):
    monkeypatch.setitem(sys.modules, "absent.part", None)
    with pytest.raises(IrlxError) as caught:
        require_extra("irlx some", "some", "json", "absent.part")
    assert str(caught.value) == "error IRL010: irlx some needs absent: pip install 'irlx[some]'"
    assert caught.value.reason.data == {"command": "irlx some", "extra": "some", "package": "absent"}
