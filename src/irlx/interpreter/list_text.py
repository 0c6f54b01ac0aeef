"""Values written back to the text of a data list: what changed gets new text, all else stays as it is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from irlx.diagnostics import Diagnostic, Place, report
from irlx.interpreter.scope import Variable
from irlx.interpreter.values import ArrayValue, RecordValue, Unset, Value, is_set, unset_part
from irlx.language import tree
from irlx.language.data_lists import ImportedList
from irlx.language.ranges import INT_LIMIT


@dataclass(frozen=True)
class Rewritten:
    """Text of a data list with present values, and warnings on values that could not be written."""

    text: str
    warnings: tuple[Diagnostic, ...] = ()


def rewritten(
    found: ImportedList, variables: Mapping[str, Variable], first: Mapping[str, Value]
) -> Rewritten:
    """The text of a data list for its variables' present values, where these are not the `first` ones.

    A value that is calculated from a changed one is written as it is now, for it would become another one.
    IRL264 warns of values of which parts are missing, and of those that bounds of arrays depend on.
    """
    changed = {key for key, variable in variables.items() if variable.value != first.get(key)}
    bounds = {name for part in found.tree.declarations for name in _names(part.type)}
    warnings: list[Diagnostic] = []
    changes: list[tuple[int, int, str]] = []
    for part in found.tree.declarations:
        for variable in part.variables:
            name, initial = variable.name, variable.initial
            used = set() if initial is None else set(_names(initial))
            if name.key not in changed and not used & changed:
                continue
            value = variables[name.key].value
            why = ""
            if not is_set(value):
                why = f"{name.name}{unset_part(value)} has no value"
            elif name.key in bounds & changed:
                why = "bounds of arrays depend on it"
            if why:
                place = Place.in_text(found.source, name.span)
                warnings.append(report("IRL264", place, name=name.name, why=why))
                changed.discard(name.key)
            elif initial is None:
                changes.append((name.span.end, name.span.end, f" := {value_text(value)}"))
            else:
                changes.append((initial.span.start, initial.span.end, value_text(value)))
    return Rewritten(_with(found.source.text, changes), tuple(warnings))


def _names(root: tree.Node) -> Iterator[str]:
    for node in tree.walk(root):
        if isinstance(node, tree.Designator):
            yield node.base.key


def _with(text: str, changes: list[tuple[int, int, str]]) -> str:
    for start, end, new in reversed(changes):
        text = text[:start] + new + text[end:]
    return text


def value_text(value: Value) -> str:
    """A value as a program writes it, to the last bit."""
    match value:
        case bool():
            return "TRUE" if value else "FALSE"
        case int():
            # The least INT has no literal: its opposite is none.
            return f"{value + 1} - 1" if value == -INT_LIMIT else str(value)
        case float():
            return repr(value)
        case str():
            return _text(value)
        case RecordValue() if not value.values:
            return f"{value.type.name}()"
        case RecordValue() | ArrayValue():
            return f"({', '.join(map(value_text, value.values))})"
        case Unset():
            raise TypeError("what has no value has no text")


def _text(value: str) -> str:
    """A literal; characters that cannot stand in one are joined to it by their numbers."""
    parts, plain = [], ""
    for character in value:
        if character.isprintable():
            plain += "''" if character == "'" else character
            continue
        parts += [f"'{plain}'"] * bool(plain) + [f"CHR({ord(character)})"]
        plain = ""
    if plain or not parts:
        parts.append(f"'{plain}'")
    return " + ".join(parts)
