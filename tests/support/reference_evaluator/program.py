"""Declarations, statements, routines and output: what happens when a program runs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any

from irlx.language import tree
from reference_evaluator.expressions import Expressions
from reference_evaluator.trouble import TooLong, Trouble
from reference_evaluator.types import (
    BOOL,
    INT,
    REAL,
    Array,
    Record,
    Value,
    fitted,
    predefined,
    variable,
)

BEYOND = (math.inf, -math.inf)


class Exited(Exception):
    """EXIT."""


class Halted(Exception):
    """HALT, or RETURN in the main program."""


class Returned(Exception):
    def __init__(self, value):
        self.value = value


class Jump(Exception):
    def __init__(self, label):
        self.label = label


@dataclass(frozen=True)
class Ending:
    """Variables of the program (name to `Value`, data None where nothing was set), output, and error."""

    variables: dict[str, Value]
    output: str
    trouble: Trouble | None
    statements: int


class Names:
    """Names of the program, and in a call those of its routine before them."""

    def __init__(self, types, routines, outer=None):
        self.types, self.routines, self.outer = types, routines, outer
        self.variables: dict[str, Any] = {}

    def variable(self, key):
        found = self.variables.get(key)
        return found if found is not None or self.outer is None else self.outer.variable(key)

    def type(self, key):
        found = self.types.get(key)
        return found if found is not None or self.outer is None else self.outer.type(key)

    def is_function(self, key):
        return self.variable(key) is None and isinstance(self.routines.get(key), tree.FunctionDeclaration)


class Run:
    """A program in execution."""

    def __init__(self, program, joints, longest):
        self.left, self.longest, self.output = longest, longest, ""
        routines = {
            d.name.key: d
            for d in program.declarations
            if isinstance(d, tree.ProcedureDeclaration | tree.FunctionDeclaration)
        }
        self.globals = Names(predefined(joints), routines)
        self.program = program

    def ended(self):
        trouble = None
        try:
            self.declare(self.program.declarations, self.globals)
            self.block(self.program.body, Frame(self, self.globals))
        except Trouble as found:
            trouble = found
        except (Halted, Returned):
            pass
        variables = {key: Value(p.type, p.holder[p.at]) for key, p in self.globals.variables.items()}
        return Ending(variables, self.output, trouble, self.longest - self.left)

    def declare(self, declarations, names):
        """Constants and types in the order of the text, then variables one after the other."""
        frame = Frame(self, names)
        for declaration in declarations:
            if isinstance(declaration, tree.TypeDefinition):
                names.types[declaration.name.key] = frame.type_of(declaration.type, declaration.name.key)
            elif isinstance(declaration, tree.ConstDeclaration):
                self.declare_all(declaration.type, declaration.constants, frame)
        for declaration in declarations:
            if isinstance(declaration, tree.VarDeclaration):
                self.declare_all(declaration.type, declaration.variables, frame)

    def declare_all(self, form, variables, frame):
        type = frame.type_of(form)
        for declared in variables:
            place = variable(type)
            if declared.initial is not None:
                place.write(frame.expressions.value(declared.initial, type))
            frame.names.variables[declared.name.key] = place

    def step(self):
        self.left -= 1
        if self.left < 0:
            raise TooLong

    def block(self, body, frame):
        """Carries out a list of statements; a GOTO out of what stands in it goes on behind the label."""
        at = 0
        while at < len(body):
            try:
                frame.statement(body[at])
                at += 1
            except Jump as jump:
                labels = [
                    i for i, s in enumerate(body) if isinstance(s, tree.Label) and s.name.key == jump.label
                ]
                if not labels:
                    raise
                at = labels[0]

    def call(self, caller, name, arguments):
        routine = self.globals.routines[name.key]
        self.step()
        names = Names({}, self.globals.routines, self.globals)
        frame = Frame(self, names)
        parameters = [(p.mode, p.type, key) for p in routine.parameters for key in p.names]
        for (mode, form, parameter), argument in zip(parameters, arguments, strict=True):
            type = frame.type_of(form)
            if mode == "VAR":
                names.variables[parameter.key] = caller.expressions.place(argument)
            else:
                place = variable(type)
                place.write(caller.expressions.value(argument, type))
                names.variables[parameter.key] = place
        self.declare(routine.declarations, names)
        if isinstance(routine, tree.FunctionDeclaration):
            frame.result = frame.type_of(routine.result)
        try:
            self.block(routine.body, frame)
        except Returned as returned:
            if isinstance(routine, tree.FunctionDeclaration):
                return fitted(returned.value, frame.result)
            return None
        if isinstance(routine, tree.FunctionDeclaration):
            raise Trouble("IRL514", routine.name)
        return None


class Frame:
    """Statements of the program or of one call, with the names that they see."""

    def __init__(self, run, names):
        self.run, self.names, self.result = run, names, None

        self.expressions = Expressions(names, partial(run.call, self))

    def type_of(self, form, name=""):
        if isinstance(form, tree.NamedType):
            return self.names.type(form.name.key)
        if isinstance(form, tree.ArrayType):
            bounds = tuple(
                (self.expressions.value(d.lower).data, self.expressions.value(d.upper).data)
                for d in form.dimensions
            )
            return Array(bounds, self.type_of(form.element))
        fields = tuple((n.key, self.type_of(g.type)) for g in form.groups for n in g.names)
        return Record(name, fields)

    def statement(self, node):
        self.run.step()
        getattr(self, type(node).__name__)(node)

    def true(self, node):
        return self.expressions.of_type(node, BOOL).data

    def Label(self, node):  # noqa: N802
        pass

    def Assignment(self, node):  # noqa: N802
        place = self.expressions.place(node.target)
        place.write(self.expressions.value(node.value, place.type))

    def Call(self, node):  # noqa: N802
        key = node.name.key
        if key in self.names.routines:
            self.run.call(self, node.name, node.arguments)
        elif key in ("write", "writeln"):
            texts = [self.written(argument) for argument in node.arguments]
            self.run.output += "".join(texts) + ("\n" if key == "writeln" else "")
        else:
            raise NotImplementedError(key)

    def written(self, argument):
        if not isinstance(argument, tree.FormattedValue):
            return plain(self.expressions.value(argument))
        value = self.expressions.value(argument.value)
        width = self.layout(argument.width, 1000)
        if argument.precision is None:
            return plain(value).rjust(width)
        return decimals(value.data, self.layout(argument.precision, 100)).rjust(width)

    def layout(self, node, most):
        number = self.expressions.of_type(node, INT).data
        if not 0 <= number <= most:
            raise Trouble("IRL505", node)
        return number

    def Return(self, node):  # noqa: N802
        raise Returned(None if node.value is None else self.expressions.value(node.value, self.result))

    def Goto(self, node):  # noqa: N802
        raise Jump(node.label.key)

    def Exit(self, node):  # noqa: N802
        raise Exited

    def Halt(self, node):  # noqa: N802
        raise Halted

    def Pause(self, node):  # noqa: N802
        pass

    def If(self, node):  # noqa: N802
        for branch in node.branches:
            if self.true(branch.condition):
                self.run.block(branch.body, self)
                return
        self.run.block(node.otherwise or (), self)

    def Case(self, node):  # noqa: N802
        selector = self.expressions.value(node.selector)
        for branch in node.branches:
            if any(self.holds(label, selector) for label in branch.labels):
                self.run.block(branch.body, self)
                return
        self.run.block(node.default or (), self)

    def holds(self, label, selector):
        if isinstance(label, tree.Range):
            low, high = (
                self.expressions.value(end, selector.type).data for end in (label.lower, label.upper)
            )
            return low <= selector.data <= high
        return self.expressions.value(label, selector.type).data == selector.data

    def For(self, node):  # noqa: N802
        place = self.expressions.place(node.variable)
        start = self.expressions.of_type(node.start, place.type).data
        stop = self.expressions.of_type(node.stop, place.type).data
        step = 1 if node.step is None else self.expressions.of_type(node.step, place.type).data
        if step <= 0:
            raise Trouble("IRL505", node.step)
        if stop - start in BEYOND:
            raise Trouble("IRL503", node.stop)
        for value in values(start, stop, step, node.down):
            self.run.step()
            place.write(Value(place.type, value))
            if not self.round(node.body):
                break

    def While(self, node):  # noqa: N802
        while self.true(node.condition):
            self.run.step()
            if not self.round(node.body):
                break

    def Repeat(self, node):  # noqa: N802
        while True:
            self.run.step()
            if not self.round(node.body) or self.true(node.condition):
                break

    def round(self, body):
        """Carries out a loop's statements once; False where EXIT leaves the loop."""
        try:
            self.run.block(body, self)
        except Exited:
            return False
        return True


def values(start, stop, step, down):
    """Values of a FOR: start plus whole steps; over REAL 1e-9 of one may be missing to the end."""
    number, sign = 0, -1 if down else 1
    slack = Fraction(step) / 10**9 if isinstance(step, float) else 0
    while True:
        value = start + sign * number * step
        if value in BEYOND or sign * (Fraction(value) - Fraction(stop)) > slack:
            return
        yield value
        number += 1


def plain(value):
    if value.type == BOOL:
        return "TRUE" if value.data else "FALSE"
    return repr(value.data).upper() if value.type == REAL else str(value.data)


def decimals(number, count):
    """A number with so many decimals, correctly rounded: the half goes to the even digit."""
    scaled = round(abs(Fraction(number)) * 10**count)
    digits = str(scaled).rjust(count + 1, "0")
    text = digits if count == 0 else f"{digits[:-count]}.{digits[-count:]}"
    return f"-{text}" if math.copysign(1.0, number) < 0 else text


def evaluated(program, joints=7, longest=200_000):
    """What a program (its tree) comes to; TooLong where it takes more than so many statements."""
    return Run(program, joints, longest).ended()


__all__ = ["Ending", "evaluated"]
