"""Fields, messages, commands and their families."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model.facts import Change, Dispute, Lines
from cobotwire_codegen.model.types import Member, Type


@dataclass(frozen=True, slots=True)
class Field:
    """An argument of a request or a part of a reply.

    ``cases`` is empty but for a field whose type another field (``by``) decides: then it holds a
    type for each value of that field, and ``type`` is the first of them. A field with ``const``
    always holds that number; the caller does not give it.
    """

    place: Place
    name: str
    type: Type
    doc: str
    echo: Literal["", "required", "optional"]
    optional: bool
    const: int | None
    by: str
    cases: tuple[tuple[Member, Type], ...]


Form = tuple[Field, ...]
# Numbers to send by argument, for the first form that has these arguments.
Tries = tuple[tuple[str, tuple[int, ...]], ...]


@dataclass(frozen=True, slots=True)
class Text:
    """Text outside any frame: a reply that ends by silence, or what follows a request."""

    place: Place
    class_name: str
    prefixes: tuple[str, ...]
    fields: tuple[tuple[str, str], ...]
    suffix: str
    silence_ms: int


@dataclass(frozen=True, slots=True)
class ReadBack:
    """How what a command has set is read: the query, and what its reply then says.

    ``fields`` pairs a field of the reply with the argument that it repeats, or with the whole
    number that it then has; none: the fields of the same name.
    """

    place: Place
    query: str
    fields: tuple[tuple[str, str | int], ...]


@dataclass(frozen=True, slots=True)
class Command:
    """One call.

    ``role`` is what hand-written code knows it by (one of ROLES, or nothing): which command stops
    the arm, which tells whether a target is reached.
    ``requests`` and ``replies`` hold the forms of the messages, the full one first. With ``alias``
    the call is another one's message under a name of its own; ``shares_id`` names the calls that
    have the same id with other data. ``tries`` are the numbers that a conformance run may
    send, where not every legal one is harmless; ``agrees_with`` are queries that tell the same at
    rest.
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
    requests: tuple[Form, ...]
    replies: tuple[Form, ...]
    ack: bool
    alias: str
    shares_id: tuple[str, ...]
    text: Text | None
    request_text: Text | None
    read_by: ReadBack | None
    tries: tuple[Tries, ...]
    agrees_with: tuple[str, ...]
    notes: tuple[str, ...]
    disputed: tuple[Dispute, ...]
    changes: tuple[Change, ...]

    @property
    def reply(self) -> Form:
        """The full form of the reply; no fields where nothing answers."""
        return self.replies[0] if self.replies else ()

    @property
    def fields(self) -> tuple[Field, ...]:
        """The fields of every form of every message."""
        forms = (*self.requests, *self.replies)
        return tuple(dict.fromkeys(field for form in forms for field in form))

    def forms(self, direction: Literal["request", "reply"]) -> tuple[Form, ...]:
        """The forms of the message, the full one first; none where nothing answers."""
        return self.requests if direction == "request" else self.replies

    @property
    def answers(self) -> bool:
        """Whether an answer is due."""
        return (bool(self.replies) and not self.ack) or self.text is not None


@dataclass(frozen=True, slots=True)
class Family:
    """Commands that belong together: one file of the spec."""

    place: Place
    name: str
    title: str
    doc: str
    commands: tuple[Command, ...]
