"""Define the protocol as data: both codecs interpret these records.

An edition is one :class:`Table`. The classes know no command by name, and do no I/O. They are plain
records, so that the Rust codec can read the same objects attribute by attribute.
:mod:`cobotwire.protocol.fields` and :mod:`cobotwire.protocol.frame_format` hold the records inside
a message and the rules for reading them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Any, Literal, NamedTuple

from cobotwire.protocol.checks import Check, Crc
from cobotwire.protocol.errors import UsageError, did_you_mean
from cobotwire.protocol.fields import Case, Field, FieldKind, Variant, named_fields
from cobotwire.protocol.frame_format import Direction, FrameFormat, Unsigned
from cobotwire.protocol.made_messages import (
    MessageTypes,
    generated_types,
    made_types,
    reply_shape,
    request_shape,
)
from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.numbers import Number
from cobotwire.protocol.robot import UNSTATED, Robot

__all__ = [
    "Address",
    "Case",
    "Check",
    "Command",
    "Crc",
    "Direction",
    "Field",
    "FieldKind",
    "FrameFormat",
    "Number",
    "ReadBack",
    "Robot",
    "Role",
    "Safety",
    "Table",
    "TextReply",
    "TextRequest",
    "Unsigned",
    "Variant",
]

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
    "paused",
    "error",
    "version",
    "gripper",
    "motion ended",
    "halt",
    "light",
]


class TextReply(NamedTuple):
    """A reply that is text outside any frame: ``prefixes[i]`` comes before ``fields[i]``.

    It ends when no byte has come for ``silence_ms``.
    """

    prefixes: tuple[str, ...]
    fields: tuple[str, ...]
    silence_ms: int
    suffix: str = ""


class TextRequest(NamedTuple):
    """Text after the frame of a request, built as in ``TextReply``; it ends with ``suffix``."""

    prefixes: tuple[str, ...]
    fields: tuple[str, ...]
    suffix: str


class ReadBack(NamedTuple):
    """The query that reads back what a command has set.

    ``fields`` pairs each field of the query's reply with the argument of the command that it
    repeats, or with the raw value that it holds afterwards. If ``fields`` is empty, each field
    repeats the argument of the same name. Arguments that the query shares with the command choose
    what is read.
    """

    query: str
    fields: tuple[tuple[str, str | int], ...]


class _CommandFields(NamedTuple):
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
    arguments: tuple[str, ...] = ()
    event: bool = False
    accepted: tuple[int, ...] = ()
    package: str = ""
    stated_effect: Mapping[str, Any] | None = None
    firmware: Mapping[str, float] | None = None


class Command(_CommandFields):
    """One command: its id, its request and its reply.

    ``request`` and ``reply`` hold the variants of the message, the full one first. Without
    ``reply`` and ``text`` the request is one-way. With ``ack`` the reply is an acknowledgement: it
    may come late or never, and by default no call waits for it. Hand-written code finds the command
    by its ``role``. ``read_by`` names the query that reads back what the command has set.
    ``samples`` lists, by argument, the raw values that a conformance run may send, for the first
    variant with these arguments; if it is empty, the run may send all legal values. ``agrees_with``
    names the queries that report the same quantity while the arm rests. ``arguments`` is the order
    of the method's arguments; if it is empty, they have the order of the wire.
    ``package`` is the generated package with the message types; empty for a table without one.
    ``stated_effect`` is what the command does, as in ``edition.json``
    (:func:`cobotwire.protocol.effects.effect_of`).
    ``firmware`` holds the versions on which it depends, as far as sources know them: ``since`` the
    first one that has the command, ``until`` the first one that lacks it again, ``reply_since`` the
    first one that replies to it.
    """

    def __hash__(self) -> int:
        """Return a hash of some fields that distinguish commands: hashing all fields takes long."""
        return hash((self.package, self.name, self.id))

    @property
    def argument_names(self) -> tuple[str, ...]:
        """The arguments of the client's method in their order."""
        text = self.request_text.fields if self.request_text else ()
        return self.arguments or (*named_fields(self.request), *text)

    @property
    def request_type(self) -> type[Request[Any]]:
        """The class of the request."""
        return self._message_types[0]

    @property
    def reply_type(self) -> type[Reply[Any]] | None:
        """The class of the reply; None for a one-way request."""
        return self._message_types[1]

    @cached_property
    def _message_types(self) -> MessageTypes:
        if self.package:
            return generated_types(self.package, self.name)
        texts = self.request_text.fields if self.request_text else ()
        request = request_shape(self.request, texts, self.argument_names)
        reply = None
        if self.reply or self.text:
            texts = self.text.fields if self.text else ()
            reply = reply_shape(self.reply, texts, self.ack)
        return made_types(self.name, request, reply, self.event)

    @property
    def is_stop(self) -> bool:
        """Whether it stops the arm or ends its motion: it has the role stop or halt."""
        return self.role in ("stop", "halt")

    @property
    def requires_reply(self) -> bool:
        """Whether the protocol requires a reply."""
        return (bool(self.reply) and not self.ack and not self.event) or self.text is not None

    def refusal(self, fields: Mapping[str, Any]) -> tuple[str, str] | None:
        """Return the name and the value of the status by which a reply reports a failure.

        Without ``accepted``, each field that is 0 reports it; constants and repeated arguments do
        not count. None: the reply reports success.
        """
        statuses: tuple[Field, ...] = ()
        for variant in self.reply:
            # A typed message lacks the constants.
            own = tuple(f for f in variant.fields if len(f.choices) != 1 or f.labels)
            if {f.name for f in own} <= set(fields) <= {f.name for f in variant.fields}:
                statuses = own
        if not statuses:
            return None
        last = statuses[-1]
        if self.accepted:
            value = fields[last.name]
            return None if value in self.accepted else (last.name, _word(last, value))
        for each in statuses:
            if not each.echo and not each.many and fields[each.name] == 0:
                return each.name, _word(each, 0)
        return None

    def variants(self, direction: Direction) -> tuple[Variant, ...]:
        """Return the variants of this command's message in one direction."""
        return self.request if direction == "request" else self.reply


