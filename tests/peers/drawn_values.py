"""Draw arguments from what the maker's library documents and checks, not from our ranges.

Sources are the numbers in a method's docstring and in the library's check of a parameter, its table
of limits, and the bounds of bytes and words.
"""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Iterator
from functools import cache
from itertools import chain
from typing import Any, NamedTuple

from pymycobot_classes import RobotLimit
from robots.comparison import calls_of
from robots.robot import Call, Robot

# The limits of bytes and words; then values between two steps, which the maker's classes truncate.
EDGES: tuple[int, ...] = (-32769, -32768, -129, -128, -1, 0, 1, 127, 128, 254, 255, 256)
EDGES += (4095, 4096, 4097, 32767, 32768, 65535, 65536)
OFF_STEP = (0.29, 12.37, -0.5)
# Registers and pins are small numbers; the library often allows only some of them.
SMALL = range(61)
_LISTED = re.compile("address|data_id|pin")
# How many calls of a method are varied at most, by replacing one argument.
MOST_BASES = 2
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
# Names of checks that compare a number with the table of limits.
_LIMITED = re.compile("angle|coord|degree|increment")
_LARGEST = 1e6


class Drawn(NamedTuple):
    """A call with a drawn argument; ``label`` is the value, or a list's index and value."""

    method: str
    parameter: str
    label: Any
    arguments: dict[str, Any]


def drawn(robot: Robot, peer: Any, methods: list[str]) -> Iterator[Drawn]:
    """Draw each argument of some methods, in calls from the edition's table or the robot's own."""
    by_method: dict[str, list[Call]] = {}
    for call in calls_of(robot):
        by_method.setdefault(call.method, []).append(call)
    for method in methods:
        yield from _of_method(peer, method, by_method.get(method, []))


def _of_method(peer: Any, method: str, calls: list[Call]) -> Iterator[Drawn]:
    signature = inspect.signature(getattr(peer, method))
    bases = [base for call in calls if (base := _bound(signature, call)) is not None]
    for at, base in enumerate(bases[:: -(-len(bases) // MOST_BASES) or 1]):
        for name, parameter in signature.parameters.items():
            if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
                continue
            given = base.get(name, parameter.default)
            for label, value in _variations(peer, method, name, given, wide=at == 0):
                yield Drawn(method, name, label, {**base, name: value})


def _bound(signature: inspect.Signature, call: Call) -> dict[str, Any] | None:
    try:
        return dict(signature.bind(*call.theirs).arguments)
    except TypeError:
        return None


def _variations(
    peer: Any, method: str, name: str, given: Any, *, wide: bool
) -> Iterator[tuple[Any, Any]]:
    """Return values for one argument, each with its label."""
    kind: Any = type(peer)
    if isinstance(given, list):
        if not wide:
            return
        yield from (("[shorter]", given[:-1]), ("[longer]", [*given, *given[-1:]]))
        for index in sorted({0, len(given) // 2, len(given) - 1} - {-1}):
            for value in sorted({*stated(kind, method, name, index), *EDGES, *OFF_STEP}):
                yield f"[{index}]={value}", [*given[:index], value, *given[index + 1 :]]
    elif not isinstance(given, str):
        found = stated(kind, method, name)
        small = SMALL if _LISTED.search(name) else ()
        for value in sorted({*found, *EDGES, *small, *OFF_STEP} if wide else found):
            yield value, value
        if wide:
            yield None, None


@cache
def stated(kind: Any, method: str, name: str, index: int | None = None) -> frozenset[float]:
    """Return the numbers that the library states for a parameter, and their neighbours.

    For an element of a list, ``index`` says which; the table of limits has a number for each.
    """
    text = inspect.getdoc(getattr(kind, method)) or ""
    found = {float(each) for each in _NUMBER.findall(text)}
    checks = _checks(kind, method, name)
    found |= set(chain.from_iterable(_checked().get(check, ()) for check in checks))
    if index is not None or any(_LIMITED.search(check) for check in checks):
        found |= _limits(kind, index)
    near = {each + step for each in found if abs(each) < _LARGEST for step in (-1, 0, 1)}
    near |= {-each for each in near}
    return frozenset(int(each) if each == int(each) else each for each in near)


@cache
def _limits(kind: Any, index: int | None) -> set[float]:
    """Return the numbers of the library's table of limits for a class, or for an index."""
    rows = [r for r in RobotLimit.robot_limit.get(kind.__name__, {}).values() if _is_row(r)]
    which = slice(None) if index is None else slice(index, index + 1)
    return {float(each) for row in rows for each in row[which]}


def _is_row(value: Any) -> bool:
    return isinstance(value, list) and all(_is_number(each) for each in value)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float)


def _checks(kind: type, method: str, name: str) -> list[str]:
    """Return the names under which a method has the library check a parameter."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(getattr(kind, method))))
    calls = (each for each in ast.walk(tree) if isinstance(each, ast.Call))
    words = (word for call in calls for word in call.keywords if isinstance(word.value, ast.Name))
    return [word.arg for word in words if word.arg and word.value.id == name]  # type: ignore[attr-defined]


@cache
def _checked() -> dict[str, set[float]]:
    """Return the numbers in the library's checks of parameters, by the names that it checks."""
    from pymycobot import error

    found: dict[str, set[float]] = {}
    for node in ast.walk(ast.parse(inspect.getsource(error))):
        if isinstance(node, ast.If) and _tests_name(node.test):
            inner = [each for part in node.body for each in ast.walk(part)]
            constants = [each.value for each in inner if isinstance(each, ast.Constant)]
            numbers = {float(each) for each in constants if isinstance(each, int | float)}
            for each in ast.walk(node.test):
                if isinstance(each, ast.Constant) and isinstance(each.value, str):
                    found.setdefault(each.value, set()).update(numbers)
    return found


def _tests_name(test: ast.expr) -> bool:
    return any(isinstance(each, ast.Name) and each.id == "parameter" for each in ast.walk(test))
