"""Renders a module for each of the library's modules."""

from __future__ import annotations

import json
import re
from itertools import groupby, zip_longest
from pathlib import PurePosixPath

from cobotwire_codegen.library.language import RESULTS
from cobotwire_codegen.library.model import ENDED, QUIET, Library, LibraryClass, Method, Parameter
from cobotwire_codegen.model import Chars, Enum, Flag, Listed, Quantity, Type, Value
from cobotwire_codegen.render import Files, environment
from cobotwire_codegen.render.arguments import Argument, arguments, keyword_only
from cobotwire_codegen.render.layout import laid_out
from cobotwire_codegen.render.parameters import results

# What constructors take besides the place to open. Only ``debug`` has an effect.
_OPTIONS = {
    "debug": "bool",
    "save_serial_log": "bool",
    "thread_lock": "bool",
    "timeout": "float",
}
_ENUM = re.compile(r"\b[A-Z]\w* \| int\b")


def render_library(library: Library) -> Files:
    """Return the modules by their names in the library."""
    jinja = environment()
    jinja.globals.update(
        bases=bases,
        call=call,
        constructor=constructor,
        head=head,
        imports=imports,
        names=names,
        naming=naming,
        native=native,
        our_call=our_call,
        sequences=sequences,
        typing=typing,
    )
    template = jinja.get_template("library/module.py.j2")
    listed = sorted(library.classes, key=lambda each: each.module)
    order = [each.name for each in library.classes]
    made: Files = {}
    for module, found in groupby(listed, key=lambda each: each.module):
        classes = sorted(found, key=lambda each: order.index(each.name))
        text = template.render(library=library, classes=classes)
        made[PurePosixPath(f"{module}.py")] = text
    index = jinja.get_template("library/index.py.j2")
    made[PurePosixPath("__init__.py")] = index.render(library=library)
    made[PurePosixPath("calls.json")] = calls_json(library)
    made[PurePosixPath("absent.json")] = absent_json(library)
    return made


def calls_json(library: Library) -> str:
    """Return how each method of the library is called in our client, for tools."""
    classes = (f'"{given.name}": {_class_json(given)}' for given in library.classes)
    return "{\n" + ",\n".join(classes) + "\n}\n"


def absent_json(library: Library) -> str:
    """Return why names have no counterpart, by class; those of all classes have the class ``*``."""
    found = [("*", library.absent)] + [(each.name, each.absent) for each in library.classes]
    data = {name: dict(absent) for name, absent in found if absent}
    return json.dumps(data, indent=1) + "\n"


def _class_json(given: LibraryClass) -> str:
    """Return a class as JSON, with a line for each method."""
    head = {
        "opens": given.opens,
        "constructor": [each.name for each in given.constructor],
        "native": given.elsewhere.class_name,
        "joints": given.edition.joints,
        "like": given.like,
        "helpers": [_place(each)[1] for each in given.helpers],
        "on_ports": [given.edition.class_name, *given.ports] if given.ports else [],
        "devices": {str(a.value): a.attribute for a in given.edition.frame.addresses},
    }
    methods = (f'  "{each.name}": {json.dumps(_as_data(each))}' for each in given.methods)
    listed = ",\n".join(methods)
    return f'{json.dumps(head)[:-1]}, "methods": {{\n{listed}\n }}}}'


def _as_data(method: Method) -> dict[str, object]:
    ours = arguments(method.command)
    return {
        "calls": method.command.name,
        "address": method.address,
        "parameters": {each.name: each.default for each in method.parameters},
        "arguments": {
            argument.name: [name, argument.default] for name, argument in zip(method.passes, ours)
        },
        "result": method.result,
        "keywords": sorted(keyword_only(method.command)),
        "gives": _gives_form(method),
    }


def _gives_form(method: Method) -> str:
    """Return what a program must do to a result of ours to have the library's.

    ``same`` is nothing, ``nothing`` says that only the library has a result. ``list``, ``int`` and
    ``ints`` (a list of numbers) say what to make of ours, ``parts`` that no word does.
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
    """Return what to make of a value of a type to have the library's."""
    if isinstance(given, Flag | Enum):
        return "int"
    if isinstance(given, Listed):
        return {"same": "list", "int": "ints"}.get(_form(given.of), "parts")
    if isinstance(given, Value):
        return "list"
    return "same" if isinstance(given, Quantity | Chars) else "parts"


def render_page(library: Library) -> Files:
    """Return the page with the calls of the library beside ours."""
    jinja = environment()
    jinja.globals.update(
        differing=differing, native_call=native_call, results=RESULTS, their_call=their_call
    )
    text = jinja.get_template("library/page.md.j2").render(library=library)
    return {PurePosixPath("pymycobot.md"): text}


