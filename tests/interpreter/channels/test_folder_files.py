"""What a program may open: the folder and nothing else, whatever names, links and kinds of files say."""

import os
import socket
import time

import pytest

from irlx.interpreter.channels.fault import ChannelFault
from irlx.interpreter.channels.folder import Folder
from irlx.interpreter.channels.folder_files import FolderFiles
from irlx.interpreter.channels.memory_files import MemoryFiles


@pytest.fixture
def place(tmp_path):
    """A folder with a file and a sub-folder, and something outside that must never be reached."""
    inside = tmp_path / "inside"
    (inside / "sub").mkdir(parents=True)
    (inside / "a.txt").write_text("inside")
    (inside / "sub" / "b.txt").write_text("deeper")
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside" / "secret.txt").write_text("secret")
    (tmp_path / "secret.txt").write_text("secret")
    yield inside
    assert (tmp_path / "outside" / "secret.txt").read_text() == "secret"
    assert (tmp_path / "secret.txt").read_text() == "secret"
    assert sorted(p.name for p in (tmp_path / "outside").iterdir()) == ["secret.txt"]
    assert sorted(p.name for p in tmp_path.iterdir()) == ["inside", "outside", "secret.txt"]


@pytest.fixture(params=["disk", "memory"])
def files(request, place):
    folder = Folder(
        place, {place / "p.irl": "the program itself", place / "p.irdata": "a stream of this run"}
    )
    return FolderFiles(folder) if request.param == "disk" else MemoryFiles(folder)


def nothing(_):
    pass


def fault(files, name, mode="READ"):
    with pytest.raises(ChannelFault) as caught:
        files.open(name, mode, nothing)
    return caught.value


def text(files, name):
    pull = files.open(name, "READ", nothing).pull
    return "".join(iter(pull, ""))


def write(files, name, content, mode="WRITE"):
    sink = files.open(name, mode, nothing).sink
    sink.write(content)
    sink.close()


MODES = pytest.mark.parametrize("mode", ["READ", "WRITE", "APPEND"])


@pytest.mark.req("LANG-42")
@MODES
@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("../secret.txt", "IRL540"),
        ("sub/../../secret.txt", "IRL540"),
        ("sub/../../inside/a.txt", "IRL540"),
        ("..", "IRL554"),
        ("../..", "IRL554"),
        ("/etc/passwd", "IRL540"),
        ("/dev/zero", "IRL540"),
        ("//etc/passwd", "IRL540"),
        ("", "IRL554"),
        (".", "IRL554"),
        ("   ", "IRL554"),
        ("a.txt/", "IRL554"),
        ("a\0.txt", "IRL554"),
        ("sub\\b.txt", "IRL554"),
        ("sub", "IRL548"),
        ("sub/..", "IRL548"),
        ("a.txt/b.txt", "IRL548"),
        ("x" * 300, "IRL548"),
        ("none/b.txt", "IRL541"),
        ("a/" * 3000 + "b", "IRL541"),
    ],
)
def test_names(files, name, mode, code):
    assert fault(files, name, mode).code == code


@pytest.mark.req("LANG-42")
def test_names_inside(files):
    assert text(files, "a.txt") == text(files, "./sub/../a.txt") == text(files, "sub//..//a.txt") == "inside"
    assert text(files, "sub/b.txt") == "deeper"
    assert fault(files, "b.txt").code == "IRL541"
    assert fault(files, "aa.txt").data["near"] == "; did you mean 'a.txt'?"
    assert fault(files, "sub/bb.txt").data["near"] == "; did you mean 'b.txt'?"


