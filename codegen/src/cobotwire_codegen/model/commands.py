"""Fields, commands and families of commands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model.effects import Effect
from cobotwire_codegen.model.facts import Change, Dispute, Firmware, Lines
from cobotwire_codegen.model.shapes import Type
from cobotwire_codegen.model.types import Member


class NoId(int):
    """A stand-in, 0, for an id that the spec does not state; it never counts as a duplicate."""


@dataclass(frozen=True, slots=True)
class Field:
    """An argument of a request, or a part of a reply.

    When another field, the ``selector``, decides the type, ``cases`` holds a type for each value of
    the selector, and ``type`` is the first of them. A field with ``const`` always holds that raw
    value; the caller does not give it. ``default`` are the raw values of an argument that the
    caller leaves out. A field with ``counts`` holds the number of elements of that list; it is
    neither an argument nor a result.
    """

    place: Place
    name: str
    type: Type
    doc: str
    echo: Literal["", "required", "optional"]
    optional: bool
    const: int | None
    selector: str
    cases: tuple[tuple[Member, Type], ...]
    default: tuple[int, ...] | None = None
    counts: str = ""


Variant = tuple[Field, ...]


def named_fields(variants: tuple[Variant, ...]) -> dict[str, tuple[Field, ...]]:
    """Return the fields of a message that are not constants, those of the longest variant first.

    A name has a field for each variant that contains it.
    """
    found: dict[str, list[Field]] = {}
    for variant in sorted(variants, key=len, reverse=True):
        for field in variant:
            if field.const is None and not field.counts:
                found.setdefault(field.name, []).append(field)
    return {name: tuple(fields) for name, fields in found.items()}


# Raw values to send by argument, for the first variant that has these arguments.
Samples = tuple[tuple[str, tuple[int, ...]], ...]


@dataclass(frozen=True, slots=True)
class Text:
    """Text outside any frame: a reply that ends with silence, or text that follows a request."""

    place: Place
    class_name: str
    prefixes: tuple[str, ...]
    fields: tuple[tuple[str, str], ...]
    suffix: str
    silence_ms: int


@dataclass(frozen=True, slots=True)
class ReadBack:
    """How to read back what a command has set: the query, and the expected contents of its reply.

    It is derived from the effects of both.

    ``fields`` pairs a field of the reply with the argument that it repeats, or with the raw
    value that it then has. If it is empty, fields of the same name are compared.
    """

    place: Place
    query: str
    fields: tuple[tuple[str, str | int], ...]


@dataclass(frozen=True, slots=True)
class Command:
    """An entry of the protocol: an id, a request and its reply.

    ``role`` (one of ROLES, or empty) is how hand-written code finds the command, for instance the
    one that stops the arm.
    ``requests`` and ``replies`` hold the variants of the messages, the full one first.
    A command with ``alias`` is another command's message under a second name; ``shares_id`` lists
    the commands that use the same id with other data.
    ``samples`` are the raw values that a conformance run may send when not every legal value is
    harmless; ``agrees_with`` lists queries that report the same values while the arm rests.
    The device sends the reply of an ``event`` without a request. ``accepted`` lists the raw values
    of the last field of a reply that report success.
    ``firmware`` has the versions that the command needs; ``notes`` state them too.
    ``arguments`` is the order of the method's arguments, if it is not that of the wire.
    """

    place: Place
    id: int
    name: str
    title: str
    doc: str
    safety: str
    role: str
    source: Lines
    deadline_ms: int
    requests: tuple[Variant, ...]
    replies: tuple[Variant, ...]
    ack: bool
    event: bool
    accepted: tuple[int, ...]
    alias: str
    shares_id: tuple[str, ...]
    text: Text | None
    request_text: Text | None
    read_by: ReadBack | None
    samples: tuple[Samples, ...]
    agrees_with: tuple[str, ...]
    notes: tuple[str, ...]
    disputed: tuple[Dispute, ...]
    changes: tuple[Change, ...]
    arguments: tuple[str, ...] = ()
    effect: Effect | None = None
    firmware: Firmware | None = None

    @property
    def reply(self) -> Variant:
        """The full variant of the reply; no fields if there is no reply."""
        return self.replies[0] if self.replies else ()

    @property
    def text_arguments(self) -> tuple[str, ...]:
        """The arguments that follow the request as text outside the frame."""
        return tuple(name for name, _ in self.request_text.fields) if self.request_text else ()

    @property
    def argument_names(self) -> tuple[str, ...]:
        """The method's arguments in their order: by default, first those that must be given."""
        if self.arguments:
            return self.arguments
        found = named_fields(self.requests)
        needed = [name for name in found if self.needs(name)]
        others = sorted(found.keys() - {*needed}, key=list(found).index)
        others.sort(key=lambda name: len(found[name]), reverse=True)
        return (*needed, *self.text_arguments, *others)

    @property
    def method_order(self) -> tuple[str, ...]:
        """The order of the method's arguments; empty: the order of the fields, then the text."""
        names = (*named_fields(self.requests), *self.text_arguments)
        return () if names == self.argument_names else self.argument_names

    def needs(self, name: str) -> bool:
        """Return whether every call must give an argument."""
        fields = named_fields(self.requests).get(name, ())
        if not fields:
            return name in self.text_arguments
        return len(fields) == len(self.requests) and all(f.default is None for f in fields)

    @property
    def fields(self) -> tuple[Field, ...]:
        """The fields of every variant of every message."""
        variants = (*self.requests, *self.replies)
        return tuple(dict.fromkeys(field for variant in variants for field in variant))

    def variants(self, direction: Literal["request", "reply"]) -> tuple[Variant, ...]:
        """Return the variants of a message, the full one first; none if there is no reply."""
        return self.requests if direction == "request" else self.replies

    @property
    def awaits_reply(self) -> bool:
        """Whether a client waits for a reply."""
        return (bool(self.replies) and not self.ack and not self.event) or self.text is not None


@dataclass(frozen=True, slots=True)
class Family:
    """Commands that belong together; one file of the spec."""

    place: Place
    name: str
    title: str
    doc: str
    commands: tuple[Command, ...]