def differing(given: LibraryClass) -> list[Method]:
    """Return the methods of a class that are called differently in our client."""
    return [method for method in given.methods if our_call(method) or method.result != "plain"]


def their_call(method: Method) -> str:
    """Return how the library's method is called, with the defaults."""
    parts = [f"{p.name}={p.default}" if p.default else p.name for p in method.parameters]
    return f"{method.name}({', '.join(parts)})"


def constructor(given: LibraryClass) -> str:
    """Return the constructor of a class."""
    types = ["str", "int" if given.opens == "socket" else "str | int"]
    parts = ["self"]
    for parameter, kind in zip_longest(given.constructor, types, fillvalue=""):
        assert isinstance(parameter, Parameter), "a constructor says what it opens"
        default = f" = {_double_quoted(parameter.default)}" if parameter.default else ""
        parts.append(f"{parameter.name}: {kind or _OPTIONS[parameter.name]}{default}")
    parts += ["*", "errors: OnFailure | None = None"]
    opened = [parameter.name for parameter in given.constructor[:2]]
    debug = "debug" if any(each.name == "debug" for each in given.constructor) else "False"
    return (
        laid_out("def __init__(", parts, ") -> None:", 4)
        + '\n        """Open the arm; see :class:`CompatibleClient`."""\n        '
        + laid_out(f"self._open_{given.opens}(", [*opened, debug, "errors"], ")", 8)
    )


def _double_quoted(literal: str) -> str:
    return literal.replace("'", '"')


def head(method: Method) -> str:
    """Return the head of a method with the library's parameters."""
    ours = {name: each for name, each in zip(method.passes, arguments(method.command))}
    parts = ["self"]
    for parameter in method.parameters:
        default = f" = {parameter.default}" if parameter.default else ""
        parts.append(
            f"{parameter.name}: {_annotation(parameter.name, ours, method.address)}{default}"
        )
    return laid_out(f"def {method.name}(", parts, ") -> Any:", 4)


def _annotation(name: str, ours: dict[str, Argument], address: str) -> str:
    if name == QUIET:
        return "bool"
    if name == address:
        return "int"
    if name not in ours:
        return "object"
    # The library has no enums, and takes 0 and 1 where we take a flag.
    return _ENUM.sub("int", ours[name].annotation).replace("bool", "int")


def call(given: LibraryClass, method: Method) -> str:
    """Return the body of a method of a class."""
    lacks = [f"{name}={name}" for name in method.lacks]
    checks = [laid_out("self._lacks(", lacks, ")", 8)] if lacks else []
    for name, lowest, highest in method.ranges:
        checks.append(laid_out("check_range(", [f'"{name}"', name, lowest, highest], ")", 8))
    return "\n        ".join([*checks, _returned(given, method)])


def _returned(given: LibraryClass, method: Method) -> str:
    """Return the statement that calls our method."""
    name = method.command.name
    everywhere = any(each.name == name for each in given.elsewhere.commands)
    device = f".at({method.address})" if method.address else ""
    ours = f"self.arm{device}.{name}" if everywhere else f'self._only_here("{name}")'
    passed = _passed(method)
    if method.result == ENDED:
        return laid_out("return self._move(", [ours, *passed, *_quiet(method)], ")", 8)
    if _asks(method):
        parts = [f"results.{method.result}", ours, *passed]
        return laid_out("return self._ask(", parts, ")", 8)
    if not method.command.ack:
        order = "_finish" if method.result == "done" else "_send"
        return laid_out(f"return self.{order}(", [ours, *passed], ")", 8)
    gives = [f"gives=results.{method.result}"] if method.result != "plain" else []
    return laid_out("return self._order(", [ours, *passed, *_quiet(method), *gives], ")", 8)


def _quiet(method: Method) -> list[str]:
    return [f"quiet={QUIET}"] if method.may_be_quiet else []


def naming(method: Method) -> str:
    """Return the decorator that names the library's parameters in errors; empty if not needed."""
    pairs = zip(method.passes, arguments(method.command))
    names = [
        f'{ours.name}="{theirs}"'
        for theirs, ours in pairs
        if theirs in method.takes and theirs != ours.name
    ]
    if method.address:
        names.append(f'address="{method.address}"')
    return laid_out("@naming(", names, ")", 4) if names else ""