@pytest.mark.req("LANG-42")
@MODES
@pytest.mark.parametrize(
    ("link", "target", "name"),
    [
        ("out.txt", "../secret.txt", "out.txt"),
        ("out.txt", "{outside}/secret.txt", "out.txt"),
        ("out", "..", "out/secret.txt"),
        ("out", "{outside}", "out/secret.txt"),
        ("out", "{outside}", "out/new.txt"),
        ("dangling.txt", "../new.txt", "dangling.txt"),
        ("dangling.txt", "{outside}/new.txt", "dangling.txt"),
        ("sub/out.txt", "../../secret.txt", "sub/out.txt"),
        ("zero", "/dev/zero", "zero"),
        ("sibling", "{inside}x/secret.txt", "sibling"),
        ("up", "{inside}/../secret.txt", "up"),
    ],
)
def test_links_that_lead_outside(files, place, mode, link, target, name):
    (place / link).symlink_to(target.format(outside=place.parent / "outside", inside=place))
    assert fault(files, name, mode).code == "IRL540"


@pytest.mark.req("LANG-42")
def test_links_that_stay_inside(files, place):
    (place / "same.txt").symlink_to("a.txt")
    (place / "sub" / "up.txt").symlink_to("../a.txt")
    (place / "abs.txt").symlink_to(place / "sub" / "b.txt")
    (place / "down").symlink_to("sub")
    (place / "chain.txt").symlink_to("down/up.txt")
    assert text(files, "same.txt") == text(files, "sub/up.txt") == text(files, "chain.txt") == "inside"
    assert text(files, "abs.txt") == text(files, "down/b.txt") == "deeper"
    (place / "new.txt").symlink_to("sub/made.txt")
    write(files, "new.txt", b"made")
    assert text(files, "sub/made.txt") == "made"


def test_links_in_a_circle(files, place):
    (place / "x").symlink_to("y")
    (place / "y").symlink_to("x")
    assert fault(files, "x", "WRITE").code == "IRL548"
    assert fault(files, "x/a.txt").code == "IRL548"


def swapped(place, name, how):
    """What is called between the look at a file and its opening, and puts something else there."""

    def swap(_):
        (place / name).rename(place / "kept")
        how(place / name)

    return swap


@pytest.mark.req("LANG-42")
@MODES
@pytest.mark.parametrize(
    "how",
    [
        lambda path: path.symlink_to("../secret.txt"),
        lambda path: path.symlink_to("kept"),
        os.mkfifo,
        os.mkdir,
    ],
    ids=["link outside", "link inside", "FIFO", "folder"],
)
def test_what_is_put_there_meanwhile(place, mode, how):
    began = time.monotonic()
    with pytest.raises(ChannelFault, match="IRL548"):
        FolderFiles(Folder(place)).open("a.txt", mode, swapped(place, "a.txt", how))
    assert time.monotonic() - began < 1.0
    assert (place / "kept").read_text() == "inside"


@pytest.mark.req("LANG-42")
def test_a_folder_that_is_replaced_meanwhile(place):
    """The folder that was entered is the one that counts, wherever it is now and whatever has its name."""
    swap = swapped(place, "sub", lambda path: path.symlink_to("../outside"))
    sink = FolderFiles(Folder(place)).open("sub/secret.txt", "WRITE", swap).sink
    sink.write(b"mine")
    sink.close()
    assert (place / "kept" / "secret.txt").read_text() == "mine"


@pytest.mark.req("LANG-42")
@MODES
def test_what_is_no_file(files, place, mode):
    os.mkfifo(place / "pipe")
    with socket.socket(socket.AF_UNIX) as listening:
        here = os.getcwd()
        os.chdir(place)
        listening.bind("sock")
        os.chdir(here)
        began = time.monotonic()
        assert "FIFO" in fault(files, "pipe", mode).data["cause"]
        assert "socket" in fault(files, "sock", mode).data["cause"]
        assert time.monotonic() - began < 1.0


