"""Names that the generated code needs for itself, and classes that would hide each other."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.model import Edition, Enum, Value

# What the generated code itself calls by these names.
RESERVED_FIELDS = frozenset(
    {
        "ack_within",
        "bool",
        "float",
        "given",
        "int",
        "reply",
        "self",
        "str",
        "to_degrees",
        "to_radians",
        "tuple",
    }
)
# What every client is and can beside its commands.
RESERVED_COMMANDS = frozenset(
    {
        "close",
        "codec",
        "listen",
        "move_angles",
        "move_coords",
        "open",
        "table",
        "wait_until_reached",
        "watch",
    }
)
# A named tuple's own methods, and the types that stand in its annotations.
RESERVED_ITEMS = frozenset({"count", "index", "int", "float", "bool", "str", "tuple"})
RESERVED_FAMILIES = frozenset({"types"})
RESERVED_CLASSES = frozenset(
    {
        "ASYNC_CLIENT",
        "Any",
        "AsyncDriver",
        "CLIENT",
        "Case",
        "ClassVar",
        "Command",
        "Driver",
        "Field",
        "FrameFormat",
        "IntEnum",
        "AsyncMoving",
        "Layout",
        "Moving",
        "NamedTuple",
        "Number",
        "Sequence",
        "TABLE",
        "TYPE_CHECKING",
        "Table",
        "TextReply",
        "TextRequest",
    }
)


def reserved(edition: Edition) -> Iterator[Problem]:
    """No name hides what the generated code needs."""
    for family in edition.families:
        if family.name in RESERVED_FAMILIES:
            yield _reserved(family.name, family.place)
    for command in edition.commands:
        if command.name in RESERVED_COMMANDS:
            yield _reserved(command.name, command.place)
        for field in command.fields:
            if field.name in RESERVED_FIELDS:
                yield _reserved(field.name, field.place)


def items_free(edition: Edition) -> Iterator[Problem]:
    """Parts of a named tuple hide neither what tuples can do nor the types of other parts."""
    for type in edition.types:
        if isinstance(type, Value):
            for name, _ in type.items:
                if name in RESERVED_ITEMS:
                    yield _reserved(name, type.place)
    for command in edition.commands:
        for field in command.reply:
            if len([f for f in command.reply if not f.echo]) > 1 and field.name in RESERVED_ITEMS:
                yield _reserved(field.name, field.place)


def _reserved(name: str, place: Place) -> Problem:
    message = f"{name} has a meaning of its own in the generated code; choose another name"
    return Problem(place, "reserved-name", message)


def classes_apart(edition: Edition) -> Iterator[Problem]:
    """Each class of the generated package has a name of its own."""
    seen: dict[str, Place] = {}
    for name, place in (*_classes(edition), *_asyncio_classes(edition)):
        if name in RESERVED_CLASSES:
            yield _reserved(name, place)
        elif name in seen:
            message = f"{name} is a class already, at {seen[name]}"
            yield Problem(place, "duplicate-class", message)
        seen.setdefault(name, place)


def _asyncio_classes(edition: Edition) -> Iterator[tuple[str, Place]]:
    """The asyncio client's; what is told of the blocking one's names is not told twice."""
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
        if len([field for field in command.reply if not field.echo]) > 1:
            yield "".join(map(str.capitalize, command.name.split("_"))) + "Reply", command.place
    shared: set[str] = set()
    for type in edition.types:
        # Types may share a class; whether they may is another rule's question.
        if isinstance(type, Enum | Value) and type.class_name not in shared:
            shared.add(type.class_name)
            yield type.class_name, type.place


RULES = (reserved, items_free, classes_apart)