def _word(field: Field, value: int) -> str:
    """Return a status as a person reads it: ``NO_POWER (3)``, or ``3 (the arm has no power)``."""
    if value in field.choices and field.labels:
        return f"{field.labels[field.choices.index(value)]} ({value})"
    meaning = field.meaning(value)
    return f"{value} ({meaning})" if meaning else str(value)


class Address(NamedTuple):
    """A value of the address byte.

    Attributes:
        name: its name in the edition.
        value: the byte.
        doc: which device has it.
        replies: where replies to a request come from: this address (``own``), several addresses
            (``any``: several devices receive it), one of them that replies for all (``one``), or
            none (``none``).
        joints: how many joints the device has; 0: as many as the edition.
    """

    name: str
    value: int
    doc: str = ""
    replies: Literal["own", "any", "one", "none"] = "own"
    joints: int = 0


class Table(NamedTuple):
    """One edition of the protocol.

    ``robot`` is what the edition states apart from its messages. ``addresses`` describes the
    addresses of ``frame``, in the same order; it is empty if they have no names. ``bases`` are the
    editions that it is a delta of, the nearest first.
    """

    edition: str
    title: str
    joints: int
    baudrate: int
    frame: FrameFormat
    commands: tuple[Command, ...]
    robot: Robot = UNSTATED
    addresses: tuple[Address, ...] = ()
    bases: tuple[str, ...] = ()

    def __hash__(self) -> int:
        """Return a hash of some fields that distinguish editions: hashing all fields takes long."""
        return hash((self.edition, self.title, self.joints, self.baudrate, len(self.commands)))

    def command(self, name: str, *, also: Iterable[str] = ()) -> Command:
        """Return the command called ``name``.

        Raises:
            UsageError: the edition has no such command; the text names the nearest one, or the
                nearest of the names in ``also``.
        """
        for command in self.commands:
            if command.name == name:
                return command
        hint = did_you_mean(name, [*(command.name for command in self.commands), *also])
        message = f"there is no command {name!r} in edition {self.edition}{hint}"
        raise UsageError("command", name, message=message)

    def request_type(self, name: str) -> type[Request[Any]]:
        """Return the class of a command's request.

        Raises:
            UsageError: the edition has no such command.
        """
        return self.command(name).request_type

    def reply_type(self, name: str) -> type[Reply[Any]] | None:
        """Return the class of a command's reply; None for a one-way request.

        Raises:
            UsageError: the edition has no such command.
        """
        return self.command(name).reply_type

    def find_role(self, role: Role) -> Command | None:
        """Return the first command with a role; None if the edition has none."""
        return next((command for command in self.commands if command.role == role), None)

    def find_setter(self, role: Role, raw: int) -> Command | None:
        """Return the first command that makes the query of a role report a raw value."""
        query = self.find_role(role)
        for command in self.commands:
            back = command.read_by
            if query is None or back is None or back.query != query.name:
                continue
            if raw in [value for _, value in back.fields]:
                return command
        return None

    def in_role(self, role: Role) -> Command:
        """Return the first command with a role.

        Raises:
            UsageError: no command of the edition has the role.
        """
        command = self.find_role(role)
        if command is not None:
            return command
        roles = ", ".join(sorted({command.role for command in self.commands} - {""}))
        message = f"edition {self.edition} has no command with the role {role!r}; it has {roles}"
        raise UsageError("role", role, roles, message=message)