def test_devices():
    files = FolderFiles(Folder(__import__("pathlib").Path("/dev")))
    assert "device" in fault(files, "zero").data["cause"]
    assert "device" in fault(files, "null", "WRITE").data["cause"]


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize("mode", ["WRITE", "APPEND"])
def test_files_of_the_run(files, place, mode):
    (place / "p.irl").write_text("program")
    (place / "link.irl").symlink_to("p.irl")
    os.link(place / "p.irl", place / "hard.irl")
    for name in ("p.irl", "./sub/../p.irl", "link.irl", "hard.irl"):
        assert fault(files, name, mode).data["what"] == "the program itself", name
    # It does not exist yet.
    assert fault(files, "p.irdata", mode).code == "IRL551"
    assert (place / "p.irl").read_text() == "program"
    assert not (place / "p.irdata").exists()
    assert text(files, "p.irl") == "program"


def test_writing(files, place):
    write(files, "a.txt", b"one")
    write(files, "a.txt", b"two", "APPEND")
    write(files, "sub/new.txt", b"three", "APPEND")
    assert (text(files, "a.txt"), text(files, "sub/new.txt")) == ("onetwo", "three")
    disk = isinstance(files, FolderFiles)
    assert (place / "a.txt").read_text() == ("onetwo" if disk else "inside")
    assert (place / "sub" / "new.txt").exists() == disk


def test_memory_appends_to_what_is_there(place):
    files = MemoryFiles(Folder(place))
    write(files, "a.txt", b"+", "APPEND")
    assert text(files, "./a.txt") == "inside+"
    assert files.written == {"a.txt": b"inside+"}


def test_memory_without_a_folder():
    files = MemoryFiles()
    write(files, "x/../a.txt", b"made")
    assert text(files, "a.txt") == "made"
    assert fault(files, "b.txt").code == "IRL541"
    assert fault(files, "../a.txt").code == "IRL540"


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize(
    ("content", "offset"),
    [(b"\xff", 0), (b"abc\xf6de", 3), ("ż".encode() + b"\xc5", 2), (b"\xed\xa0\x80", 0)],
)
def test_what_is_no_text(files, place, content, offset):
    (place / "a.txt").write_bytes(content)
    found = fault(files, "a.txt")
    assert (found.code, found.data["offset"]) == ("IRL550", offset)


def test_marks_and_line_ends(files, place):
    (place / "a.txt").write_bytes(b"\xef\xbb\xbf1\r\n2\r3\n")
    assert text(files, "a.txt") == "1\n2\r3\n"


def test_too_large(files, place):
    with (place / "large.txt").open("wb") as file:
        file.truncate(100_000_001)
    assert "100,000,000" in fault(files, "large.txt").data["cause"]


def test_permissions(place):
    if os.geteuid() == 0:
        pytest.skip("root may do anything")
    files = FolderFiles(Folder(place))
    (place / "a.txt").chmod(0)
    assert fault(files, "a.txt").data["cause"] == "permission denied"
    assert fault(files, "a.txt", "WRITE").code == "IRL548"


def test_a_folder_that_is_gone(tmp_path):
    assert fault(FolderFiles(Folder(tmp_path / "gone")), "a.txt").code == "IRL548"


@pytest.mark.req("LANG-42")
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_full_disk(place, monkeypatch):
    """The descriptor of the file is one of /dev/full, on which every write says that there is no room."""
    opened = FolderFiles(Folder(place)).open("full.txt", "WRITE", nothing)
    full = os.open("/dev/full", os.O_WRONLY)
    os.dup2(full, opened.sink._handle)
    os.close(full)
    with pytest.raises(ChannelFault) as caught:
        opened.sink.write(b"x")
    assert (caught.value.code, caught.value.data["cause"]) == ("IRL548", "no space left on device")
    opened.sink.close()


def test_no_descriptor_is_left(place):
    files = FolderFiles(Folder(place))
    (place / "out.txt").symlink_to("../secret.txt")
    (place / "bad.txt").write_bytes(b"\xff")
    before = len(os.listdir("/proc/self/fd"))
    for name in ("a.txt", "sub/b.txt"):
        text(files, name)
    for name in ("out.txt", "sub", "none.txt", "none/x", "bad.txt", "sub/../../x", "a.txt/x"):
        fault(files, name)
    assert len(os.listdir("/proc/self/fd")) == before
