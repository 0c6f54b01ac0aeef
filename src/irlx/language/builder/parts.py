"""Reductions of program parts."""

from __future__ import annotations

from typing import Literal

from irlx.language import tree
from irlx.language.builder.children import Children, nodes_of, span_of
from irlx.language.token import Token


def _words(children: Children) -> list[str]:
    return [child.type for child in children if isinstance(child, Token)]


class PartBuilder:
    """Methods for the rules of programs, declarations and types."""

    def program(self, children: Children) -> tree.Program:
        """Reduce a whole program."""
        return tree.Program(span_of(children), children[1], children[3], children[5])

    def module(self, children: Children) -> tree.Module:
        """Reduce a whole module."""
        return tree.Module(span_of(children), children[1], children[3])

    def datalist(self, children: Children) -> tree.DataList:
        """Reduce a whole data list."""
        return tree.DataList(span_of(children), children[1], nodes_of(children[3:]))

    def declarations(self, children: Children) -> tuple[tree.Declaration, ...]:
        """Reduce the declarations of a program or module."""
        return nodes_of(children)

    def local_declarations(self, children: Children) -> tuple[tree.Declaration, ...]:
        """Reduce the declarations of a routine."""
        return nodes_of(children)

    def system_specification(self, children: Children) -> tree.SystemSpecification:
        """Reduce SYSTEM SPECIFICATION."""
        return tree.SystemSpecification(span_of(children), children[2])

    def import_from(self, children: Children) -> tree.ImportFrom:
        """Reduce FROM .. IMPORT."""
        return tree.ImportFrom(span_of([children[0], children[3][-1]]), children[1], children[3])

    def import_datalist(self, children: Children) -> tree.ImportDatalist:
        """Reduce IMPORT DATALIST."""
        return tree.ImportDatalist(span_of(children), children[2])

    def export(self, children: Children) -> tree.Export:
        """Reduce EXPORT."""
        recipient = children[3] if len(children) > 2 else None
        span = span_of([children[0], recipient or children[1][-1]])
        return tree.Export(span, children[1], recipient)

    def robot_binding(self, children: Children) -> tree.RobotBinding:
        """Reduce ROBOT."""
        return tree.RobotBinding(span_of(children), children[1], children[3])

    def standard_channel(self, children: Children) -> tree.StandardChannel:
        """Reduce STANDARD_IN or STANDARD_OUT."""
        direction = children[0].type.removeprefix("STANDARD_")
        return tree.StandardChannel(span_of(children), direction, children[2])

    def constants(self, children: Children) -> tree.ConstDeclaration:
        """Reduce constants of one type."""
        return tree.ConstDeclaration(span_of(children), children[0], nodes_of(children[2:]))

    def variables(self, children: Children) -> tree.VarDeclaration:
        """Reduce variables of one type."""
        return tree.VarDeclaration(span_of(children), children[0], nodes_of(children[2:]))

    def variable(self, children: Children) -> tree.Variable:
        """Reduce one declared name."""
        return tree.Variable(span_of(children), children[0], children[2] if len(children) > 1 else None)

    def signals(self, children: Children) -> tree.SignalDeclaration:
        """Reduce signals of one kind."""
        words = set(_words(children))
        nodes = nodes_of(children)
        type_name = nodes[0] if isinstance(nodes[0], tree.NamedType) else None
        return tree.SignalDeclaration(
            span_of(children),
            "INPUT" if "INPUT" in words else "OUTPUT",
            "DIGITAL" if "DIGITAL" in words else "ANALOG" if "ANALOG" in words else None,
            type_name,
            nodes[1:] if type_name else nodes,
        )

    def signal(self, children: Children) -> tree.SignalPort:
        """Reduce ``name AT port``."""
        return tree.SignalPort(span_of(children), children[0], children[2])

    def type_definition(self, children: Children) -> tree.TypeDefinition:
        """Reduce ``type = name``."""
        return tree.TypeDefinition(span_of(children), children[0], children[2])

    def type_name(self, children: Children) -> tree.NamedType:
        """Reduce a type's name."""
        return tree.NamedType(span_of(children), children[0])

    def array_type(self, children: Children) -> tree.ArrayType:
        """Reduce ARRAY."""
        return tree.ArrayType(span_of(children), nodes_of(children[:-1]), children[-1])

    def record_type(self, children: Children) -> tree.RecordType:
        """Reduce RECORD."""
        return tree.RecordType(span_of(children), nodes_of(children))

    def field_group(self, children: Children) -> tree.FieldGroup:
        """Reduce fields of one type."""
        return tree.FieldGroup(span_of(children), children[0], nodes_of(children[2:]))

    def field_name(self, children: Children) -> tree.Name:
        """Reduce a field's name, dots and all."""
        names = nodes_of(children)
        if len(names) == 1:
            return names[0]  # type: ignore[no-any-return]
        spelling = ".".join(name.name for name in names)
        return tree.Name(span_of(children), spelling, spelling.casefold())

    def procedure(self, children: Children) -> tree.ProcedureDeclaration:
        """Reduce PROCEDURE."""
        name, parameters, declarations, body = (children[i] for i in (1, 2, 4, 6))
        return tree.ProcedureDeclaration(span_of(children), name, parameters, declarations, body)

    def function(self, children: Children) -> tree.FunctionDeclaration:
        """Reduce FUNCTION."""
        name, parameters, result, declarations, body = (children[i] for i in (1, 2, 4, 6, 8))
        return tree.FunctionDeclaration(span_of(children), name, parameters, result, declarations, body)

    def parameters(self, children: Children) -> tuple[tree.Parameter, ...]:
        """Reduce the parameters of a routine."""
        return nodes_of(children)

    def parameter(self, children: Children) -> tree.Parameter:
        """Reduce parameters of one type and mode."""
        words = _words(children)
        mode: Literal["IN", "VAR"] = "VAR" if "VAR" in words else "IN"
        names = children[-1]
        return tree.Parameter(span_of([children[0], names[-1]]), mode, children[-3], names)
