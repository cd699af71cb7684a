"""Short sessions about one request, with a query before and after it; and clients with a fault."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.client import ScriptLine
from cobotwire.conformance.codec.questions.frames import frame_of
from cobotwire.conformance.samples.physical import physical_values
from cobotwire.conformance.samples.raw import RawValues, ordinary
from cobotwire.protocol.table import Command, Table, Variant
from cobotwire.session import text

# Longer than any reply takes, and longer than a session waits for a late one.
PAUSE = 1.2


class Sent(NamedTuple):
    """A write, ``after`` seconds after the previous one."""

    after: float
    data: bytes


class ClientMutant(NamedTuple):
    """A client with a fault. ``script`` is what it should send; if ``lost``, it gets no reply."""

    kind: str
    text: str
    script: tuple[ScriptLine, ...]
    writes: tuple[Sent, ...]
    lost: bool = False

    @property
    def id(self) -> str:
        """The name in tables."""
        return f"{self.kind}: {self.text}"


@dataclass(frozen=True)
class Session:
    """A request with its bytes, and the queries around it."""

    table: Table
    command: Command
    variant: Variant
    position: int
    raw_values: RawValues

    @property
    def place(self) -> str:
        """The session's name in mutant ids."""
        return f"{self.command.name} {self.position + 1}"

    @cached_property
    def frame(self) -> bytes:
        """The unchanged request."""
        return self.frame_with(self.raw_values)

    def frame_with(self, raw_values: RawValues) -> bytes:
        """Return the request with other raw values."""
        return frame_of(self.table, self.command.id, self.variant.pack(raw_values))

    @cached_property
    def text(self) -> bytes:
        """The text that follows the request, if it has one."""
        request_text = self.command.request_text
        if request_text is None:
            return b""
        return text.encode(request_text, {name: "word" for name in request_text.fields})

    @cached_property
    def other(self) -> Command:
        """A query with another id and without arguments, such as whether the arm has power."""
        roles = ("powered", "joints")
        queries = sorted(
            (c for c in self.table.commands if c.safety == "query" and c.requires_reply),
            key=lambda c: roles.index(c.role) if c.role in roles else len(roles),
        )
        return next(
            c for c in queries if c.id != self.command.id and not any(v.fields for v in c.request)
        )

    @cached_property
    def query(self) -> bytes:
        """The bytes of the query."""
        return frame_of(self.table, self.other.id, b"")

    @cached_property
    def line(self) -> ScriptLine:
        """The line of a script with the request."""
        values = tuple(physical_values(self.variant, self.raw_values).values())
        return ScriptLine(self.command, values, "the call")

    @cached_property
    def whole(self) -> bytes:
        """The unchanged request with its text."""
        return self.frame + self.text

    def mutant(self, kind: str, text: str, *frames: bytes) -> ClientMutant:
        """Return a client that sends something else in place of the request."""
        writes = [Sent(PAUSE, data) for data in (self.query, *frames, self.query)]
        return self.timed(kind, text, *writes)

    def timed(self, kind: str, text: str, *writes: Sent) -> ClientMutant:
        """Return a client that writes at other times; ``text`` follows the session's name."""
        query = ScriptLine(self.other, (), "before")
        script = (query, self.line, query)
        return ClientMutant(kind, f"{self.place}: {text}", script, writes)


def sessions(table: Table) -> list[Session]:
    """Return a session for each variant of each request of an edition."""
    codec = ReferenceCodec(table)
    found = []
    for command in table.commands:
        for index, variant in enumerate(command.request):
            session = Session(table, command, variant, index, ordinary(variant))
            values: list[Any] = list(physical_values(variant, session.raw_values).values())
            # Skip a variant if an earlier one accepts all its values.
            if codec.encode(command.name, "request", values) == session.frame:
                found.append(session)
    return found
