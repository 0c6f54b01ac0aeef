"""Random use of files: on disk, in memory, and by a model of a few lines that has never seen either."""

import os
import random
import shutil

import pytest

from irlx.interpreter.channels.setup import ChannelSetup
from irlx.interpreter.errors import InterpreterError
from irlx.interpreter.interpret import Interpretation
from irlx.language.analysis import analyse
from irlx.language.source import source_text
from long_run import first

GOOD = {
    "a.txt": "a.txt",
    "./b.txt": "b.txt",
    "sub/c.txt": "sub/c.txt",
    "sub/../a.txt": "a.txt",
    "link": "b.txt",
}
BAD = {"../x.txt": "IRL540", "/tmp/x.txt": "IRL540", "out/x.txt": "IRL540", "out": "IRL540", "pipe": "IRL548"}
BAD |= {"sub": "IRL548", "": "IRL554", "no/x.txt": "IRL541", "self.irl": "IRL551", "a.txt/x": None}
FIRST = {"a.txt": "1\n2\n3\n"}


class Model:
    """What a program of these statements does to files of whole numbers."""

    def __init__(self):
        self.files = dict(FIRST)
        self.open = {}
        self.shown = ""

    def do(self, statement):
        """Carry out a statement; the code of what is wrong with it, or None."""
        word, variable, *rest = statement
        if word == "OPEN":
            return self._open(variable, *rest)
        if variable not in self.open:
            return "IRL542"
        name, mode, left = self.open[variable]
        if word == "CLOSE":
            del self.open[variable]
        elif word == "WRITELN":
            if mode == "READ":
                return "IRL545"
            self.files[name] += f"{rest[0]}\n"
        elif mode != "READ":
            return "IRL545"
        elif word == "READ":
            if not left:
                return "IRL546"
            self.shown += f"{left.pop(0)} "
        else:
            self.shown += f"{'FALSE' if left else 'TRUE'} "
        return None

    def _open(self, variable, name, mode):
        if variable in self.open:
            return "IRL543"
        if name in BAD:
            missing = "IRL548" if "a.txt" in self.files else "IRL541"
            # The program may be read.
            return None if (name, mode) == ("self.irl", "READ") else BAD[name] or missing
        real = GOOD[name]
        if mode == "READ" and real not in self.files:
            return "IRL541"
        if any(other == real and {how, mode} != {"READ"} for other, how, _ in self.open.values()):
            return "IRL544"
        if mode == "WRITE" or real not in self.files:
            self.files[real] = ""
        self.open[variable] = (real, mode, self.files[real].split() if mode == "READ" else [])
        return None


def statements(chance):
    """Statements of a program, mostly sensible ones; the first wrong one ends it."""
    trouble = chance.choice([0.0, 0.002, 0.01, 0.05])
    model, found = Model(), []
    for _ in range(chance.randint(1, 150)):
        variable = chance.choice("fgh")
        mode = chance.choice(["READ", "WRITE", "APPEND"])
        name = chance.choice(list(BAD if chance.random() < 10 * trouble else GOOD))
        use = [("READ", variable), ("EOF", variable), ("WRITELN", variable, chance.randint(-99, 99))]
        statement = chance.choice([("OPEN", variable, name, mode), ("CLOSE", variable), *use, *use])
        if name == "self.irl" and statement[0] == "OPEN" and mode == "READ":
            continue
        tried = Model()
        wrong = [tried.do(one) for one in [*found, statement]][-1]
        if wrong is None or chance.random() < trouble:
            found.append(statement)
            if wrong is not None:
                break
    code = [model.do(one) for one in found][-1] if found else None
    return found, code, model


def text_of(statement):
    word, variable, *rest = statement
    if word == "OPEN":
        return f"OPEN({variable}, '{rest[0]}', '{rest[1]}');"
    if word == "READ":
        return f"READ({variable}, i); WRITE(i, ' ');"
    if word == "EOF":
        return f"WRITE(EOF({variable}), ' ');"
    return f"{word}({', '.join([variable, *map(str, rest)])});"


def furnished(folder):
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "in" / "sub").mkdir(parents=True)
    (folder / "in" / "a.txt").write_text(FIRST["a.txt"])
    (folder / "in" / "self.irl").write_text("program")
    (folder / "in" / "out").symlink_to("..")
    (folder / "in" / "link").symlink_to("b.txt")
    os.mkfifo(folder / "in" / "pipe")
    return folder / "in"


def contents(folder):
    names = ("a.txt", "b.txt", "sub/c.txt")
    return {name: (folder / name).read_text() for name in names if (folder / name).is_file()}


def outcome(body, channels, setting):
    """Code of the error that ends a program, if any, and what it has shown; its files are closed then."""
    declarations = "VAR FILE: f, g, h; INT: i;"
    analysis = analyse(source_text("t.irl", f"PROGRAM t; {declarations}\nBEGIN\n{body}\nENDPROGRAM"))
    assert not analysis.has_errors, analysis.diagnostics
    code = None
    try:
        list(Interpretation(analysis.tree, analysis.source, setting(), channels=channels).run())
    except InterpreterError as error:
        code = error.reason.code
    channels.finish()
    return code, channels.output


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize("seed", first(1, [1, 0, 2, 3]))
def test_disk_memory_and_model(tmp_path, setting, seed):
    chance = random.Random(seed)
    codes = set()
    for _ in range(40):
        found, code, model = statements(chance)
        body = "\n".join(map(text_of, found))
        folder = furnished(tmp_path / "place")
        setup = ChannelSetup(folder, {folder / "self.irl": "the program itself"})
        memory = setup.in_memory()
        assert outcome(body, memory, setting) == (code, model.shown), (seed, body)
        assert contents(folder) == FIRST
        assert outcome(body, setup.on_disk(), setting) == (code, model.shown), (seed, body)
        assert contents(folder) == model.files, (seed, body)
        written = {GOOD[name]: bytes(text).decode() for name, text in memory.files.written.items()}
        assert {**FIRST, **written} == model.files, (seed, body)
        assert sorted(path.name for path in folder.parent.iterdir()) == ["in"]
        codes.add(code)
    assert {None, "IRL542"} <= codes
    assert seed != 1 or codes >= {"IRL541", "IRL545", "IRL554"}
