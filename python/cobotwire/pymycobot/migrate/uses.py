"""Find how a program uses the results of calls, and whether our results work there as well."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

import libcst as cst
from libcst import matchers

from cobotwire.pymycobot.migrate.calls import library
from cobotwire.pymycobot.migrate.names import Names
from cobotwire.pymycobot.migrate.values import Result

# Functions that return the same for a tuple as for a list of the same items.
_OF_ROWS = {"all", "any", "enumerate", "len", "list", "map", "max", "min", "reversed", "set"}
_OF_ROWS |= {"sorted", "sum", "tuple", "zip"}
# Operators for which False and True are 0 and 1.
_OF_NUMBERS = cst.Add | cst.Subtract | cst.Multiply | cst.Divide | cst.FloorDivide
_KINDS = {"isinstance", "type"}
# What the library returns if a call fails; some methods return an empty list.
_FAILURES = {"-1", "None", "[]", "()", "''", '""'}
# Methods of arms that many other classes have, too.
_COMMON = {"close", "is_open", "open", "pause", "resume", "stop", "wait"}


@lru_cache
def _methods() -> frozenset[str]:
    """Return the methods of all classes of the library, except those in ``_COMMON``."""
    return frozenset(name for kind in library().values() for name in kind.methods) - _COMMON


_LENGTH = matchers.Name("len")


class Use(NamedTuple):
    """A use of a value: the expression that has the value, and the node that contains it."""

    node: cst.CSTNode
    inside: cst.CSTNode


class Uses:
    """Finds where a program uses the results of its calls."""

    def __init__(self, names: Names) -> None:
        self.names = names
        self._parents = names.keys.parents
        self._stored = names.keys.stored
        # Names of arms, and of other objects on which methods of arms are called.
        self._arm_names = names.arm_names(_methods())

    def of(self, node: cst.CSTNode) -> list[Use]:
        """Return where the value of an expression is used; nothing if it is dropped."""
        return list(self._follow(node, set()))

    def is_proven(self, use: Use, form: str) -> bool:
        """Return whether a use has the same effect with our result as with the library's.

        Our result is a named tuple if ``form`` is ``list``, and a flag or an enum if it is ``int``.
        """
        return self._is_safe_row(use) if form == "list" else self._is_safe_number(use)

    def is_converted(self, use: Use, form: str) -> bool:
        """Return whether the program itself converts a result of ours to the library's form."""
        call = self._parents[use.inside]
        if not isinstance(use.inside, cst.Arg) or not isinstance(call, cst.Call):
            return False
        made = matchers.Call(matchers.Name("int"))
        if form == "ints":
            made = matchers.Call(
                matchers.Name("map"), [matchers.Arg(matchers.Name("int")), matchers.Arg()]
            )
        return matchers.matches(call, made)

    def is_failure_test(self, node: cst.CSTNode) -> bool:
        """Return whether an expression tests whether a call of an arm failed."""
        if isinstance(node, cst.Comparison):
            sides = [node.left, *(each.comparator for each in node.comparisons)]
            forms = {form for side in sides for form in self._forms(side)}
            found = bool(forms) and (any(map(_may_be_failure, sides)) or _tests_sign(node))
            return found or any(map(self._is_length, sides))
        if isinstance(node, cst.Call) and isinstance(node.func, cst.Name):
            given = node.args[:1] if node.func.value in _KINDS else ()
            if any(self._forms(each.value) for each in given):
                return True
        return "list" in self._forms(node) and self._is_condition(Use(node, self._parents[node]))

    def may_be_arm(self, node: cst.BaseExpression, method: str) -> bool:
        """Return whether an unknown value may be an arm, given the method that is called on it."""
        name = node.attr if isinstance(node, cst.Attribute) else node
        like_arm = isinstance(name, cst.Name) and name.value in self._arm_names
        if self.names.kinds(node) or self._is_result(node) or self._is_device(node):
            return False
        return method in _methods() or (like_arm and method in _COMMON)

    def _is_result(self, node: cst.BaseExpression) -> bool:
        """Return whether a value is the result of an arm's method; its uses are listed anyway."""
        func = node.func if isinstance(node, cst.Call) else None
        return isinstance(func, cst.Attribute) and bool(self.names.arms(func.value))

    def _is_device(self, node: cst.BaseExpression) -> bool:
        """Return whether a value is a device of an arm of ours: ``arm.left`` or ``arm.at(1)``."""
        found = node.func if isinstance(node, cst.Call) else node
        return isinstance(found, cst.Attribute) and self.names.is_ours(found.value)

    def is_hidden(self, name: str) -> bool:
        """Return whether the program uses the name of a built-in function for something else."""
        return name in self._stored

    def _follow(self, node: cst.CSTNode, seen: set[cst.CSTNode]) -> Iterator[Use]:
        inside = self._parents[node]
        if isinstance(inside, cst.Expr) or node in seen:
            return
        seen.add(node)
        targets = [each.target for each in getattr(inside, "targets", ())]
        if isinstance(inside, cst.NamedExpr):
            yield from self._follow(inside, seen)
            targets = [inside.target]
        elif not isinstance(inside, cst.Assign) or not all(map(_is_name, targets)):
            yield Use(node, inside)
            return
        for target in targets:
            for load in self.names.keys.loads.get(self.names.key(target) or (), ()):
                yield from self._follow(load, seen)

    def _forms(self, node: cst.CSTNode) -> set[str]:
        """Return the forms of the results that an expression may evaluate to."""
        found = (each.form for each in self.names.values(node) if isinstance(each, Result))
        return {form for form in found if form != "nothing"}

    def _is_length(self, node: cst.CSTNode) -> bool:
        if not isinstance(node, cst.Call) or not matchers.matches(node.func, _LENGTH):
            return False
        return any("list" in self._forms(each.value) for each in node.args)

    def _is_safe_row(self, use: Use) -> bool:
        node, inside = use
        if isinstance(inside, cst.Subscript):
            is_item = all(isinstance(each.slice, cst.Index) for each in inside.slice)
            return is_item and self.names.keys.is_read(inside)
        if isinstance(inside, cst.Assign):
            return isinstance(inside.targets[0].target, cst.Tuple)
        if isinstance(inside, cst.For | cst.CompFor):
            return inside.iter is node
        if isinstance(inside, cst.Arg):
            return inside.star == "*" or self._is_known(self._parents[inside])
        return self._is_condition(use)

    def _is_known(self, call: cst.CSTNode) -> bool:
        """Return whether a function or a method of an arm is called that takes any sequence."""
        if not isinstance(call, cst.Call):
            return False
        if isinstance(call.func, cst.Name):
            return call.func.value in _OF_ROWS and not self.is_hidden(call.func.value)
        return bool(self.names.called(call))

    def _is_safe_number(self, use: Use) -> bool:
        inside = use.inside
        if isinstance(inside, cst.ComparisonTarget):
            return not isinstance(inside.operator, cst.Is | cst.IsNot)
        if isinstance(inside, cst.Comparison):
            return not any(isinstance(e.operator, cst.Is | cst.IsNot) for e in inside.comparisons)
        if isinstance(inside, cst.BinaryOperation):
            return isinstance(inside.operator, _OF_NUMBERS)
        return isinstance(inside, cst.Index) or self._is_condition(use)

    def _is_condition(self, use: Use) -> bool:
        """Return whether only the truth of a value is used."""
        node, inside = use
        if isinstance(inside, cst.If | cst.While | cst.Assert):
            return True
        if isinstance(inside, cst.IfExp):
            return inside.test is node
        if isinstance(inside, cst.UnaryOperation):
            return isinstance(inside.operator, cst.Not)
        if isinstance(inside, cst.BooleanOperation):
            return self._is_condition(Use(inside, self._parents[inside]))
        return False


def _is_name(node: cst.CSTNode) -> bool:
    return isinstance(node, cst.Name)


def _may_be_failure(node: cst.CSTNode) -> bool:
    """Return whether an expression is, or contains, a value that the library returns on failure."""
    if isinstance(node, cst.Tuple | cst.List | cst.Set) and node.elements:
        return any(_may_be_failure(each.value) for each in node.elements)
    return cst.Module([]).code_for_node(node) in _FAILURES


def _tests_sign(node: cst.Comparison) -> bool:
    """Return whether a comparison distinguishes negative numbers from others."""
    for each in node.comparisons:
        is_zero = isinstance(each.comparator, cst.Integer) and each.comparator.value == "0"
        if is_zero and isinstance(each.operator, cst.LessThan | cst.GreaterThanEqual):
            return True
    return False
