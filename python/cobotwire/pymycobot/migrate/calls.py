"""How the calls of the maker's library are written for our clients, as the generator states it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import Any


@dataclass(frozen=True, slots=True)
class Call:
    """A method of the library beside ours.

    Attributes:
        calls: our method.
        parameters: the library's parameters in their order, each with its default as text.
        arguments: our arguments in their order: the library's parameter, and our default.
        result: how the library gives the result.
        row: whether our result is a named tuple where the library's is a list.
        keywords: our arguments that have no position.
    """

    calls: str
    parameters: dict[str, str]
    arguments: dict[str, tuple[str, str]]
    result: str = "plain"
    row: bool = False
    keywords: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class LibraryClass:
    """A class of the library: what it opens, our class, its joints, and its methods."""

    opens: str
    constructor: tuple[str, ...]
    native: str
    joints: int
    methods: dict[str, Call]


def _waited(kind: str, parameters: dict[str, str], *names: str) -> Call:
    arguments = {name: (given, "") for name, given in zip(names, parameters)}
    arguments["timeout"] = ("timeout", "")
    return Call(f"move_{kind}", parameters, arguments, keywords=("timeout",))


# Methods of several requests that our clients have too.
_SEVERAL = {
    "sync_send_angles": _waited(
        "angles", {"degrees": "", "speed": "", "timeout": "15"}, "angles", "speed"
    ),
    "sync_send_coords": _waited(
        "coords",
        {"coords": "", "speed": "", "mode": "0", "timeout": "15"},
        "coords",
        "speed",
        "mode",
    ),
    "close": Call("close", {}, {}),
}


@lru_cache
def library() -> dict[str, LibraryClass]:
    """Return the classes of the library by name."""
    data = json.loads(files("cobotwire.pymycobot").joinpath("calls.json").read_text("utf-8"))
    made: dict[str, LibraryClass] = {}
    for name, given in data.items():
        methods = {key: _call(each) for key, each in given["methods"].items()}
        shared = made[given["like"]].methods if given["like"] else _SEVERAL
        constructor = tuple(given["constructor"])
        made[name] = LibraryClass(
            given["opens"],
            constructor,
            given["native"],
            given["joints"],
            {**shared, **methods},
        )
    return made


def _call(given: dict[str, Any]) -> Call:
    pairs = {name: (each[0], each[1]) for name, each in given["arguments"].items()}
    return Call(**{**given, "arguments": pairs})
