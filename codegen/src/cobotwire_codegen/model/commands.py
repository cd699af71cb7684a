"""Fields, commands and families of commands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model.facts import Change, Dispute, Lines
from cobotwire_codegen.model.types import Member, Type, Value


@dataclass(frozen=True, slots=True)
class Field:
    """An argument of a request, or a part of a reply.

    When another field, the ``selector``, decides the type, ``cases`` holds a type for each value of
    the selector, and ``type`` is the first of them. A field with ``const`` always holds that raw
    value; the caller does not give it.
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

    @property
    def smallest(self) -> object:
        """The constant, or else the smallest legal value, as a vector writes it."""
        if self.const is None or isinstance(self.type, Value):
            return self.type.smallest
        return self.type.from_raw(self.const)


Variant = tuple[Field, ...]
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
    """How to read what a command has set: the query, and what its reply then contains.

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

    @property
    def reply(self) -> Variant:
        """The full variant of the reply; no fields if there is no reply."""
        return self.replies[0] if self.replies else ()

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
        return (bool(self.replies) and not self.ack) or self.text is not None


@dataclass(frozen=True, slots=True)
class Family:
    """Commands that belong together; one file of the spec."""

    place: Place
    name: str
    title: str
    doc: str
    commands: tuple[Command, ...]