def native(given: LibraryClass) -> list[str]:
    """Return the attributes that say which of our clients a class uses."""
    here, there = (f"{each.name}.{each.class_name}" for each in (given.edition, given.elsewhere))
    orders = [f'ORDERS = "{given.orders}"'] if given.orders != "acknowledged" else []
    if here == there:
        return [f"NATIVE = {given.edition.name}.CLIENT", *orders, f"arm: {here}"]
    ports = ", ".join(f'"{port}"' for port in given.ports)
    return [
        f"NATIVE = {given.edition.name}.CLIENT",
        f"ELSEWHERE = {given.elsewhere.name}.CLIENT",
        f"PORTS = ({ports})",
        *orders,
        f"arm: {there} | {here}",
    ]


def _passed(method: Method) -> list[str]:
    """Return what our method is given. A flag that is False by default is left out then."""
    # A number has no default.
    defaults = {each.name: each.default for each in method.parameters}
    ours = {name: each.default for name, each in zip(method.passes, arguments(method.command))}
    no = {"False", "0"}
    left_out = {name for name in ours if defaults.get(name) in no and ours[name] == "None"}
    return [f"{name} or None" if name in left_out else name for name in method.passes]


def our_call(method: Method) -> str:
    """Return how our client is called; empty if it is called in the same way."""
    if tuple(each.name for each in method.parameters) == method.command.argument_names:
        return ""
    return f"Calls ``{native_call(method)}``."


def native_call(method: Method) -> str:
    """Return the call of our client, with the numbers that no parameter gives."""
    device = f"at({method.address})." if method.address else ""
    ours = method.command.argument_names
    pairs = zip_longest(ours, method.passes[: len(ours)], fillvalue="")
    shown = [name if given in {"", *method.takes} else given for name, given in pairs]
    return f"{device}{method.command.name}({', '.join(shown)})"


def names(library: Library) -> list[str]:
    """Return what the package exports, in the order of ruff."""
    constants = ["PI_BAUD", "PI_PORT"]
    classes = sorted([each.name for each in library.classes] + ["Angle", "Coord"])
    return [*constants, *classes, "utils"]


def bases(given: LibraryClass) -> str:
    """Return the bases of a class: the helpers, what it is like, or else what all share."""
    found = [*(_place(each)[1] for each in given.helpers), *([given.like] if given.like else [])]
    return ", ".join(found or ["CompatibleClient"])


def _place(helper: str) -> tuple[str, str]:
    """Return the module of the layer that has a helper, and the name of its class."""
    module, _, name = helper.rpartition(".")
    return module or "helpers", name


def sequences(classes: list[LibraryClass]) -> bool:
    """Return whether a method of the classes takes a row of numbers."""
    found = (each for given in classes for each in given.methods)
    return any("Sequence[" in head(method) for method in found)


def typing(classes: list[LibraryClass]) -> str:
    """Return what a module imports from ``typing``."""
    methods = any(given.methods for given in classes)
    return ", ".join(["TYPE_CHECKING"] * sequences(classes) + ["Any"] * methods)


def imports(library: Library, classes: list[LibraryClass]) -> list[str]:
    """Return the imports of a module."""
    layer = "cobotwire.pymycobot.layer"
    editions = sorted(
        {name for each in classes for name in (each.edition.name, each.elsewhere.name)}
    )
    found = [f"from cobotwire.editions import {', '.join(editions)}"]
    methods = [method for given in classes for method in given.methods]
    if any(map(_gives, methods)):
        found.append(f"from {layer} import results")
    shared = ["CompatibleClient"] * any(bases(each) == "CompatibleClient" for each in classes)
    found.append(f"from {layer}.client import {', '.join([*shared, 'OnFailure'])}")
    helpers = sorted({_place(helper) for each in classes for helper in each.helpers})
    for module, group in groupby(helpers, key=lambda place: place[0]):
        found.append(f"from {layer}.{module} import {', '.join(name for _, name in group)}")
    if any(map(naming, methods)):
        found.append(f"from {layer}.naming import naming")
    if any(method.ranges for method in methods):
        found.append(f"from {layer}.ranges import check_range")
    here = {each.name for each in classes}
    modules = {each.name: each.module for each in library.classes}
    likes = sorted({each.like for each in classes} - here - {""})
    found += [f"from cobotwire.pymycobot.{modules[like]} import {like}" for like in likes]
    return sorted(found)


def _gives(method: Method) -> bool:
    """Return whether a method names a function for its result."""
    if method.result == ENDED:
        return False
    return _asks(method) or (method.command.ack and method.result != "plain")


def _asks(method: Method) -> bool:
    return method.command.awaits_reply and not method.command.ack
