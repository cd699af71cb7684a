"""Find a command's message types in its generated package, or make equal ones at run time."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable, Sequence  # noqa: F401  (annotations use Sequence)
from functools import cache, lru_cache
from importlib import import_module
from types import new_class
from typing import Any, NamedTuple

from cobotwire.protocol.arguments import Row
from cobotwire.protocol.fields import Field, Variant, named_fields
from cobotwire.protocol.messages import Event, Reply, Request

MessageTypes = tuple[type[Request[Any]], type[Reply[Any]] | None]


class MessageShape(NamedTuple):
    """What a message class needs to know about a request or reply.

    Attributes:
        annotations: the type of each attribute as text; those without a default come first.
        defaults: the defaults of attributes; None if a variant leaves one out.
        rows: the variants.
        text: the attributes that are text outside the frame.
        results: the attributes of a reply that the client's method returns.
    """

    annotations: tuple[tuple[str, str], ...]
    defaults: tuple[tuple[str, Any], ...]
    rows: tuple[Row, ...]
    text: tuple[str, ...]
    results: tuple[str, ...] = ()


def class_name(command: str) -> str:
    """Return the name of a command's request class: ``get_angles`` gives ``GetAngles``."""
    return "".join(word[:1].upper() + word[1:] for word in command.split("_"))


@cache
def generated_types(package: str, command: str) -> MessageTypes:
    """Return the message types that the generator wrote into an edition's package."""
    found = getattr(import_module(f"{package}.messages"), class_name(command))
    # An event has no request.
    return (Request, found) if issubclass(found, Event) else (found, found.reply_type)


@lru_cache(maxsize=1024)
def made_types(
    command: str, request: MessageShape, reply: MessageShape | None, is_event: bool = False
) -> MessageTypes:
    """Make the message types of a command; equal shapes give the same types.

    A table has no enum classes, named tuples or radians, so the fields hold integers, tuples and
    the units of the wire.
    """
    name = class_name(command)
    if is_event and reply is not None:
        layout = {"event": command, **_layout(reply)}
        event: Any = new_class(name, (Event,), layout, _body(reply, f"Event {command}."))
        return Request, event
    keywords: dict[str, Any] = {"command": command, **_layout(request)}
    made: Any = new_class(name, (Request,), keywords, _body(request, f"Request {command}."))
    if reply is not None:
        result = _named_tuple(name, reply.results) if len(reply.results) > 1 else None
        keywords = {"to": made, "result": result, "results": reply.results, **_layout(reply)}
        new_class(f"{name}Reply", (Reply,), keywords, _body(reply, f"Reply to {command}."))
    return made, made.reply_type


def request_shape(
    variants: tuple[Variant, ...], text: tuple[str, ...], order: tuple[str, ...]
) -> MessageShape:
    """Return the shape of a request; ``order`` names all its arguments."""
    return _shape(variants, named_fields(variants), text, order)


def reply_shape(variants: tuple[Variant, ...], text: tuple[str, ...], is_ack: bool) -> MessageShape:
    """Return the shape of a reply; an acknowledgement has no result."""
    fields = {name: found for name, found in named_fields(variants).items() if not found[0].echo}
    # The result has the fields that all variants have. If no field is in all, it has every field.
    common = [name for name, found in fields.items() if len(found) == len(variants)]
    results = () if is_ack else tuple(common or fields)
    return _shape(variants, named_fields(variants), text, (*fields, *text))._replace(
        results=(*results, *text)
    )


def _shape(
    variants: tuple[Variant, ...],
    fields: dict[str, list[Field]],
    text: tuple[str, ...],
    order: tuple[str, ...],
) -> MessageShape:
    types = dict.fromkeys(text, "str")
    defaults: dict[str, Any] = {}
    for name, found in fields.items():
        types[name] = _annotation(found[0])
        given = {field.default for field in found}
        if len(found) < len(variants) or found[0].echo or len(given) > 1:
            defaults[name] = None
        elif None not in given:
            defaults[name] = found[0].physical(found[0].default or ())
    names = dict.fromkeys((*order, *fields))
    declared = sorted(names, key=lambda name: name in defaults)
    return MessageShape(
        tuple((name, types[name]) for name in declared),
        tuple(defaults.items()),
        tuple(variant.row for variant in variants),
        text,
    )


def _annotation(field: Field) -> str:
    if field.kind == "flag":
        return "bool"
    word = "float" if any(number.real for number in field.numbers) else "int"
    return f"Sequence[{word}]" if field.many else word


def _layout(shape: MessageShape) -> dict[str, Any]:
    """Return the keywords of a class that describe what is on the wire."""
    if len(set(shape.rows)) > 1:
        return {"variants": shape.rows, "text": shape.text}
    [row] = set(shape.rows) or {()}
    wire = tuple([part[0] if isinstance(part, tuple) else part for part in row])
    declared = tuple([name for name, _ in shape.annotations if name not in shape.text])
    return {"wire": wire if wire != declared else (), "text": shape.text}


def _body(shape: MessageShape, doc: str) -> Callable[[dict[str, Any]], None]:
    """Return a function that fills the body of a class: annotations and defaults."""
    return lambda body: body.update(
        __annotations__=dict(shape.annotations),
        __module__=__name__,
        __doc__=doc,
        **dict(shape.defaults),
    )


def _named_tuple(name: str, results: tuple[str, ...]) -> Any:
    return namedtuple(f"{name}Result", results)
