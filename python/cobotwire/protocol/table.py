"""The protocol as data: both codecs interpret these records.

An edition is one :class:`Table`. The classes know no command by name and do no I/O. They are plain
records, so that the Rust codec can read the same objects attribute by attribute.
:mod:`cobotwire.protocol.fields` and :mod:`cobotwire.protocol.frame_format` hold the records inside
a message and the rules for reading them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.fields import Case, Field, FieldKind, Number, Variant
from cobotwire.protocol.frame_format import Check, FrameFormat
from cobotwire.protocol.made_messages import (
    FieldShape,
    MessageShape,
    MessageTypes,
    generated_types,
    made_types,
)
from cobotwire.protocol.messages import Reply, Request

__all__ = [
    "Case",
    "Check",
    "Command",
    "Direction",
    "Field",
    "FieldKind",
    "FrameFormat",
    "Number",
    "ReadBack",
    "Role",
    "Safety",
    "Table",
    "TextReply",
    "TextRequest",
    "Variant",
]

Direction = Literal["request", "reply"]
Safety = Literal["query", "setting", "motion", "power", "persistent write"]
Role = Literal[
    "",
    "joint targets",
    "joint target",
    "coordinate targets",
    "coordinate target",
    "reached",
    "moving",
    "stop",
    "joints",
    "coordinates",
    "powered",
    "version",
]


@dataclass(frozen=True, slots=True)
class TextReply:
    """A reply that is text outside any frame: ``prefixes[i]`` comes before ``fields[i]``.

    It ends when no byte has come for ``silence_ms``.
    """

    prefixes: tuple[str, ...]
    fields: tuple[str, ...]
    silence_ms: int
    suffix: str = ""


@dataclass(frozen=True, slots=True)
class TextRequest:
    """Text that follows the frame of a request, as in TextReply, and ends with ``suffix``."""

    prefixes: tuple[str, ...]
    fields: tuple[str, ...]
    suffix: str


@dataclass(frozen=True, slots=True)
class ReadBack:
    """How to read back what a command has set: by the reply to ``query``.

    ``fields`` pairs a field of the reply with the argument that it repeats, or with the raw value
    that it then holds; if empty, fields repeat the arguments of the same name. Arguments of that
    name in the query choose what is read.
    """

    query: str
    fields: tuple[tuple[str, str | int], ...]


@dataclass(frozen=True, slots=True)
class Command:
    """One command: its id, its request and its reply.

    ``request`` and ``reply`` hold the variants of the message, which differ in size; the first is
    the full one. Without ``reply`` and ``text`` the request is one-way. With ``ack`` the reply is
    an acknowledgement, which may come late or never and which nobody waits for. Hand-written code
    finds the command by its ``role``. ``read_by`` says how to read its effect. ``samples`` are the
    raw values by argument that a conformance run may send, for the first variant that has these
    arguments; if empty, it may send all legal values. ``agrees_with`` names queries that report the
    same while the arm rests.
    """

    id: int
    name: str
    title: str
    doc: str
    family: str
    safety: Safety
    deadline_ms: int
    request: tuple[Variant, ...]
    reply: tuple[Variant, ...] = ()
    text: TextReply | None = None
    notes: tuple[str, ...] = ()
    ack: bool = False
    request_text: TextRequest | None = None
    role: Role = ""
    read_by: ReadBack | None = None
    samples: tuple[tuple[tuple[str, tuple[int, ...]], ...], ...] = ()
    agrees_with: tuple[str, ...] = ()
    package: str = field(default="", compare=False, repr=False)
    """The generated package that holds the message types; empty where there is none."""
    _types: list[MessageTypes] = field(default_factory=list, init=False, compare=False, repr=False)

    @property
    def request_type(self) -> type[Request[Any]]:
        """The class of the request."""
        return self._message_types()[0]

    @property
    def reply_type(self) -> type[Reply[Any]] | None:
        """The class of the reply; None where nothing replies."""
        return self._message_types()[1]

    def _message_types(self) -> MessageTypes:
        if not self._types:
            if self.package:
                found = generated_types(self.package, self.name)
            else:
                request, reply = _shape(self.request, self.request_text), None
                if self.reply or self.text:
                    reply = _shape(self.reply, self.text)
                found = made_types(self.name, request, reply)
            self._types.append(found)
        return self._types[0]

    @property
    def answers(self) -> bool:
        """Whether a reply is due."""
        return (bool(self.reply) and not self.ack) or self.text is not None

    def variants(self, direction: Direction) -> tuple[Variant, ...]:
        """Return the variants of this command's message in one direction."""
        return self.request if direction == "request" else self.reply


def _shape(variants: tuple[Variant, ...], text: TextRequest | TextReply | None) -> MessageShape:
    """Return what the class of a message must know; fields of text stand outside the frame."""
    longest_first = sorted(variants, key=lambda variant: len(variant.fields), reverse=True)
    fields = {field.name: field for variant in longest_first for field in variant.fields}
    return MessageShape(
        tuple(
            FieldShape(name, _annotation(field), field.echo or not _in_all(name, variants))
            for name, field in fields.items()
        ),
        text.fields if text else (),
    )


def _in_all(name: str, variants: tuple[Variant, ...]) -> bool:
    return all(any(field.name == name for field in variant.fields) for variant in variants)


def _annotation(field: Field) -> str:
    if field.kind == "flag":
        return "bool"
    word = "float" if any(number.scaled for number in field.numbers) else "int"
    return f"Sequence[{word}]" if field.many else word


@dataclass(frozen=True, slots=True)
class Table:
    """One edition of the protocol."""

    edition: str
    title: str
    joints: int
    baudrate: int
    frame: FrameFormat
    commands: tuple[Command, ...]

    def command(self, name: str) -> Command:
        """Return the command called ``name``.

        Raises:
            UsageError: the edition has no such command; the text names the nearest one.
        """
        for command in self.commands:
            if command.name == name:
                return command
        from difflib import get_close_matches  # rarely needed, slow to import

        near = get_close_matches(name, [command.name for command in self.commands], n=1)
        hint = f"; did you mean {near[0]}?" if near else ""
        raise UsageError("command", name, f"a command of edition {self.edition}{hint}")

    def request_type(self, name: str) -> type[Request[Any]]:
        """Return the class of a command's request.

        Raises:
            UsageError: the edition has no such command.
        """
        return self.command(name).request_type

    def reply_type(self, name: str) -> type[Reply[Any]] | None:
        """Return the class of a command's reply; None where nothing replies.

        Raises:
            UsageError: the edition has no such command.
        """
        return self.command(name).reply_type

    def in_role(self, role: Role) -> Command:
        """Return the first command that has a role.

        Raises:
            UsageError: no command has it.
        """
        for command in self.commands:
            if command.role == role:
                return command
        roles = ", ".join(sorted({command.role for command in self.commands} - {""}))
        raise UsageError("role", role, roles)
