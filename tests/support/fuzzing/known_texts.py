"""Sound and faulty programs to begin with: `programs/`, the conformance suite, the pages of the documents."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from fuzzing.made_texts import MADE

ROOT = Path(__file__).resolve().parents[3]
_LARGEST = 12_000
_BLOCK = re.compile(r"(?:^`([\w.]+)`:\n\n)?^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
_LANGUAGES = ("irl", "dat", "pascal")
_DIVIDER = "%%file"


def joined(parts: dict[str, str]) -> str:
    """A program and the files beside it as one text: behind the program each has a line with its name."""
    first, *others = parts.items()
    return first[1] + "".join(f"\n{_DIVIDER} {name}\n{text}" for name, text in others)


def parts_of(content: bytes) -> list[tuple[str, bytes]]:
    """The files of a joined text; the first one has no name."""
    first, *others = re.split(rb"\n%%file (\w{1,40}\.(?:irl|dat|toml))\n", content)
    return [("", first), *((others[i].decode(), others[i + 1]) for i in range(0, len(others), 2))]


@cache
def known_texts() -> tuple[str, ...]:
    """Every program that the project knows, with the lists and modules beside it, each once."""
    found = [*_with_neighbours(ROOT / "tests" / "conformance"), *_of_programs(), *_of_documents()]
    found += map(joined, MADE)
    data = ROOT / "tests" / "language" / "data"
    found += [path.read_text(encoding="utf-8") for path in sorted(data.glob("*.irl"))]
    return tuple(dict.fromkeys(text for text in found if len(text) <= _LARGEST))


def _with_neighbours(root: Path) -> list[str]:
    texts = []
    for program in sorted(root.rglob("program.irl")):
        parts = {"": program.read_text(encoding="utf-8")}
        for path in sorted(program.parent.iterdir()):
            if path.suffix in (".irl", ".dat", ".toml") and path != program:
                name = "p.toml" if path.suffix == ".toml" else path.name
                parts[name] = path.read_text(encoding="utf-8", errors="surrogateescape")
        texts.append(joined(parts))
    return texts


def _of_programs() -> list[str]:
    folder = ROOT / "programs"
    paths = [*sorted(folder.rglob("*.irl")), *sorted(folder.rglob("*.dat"))]
    texts = [path.read_text(encoding="utf-8") for path in paths]
    for path in sorted(folder.rglob("*.irl")):
        text = path.read_text(encoding="utf-8")
        names = re.findall(r"\b(?:DATALIST|FROM)\s+(\w+)", text)
        beside = {
            file.name: file.read_text(encoding="utf-8")
            for name in names
            for file in (path.with_name(f"{name}.dat"), path.with_name(f"{name}.irl"))
            if file.is_file()
        }
        cell = path.with_suffix(".toml")
        if cell.is_file():
            beside["p.toml"] = cell.read_text(encoding="utf-8")
        texts += [joined({"": text, **beside})] if beside else []
    return texts


def _of_documents() -> list[str]:
    """Blocks of programs in the pages; those with a file name above belong to the one before."""
    texts = []
    for page in sorted((ROOT / "docs").rglob("*.md")):
        parts: list[dict[str, str]] = []
        for name, language, text in _BLOCK.findall(page.read_text(encoding="utf-8")):
            if parts and (language == "toml" or name.endswith((".irl", ".dat", ".toml"))):
                parts[-1]["p.toml" if language == "toml" else name] = text
            elif language in _LANGUAGES:
                parts.append({"": text})
        texts += [joined(one) for one in parts]
    return texts
