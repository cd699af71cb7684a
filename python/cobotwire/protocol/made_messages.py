"""Find a command's message types in its generated package, or make equal ones at run time."""

from __future__ import annotations

from collections.abc import Callable, Sequence  # noqa: F401  (annotations use Sequence)
from functools import cache, lru_cache
from importlib import import_module
from types import new_class
from typing import Any, NamedTuple

from cobotwire.protocol.messages import Reply, Request

MessageTypes = tuple[type[Request[Any]], type[Reply[Any]] | None]


class FieldShape(NamedTuple):
    """What a message class needs to know about a field."""

    name: str
    type: str
    """The annotation, as text."""
    optional: bool
    """Whether a variant of the message leaves the field out, or the field echoes the request."""


class MessageShape(NamedTuple):
    """What a message class needs to know about a request or reply, with fields in wire order."""

    fields: tuple[FieldShape, ...]
    text: tuple[str, ...] = ()


def class_name(command: str) -> str:
    """Return the name of a command's request class: ``get_angles`` gives ``GetAngles``."""
    return "".join(word[:1].upper() + word[1:] for word in command.split("_"))


@cache
def generated_types(package: str, command: str) -> MessageTypes:
    """Return the message types that the generator wrote into an edition's package."""
    request = getattr(import_module(f"{package}.messages"), class_name(command))
    return request, request.reply_type


@lru_cache(maxsize=1024)
def made_types(command: str, request: MessageShape, reply: MessageShape | None) -> MessageTypes:
    """Make the message types of a command; equal shapes give the same types.

    A table has no enum classes, named tuples or radians, so the fields hold integers, tuples and
    the units of the wire.
    """
    name = class_name(command)
    keywords: dict[str, Any] = {"command": command, "wire": _wire(request), "text": request.text}
    made: Any = new_class(name, (Request,), keywords, _body(request, f"Request {command}."))
    if reply is not None:
        results = [field.name for field in reply.fields if not field.optional] + list(reply.text)
        result = _named_tuple(name, results) if len(results) > 1 else None
        keywords = {"to": made, "result": result, "wire": _wire(reply), "text": reply.text}
        new_class(f"{name}Reply", (Reply,), keywords, _body(reply, f"Reply to {command}."))
    return made, made.reply_type


def _body(shape: MessageShape, doc: str) -> Callable[[dict[str, Any]], None]:
    """Return a function that fills the body of a class: annotations, and None as defaults."""
    required = {field.name: field.type for field in shape.fields if not field.optional}
    optional = {field.name: field.type for field in shape.fields if field.optional}
    annotations = required | {name: "str" for name in shape.text} | optional
    defaults: dict[str, Any] = dict.fromkeys(optional)
    return lambda body: body.update(
        __annotations__=annotations, __module__=__name__, __doc__=doc, **defaults
    )


def _wire(shape: MessageShape) -> tuple[str, ...]:
    """Return the field names in wire order; empty if that is the order of declaration."""
    names = [field.name for field in shape.fields]
    declared = sorted(shape.fields, key=lambda field: field.optional)
    return tuple(names) if names != [field.name for field in declared] else ()


def _named_tuple(name: str, results: list[str]) -> Any:
    from collections import namedtuple

    return namedtuple(f"{name}Result", results)
