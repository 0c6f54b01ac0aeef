"""Declarations in the order in which they take effect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from irlx.diagnostics import Related
from irlx.language import tree
from irlx.language.checking.channels import Channels
from irlx.language.checking.context import NOTHING, Typed
from irlx.language.checking.names import Constant, Entry, Names
from irlx.language.checking.type_forms import TypeForms
from irlx.language.data_lists import ImportedList
from irlx.language.references import Access, Reference
from irlx.language.symbols import Routine, Symbol, SymbolKind
from irlx.language.types import BOOL, INT, REAL, UNKNOWN, Parameter, Signature, Type, holds_files, same_type

_SIGNAL_TYPES = (BOOL, INT, REAL)
_FURTHER_DOWN = "; it is declared further down"
_OF_A_LIST = "; it comes from a data list and is a variable, of which constants know nothing"


class Declarations(TypeForms, Channels):
    """Declares what a program, module or routine declares.

    Without `complete`, values that are missing prove nothing: the text may have been left out.
    """

    complete = True
    is_program = False
    _channels: dict[str, tree.StandardChannel]
    modules: Mapping[str, Mapping[str, Symbol]] = MappingProxyType({})
    """What modules export, as far as they are known, by casefolded names."""

    def declare(self, declarations: Sequence[tree.Declaration], lists: Sequence[ImportedList] = ()) -> None:
        """Constants, types in the order of the text, signatures, data lists, signals, variables; channels."""
        self._announce(declarations, lists)
        for part in declarations:
            self._first(part)
        for part in declarations:
            if isinstance(part, tree.ProcedureDeclaration | tree.FunctionDeclaration):
                self._signature(part)
            elif isinstance(part, tree.SignalDeclaration):
                self._signals(part)
        for found in lists:
            self.data_list(found)
        for part in declarations:
            if isinstance(part, tree.VarDeclaration):
                self._variables(part, part.type, part.variables, "variable")
            elif isinstance(part, tree.Export):
                for name in part.names:
                    self._mention(name, "change")
        for part in declarations:
            if isinstance(part, tree.StandardChannel):
                self._mention(part.channel, "change")
                self._standard(part)

    def _first(self, part: tree.Declaration) -> None:
        """Declare what everything else may use."""
        match part:
            case tree.TypeDefinition(name=name):
                self.announced_types = self.announced_types - {name.key}
                self.define(part)
            case tree.ConstDeclaration(type=form, constants=constants):
                self._variables(part, form, constants, "constant")
            case tree.ImportFrom(names=names, module=module):
                for name in names:
                    self._imported(name, part, self.modules.get(module.key, {}).get(name.key))
            case tree.RobotBinding(name=name):
                self._enter(name, "robot", part, UNKNOWN)

    def _imported(self, name: tree.Name, part: tree.Node, found: Symbol | None) -> None:
        """Bring a name of a module in view, with what the module declares it to be."""
        if found is not None and found.kind == "type":
            if name.key and found.type is not None and name.key not in self.names.type_symbols:
                self.set_type(name.key, found.type)
                self.names.type_symbols[name.key] = Symbol(name, "import", part, None, found.type)
            return
        type = found.type if found is not None and found.type is not None else UNKNOWN
        signature = found.signature if found is not None else None
        entry = self._enter(name, "import", part, type, signature=signature)
        if entry is not None and found is not None:
            entry.kind = found.kind
            # The module may set it as well, and others that import it.
            entry.set(None, whole=False)

    def _announce(self, declarations: Sequence[tree.Declaration], lists: Sequence[ImportedList]) -> None:
        """Names to come: whoever uses one before it is there is told so."""
        self.announced_types = {p.name.key for p in declarations if isinstance(p, tree.TypeDefinition)}
        self.announced.clear()
        for found in lists:
            for values in found.tree.declarations:
                self.announced.update((variable.name.key, _OF_A_LIST) for variable in values.variables)
        for part in declarations:
            if isinstance(part, tree.VarDeclaration):
                self.announced.update((variable.name.key, _FURTHER_DOWN) for variable in part.variables)
            elif isinstance(part, tree.ConstDeclaration):
                self.announced.update((constant.name.key, _FURTHER_DOWN) for constant in part.constants)

    def _standard(self, part: tree.StandardChannel) -> None:
        """A standard channel, which is said once."""
        first = self._channels.setdefault(part.direction, part)
        if first is not part:
            related = (Related("said here first", self.place(first)),)
            self.add("IRL202", part, related=related, name=f"STANDARD_{part.direction}")
        self.standard_channel(part, in_program=self.is_program)

    def _mention(self, name: tree.Name, access: Access) -> None:
        entry = self.names.value(name.key)
        symbol = entry.symbol if entry is not None else self.names.type_symbol(name.key)
        if symbol is not None:
            self.references.append(Reference(name.span, symbol, access))

    # ---- variables and constants

    def _variables(
        self,
        part: tree.Declaration,
        form: tree.TypeForm,
        variables: Sequence[tree.Variable],
        kind: SymbolKind,
        text: ImportedList | None = None,
    ) -> None:
        type = self.type_of(form)
        if holds_files(type) and (kind == "constant" or text is not None):
            self.add("IRL267", form, what="a constant" if kind == "constant" else "part of a data list")
            type = UNKNOWN
        for variable in variables:
            found = NOTHING
            if variable.initial is not None:
                found = self.fitted(variable.initial, type)
            elif kind == "constant" and self.complete:
                self.add("IRL251", variable.name, name=variable.name.name)
            self._variable(part, variable, type, kind, found, text)

    def _variable(
        self,
        part: tree.Declaration,
        variable: tree.Variable,
        type: Type,
        kind: SymbolKind,
        found: Typed,
        text: ImportedList | None,
    ) -> None:
        entry = self._enter(variable.name, kind, part, type, text)
        if entry is None or variable.initial is None:
            return
        value = _converted(found.value, type)
        entry.set(value)
        if kind == "constant" and same_type(found.type, type):
            entry.value = value

    def _enter(
        self,
        name: tree.Name,
        kind: SymbolKind,
        part: tree.Node,
        type: Type,
        text: ImportedList | None = None,
        signature: Signature | None = None,
    ) -> Entry | None:
        """Bring a name in view; None for one that is there already, which is told with the names."""
        self.announced.pop(name.key, None)
        if not name.key or name.key in self.names.values:
            return None
        symbol = Symbol(name, kind, part, text.source if text else None, type, signature)
        entry = Entry(kind, type, symbol, signature=signature)
        self.names.values[name.key] = entry
        return entry

    def data_list(self, found: ImportedList) -> None:
        """Declare the values of a data list, which know the types of the program and each other.

        What is referred to inside of it stands in another text than that of the program.
        """
        kept = self.source, self.names, self.references, self.announced
        own = Names(self.names.types)
        own.functions = self.names.functions
        # What a list may not use, and what stands further down in it, is told with its names.
        references = self.references if found.source is self.source else []
        self.source, self.names, self.references, self.announced = found.source, own, references, {}
        for part in found.tree.declarations:
            self._variables(part, part.type, part.variables, "variable", found)
        self.source, self.names, self.references, self.announced = kept
        for key, entry in own.values.items():
            self.names.values.setdefault(key, entry)
            self.announced.pop(key, None)

    # ---- signals

    def _signals(self, part: tree.SignalDeclaration) -> None:
        kind: SymbolKind = "input" if part.direction == "INPUT" else "output"
        type: Type = BOOL if part.medium == "DIGITAL" else REAL
        if part.type is not None:
            type = self.type_of(part.type)
            if not any(same_type(type, possible) for possible in _SIGNAL_TYPES):
                self.mismatch(part.type, "BOOL, INT or REAL for a signal", type.name)
                type = UNKNOWN
        for signal in part.signals:
            self.fitted(signal.port, INT)
            self._enter(signal.name, kind, part, type)

    # ---- signatures

    def _signature(self, routine: Routine) -> None:
        parameters = []
        for parameter in routine.parameters:
            type = self.type_of(parameter.type)
            by_reference = parameter.mode == "VAR"
            if holds_files(type) and not by_reference:
                # Told once, and not for every call as well.
                by_reference = True
                self.add("IRL267", parameter, what="a parameter by value")
            parameters += [Parameter(name.name, (type,), by_reference) for name in parameter.names]
        result = self.type_of(routine.result) if isinstance(routine, tree.FunctionDeclaration) else None
        if result is not None and holds_files(result) and isinstance(routine, tree.FunctionDeclaration):
            self.add("IRL267", routine.result, what="the result of a function")
            result = UNKNOWN
        signature = Signature(routine.name.name, tuple(parameters), result, len(parameters))
        kind: SymbolKind = "procedure" if result is None else "function"
        self._enter(routine.name, kind, routine, result or UNKNOWN, signature=signature)

    def enter_parameters(self, routine: Routine, signature: Signature) -> None:
        """Bring the parameters of a routine in view."""
        types = iter(signature.parameters)
        for parameter in routine.parameters:
            for name in parameter.names:
                entry = self._enter(name, "parameter", parameter, next(types).types[0])
                if entry is not None:
                    entry.set(None, whole=False)


def _converted(value: Constant | None, type: Type) -> Constant | None:
    """A whole number as the REAL that it becomes."""
    whole = isinstance(value, int) and not isinstance(value, bool)
    return float(value) if type is REAL and whole and isinstance(value, int) else value
