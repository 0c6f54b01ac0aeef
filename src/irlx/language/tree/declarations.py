"""Nodes of program parts: types, declarations, routines, programs and modules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from irlx.language.tree.expressions import Expression, Range
from irlx.language.tree.nodes import Name, Node
from irlx.language.tree.statements import Statement


@dataclass(frozen=True, slots=True)
class NamedType(Node):
    """A type by its name, predefined or declared."""

    name: Name


@dataclass(frozen=True, slots=True)
class ArrayType(Node):
    """ARRAY of one or more dimensions, each with a range of indices."""

    dimensions: tuple[Range, ...]
    element: TypeForm


@dataclass(frozen=True, slots=True)
class FieldGroup(Node):
    """Fields of one type in a record; a dotted field name is one `Name` with its dots."""

    type: TypeForm
    names: tuple[Name, ...]


@dataclass(frozen=True, slots=True)
class RecordType(Node):
    """RECORD with its fields in order."""

    groups: tuple[FieldGroup, ...]


TypeForm: TypeAlias = "NamedType | ArrayType | RecordType"


@dataclass(frozen=True, slots=True)
class SystemSpecification(Node):
    """SYSTEM SPECIFICATION: names the cell."""

    name: Name


@dataclass(frozen=True, slots=True)
class ImportFrom(Node):
    """FROM module IMPORT names."""

    module: Name
    names: tuple[Name, ...]


@dataclass(frozen=True, slots=True)
class ImportDatalist(Node):
    """IMPORT DATALIST name: taught values from a file beside the program."""

    name: Name


@dataclass(frozen=True, slots=True)
class Export(Node):
    """EXPORT names, to one named importer or to everybody."""

    names: tuple[Name, ...]
    recipient: Name | None


@dataclass(frozen=True, slots=True)
class RobotBinding(Node):
    """ROBOT name := robot of the cell."""

    name: Name
    robot: Name


@dataclass(frozen=True, slots=True)
class StandardChannel(Node):
    """STANDARD_IN or STANDARD_OUT set to a channel."""

    direction: Literal["IN", "OUT"]
    channel: Name


@dataclass(frozen=True, slots=True)
class Variable(Node):
    """One declared name with its own initial value, or None."""

    name: Name
    initial: Expression | None


@dataclass(frozen=True, slots=True)
class VarDeclaration(Node):
    """Variables of one type in a VAR part."""

    type: TypeForm
    variables: tuple[Variable, ...]


@dataclass(frozen=True, slots=True)
class ConstDeclaration(Node):
    """Constants of one type in a CONST part; every one has a value in a correct program."""

    type: TypeForm
    constants: tuple[Variable, ...]


@dataclass(frozen=True, slots=True)
class TypeDefinition(Node):
    """A type and the name it gets."""

    type: TypeForm
    name: Name


@dataclass(frozen=True, slots=True)
class SignalPort(Node):
    """A signal's name and the number of its port."""

    name: Name
    port: Expression


@dataclass(frozen=True, slots=True)
class SignalDeclaration(Node):
    """Signals of the cell; `type` is None where DIGITAL or ANALOG says it (`medium`), and the other way."""

    direction: Literal["INPUT", "OUTPUT"]
    medium: Literal["DIGITAL", "ANALOG"] | None
    type: NamedType | None
    signals: tuple[SignalPort, ...]


@dataclass(frozen=True, slots=True)
class Parameter(Node):
    """Parameters of one type; a VAR parameter is the caller's own variable."""

    mode: Literal["IN", "VAR"]
    type: TypeForm
    names: tuple[Name, ...]


@dataclass(frozen=True, slots=True)
class ProcedureDeclaration(Node):
    """PROCEDURE with its own declarations."""

    name: Name
    parameters: tuple[Parameter, ...]
    declarations: tuple[Declaration, ...]
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class FunctionDeclaration(Node):
    """FUNCTION with its own declarations and the type of its result."""

    name: Name
    parameters: tuple[Parameter, ...]
    result: TypeForm
    declarations: tuple[Declaration, ...]
    body: tuple[Statement, ...]


Declaration: TypeAlias = (
    "SystemSpecification | ImportFrom | ImportDatalist | Export | RobotBinding | StandardChannel"
    " | VarDeclaration | ConstDeclaration | TypeDefinition | SignalDeclaration"
    " | ProcedureDeclaration | FunctionDeclaration"
)


@dataclass(frozen=True, slots=True)
class Program(Node):
    """A program: declarations in the order written, then the main statements."""

    name: Name
    declarations: tuple[Declaration, ...]
    body: tuple[Statement, ...]


@dataclass(frozen=True, slots=True)
class Module(Node):
    """A module: declarations for other files."""

    name: Name
    declarations: tuple[Declaration, ...]


@dataclass(frozen=True, slots=True)
class DataList(Node):
    """A data list: named values, such as taught points, that are variables of the programs that import it."""

    name: Name
    declarations: tuple[VarDeclaration, ...]
