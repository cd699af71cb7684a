"""Makes the classes with the maker's names from what the generator states about them.

A method is a plain Python function with the library's parameters. So Python itself rejects wrong
arguments, and ``inspect`` and ``help`` show the parameters.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from types import CellType, CodeType, FunctionType
from typing import Any

from cobotwire.client import Client
from cobotwire.pymycobot.layer.calling import Method
from cobotwire.pymycobot.layer.client import CompatibleClient
from cobotwire.pymycobot.layer.stated import Row, class_row, methods

# Each parameter, its annotation, and its default if it has one.
Parameters = tuple[tuple[Any, ...], ...]

_ERRORS = (("errors", "OnFailure | None", None),)
_made: dict[str, type] = {}


def class_named(name: str) -> type:
    """Return a class of the layer; make it, if it was not used before.

    Raises:
        AttributeError: there is no such class.
    """
    if name not in _made:
        # Two threads that make a class at the same time get the same one.
        _made.setdefault(name, _class(class_row(name)))
    return _made[name]


def _class(row: Row) -> type:
    name = row["name"]
    bases = [_helper(*each) for each in row.get("helpers", ())]
    if "like" in row:
        bases.append(class_named(row["like"]))
    body: dict[str, Any] = {
        "__module__": f"cobotwire.pymycobot.{row['module']}",
        "__doc__": row["doc"],
        "NATIVE": _client(row["edition"]),
    }
    if "elsewhere" in row:
        body |= {"ELSEWHERE": _client(row["elsewhere"]), "PORTS": row["ports"]}
    if "one_way" in row:
        body["ONE_WAY"] = row["one_way"]
    functions = [_constructor(row), *map(_method, methods(row))]
    for function in functions:
        function.__module__ = body["__module__"]
        function.__qualname__ = f"{name}.{function.__name__}"
        body[function.__name__] = function
    return type(name, tuple(bases or [CompatibleClient]), body)


def _helper(module: str, name: str) -> type:
    found: type = getattr(import_module(f"cobotwire.pymycobot.layer.{module}"), name)
    return found


def _client(edition: str) -> type[Client]:
    found: type[Client] = import_module(f"cobotwire.editions.{edition}").CLIENT
    return found


def _constructor(row: Row) -> FunctionType:
    opening = f"_open_{row['opens']}"
    names = [name for name, *_ in row["constructor"]]
    debug = names.index("debug") if "debug" in names else None

    def construct(self: Any, *given: Any) -> None:
        shown = debug is not None and given[debug]
        getattr(self, opening)(given[0], given[1], shown, given[-1])

    doc = "Open the arm; see :class:`CompatibleClient`."
    return _function("__init__", doc, construct, row["constructor"], _ERRORS, "None")


def _method(method: Method) -> FunctionType:
    return _function(method.name, method.doc, method, method.parameters, (), "Any")


def _function(
    name: str,
    doc: str,
    do: Callable[..., Any],
    parameters: Parameters,
    named: Parameters,
    returns: str,
) -> FunctionType:
    """Return a method that calls ``do`` with its object and all arguments, in their order.

    ``named`` are parameters that are given by name only; ``returns`` annotates the result.
    """
    every = parameters + named
    # The only other way to make a function with given parameter names is to compile text.
    code = _CODES[len(every)].replace(
        co_name=name,
        co_varnames=("self", *(each for each, *_ in every)),
        co_argcount=1 + len(parameters),
        co_kwonlyargcount=len(named),
    )
    defaults = tuple(default for _, _, *given in parameters for default in given)
    made = FunctionType(code, globals(), name, defaults or None, (CellType(do),))
    made.__doc__ = doc
    if named:
        made.__kwdefaults__ = {each: default for each, _, default in named}
    made.__annotations__ = {**{each: kind for each, kind, *_ in every}, "return": returns}
    return made


def _codes(do: Callable[..., Any]) -> list[CodeType]:
    """Return the code of methods that pass 0 to 6 parameters to a function."""
    methods: list[Callable[..., Any]] = [
        lambda self: do(self),
        lambda self, a: do(self, a),
        lambda self, a, b: do(self, a, b),
        lambda self, a, b, c: do(self, a, b, c),
        lambda self, a, b, c, d: do(self, a, b, c, d),
        lambda self, a, b, c, d, e: do(self, a, b, c, d, e),
        lambda self, a, b, c, d, e, f: do(self, a, b, c, d, e, f),
    ]
    return [method.__code__ for method in methods]


# Each function gets another ``do``.
_CODES = _codes(print)
