"""Finds what the variables and functions of a program may be."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

import libcst as cst
from libcst.helpers import get_full_name_for_node

from cobotwire.pymycobot.migrate.bindings import Bindings
from cobotwire.pymycobot.migrate.calls import Call, counterparts, library
from cobotwire.pymycobot.migrate.keys import Key, Keys
from cobotwire.pymycobot.migrate.values import (
    NONE,
    UNKNOWN,
    Arm,
    Instance,
    Kind,
    Result,
    Value,
    Values,
)

LIBRARY = "pymycobot"
_NOTHING: Values = frozenset()
# A rewritten program calls these to convert a result of ours to the library's.
_CONVERSIONS = {"int", "list", "map"}


class Names:
    """What the names in a program stand for: classes of the library, arms, results of arms."""

    def __init__(self, keys: Keys, found: Bindings) -> None:
        self.keys = keys
        keys.stored |= found.imported
        self._found = found
        self._bound: dict[Key, Values] = {}
        # The methods of a class and of those that inherit from it have one key.
        self._functions: dict[Key, list[cst.FunctionDef]] = defaultdict(list)
        for each in found.functions:
            self._functions[keys.function_key(each)].append(each)
        # In the first pass, a name without known values has no values; in the second, it is
        # unknown.
        for unbound in (_NOTHING, frozenset({UNKNOWN})):
            before = None
            while before != self._bound:
                before = dict(self._bound)
                self._bind(unbound)

    def key(self, node: cst.CSTNode) -> Key | None:
        """Return the key of a name or of an attribute; None if the node is something else."""
        if isinstance(node, cst.Name):
            return self.keys.key(node)
        if not isinstance(node, cst.Attribute):
            return None
        owners = [each.key for each in self.values(node.value) if isinstance(each, Instance)]
        owner = owners[0] if len(owners) == 1 else self.keys.owner(node.value)
        before = owner or self.key(node.value)
        return before and (*before, node.attr.value)

    def values(self, node: cst.CSTNode) -> Values:
        """Return everything that an expression may be."""
        if isinstance(node, cst.Name):
            return frozenset({NONE}) if node.value == "None" else self._of_name(node)
        if isinstance(node, cst.Attribute):
            return self._bound.get(self.key(node) or (), _NOTHING)
        if isinstance(node, cst.IfExp):
            return self.values(node.body) | self.values(node.orelse)
        if isinstance(node, cst.BooleanOperation):
            return self.values(node.left) | self.values(node.right)
        if isinstance(node, cst.NamedExpr):
            return self.values(node.value)
        return self._of_call(node) if isinstance(node, cst.Call) else frozenset({UNKNOWN})

    def arms(self, node: cst.CSTNode) -> list[str]:
        """Return the classes of the library whose objects an expression may be."""
        return sorted(each.kind for each in self.values(node) if isinstance(each, Arm))

    def kinds(self, node: cst.CSTNode) -> list[str]:
        """Return the classes of the library that an expression may be."""
        return sorted(each.name for each in self.values(node) if isinstance(each, Kind))

    def is_ours(self, node: cst.CSTNode) -> bool:
        """Return whether an expression may be a class of ours, or an object of one."""
        return any(isinstance(v, Kind | Arm) and v.ours for v in self.values(node))

    def classes(self) -> list[str]:
        """Return the names by which the program knows classes of arms."""
        return sorted({name for each in self._found.from_imports for name, _ in _kinds(each)})

    def is_only(self, node: cst.CSTNode, kind: type[Value]) -> bool:
        """Return whether an expression has only values of a kind, or None."""
        return all(isinstance(each, kind) for each in self.values(node) - {NONE})

    def arm_names(self, methods: frozenset[str]) -> set[str]:
        """Return the names (after the last dot) of arms, and of objects with these methods."""
        arms = (key for key, found in self._bound.items() if any(isinstance(v, Arm) for v in found))
        found = {str(key[-1]) for key in arms}
        for call in self._found.calls:
            if isinstance(call.func, cst.Attribute) and call.func.attr.value in methods:
                name = get_full_name_for_node(call.func.value) or ""
                found.add(name.rpartition(".")[2])
        return found

    def called(self, node: cst.CSTNode) -> list[Call]:
        """Return the methods of the library that a node may call."""
        if not isinstance(node, cst.Call) or not isinstance(node.func, cst.Attribute):
            return []
        name = node.func.attr.value
        kinds = [library()[kind] for kind in self.arms(node.func.value)]
        found = [kind.call(name) for kind in kinds]
        if self.is_ours(node.func.value):
            found = [call or kind.called(name) for kind, call in zip(kinds, found)]
        return [each for each in found if each]

    def parameters(self, argument: cst.Arg) -> list[cst.Param]:
        """Return the parameters that take an argument, in each function that may be called.

        The list is empty if the function is not defined in this program, or hides the argument.
        """
        call = self.keys.parents.get(argument)
        functions = self._called(call) if isinstance(call, cst.Call) and not argument.star else []
        found = [
            self._parameter(each, cst.ensure_type(call, cst.Call), argument) for each in functions
        ]
        return [each for each in found if each] if all(found) else []

    def _parameter(
        self, function: cst.FunctionDef, call: cst.Call, argument: cst.Arg
    ) -> cst.Param | None:
        taken = function.params.params[1 if self.keys.class_of(function) else 0 :]
        if argument.keyword is not None:
            every = (*taken, *function.params.kwonly_params)
            named = [each for each in every if each.name.value == argument.keyword.value]
            return named[0] if named else None
        at = call.args.index(argument)
        starred = any(each.star for each in call.args[:at])
        return taken[at] if at < len(taken) and not starred else None

    def _of_name(self, node: cst.Name) -> Values:
        imported = {
            kind
            for each in self.keys.assigned(node)
            if isinstance(each, cst.ImportFrom)
            for name, kind in _kinds(each)
            if node.value == name
        }
        return self._bound.get(self.keys.key(node), _NOTHING) | imported

    def _of_call(self, node: cst.Call) -> Values:
        owner, functions = self._class(node), self._called(node)
        if owner is not None:
            return frozenset({Instance(self.keys.class_key(owner))})
        if functions:
            returned = (self._bound.get(_returned(each), _NOTHING) for each in functions)
            return frozenset().union(*returned)
        if isinstance(node.func, cst.Name) and node.func.value in _CONVERSIONS and node.args:
            return frozenset(v for v in self.values(node.args[-1].value) if isinstance(v, Result))
        made = self._objects(node.func)
        results = frozenset(Result(each.gives) for each in self.called(node))
        return made | results or frozenset({UNKNOWN})

    def _called(self, node: cst.Call) -> list[cst.FunctionDef]:
        """Return the functions of this program that a call may call."""
        owner = self._class(node)
        key = (*self.keys.class_key(owner), "__init__") if owner else self.key(node.func)
        found = self._functions.get(key or (), [])
        return [] if any(each.decorators or each.asynchronous for each in found) else found

    def _class(self, node: cst.Call) -> cst.ClassDef | None:
        """Return the class of this program that is called."""
        found = self.keys.assigned(node.func) if isinstance(node.func, cst.Name) else []
        return found[0] if len(found) == 1 and isinstance(found[0], cst.ClassDef) else None

    def _bind(self, unbound: Values) -> None:
        for target, annotation in self._found.annotated:
            self._note(target, self._objects(annotation))
        for target, value in self._found.assigned:
            found = frozenset({UNKNOWN}) if value is None else self.values(value)
            self._note(target, found or unbound)
        for function, returned in self._found.returns.items():
            key = _returned(function)
            self._bound[key] = self._bound.get(key, _NOTHING).union(*map(self.values, returned))
        given: dict[cst.Param, Values] = {}
        for call in self._found.calls:
            for argument in call.args:
                for parameter in self.parameters(argument):
                    given[parameter] = given.get(parameter, _NOTHING) | self.values(argument.value)
        for function in self._found.functions:
            for parameter in (*function.params.params, *function.params.kwonly_params):
                self._note(parameter.name, self._of_parameter(parameter, given))

    def _of_parameter(self, node: cst.Param, given: dict[cst.Param, Values]) -> Values:
        annotated = self._objects(node.annotation.annotation) if node.annotation else _NOTHING
        if annotated:
            return annotated
        default = self.values(node.default) if node.default else _NOTHING
        return default | given.get(node, frozenset({UNKNOWN}))

    def _objects(self, node: cst.CSTNode) -> Values:
        """Return the arms that the classes of an expression make."""
        return frozenset(Arm(*each) for each in self.values(node) if isinstance(each, Kind))

    def _note(self, target: cst.CSTNode, values: Iterable[Value]) -> None:
        key = self.key(target)
        if key is not None:
            self._bound[key] = self._bound.get(key, _NOTHING) | frozenset(values)


def _returned(node: cst.FunctionDef) -> Key:
    """Return the key of what a function returns."""
    return ("returned", id(node))


def _kinds(node: cst.ImportFrom) -> Iterable[tuple[str, Kind]]:
    """Return the classes that a line imports from the library, or from this package, by name."""
    ours = not node.relative and _module(node) == "cobotwire"
    if isinstance(node.names, cst.ImportStar) or not (ours or is_of_library(node)):
        return
    for alias in node.names:
        name = alias.evaluated_name
        name = counterparts().get(name, "") if ours else name
        if name in library():
            yield alias.evaluated_alias or alias.evaluated_name, Kind(name, ours)


def is_of_library(node: cst.ImportFrom) -> bool:
    """Return whether a line imports names of the library."""
    return _module(node).partition(".")[0] == LIBRARY and not node.relative


def _module(node: cst.ImportFrom) -> str:
    return (get_full_name_for_node(node.module) or "") if node.module else ""
