"""Rules for names that the generated code needs, and for classes of the same name."""

from __future__ import annotations

import keyword
from collections.abc import Iterator

from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.lower import message_class
from cobotwire_codegen.model import Edition

# The types in annotations: a method or a field with that name would hide them.
_ANNOTATIONS = frozenset({"bool", "bytes", "float", "int", "str", "tuple"})
# The attributes of every message, and the names that the generated methods use.
RESERVED_FIELDS = _ANNOTATIONS | {
    "ack_within",
    "command",
    "fieldless",
    "fields",
    "fields_in_radians",
    "from_fields",
    "messages",
    "reply_type",
    "request_type",
    "result",
    "result_from",
    "result_of",
    "self",
    "text_values",
    "values",
    "variant_index",
}
# The attributes that every client has in addition to its commands. The generator does not import
# the package, so they are repeated here; a test compares them with the classes.
RESERVED_COMMANDS = _ANNOTATIONS | {
    "add_traffic_listener",
    "at",
    "close",
    "close_gripper",
    "codec",
    "events",
    "follow",
    "go_home",
    "on",
    "listen",
    "move_angles",
    "move_coords",
    "open",
    "open_gripper",
    "stream",
    "table",
    "wait_until_reached",
}
# The methods of a named tuple.
RESERVED_ITEMS = _ANNOTATIONS | {"count", "index"}
RESERVED_FAMILIES = frozenset({"types"})
RESERVED_CLASSES = frozenset(
    {
        "ASYNC_CLIENT",
        "Any",
        "AsyncClient",
        "CLIENT",
        "Case",
        "ClassVar",
        "Command",
        "Client",
        "Message",
        "Event",
        "Field",
        "FrameFormat",
        "IntEnum",
        "AsyncMovingClient",
        "Variant",
        "MovingClient",
        "NamedTuple",
        "Number",
        "Reply",
        "Request",
        "Sequence",
        "TABLE",
        "TYPE_CHECKING",
        "Table",
        "TextReply",
        "TextRequest",
    }
)


def reserved(edition: Edition) -> Iterator[Problem]:
    """Report names that would hide what the generated code needs."""
    for family in edition.families:
        if family.name in RESERVED_FAMILIES:
            yield _reserved(family.name, family.place)
    for command in edition.commands:
        if command.name in RESERVED_COMMANDS:
            yield _reserved(command.name, command.place)
        for field in command.fields:
            if field.name in RESERVED_FIELDS:
                yield _reserved(field.name, field.place)
        for text in filter(None, (command.text, command.request_text)):
            for name in (name for name, _ in text.fields if name in RESERVED_FIELDS):
                yield _reserved(name, text.place)


def addresses_apart(edition: Edition) -> Iterator[Problem]:
    """Report addresses that would hide a command, another address, or an attribute of clients."""
    seen = {command.name: command.place for command in edition.commands}
    for address in edition.frame.addresses:
        name = address.attribute
        if name in RESERVED_COMMANDS or keyword.iskeyword(name):
            yield _reserved(name, address.place)
        elif name in seen:
            message = f"clients already have {name}, for {seen[name]}; rename the address"
            yield Problem(address.place, "reserved-name", message)
        seen.setdefault(name, address.place)


def items_free(edition: Edition) -> Iterator[Problem]:
    """Report parts of named tuples that would hide methods of tuples or types."""
    for type in edition.types:
        for name, _ in type.parts:
            if name in RESERVED_ITEMS:
                yield _reserved(name, type.place)
    for command in edition.commands:
        if command.text is not None:
            for name in (name for name, _ in command.text.fields if name in RESERVED_ITEMS):
                yield _reserved(name, command.text.place)
        for field in command.reply:
            if len([f for f in command.reply if not f.echo]) > 1 and field.name in RESERVED_ITEMS:
                yield _reserved(field.name, field.place)


def _reserved(name: str, place: Place) -> Problem:
    message = f"{name} is reserved in the generated code; choose another name"
    return Problem(place, "reserved-name", message)


def classes_apart(edition: Edition) -> Iterator[Problem]:
    """Report classes of the generated package that have the same name."""
    seen: dict[str, Place] = {}
    for name, place in (*_classes(edition), *_asyncio_classes(edition)):
        if not name:
            continue
        if name in RESERVED_CLASSES:
            yield _reserved(name, place)
        elif name in seen:
            message = f"there is already a class {name} at {seen[name]}"
            yield Problem(place, "duplicate-class", message)
        seen.setdefault(name, place)


def _asyncio_classes(edition: Edition) -> Iterator[tuple[str, Place]]:
    """Return the asyncio client's classes; classes of the blocking client are reported already."""
    for family in edition.families:
        yield f"Async{family.name.capitalize()}Commands", family.place
    if edition.class_name not in RESERVED_CLASSES:
        yield f"Async{edition.class_name}", edition.place


def _classes(edition: Edition) -> Iterator[tuple[str, Place]]:
    yield edition.class_name, edition.place
    for family in edition.families:
        yield f"{family.name.capitalize()}Commands", family.place
    for command in edition.commands:
        if command.text is not None:
            yield command.text.class_name, command.text.place
        name = message_class(command.name)
        yield name, command.place
        if command.replies or command.text is not None:
            yield f"{name}Reply", command.place
        if len([field for field in command.reply if not field.echo]) > 1:
            yield f"{name}Result", command.place
    shared: set[str] = set()
    for type in edition.types:
        # Types may share a class; another rule checks that their parts agree.
        if type.class_name and type.class_name not in shared:
            shared.add(type.class_name)
            yield type.class_name, type.place


RULES = (reserved, addresses_apart, items_free, classes_apart)
