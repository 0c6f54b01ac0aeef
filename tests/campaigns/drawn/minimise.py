"""Findings made smaller: lines, clauses and entries are left out while the finding stays what it is."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from drawn.judging import judged
from drawn.program import Case

OPENING = re.compile(r"^\s*(IF|CASE|FOR|WHILE|REPEAT|PROCEDURE|FUNCTION)\b")
CLOSING = re.compile(r"(ENDIF|ENDCASE|ENDFOR|ENDWHILE|ENDPROC|ENDFCT)\b|^\s*UNTIL\b")
CLAUSE = re.compile(r" WITH (?:(?! WITH ).)*(?=;| WITH )")
PARAMETER = re.compile(
    r",? [A-Z_]+ := (?:[^,;()]|\([^()]*(?:\([^()]*\)[^()]*)*\))+?(?=;|,? [A-Z_]+ :=| WITH)"
)


def kind_of(finding: str) -> str:
    """What a smaller program must show as well: the kind of mistake, and the code or check that told it."""
    head = finding.splitlines()[0] if finding else ""
    if head.startswith("traceback"):
        return "traceback " + finding.strip().splitlines()[-1].split(":")[0]
    words = head.split(":")
    code = re.search(r"IRL\d+", head)
    return words[0] + (f" {code.group()}" if code and words[0] in {"check", "refusal", "again"} else "")


def smaller(files: dict[str, str], seed: int, most: int = 1500) -> dict[str, str]:
    """The files of a finding with as little in them as still shows it, after at most so many runs."""
    wanted = kind_of(_finding(files, seed))
    left = [most]

    def shows(tried: dict[str, str]) -> bool:
        left[0] -= 1
        return left[0] > 0 and kind_of(_finding(tried, seed)) == wanted

    before = None
    while files != before and left[0] > 0:
        before = dict(files)
        files = _without_files(files, shows)
        for name in [name for name in files if name.endswith((".irl", ".toml", ".dat"))]:
            for attempts in (_chunks, _groups, _parts):
                files = _reduced(files, name, attempts, shows)
    return files


def _finding(files: dict[str, str], seed: int) -> str:
    with TemporaryDirectory() as folder:
        for name, text in files.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        return judged(Path(folder), seed, False).finding


def _without_files(files: dict[str, str], shows: Callable[[dict[str, str]], bool]) -> dict[str, str]:
    for name in list(files):
        tried = {other: text for other, text in files.items() if other != name}
        if name not in {"program.irl", "cell.toml"} and shows(tried):
            files = tried
    return files


Lines = list[str]


def _reduced(
    files: dict[str, str],
    name: str,
    attempts: Callable[[Lines], Iterator[Lines]],
    shows: Callable[[dict[str, str]], bool],
) -> dict[str, str]:
    """Take every attempt that still shows the finding, until none does."""
    found = True
    while found:
        found = False
        for lines in attempts(files[name].splitlines()):
            tried = {**files, name: "\n".join([*lines, ""])}
            if tried != files and shows(tried):
                files, found = tried, True
                break
    return files


def _chunks(lines: Lines) -> Iterator[Lines]:
    """Without runs of lines, the longest first, the last of the text first."""
    size = len(lines) // 2
    while size >= 1:
        for start in range(len(lines) - size, -1, -size):
            yield lines[:start] + lines[start + size :]
        size //= 2


def _groups(lines: Lines) -> Iterator[Lines]:
    """Without a statement of several lines, or without its head and end alone."""
    for start, line in enumerate(lines):
        if not OPENING.match(line) or CLOSING.search(line):
            continue
        depth = 0
        for end in range(start, len(lines)):
            depth += bool(OPENING.match(lines[end])) - bool(CLOSING.search(lines[end]))
            if depth <= 0:
                yield lines[:start] + lines[end + 1 :]
                yield lines[:start] + lines[start + 1 : end] + lines[end + 1 :]
                break


def _parts(lines: Lines) -> Iterator[Lines]:
    """Without a clause or a parameter of a line."""
    for place, line in enumerate(lines):
        for pattern in (CLAUSE, PARAMETER):
            for match in pattern.finditer(line):
                yield [*lines[:place], line[: match.start()] + line[match.end() :], *lines[place + 1 :]]


def kept_case(case: Case, finding: str, folder: Path) -> Path:
    """Write the smallest form of a finding into a folder of the corpus, with a note of what was found."""
    files = smaller(dict(case.files), case.seed)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    first = finding.splitlines()[0]
    (folder / "note.txt").write_text(f"From the program of seed {case.seed}: {first}\n", encoding="utf-8")
    return folder
