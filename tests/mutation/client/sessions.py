"""Short sessions about one request: the request, with a query before and after it."""

from __future__ import annotations

from typing import Any, NamedTuple

from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.client import ScriptLine
from cobotwire.conformance.codec.questions.frames import frame_of
from cobotwire.conformance.samples import (
    RawValues,
    ordinary,
    physical_values,
)
from cobotwire.protocol.table import Command, Table, Variant
from cobotwire.session import text
from mutation.client.mutant import PAUSE, Sent


class Session(NamedTuple):
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

    @property
    def frame(self) -> bytes:
        """The unchanged request."""
        return self.frame_with(self.raw_values)

    def frame_with(self, raw_values: RawValues) -> bytes:
        """Return the request with other raw values."""
        return frame_of(self.table, self.command.id, self.variant.pack(raw_values))

    @property
    def text(self) -> bytes:
        """The text that follows the request, if it has one."""
        request_text = self.command.request_text
        if request_text is None:
            return b""
        return text.encode(request_text, {name: "word" for name in request_text.fields})

    @property
    def other(self) -> Command:
        """A query with another id and without arguments, such as that of the power."""
        roles = ("powered", "joints")
        queries = sorted(
            (c for c in self.table.commands if c.safety == "query" and c.requires_reply),
            key=lambda c: roles.index(c.role) if c.role in roles else len(roles),
        )
        return next(
            c for c in queries if c.id != self.command.id and not any(v.fields for v in c.request)
        )

    @property
    def query(self) -> bytes:
        """The bytes of the query."""
        return frame_of(self.table, self.other.id, b"")

    def script(self, *between: ScriptLine) -> tuple[ScriptLine, ...]:
        """Return the script: query, request, query."""
        values = tuple(physical_values(self.variant, self.raw_values).values())
        query_line = ScriptLine(self.other, (), "before")
        return (query_line, ScriptLine(self.command, values, "the call"), *between, query_line)

    def writes(self, *frames: bytes) -> tuple[Sent, ...]:
        """Return the queries with other writes in place of the request."""
        return tuple(Sent(PAUSE, data) for data in (self.query, *frames, self.query))


def sessions(table: Table) -> list[Session]:
    """Return a session for each variant of each request of an edition."""
    codec = ReferenceCodec(table)
    found = []
    for command in table.commands:
        for index, variant in enumerate(command.request):
            session = Session(table, command, variant, index, ordinary(variant))
            values: list[Any] = list(physical_values(variant, session.raw_values).values())
            # Skip a variant that no values select, because an earlier one allows them.
            if codec.encode(command.name, "request", values) == session.frame:
                found.append(session)
    return found
