"""Finds places where a program may behave differently although its calls are rewritten."""

from __future__ import annotations

import libcst as cst
from libcst.helpers import get_full_name_for_node

from cobotwire.pymycobot.migrate import imports
from cobotwire.pymycobot.migrate.calls import library
from cobotwire.pymycobot.migrate.decisions import (
    ATTRIBUTE,
    BY_TEXT,
    ESCAPED,
    INHERITS,
    NEVER_FAILED,
    NOT_STATEMENT,
    UTILITY,
    Decide,
    why_left,
)
from cobotwire.pymycobot.migrate.names import LIBRARY, is_of_library
from cobotwire.pymycobot.migrate.uses import Uses

# Functions that call nothing of an arm.
_HARMLESS = {"bool", "callable", "hash", "id", "isinstance", "print", "repr", "str", "type"}
_RUNNING, _IMPORTING = {"eval", "exec"}, {"__import__", "import_module", "importlib.import_module"}
_STORING = cst.AssignTarget | cst.Param | cst.AsName | cst.NameItem | cst.Del | cst.Annotation
_TESTING = cst.If | cst.While | cst.Assert | cst.Comparison | cst.ComparisonTarget
_PASSING = cst.Assign | cst.AnnAssign | cst.NamedExpr | cst.WithItem | cst.Return | cst.Expr
_PASSING |= cst.IfExp | cst.BooleanOperation | cst.UnaryOperation | cst.Attribute


class Places(cst.CSTVisitor):
    """Notes where an arm cannot be followed, and where a program tests whether a call failed."""

    def __init__(self, uses: Uses, decide: Decide) -> None:
        self._uses = uses
        self.names = names = uses.names
        self._parents = names.keys.parents
        self._decide = decide
        self._imports_library = False
        self._ran = False

    def visit_Import(self, node: cst.Import) -> None:
        for alias in node.names:
            if alias.evaluated_name.partition(".")[0] == LIBRARY:
                what = f"names of `import {alias.evaluated_name}` are not rewritten; "
                self._decide(node, f"{what}write `from {LIBRARY} import ...`, and run this again")

    def visit_ImportFrom(self, node: cst.ImportFrom) -> None:
        if not is_of_library(node):
            return
        self._imports_library = True
        line = self._parents[node]
        if not isinstance(line, cst.SimpleStatementLine) or len(line.body) > 1:
            self._decide(node, NOT_STATEMENT)

    def visit_ClassDef(self, node: cst.ClassDef) -> None:
        for base in node.bases:
            for kind in self.names.kinds(base.value):
                self._decide(node, INHERITS.format(node.name.value, kind))

    def visit_Call(self, node: cst.Call) -> None:
        self._visit_value(node)
        name = get_full_name_for_node(node.func) or ""
        runs = name in _RUNNING and self._imports_library
        runs = runs or (name in _IMPORTING and _names_library(node))
        if runs and not self._ran:
            self._decide(node, BY_TEXT.format(name))
            # Noted once: a program that runs one text as code often runs many.
            self._ran = True

    def visit_Comparison(self, node: cst.Comparison) -> None:
        if self._uses.is_failure_test(node):
            self._decide(node, NEVER_FAILED)

    def visit_Name(self, node: cst.Name) -> None:
        self._visit_value(node)

    def visit_Attribute(self, node: cst.Attribute) -> None:
        self._visit_value(node)
        arms = self.names.arms(node.value)
        # In our classes, check only names that the library has too: they may not be rewritten yet.
        if self.names.is_ours(node.value) and not library()[arms[0]].has(node.attr.value):
            arms = []
        if arms and not self._is_called(node):
            self._decide(node, self._why_not_called(node))
        is_kept = node.attr.value in imports.KEPT["utils"]
        if isinstance(node.value, cst.Name) and self._is_utils(node.value) and not is_kept:
            self._decide(node, UTILITY.format(node.attr.value))

    def _why_not_called(self, node: cst.Attribute) -> str:
        kind, name = library()[self.names.arms(node.value)[0]], node.attr.value
        if kind.call(name):
            return ATTRIBUTE.format(get_full_name_for_node(node) or name)
        return why_left(kind, name)

    def _visit_value(self, node: cst.BaseExpression) -> None:
        """Note an arm that is given to something that cannot be followed."""
        inside = self._parents[node]
        if isinstance(inside, cst.Attribute) and inside.attr is node:
            return
        kinds = self.names.arms(node)
        if kinds and not self._is_followed(node, inside):
            self._decide(node, ESCAPED.format(" or ".join(kinds)))
        if self._uses.is_failure_test(node):
            self._decide(node, NEVER_FAILED)

    def _is_followed(self, node: cst.BaseExpression, inside: cst.CSTNode) -> bool:
        if isinstance(inside, cst.Arg):
            if inside.keyword is node or self.names.parameters(inside):
                return True
            call = self._parents[inside]
            func = call.func if isinstance(call, cst.Call) else None
            return isinstance(func, cst.Name) and func.value in _HARMLESS
        if isinstance(inside, cst.Assign):
            # An arm is followed into names and attributes, but not into elements such as `arms[0]`.
            return all(isinstance(t.target, cst.Name | cst.Attribute) for t in inside.targets)
        return isinstance(inside, _STORING | _TESTING | _PASSING)

    def _is_called(self, node: cst.Attribute) -> bool:
        inside = self._parents[node]
        return isinstance(inside, cst.Call) and inside.func is node

    def _is_utils(self, node: cst.Name) -> bool:
        found = self.names.keys.assigned(node)
        return node.value == "utils" and any(
            isinstance(each, cst.ImportFrom) and is_of_library(each) for each in found
        )


def _names_library(node: cst.Call) -> bool:
    """Return whether an argument is a text that names the library."""
    texts = (each.value for each in node.args)
    return any(isinstance(t, cst.SimpleString) and LIBRARY in t.value for t in texts)
