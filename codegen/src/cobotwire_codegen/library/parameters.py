"""Types the parameters of the library's methods and constructors."""

from __future__ import annotations

import re
from itertools import zip_longest

from cobotwire_codegen.library.model import QUIET, LibraryClass, Method, Parameter
from cobotwire_codegen.render.arguments import Argument, arguments

# Parameters of constructors besides those that say what to open. Only ``debug`` has an effect.
_OPTIONS = {
    "debug": "bool",
    "save_serial_log": "bool",
    "thread_lock": "bool",
    "timeout": "float",
}
_ENUM = re.compile(r"\b[A-Z]\w* \| int\b")
Typed = list[tuple[Parameter, str]]


def of_constructor(given: LibraryClass) -> Typed:
    """Return the parameters of a class, each with its annotation."""
    types = ["str", "int" if given.opens == "socket" else "str | int"]
    typed = []
    for parameter, kind in zip_longest(given.constructor, types, fillvalue=""):
        assert isinstance(parameter, Parameter), "a constructor says what it opens"
        typed.append((parameter, kind or _OPTIONS[parameter.name]))
    return typed


def of_method(method: Method) -> Typed:
    """Return the parameters of a method, each with its annotation."""
    ours = dict(zip(method.passes, arguments(method.command)))
    return [(each, _annotation(each.name, ours, method.address)) for each in method.parameters]


def _annotation(name: str, ours: dict[str, Argument], address: str) -> str:
    if name == QUIET:
        return "bool"
    if name == address:
        return "int"
    if name not in ours:
        return "object"
    # The library has no enums, and takes 0 and 1 where we take a flag.
    return _ENUM.sub("int", ours[name].annotation).replace("bool", "int")
