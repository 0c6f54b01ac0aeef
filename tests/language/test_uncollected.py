"""The search for garbage rests while a text is checked, and is as it was afterwards."""

from __future__ import annotations

import gc

import pytest

from irlx.language.analysis import analyse
from irlx.language.source import source_text
from irlx.language.uncollected import uncollected


@pytest.mark.parametrize("collecting", [True, False])
def test_it_is_as_before_behind_a_check(collecting: bool) -> None:
    before = gc.isenabled()
    try:
        (gc.enable if collecting else gc.disable)()
        assert analyse(source_text("p.irl", "PROGRAM p;\nBEGIN\nENDPROGRAM;\n")).tree is not None
        assert gc.isenabled() is collecting
    finally:
        (gc.enable if before else gc.disable)()


def test_it_rests_meanwhile_and_goes_on_behind_an_error() -> None:
    gc.enable()
    seen = list[bool]()

    def fail() -> None:
        seen.append(gc.isenabled())
        raise KeyError

    with pytest.raises(KeyError), uncollected():
        fail()
    assert seen == [False]
    assert gc.isenabled()
