"""Collects where a program gives values to names."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

import libcst as cst


class Bindings(cst.CSTVisitor):
    """Where a program gives values to names, calls functions, and returns values."""

    def __init__(self) -> None:
        self.assigned: list[tuple[cst.CSTNode, cst.BaseExpression | None]] = []
        self.annotated: list[tuple[cst.CSTNode, cst.BaseExpression]] = []
        self.calls: list[cst.Call] = []
        self.functions: list[cst.FunctionDef] = []
        self.from_imports: list[cst.ImportFrom] = []
        self.returns: dict[cst.FunctionDef, list[cst.BaseExpression]] = defaultdict(list)
        # Names that imports bind, except modules under their own names.
        self.imported: set[str] = set()
        self._inside: list[cst.FunctionDef] = []

    def visit_Import(self, node: cst.Import) -> None:
        self._import(alias for alias in node.names if alias.asname)

    def visit_ImportFrom(self, node: cst.ImportFrom) -> None:
        self.from_imports.append(node)
        if not isinstance(node.names, cst.ImportStar):
            self._import(node.names)

    def _import(self, aliases: Iterable[cst.ImportAlias]) -> None:
        self.imported |= {each.evaluated_alias or each.evaluated_name for each in aliases}

    def visit_Assign(self, node: cst.Assign) -> None:
        for target in node.targets:
            self._assign(target.target, node.value)

    def visit_AnnAssign(self, node: cst.AnnAssign) -> None:
        self.annotated.append((node.target, node.annotation.annotation))
        if node.value is not None:
            self._assign(node.target, node.value)

    def visit_NamedExpr(self, node: cst.NamedExpr) -> None:
        self._assign(node.target, node.value)

    def visit_WithItem(self, node: cst.WithItem) -> None:
        if node.asname is not None:
            self._assign(node.asname.name, node.item)

    def visit_AugAssign(self, node: cst.AugAssign) -> None:
        self._assign(node.target, None)

    def visit_For(self, node: cst.For) -> None:
        self._assign(node.target, None)

    def visit_CompFor(self, node: cst.CompFor) -> None:
        self._assign(node.target, None)

    def visit_Call(self, node: cst.Call) -> None:
        self.calls.append(node)

    def visit_FunctionDef(self, node: cst.FunctionDef) -> None:
        self.functions.append(node)
        self._inside.append(node)

    def leave_FunctionDef(self, original_node: cst.FunctionDef) -> None:
        self._inside.pop()

    def visit_Return(self, node: cst.Return) -> None:
        if self._inside and node.value is not None:
            self.returns[self._inside[-1]].append(node.value)

    def _assign(self, target: cst.CSTNode, value: cst.BaseExpression | None) -> None:
        if not isinstance(target, cst.Tuple | cst.List):
            self.assigned.append((target, value))
            return
        given: list[cst.BaseExpression | None] = [None] * len(target.elements)
        if isinstance(value, cst.Tuple | cst.List) and len(value.elements) == len(given):
            given = [each.value for each in value.elements]
        for element, part in zip(target.elements, given, strict=True):
            self._assign(element.value, part)
