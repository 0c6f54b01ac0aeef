"""Readers of programs for controllers, written apart from what writes them: each line must fit a grammar."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

NUMBER = r"-?(?:0|[1-9]\d*)(?:\.\d+)?"
TOKEN = re.compile(rf"\s*(?:(?P<number>{NUMBER})(?![\w.])|(?P<name>[A-Za-z]\w*)|(?P<sign>[()\[\],=]))")


class SyntaxFault(Exception):
    """A line that its target would not take."""


@dataclass
class Point:
    """One move: its values in the order of the axes, as written; seconds to it, seconds to stand there."""

    values: list[float]
    passes: bool = False
    seconds: float | None = None
    wait: float = 0.0


@dataclass
class Played:
    """What a program does."""

    name: str
    points: list[Point] = field(default_factory=list)
    axes: list[str] = field(default_factory=list)
    comments: list[str] = field(default_factory=list)


def demand(holds: object, line: str) -> None:
    if not holds:
        raise SyntaxFault(line)


def number(text: str, line: str) -> float:
    demand(re.fullmatch(NUMBER, text), line)
    demand(not re.fullmatch(r"-0(\.0+)?", text), line)
    return float(text)


def lines_of(data: bytes, line_end: str, longest: int) -> list[str]:
    """Lines of a file of plain ASCII, every one of which ends in the same way."""
    text = data.decode("ascii")
    demand(text.endswith(line_end), "the end of the file")
    lines = text.split(line_end)[:-1]
    for line in lines:
        demand(line.isprintable() and len(line) <= longest, line)
    return lines


def read_urscript(data: bytes) -> Played:
    """`def NAME():`, calls of movej, servoj and stopj, `end`; the points are all postures in their order.

    The last movej stands behind stopj and is the last point again.
    """
    played, calls, state = Played(""), [], "before"
    for line in lines_of(data, "\n", 1000):
        text = line.strip()
        if text.startswith("#"):
            played.comments.append(text[1:].strip())
        elif state == "before":
            head = re.fullmatch(r"def ([A-Za-z]\w*)\(\):", line)
            demand(head, line)
            played.name, state = head[1], "inside"
        elif line == "end":
            demand(state == "inside", line)
            state = "behind"
        else:
            demand(state == "inside" and line.startswith("  ") and line[2] != " ", line)
            calls.append(ur_call(text))
    demand(state == "behind", "end")
    names = [name for name, _, _ in calls]
    demand(names == ["movej", *["servoj"] * (len(names) - 3), "stopj", "movej"], str(names))
    for name, posture, more in calls:
        if name == "stopj":
            demand(set(more) == {""} and more[""] > 0, str(more))
            continue
        demand(len(posture) == 6, str(posture))
        if name == "movej":
            demand(set(more) == {"a", "v"} and 0 < more["a"] <= 2 and 0 < more["v"] <= 1, str(more))
        else:
            # What the script manual allows.
            demand(set(more) == {"t", "lookahead_time", "gain"} and more["t"] == 0.002, str(more))
            demand(0.03 <= more["lookahead_time"] <= 0.2 and 100 <= more["gain"] <= 2000, str(more))
        played.points.append(Point(posture, name == "servoj", more.get("t")))
    return played


def ur_call(text: str) -> tuple[str, list[float], dict[str, float]]:
    """Name, list argument, and arguments by name ('' for a plain number) of a call, by its tokens."""
    tokens, place = [], 0
    while place < len(text):
        found = TOKEN.match(text, place)
        demand(found, text)
        tokens.append((found.lastgroup, found[found.lastgroup]))
        place = found.end()
    demand([kind for kind, _ in tokens[:1]] == ["name"] and tokens[1:2] == [("sign", "(")], text)
    demand(tokens[-1] == ("sign", ")"), text)
    inside = tokens[2:-1]
    posture: list[float] = []
    more: dict[str, float] = {}
    if inside[0] == ("sign", "["):
        close = inside.index(("sign", "]"))
        listed = inside[1:close]
        for k, (kind, word) in enumerate(listed):
            demand(kind == "number" if k % 2 == 0 else word == ",", text)
        demand(len(listed) % 2 == 1, text)
        posture = [number(word, text) for _, word in listed[::2]]
        inside = inside[close + 1 :]
        demand(inside[:1] == [("sign", ",")], text)
        inside = inside[1:]
    while inside:
        if inside[0][0] == "name":
            demand(inside[1] == ("sign", "=") and inside[2][0] == "number", text)
            more[inside[0][1]] = number(inside[2][1], text)
            inside = inside[3:]
        else:
            demand(inside[0][0] == "number" and not more, text)
            more[""] = number(inside[0][1], text)
            inside = inside[1:]
        if inside:
            demand(inside[0] == ("sign", ",") and inside[1:], text)
            inside = inside[1:]
    return tokens[0][1], posture, more


KRL_SETTINGS = (
    r"BAS\(#INITMOV,0\)",
    r"BAS\(#VEL_PTP,(?:[1-9]\d?|100)\)",
    r"\$ADVANCE=[1-5]",
    r"\$APO\.CPTP=(?:[1-9]\d?|100)",
)


def read_krl(data: bytes) -> Played:
    """`DEF NAME()`, settings, `PTP {A1 .., ..}` with or without `C_PTP`, `WAIT SEC`, `END`."""
    lines = lines_of(data, "\r\n", 471)
    demand(lines[0].startswith("&ACCESS ") and lines[1].startswith("&REL "), lines[0])
    head = re.fullmatch(r"DEF ([A-Za-z]\w{0,23})\(\)", lines[2])
    demand(head, lines[2])
    demand(lines[-1] == "END", lines[-1])
    played = Played(head[1])
    settings = []
    for line in lines[3:-1]:
        if line.startswith(";"):
            demand(not re.match(r";\s*(END)?FOLD", line), line)
            played.comments.append(line[1:].strip())
        elif re.match(r"BAS|\$", line):
            demand(not played.points, line)
            settings.append(line)
        elif line.startswith("WAIT SEC "):
            demand(played.points and not played.points[-1].passes and not played.points[-1].wait, line)
            played.points[-1].wait = number(line[9:], line)
        else:
            found = re.fullmatch(r"PTP \{(.*)\}( C_PTP)?", line)
            demand(found and settings, line)
            parts = [re.fullmatch(rf"([AE][1-6]) ({NUMBER})", part) for part in found[1].split(", ")]
            demand(all(parts), line)
            axes = [part[1] for part in parts]
            demand(len(set(axes)) == len(axes) and axes == (played.axes or axes), line)
            played.axes = axes
            played.points.append(Point([number(part[2], line) for part in parts], found[2] is not None))
    demand(len(settings) == len(KRL_SETTINGS), str(settings))
    for form, line in zip(KRL_SETTINGS, settings, strict=True):
        demand(re.fullmatch(form, line), line)
    demand(not played.points[0].passes and not played.points[-1].passes, lines[-2])
    return played


RAPID_MOVE = re.compile(
    rf"MoveAbsJ \[\[(?P<robax>[^\]]*)\],\[(?P<extax>[^\]]*)\]\]\\NoEOffs, "
    rf"v(?P<speed>\d+)(?:\\T:=(?P<time>{NUMBER}))?, (?P<zone>fine|z0), tool0;"
)


def read_rapid(data: bytes) -> Played:
    """A module with one procedure of `MoveAbsJ` and `WaitTime`; values are those of robax, then extax."""
    lines = [line.strip() for line in lines_of(data, "\r\n", 400)]
    comments = [line[1:].strip() for line in lines if line.startswith("!")]
    lines = [line for line in lines if not line.startswith("!")]
    module = re.fullmatch(r"MODULE ([A-Za-z]\w{0,31})", lines[0])
    procedure = re.fullmatch(r"PROC ([A-Za-z]\w{0,31})\(\)", lines[1])
    demand(module and procedure and module[1].lower() != procedure[1].lower(), lines[1])
    demand(lines[-2:] == ["ENDPROC", "ENDMODULE"], lines[-1])
    played = Played(procedure[1], comments=comments)
    for line in lines[2:-2]:
        if line.startswith("WaitTime "):
            demand(line.endswith(";") and not played.points[-1].passes and not played.points[-1].wait, line)
            played.points[-1].wait = number(line[9:-1], line)
            continue
        found = RAPID_MOVE.fullmatch(line)
        demand(found, line)
        robax, extax = found["robax"].split(","), found["extax"].split(",")
        demand(len(robax) == len(extax) == 6, line)
        used = [word for word in extax if word != "9E9"]
        demand(extax == used + ["9E9"] * (6 - len(used)), line)
        demand((found["time"] is None) == (not played.points), line)
        seconds = number(found["time"] or "0", line)
        demand(seconds > 0 or not played.points, line)
        values = [number(word, line) for word in [*robax, *used]]
        demand(not played.points or len(values) == len(played.points[0].values), line)
        played.points.append(Point(values, found["zone"] == "z0", seconds))
    demand(not played.points[0].passes and not played.points[-1].passes, lines[-3])
    return played


def read_robodk(data: bytes) -> Played:
    """Lines of joint values and a time that rises, nothing else."""
    played, times = Played(""), []
    for line in lines_of(data, "\n", 1000):
        *values, time = [number(word.strip(), line) for word in line.split(",")]
        demand(not times or time > times[-1], line)
        demand(not played.points or len(values) == len(played.points[0].values), line)
        times.append(time)
        played.points.append(Point(values, seconds=time))
    return played
