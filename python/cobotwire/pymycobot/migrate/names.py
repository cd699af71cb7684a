"""Finds the names of a program that stand for arms, and those that stand for their results."""

from __future__ import annotations

import libcst as cst
from libcst.helpers import get_full_name_for_node

from cobotwire.pymycobot.migrate.calls import LibraryClass, library

LIBRARY = "pymycobot"
# What a program does with a list and cannot do with a tuple.
_CHANGING = {"append", "extend", "insert", "remove", "pop", "clear", "sort", "reverse", "copy"}


class Names(cst.CSTVisitor):
    """What the names of a program are.

    Attributes:
        classes: classes of the library by the names that the program gives them.
        several: names that stand for different classes.
        arms: variables and attributes (``self.mc``) that are assigned an arm, with its class.
        results: variables that are assigned the result of a call of an arm.
        lists: those of ``results`` that are used in a way that only a list allows.
    """

    def __init__(self) -> None:
        self.classes: dict[str, str] = {}
        self.several: set[str] = set()
        self.arms: dict[str, LibraryClass] = {}
        self.results: set[str] = set()
        self.lists: set[str] = set()

    def visit_ImportFrom(self, node: cst.ImportFrom) -> None:
        module = get_full_name_for_node(node.module) if node.module else ""
        if (module or "").partition(".")[0] != LIBRARY or isinstance(node.names, cst.ImportStar):
            return
        for alias in node.names:
            name = alias.evaluated_name
            if name in library():
                self.classes[alias.evaluated_alias or name] = name

    def visit_Assign(self, node: cst.Assign) -> None:
        for target in node.targets:
            self._assigned(get_full_name_for_node(target.target), node.value)
            self._changed(target.target)

    def visit_AnnAssign(self, node: cst.AnnAssign) -> None:
        name = get_full_name_for_node(node.target)
        self._annotated(name, node.annotation)
        if node.value is not None:
            self._assigned(name, node.value)

    def visit_Param(self, node: cst.Param) -> None:
        if node.annotation is not None:
            self._annotated(node.name.value, node.annotation)

    def visit_WithItem(self, node: cst.WithItem) -> None:
        if node.asname is not None:
            self._assigned(get_full_name_for_node(node.asname.name), node.item)

    def visit_AugAssign(self, node: cst.AugAssign) -> None:
        self._changed(node.target)
        name = get_full_name_for_node(node.target)
        if name:
            self.lists.add(name)

    def visit_Del(self, node: cst.Del) -> None:
        self._changed(node.target)

    def visit_BinaryOperation(self, node: cst.BinaryOperation) -> None:
        for side in (node.left, node.right):
            name = get_full_name_for_node(side)
            if name:
                self.lists.add(name)

    def visit_Call(self, node: cst.Call) -> None:
        if isinstance(node.func, cst.Attribute) and node.func.attr.value in _CHANGING:
            name = get_full_name_for_node(node.func.value)
            if name:
                self.lists.add(name)

    def _annotated(self, name: str | None, annotation: cst.Annotation) -> None:
        """Note a name with the annotation of a class as an arm of it."""
        kind = get_full_name_for_node(annotation.annotation)
        if name and kind in self.classes:
            self.arms[name] = library()[self.classes[kind]]

    def _assigned(self, name: str | None, value: cst.BaseExpression) -> None:
        other = get_full_name_for_node(value)
        if name and isinstance(value, cst.Name | cst.Attribute) and other in self.arms:
            self.arms[name] = self.arms[other]
        if name and isinstance(value, cst.Name) and other in self.classes:
            self._named(name, self.classes[other])
        if name is None or not isinstance(value, cst.Call):
            return
        called = get_full_name_for_node(value.func) or ""
        if called in self.classes:
            self.arms[name] = library()[self.classes[called]]
        elif called.rpartition(".")[0] in self.arms:
            self.results.add(name)

    def _named(self, name: str, kind: str) -> None:
        """Note a name that a program gives to a class."""
        if self.classes.setdefault(name, kind) != kind:
            self.several.add(name)

    def _changed(self, target: cst.CSTNode) -> None:
        if isinstance(target, cst.Subscript):
            name = get_full_name_for_node(target.value)
            if name:
                self.lists.add(name)
