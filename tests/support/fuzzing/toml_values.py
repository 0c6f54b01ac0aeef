"""TOML tables with each value in turn of another type, out of any range, missing or twice."""

from __future__ import annotations

import datetime
import sys
from collections.abc import Callable, Iterator
from copy import deepcopy
from random import Random
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Path = tuple[str | int, ...]
OTHERS: tuple[Any, ...] = (
    *(True, False, 0, 1, -1, 7, 2**62, -(2**62), 10**400, 0.0, -0.0, 0.5, -0.5, 1e-320, 1e308, -1e308, 1e15),
    *(float("nan"), float("inf"), float("-inf"), "", "x", "koch11", "../x", "/", "\0", "nan", "1", "é" * 300),
    *(
        [],
        [0],
        [1, 2, 3],
        [1e308, -1e308, 1e308],
        [[]],
        [[0, 1], [0, 1]],
        [["a", "b"]],
        [True],
        ["x"],
        [{}],
        {},
    ),
    *({"x": 1}, {"xyz": [0, 0, 0]}, [float("nan")] * 3, [0] * 11, [0] * 300, [[0, float("inf")]]),
    *(datetime.date(2020, 1, 1), datetime.time(1, 2, 3), datetime.datetime(2020, 1, 1, 1, 1)),
)


def as_toml(value: Any) -> str:
    """A value in TOML, tables in one line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return '"' + "".join(_character(one) for one in value) + '"'
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, list):
        return f"[{', '.join(map(as_toml, value))}]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{as_toml(str(key))} = {as_toml(one)}" for key, one in value.items()) + "}"
    if isinstance(value, datetime.date | datetime.time):
        return value.isoformat()
    return str(value)


def file_of(table: dict[str, Any]) -> bytes:
    """A table as a TOML file, a line a key."""
    return "".join(f"{as_toml(key)} = {as_toml(value)}\n" for key, value in table.items()).encode()


def paths_of(value: Any, path: Path = ()) -> Iterator[Path]:
    """Paths of all values in a table, tables and lists included."""
    if path:
        yield path
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, one in inside:
        yield from paths_of(one, (*path, key))


def replaced(table: dict[str, Any], path: Path, value: Any) -> dict[str, Any]:
    """A copy with another value at a path."""
    new = deepcopy(table)
    holder: Any = new
    for step in path[:-1]:
        holder = holder[step]
    holder[path[-1]] = value
    return new


def each_replaced(content: bytes) -> Iterator[Callable[[], bytes]]:
    """What makes a TOML file with each of its values in turn replaced by each other value."""
    table = tomllib.loads(content.decode())
    for path in paths_of(table):
        for value in OTHERS:
            yield lambda path=path, value=value: file_of(replaced(table, path, value))  # type: ignore[misc]


def confused(content: bytes, chance: Random) -> bytes:
    """A TOML file with some values replaced, left out, put in elsewhere, or of another scale."""
    try:
        table = tomllib.loads(content.decode("utf-8-sig"))
    except (ValueError, RecursionError):
        return content
    for _ in range(min(1 + int(chance.expovariate(1.0)), 4)):
        paths = list(paths_of(table))
        if not paths:
            break
        table = _changed(table, chance.choice(paths), paths, chance)
    return file_of(table)


def _changed(table: dict[str, Any], path: Path, paths: list[Path], chance: Random) -> dict[str, Any]:
    change = chance.randrange(6)
    if change == 0:
        new = deepcopy(table)
        holder = _at(new, path[:-1])
        del holder[path[-1]]
        return new
    if change == 1:
        return replaced(table, path, deepcopy(_at(table, chance.choice(paths))))
    value = _at(table, path)
    if change == 2 and isinstance(value, list):
        return replaced(table, path, value * chance.choice((2, 3)) if chance.random() < 0.5 else value[1:])
    if change == 3 and isinstance(value, int | float) and not isinstance(value, bool):
        return replaced(table, path, _scaled(value, chance.choice((-1, 1000, 1e-3, 1e150, 1e300, 0, 1e-200))))
    if change == 4 and isinstance(value, dict):
        return replaced(table, path, {**value, chance.choice(("x", "name", "xyz", "", "é")): 1})
    return replaced(table, path, chance.choice(OTHERS))


def _scaled(value: float, factor: float) -> float:
    # Times 1000 again and again an integer becomes too large for a product with a float.
    return value * (factor if isinstance(factor, int) or abs(value) < 1e300 else int(factor))


def _at(table: Any, path: Path) -> Any:
    for step in path:
        table = table[step]
    return table


def _character(one: str) -> str:
    return f"\\u{ord(one):04X}" if ord(one) < 32 or one in '"\\\x7f' else one
