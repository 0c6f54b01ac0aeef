"""Small damages of a module, found in its syntax tree: which there are, and the module with one of them."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

_COMPARED = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq}
_COMPARED |= {ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In}
_COMPUTED = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult}
_COMPUTED |= {ast.FloorDiv: ast.Div, ast.Mod: ast.FloorDiv, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd}
_PAIRS = "min max,minimum maximum,argmin argmax,any all,floor ceil,sin cos,zeros ones,lower upper,first last"
_PAIRS += ",position_lower position_upper,speed_lower speed_upper,acceleration_lower acceleration_upper"
_SWAPPED = {a: b for pair in _PAIRS.split(",") for a, b in (pair.split(), pair.split()[::-1])}
_TEXTS = ast.Constant | ast.JoinedStr | ast.List | ast.Tuple | ast.ListComp
_UNTOUCHED = ast.Import | ast.ImportFrom | ast.Assert | ast.JoinedStr | ast.Global | ast.Nonlocal
_FUNCTION = ast.FunctionDef | ast.AsyncFunctionDef
_NO_VALUES = {"annotation", "returns", "type_params", "bases", "decorator_list"}


@dataclass(frozen=True)
class Mutation:
    """One damage. `function` is the outermost one that holds it, with its class, empty outside of any.

    `lines` are those of the statement, of which `old` is the text and `new` what it becomes; `defined_at`
    is where the function begins, its decorators included.
    """

    path: Path
    index: int
    line: int
    lines: range
    function: str
    defined_at: int
    kind: str
    old: str
    new: str

    @property
    def id(self) -> str:
        """What the command line calls it; counted anew where the module changes."""
        return f"{self.path.as_posix()}#{self.index}"


@dataclass
class _Edit:
    """A change of the tree, made and undone by putting one node or the other."""

    put: Callable[[object], None]
    before: object
    after: object
    node: ast.AST
    kind: str
    statement: ast.stmt
    function: tuple[str, int]


def mutations_of(root: Path, path: Path) -> list[Mutation]:
    """All damages of a module, in the order of the text."""
    found = []
    for index, edit in enumerate(_edits(ast.parse((root / path).read_text(encoding="utf-8")))):
        old = _text(edit.statement)
        edit.put(edit.after)
        new = _text(edit.after if edit.before is edit.statement else edit.statement)
        edit.put(edit.before)
        lines, (function, defined_at) = _lines(edit.statement), edit.function
        found.append(
            Mutation(path, index, edit.node.lineno, lines, function, defined_at, edit.kind, old, new)
        )
    return found


def mutated(root: Path, mutation: Mutation) -> ast.Module:
    """The module with one damage; the places of everything else are as they were."""
    tree = ast.parse((root / mutation.path).read_text(encoding="utf-8"))
    edit = list(_edits(tree))[mutation.index]
    edit.put(
        ast.copy_location(edit.after, edit.node)
        if isinstance(edit.after, ast.expr | ast.stmt)
        else edit.after
    )
    return ast.fix_missing_locations(tree)


def _text(statement: ast.stmt) -> str:
    """A statement, of one that holds others only its head."""
    whole = ast.unparse(statement).splitlines()
    return (
        next(line for line in whole if not line.startswith("@")) if hasattr(statement, "body") else whole[0]
    )


def _lines(statement: ast.stmt) -> range:
    body = getattr(statement, "body", None)
    last = body[0].lineno - 1 if body else statement.end_lineno
    return range(statement.lineno, max(last, statement.lineno) + 1)


def _edits(tree: ast.Module) -> list[_Edit]:
    found: list[_Edit] = []
    _walk(tree, None, ("", 0), set(), found)
    return sorted(found, key=lambda edit: (edit.node.lineno, edit.node.col_offset))


def _walk(
    node: ast.AST, statement: ast.stmt | None, function: tuple[str, int], known: set, found: list
) -> None:
    """Collects the changes below a node; `known` are names that have a value already."""
    if isinstance(node, _FUNCTION | ast.ClassDef) and not function[1]:
        name = f"{function[0]}.{node.name}".lstrip(".")
        first = min(part.lineno for part in (node, *node.decorator_list))
        function = (name, first if isinstance(node, _FUNCTION) else 0)
        known = (
            {part.arg for part in ast.walk(node.args) if isinstance(part, ast.arg)} if function[1] else set()
        )
    for field, value in ast.iter_fields(node):
        if field in _NO_VALUES or (isinstance(node, _FUNCTION) and field == "args" and not _defaults(node)):
            continue
        many = value if isinstance(value, list) else [value]
        for place, child in enumerate(many):
            if not isinstance(child, ast.AST) or _left_alone(child):
                continue
            put = _putter(node, field, place if isinstance(value, list) else None)
            inner = child if isinstance(child, ast.stmt) else statement
            if inner is not None and hasattr(child, "lineno"):
                for kind, after in _replacements(child, node, field, known):
                    found.append(_Edit(put, child, after, child, kind, inner, function))
            _walk(child, inner, function, known, found)
            if isinstance(child, ast.Assign | ast.AnnAssign | ast.For):
                known |= {part.id for part in ast.walk(child) if isinstance(part, ast.Name)}


def _defaults(node: ast.FunctionDef) -> bool:
    return bool(node.args.defaults or node.args.kw_defaults)


def _putter(node: ast.AST, field: str, place: int | None) -> Callable[[object], None]:
    def put(new: object) -> None:
        if place is None:
            setattr(node, field, new)
        else:
            getattr(node, field)[place] = new

    return put


def _left_alone(node: ast.AST) -> bool:
    """Imports, texts, types and what only shows a value: nothing that a run depends on."""
    if isinstance(node, _FUNCTION):
        return node.name in {"__repr__", "__str__"}
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return True
    if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
        name = node.targets[0].id.lstrip("_")
        return name == "all__" or (name[:1].isupper() and not name.isupper())
    if isinstance(node, ast.AnnAssign):
        return "TypeAlias" in ast.unparse(node.annotation)
    if isinstance(node, ast.If):
        return isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
    return isinstance(node, _UNTOUCHED)


def _replacements(node: ast.AST, parent: ast.AST, field: str, known: set) -> Iterator[tuple[str, ast.AST]]:
    if isinstance(node, ast.stmt):
        yield from _of_statement(node, known)
    elif isinstance(node, ast.Constant):
        yield from _of_constant(node, parent)
    elif isinstance(node, ast.Compare):
        for i, op in enumerate(node.ops):
            ops = [*node.ops[:i], _COMPARED[type(op)](), *node.ops[i + 1 :]]
            yield "comparison", ast.Compare(node.left, ops, node.comparators)
    elif isinstance(node, ast.BinOp):
        yield from _of_computation(node, parent)
    elif isinstance(node, ast.BoolOp):
        yield "and/or", ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield "sign" if isinstance(node.op, ast.USub) else "not", node.operand
    elif isinstance(node, ast.Call):
        yield from _of_call(node)
    elif isinstance(node, ast.Attribute) and node.attr in _SWAPPED and isinstance(node.ctx, ast.Load):
        yield "other name", ast.Attribute(node.value, _SWAPPED[node.attr], node.ctx)
    elif (
        isinstance(node, ast.Name)
        and node.id in _SWAPPED
        and isinstance(node.ctx, ast.Load)
        and field == "func"
    ):
        yield "other name", ast.Name(_SWAPPED[node.id], node.ctx)
    tested = (field == "test" and isinstance(parent, ast.If | ast.While | ast.IfExp)) or field == "ifs"
    if tested and not (isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not)):
        yield "negation", ast.UnaryOp(ast.Not(), node)


def _of_statement(node: ast.stmt, known: set) -> Iterator[tuple[str, ast.AST]]:
    if isinstance(node, ast.AugAssign) and type(node.op) in _COMPUTED:
        yield "arithmetic", ast.AugAssign(node.target, _COMPUTED[type(node.op)](), node.value)
    if isinstance(node, ast.Return) and node.value is not None and not _is_none(node.value):
        yield "returns nothing", ast.Return(ast.Constant(None))
    again = isinstance(node, ast.Assign) and all(
        isinstance(target, ast.Attribute | ast.Subscript)
        or (isinstance(target, ast.Name) and target.id in known)
        for target in node.targets
    )
    leaves = ast.AugAssign | ast.Raise | ast.Continue | ast.Break
    if (
        again
        or isinstance(node, leaves)
        or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Call | ast.YieldFrom))
    ):
        yield "left out", ast.Pass()


def _is_none(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def _of_constant(node: ast.Constant, parent: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    value = node.value
    if isinstance(parent, ast.keyword) and parent.arg == "strict":
        return
    if isinstance(value, bool):
        yield "constant", ast.Constant(not value)
    elif isinstance(value, int):
        axis = isinstance(parent, ast.keyword) and parent.arg == "axis"
        yield "axis" if axis else "constant", ast.Constant(1 - value if axis else value + 1)
    elif isinstance(value, float):
        yield "constant", ast.Constant(2.0 * value or 1.0)


def _of_computation(node: ast.BinOp, parent: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    if isinstance(node.op, ast.MatMult) and ast.dump(node.left) != ast.dump(node.right):
        yield "operands", ast.BinOp(node.right, node.op, node.left)
    typed = isinstance(node.op, ast.BitOr) and isinstance(parent, ast.Call | ast.BinOp)
    of_texts = any(isinstance(side, _TEXTS) and not _is_number(side) for side in (node.left, node.right))
    if type(node.op) in _COMPUTED and not typed and not of_texts:
        yield "arithmetic", ast.BinOp(node.left, _COMPUTED[type(node.op)](), node.right)


def _is_number(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, int | float)


def _of_call(node: ast.Call) -> Iterator[tuple[str, ast.AST]]:
    called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
    if called in {"isinstance", "getattr", "hasattr", "TypeVar", "field", "report"}:
        return
    plain = not any(isinstance(one, ast.Starred) for one in node.args)
    if called in {"abs", "clip", "sorted"} and node.args and plain:
        yield "call left out", node.args[0]
    if called == "range" and plain:
        stop = 0 if len(node.args) == 1 else 1
        shorter = ast.BinOp(node.args[stop], ast.Sub(), ast.Constant(1))
        yield "off by one", ast.Call(node.func, [*node.args[:stop], shorter, *node.args[stop + 1 :]], [])
    elif len(node.args) >= 2 and plain and called not in {"min", "max", "minimum", "maximum"}:
        swapped = [node.args[1], node.args[0], *node.args[2:]]
        if type(node.args[0]) is type(node.args[1]) and ast.dump(node.args[0]) != ast.dump(node.args[1]):
            yield "arguments", ast.Call(node.func, swapped, node.keywords)
    if node.keywords and node.keywords[-1].arg not in {None, "strict", "dtype"}:
        yield "argument left out", ast.Call(node.func, node.args, node.keywords[:-1])
