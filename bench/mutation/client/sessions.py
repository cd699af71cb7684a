"""Short sessions about one request: the request, and a question before and after it."""

from __future__ import annotations

from typing import Any, NamedTuple

from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.client import Told
from cobotwire.conformance.codec.trials.frames import frame_of
from cobotwire.conformance.codec.trials.pictures import Wholes, named_values, ordinary, wire_data
from cobotwire.session import text
from cobotwire.table import Command, Layout, Table
from mutation.client.mutant import PAUSE, Sent


class Session(NamedTuple):
    """A request with its bytes, and what stands around it."""

    table: Table
    command: Command
    layout: Layout
    form: int
    wholes: Wholes

    @property
    def place(self) -> str:
        """What it is called in ids."""
        return f"{self.command.name} {self.form + 1}"

    @property
    def frame(self) -> bytes:
        """The right request."""
        return self.frame_with(self.wholes)

    def frame_with(self, wholes: Wholes) -> bytes:
        """The request with other numbers."""
        return frame_of(self.table, self.command.id, wire_data(self.layout, wholes))

    @property
    def behind(self) -> bytes:
        """The text behind the request, where it has one."""
        spelled = self.command.request_text
        if spelled is None:
            return b""
        return text.spell(spelled, {name: "word" for name in spelled.fields})

    @property
    def other(self) -> Command:
        """A question that is not about the same id."""
        role = "powered" if self.command.role != "powered" else "joints"
        return self.table.in_role(role)  # type: ignore[arg-type]

    @property
    def question(self) -> bytes:
        """That question's bytes."""
        return frame_of(self.table, self.other.id, b"")

    def told(self, *between: Told) -> tuple[Told, ...]:
        """The script: question, request, question."""
        values = tuple(named_values(self.layout, self.wholes).values())
        asked = Told(self.other, (), "before")
        return (asked, Told(self.command, values, "the call"), *between, asked)

    def writes(self, *frames: bytes) -> tuple[Sent, ...]:
        """What is sent instead of the request, with the questions around it."""
        return tuple(Sent(PAUSE, data) for data in (self.question, *frames, self.question))


def sessions(table: Table) -> list[Session]:
    """One for each form of each request of an edition."""
    codec = ReferenceCodec(table)
    found = []
    for command in table.commands:
        for form, layout in enumerate(command.request):
            session = Session(table, command, layout, form, ordinary(layout))
            values: list[Any] = list(named_values(layout, session.wholes).values())
            # A form that another one hides is never sent.
            if codec.encode(command.name, "request", values) == session.frame:
                found.append(session)
    return found
