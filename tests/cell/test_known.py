"""What a check may know of a cell without loading it, and why nothing of it can be read."""

from dataclasses import replace

import pytest

from irlx.cell.known import KnownCell, known_of_file, unreadable

pytestmark = pytest.mark.req("LANG-53")

KNOWN = KnownCell({"bench": False, "hand": True}, ("Wall", "post"), ("one", "two"))


@pytest.mark.parametrize(
    ("content", "found"),
    [
        ("[robot]\n", []),
        ("nothing = 3\n", []),
        ("[robot\n", [("IRL601", "line 1")]),
        (None, [("IRL002", ": no such file or directory")]),
        ("", [("IRL002", ": is a directory")]),
    ],
)
def test_what_cannot_be_read(tmp_path, content, found):
    path = tmp_path / "c.toml"
    if content:
        path.write_text(content, encoding="utf-8")
    elif content is not None:
        path.mkdir()
    told = unreadable(path)
    assert [one.code for one in told] == [code for code, _ in found]
    for one, (_, words) in zip(told, found, strict=True):
        assert one.place.file == str(path)
        assert words in one.message.casefold()


def test_a_path_that_is_none_has_its_reason_told(tmp_path):
    """No word of the system comes with that."""
    (one,) = unreadable(tmp_path / "a\0b.toml")
    assert (one.code, "null" in one.message) == ("IRL002", True)


def test_cells_that_tell_the_same():
    """Names of obstacles are told apart by no case, and come in no order."""
    assert KNOWN.tells_the_same(replace(KNOWN, obstacles=("post", "WALL")))
    for other in (
        replace(KNOWN, obstacles=("post",)),
        replace(KNOWN, obstacles=None),
        replace(KNOWN, frames={"bench": True, "hand": True}),
        replace(KNOWN, joints=("two", "one")),
    ):
        assert not KNOWN.tells_the_same(other)
    assert not KnownCell().tells_the_same(KnownCell(obstacles=()))


def test_of_what_is_no_toml_no_names_are_known_to_be_missing(tmp_path):
    path = tmp_path / "c.toml"
    for content, known in (("[robot\n", None), ("[[obstacle]]\nname = 'post'\n", ("post",)), ("a = 1\n", ())):
        path.write_text(content, encoding="utf-8")
        assert known_of_file(path).obstacles == known
