"""Names the variables of a program: the same key is the same variable."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import libcst as cst
from libcst.metadata import (
    Assignment,
    CodeRange,
    ExpressionContext,
    ExpressionContextProvider,
    MetadataWrapper,
    ParentNodeProvider,
    PositionProvider,
    ScopeProvider,
)

Key = tuple[object, ...]


class Keys:
    """The variables of a program: names by their scope, attributes of ``self`` by their class.

    Attributes:
        parents: the parent of each node.
        positions: where each node is.
        loads: where the program reads each variable that is a plain name.
        stored: the plain names to which the program assigns.
    """

    def __init__(self, wrapper: MetadataWrapper) -> None:
        found: Any = wrapper.resolve_many(
            [ParentNodeProvider, ScopeProvider, ExpressionContextProvider, PositionProvider]
        )
        self.parents: Mapping[cst.CSTNode, cst.CSTNode] = found[ParentNodeProvider]
        self.positions: Mapping[cst.CSTNode, CodeRange] = found[PositionProvider]
        self._scopes: Mapping[cst.CSTNode, Any] = found[ScopeProvider]
        self._contexts: Mapping[cst.CSTNode, Any] = found[ExpressionContextProvider]
        self.loads: dict[Key, list[cst.Name]] = {}
        self.stored: set[str] = set()
        for node, context in self._contexts.items():
            if not isinstance(node, cst.Name):
                continue
            if context is ExpressionContext.LOAD:
                self.loads.setdefault(self.key(node), []).append(node)
            else:
                self.stored.add(node.value)

    def is_read(self, node: cst.CSTNode) -> bool:
        """Return whether a name, an attribute or an item is read, not changed."""
        return self._contexts.get(node) is ExpressionContext.LOAD

    def assigned(self, node: cst.Name) -> list[cst.CSTNode]:
        """Return the nodes that give a name its value."""
        return [each.node for each in self._assignments(node) if isinstance(each, Assignment)]

    def key(self, node: cst.Name) -> Key:
        """Return the key of a name."""
        scopes = {id(each.scope) for each in self._assignments(node)}
        return (min(scopes, default=0), node.value)

    def class_key(self, node: cst.ClassDef) -> Key:
        """Return the key of a class; for a class of the program, the key of its first base."""
        for base in node.bases:
            found = self.assigned(base.value) if isinstance(base.value, cst.Name) else []
            if len(found) == 1 and isinstance(found[0], cst.ClassDef) and found[0] is not node:
                return self.class_key(found[0])
        return ("class", id(node))

    def function_key(self, node: cst.FunctionDef) -> Key:
        """Return the key by which a function is called."""
        owner = self.class_of(node)
        return (*self.class_key(owner), node.name.value) if owner else self.key(node.name)

    def class_of(self, node: cst.FunctionDef) -> cst.ClassDef | None:
        """Return the class that a function is a method of."""
        block = self.parents.get(node)
        owner = self.parents.get(block) if isinstance(block, cst.IndentedBlock) else None
        return owner if isinstance(owner, cst.ClassDef) else None

    def function_of(self, node: cst.CSTNode) -> cst.FunctionDef | None:
        """Return the function that a node is a parameter of."""
        found = self.parents.get(self.parents.get(node, node))
        return found if isinstance(found, cst.FunctionDef) else None

    def owner(self, node: cst.CSTNode) -> Key | None:
        """Return the key of the class, if a node is the first parameter of a method of it."""
        for given in self.assigned(node) if isinstance(node, cst.Name) else ():
            parameters = self.parents.get(given)
            if not isinstance(given, cst.Param) or not isinstance(parameters, cst.Parameters):
                continue
            function = self.parents.get(parameters)
            owner = self.class_of(function) if isinstance(function, cst.FunctionDef) else None
            if owner and next(iter(parameters.params), None) is given:
                return self.class_key(owner)
        return None

    def _assignments(self, node: cst.Name) -> list[Any]:
        scope = self._scopes.get(node)
        return list(scope[node.value]) if scope is not None else []
