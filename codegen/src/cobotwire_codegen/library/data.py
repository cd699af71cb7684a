"""Renders the table that the layer and ``cobotwire migrate`` interpret."""

from __future__ import annotations

import json
from ast import literal_eval
from itertools import zip_longest
from typing import NamedTuple

from cobotwire_codegen.library.model import ENDED, Library, LibraryClass, Method
from cobotwire_codegen.library.parameters import Typed, of_constructor, of_method
from cobotwire_codegen.model import Chars, Enum, Flag, Listed, Quantity, Type, Value
from cobotwire_codegen.render.arguments import arguments, keyword_only
from cobotwire_codegen.render.parameters import results

Row = tuple[object, ...]


class Stated(NamedTuple):
    """The contents of a class's file, as texts that are Python literals.

    ``methods`` has each method that no earlier class has, with all classes that have it.
    """

    file: str
    name: str
    row: str
    methods: list[str]


def stated(library: Library) -> list[Stated]:
    """Return what is stated about each class; a method is stated once, with its first class."""
    # Compare methods by their text, because the defaults False and 0 are equal.
    owners: dict[str, list[str]] = {}
    for given in library.classes:
        for method in given.methods:
            owners.setdefault(repr(_method(given, method)), []).append(given.name)
    made = []
    for given in library.classes:
        firsts = {names[0] for names in owners.values() if given.name in names}
        files = tuple(each.name.lower() for each in library.classes if each.name in firsts)
        row = repr(_not_empty({**_class(given), "methods_in": files}))
        own = {text: names for text, names in owners.items() if names[0] == given.name}
        methods = [f"({tuple(names)}, {text[1:]}" for text, names in own.items()]
        made.append(Stated(given.name.lower(), given.name, row, methods))
    return made


def absent_json(library: Library) -> str:
    """Return the reasons why names have no counterpart, by class; ``*`` stands for all classes."""
    found = [("*", library.absent)] + [(each.name, each.absent) for each in library.classes]
    data = {name: dict(absent) for name, absent in found if absent}
    return json.dumps(data, indent=1) + "\n"


def place_of(helper: str) -> tuple[str, str]:
    """Return the module of the layer that has a helper, and the name of its class."""
    module, _, name = helper.rpartition(".")
    return module or "helpers", name


def _not_empty(row: dict[str, object]) -> dict[str, object]:
    """Return the entries with values that are not empty."""
    return {key: value for key, value in row.items() if value}


def _class(given: LibraryClass) -> dict[str, object]:
    return {
        "name": given.name,
        "module": given.module,
        "doc": given.doc,
        "edition": given.edition.name,
        "elsewhere": given.elsewhere.name if given.ports else "",
        "ports": given.ports,
        "one_way": given.one_way if given.one_way != "acknowledged" else "",
        "opens": given.opens,
        "constructor": _parameters(of_constructor(given)),
        "like": given.like,
        "helpers": tuple(map(place_of, given.helpers)),
        "native": given.elsewhere.class_name,
        "joints": given.edition.joints,
        "on_ports": (given.edition.class_name, *given.ports) if given.ports else (),
        "devices": {str(each.value): each.attribute for each in given.edition.frame.addresses},
    }


def _parameters(typed: Typed) -> Row:
    """Return each parameter with its annotation, and its default if it has one."""
    return tuple(
        (each.name, kind, literal_eval(each.default)) if each.default else (each.name, kind)
        for each, kind in typed
    )


def _method(given: LibraryClass, method: Method) -> Row:
    command = method.command
    everywhere = any(each.name == command.name for each in given.elsewhere.commands)
    gives = _gives_form(method)
    more = {
        "calls": command.name if command.name != method.name else "",
        "only_here": not everywhere,
        "address": method.address,
        "lacks": method.lacks,
        "ranges": tuple((name, int(low), int(high)) for name, low, high in method.ranges),
        "result": method.result if method.result != "plain" else "",
        "keywords": tuple(sorted(keyword_only(command))),
        "gives": gives if gives != "nothing" else "",
    }
    # A number in place of a parameter is passed as it is; our last arguments may be left out.
    passed = tuple(
        (ours.name, theirs, ours.default) if ours.default else (ours.name, theirs)
        for theirs, ours in zip_longest(method.passes, arguments(command), fillvalue="")
        if not isinstance(ours, str)
    )
    further = tuple(_not_empty(more).items())
    return method.name, command.title, _by(method), _parameters(of_method(method)), passed, further


def _by(method: Method) -> str:
    """Return the name of the layer's method that makes the call."""
    if method.result == ENDED:
        return "move"
    if method.command.ack:
        return "send_acked"
    if method.command.awaits_reply:
        return "query"
    return "finish" if method.result == "done" else "send"


def _gives_form(method: Method) -> str:
    """Return how a program converts a result of ours to the library's.

    ``same``: no conversion is needed; ``nothing``: our method has no result, but the library's has;
    ``list``, ``int`` or ``ints`` (a list of numbers): convert to that type; ``parts``: by hand.
    """
    if method.result == ENDED or method.command.ack or not method.command.awaits_reply:
        has_result = method.result != "nothing" and (method.command.ack or method.result != "plain")
        return "nothing" if has_result or method.result == ENDED else "same"
    found = results(method.command)
    if method.result != "plain" or len(found) != 1 or found[0].optional or method.command.text:
        return "parts"
    forms = {_form(each) for each in found[0].types}
    return forms.pop() if len(forms) == 1 else "parts"


def _form(given: Type) -> str:
    """Return how a value of a type is converted to the library's."""
    if isinstance(given, Flag | Enum):
        return "int"
    if isinstance(given, Listed):
        return {"same": "list", "int": "ints"}.get(_form(given.of), "parts")
    if isinstance(given, Value):
        return "list"
    return "same" if isinstance(given, Quantity | Chars) else "parts"
