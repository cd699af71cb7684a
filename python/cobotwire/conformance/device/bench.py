"""What every trial works with: the line, the edition, what was heard, and what to set back."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from cobotwire.codec.interface import Codec
from cobotwire.conformance.device.asking import Asker, Waits
from cobotwire.conformance.device.ending import Hopeless
from cobotwire.conformance.device.hearing import Hearing
from cobotwire.conformance.device.leave import Leave
from cobotwire.conformance.device.line import Line
from cobotwire.conformance.device.values import Known, units
from cobotwire.errors import UsageError
from cobotwire.session.request import Request
from cobotwire.table import Command, Role, Table

Undo = Callable[[], None]


# How often an unframed answer is asked for until two are the same.
TEXT_TRIES = 5


class Bench:
    """The arm under test as the trials see it."""

    def __init__(
        self,
        line: Line,
        codec: Codec,
        *,
        leave: Leave,
        places: Mapping[str, str],
        waits: Waits,
        retries: int = 0,
    ) -> None:
        self.line = line
        self.table: Table = codec.table
        self.leave = leave
        self.places = places
        self.waits = waits
        self.asker = Asker(line, codec, waits)
        self.retries = retries
        # Reply times in seconds by command.
        self.reply_seconds: dict[str, list[float]] = {}
        # Bytes of noise heard, by its kind.
        self.noise: dict[str, int] = {}
        # Commands that were asked again, and answered then.
        self.retried: set[str] = set()
        # Which commands were acknowledged, of those that may be.
        self.acknowledged: dict[str, bool] = {}
        # What to set back at the end of a trial, and what at the end of the run.
        self.undo: dict[str, Undo] = {}
        self.undo_last: dict[str, Undo] = {}

    def command(self, role: Role) -> Command | None:
        """The first command in a role; None where the edition has none."""
        return next((c for c in self.table.commands if c.role == role), None)

    def ask(
        self,
        command: Command,
        values: Sequence[Any] = (),
        text: Mapping[str, str] | None = None,
    ) -> Hearing:
        """Send a request and hear what comes; a query is asked again as often as is allowed."""
        request = self.asker.request(command, values, text)
        if command.text is not None:
            return self._ask_text(request)
        hearing = self.note(self.asker.ask(request))
        tries = self.retries if command.safety == "query" else 0
        while hearing.good is None and not hearing.replies and tries:
            tries -= 1
            hearing = self.note(self.asker.ask(request))
            if hearing.good is not None:
                self.retried.add(command.name)
        return hearing

    def _ask_text(self, request: Request) -> Hearing:
        """Text has no frame, and noise behind it reads as more of it: two answers must agree."""
        said: list[Hearing] = []
        while len(said) < TEXT_TRIES:
            hearing = self.note(self.asker.ask(request))
            if not hearing.replies or any(_same_text(hearing, other) for other in said):
                return hearing
            said.append(hearing)
        return said[-1]

    def note(self, hearing: Hearing) -> Hearing:
        """Count what a hearing brought."""
        for finding in hearing.noise:
            self.noise[finding.kind] = self.noise.get(finding.kind, 0) + len(finding.data)
        command = hearing.request.command
        if command.answers and hearing.good is not None:
            self.reply_seconds.setdefault(command.name, []).append(hearing.good.seconds)
        return hearing

    def read(self, command: Command, values: Sequence[Any] = ()) -> dict[str, Any] | None:
        """The fields of a query's legal answer; None where none came."""
        good = self.ask(command, values).good
        return None if good is None else good.fields

    def known(self) -> Known:
        """Where the arm is, by the units of the rows: what it surely can calculate with."""
        found: dict[tuple[str, ...], tuple[float, ...]] = {}
        for role in ("joints", "coordinates"):
            command = self.command(role)
            if command is None:
                continue
            fields = self.read(command)
            field = command.reply[0].fields[0]
            if fields is not None:
                found[units(field.cases[0].numbers)] = fields[field.name]
        return found

    def switch(self, query: Command, value: int) -> Command | None:
        """The command that makes a query's flag say ``value``."""
        for command in self.table.commands:
            back = command.read_by
            if back and back.query == query.name and any(said == value for _, said in back.fields):
                return command
        return None

    def set_back(self, undo: dict[str, Undo]) -> None:
        """Set back what a trial, or the run, has changed: the last first.

        What an interrupt cuts short stays in ``undo``, and can be set back again.
        """
        while undo:
            name = next(reversed(undo))
            # What a device told may be nonsense, and a case may have failed often enough.
            with suppress(UsageError, Hopeless):
                undo[name]()
            undo.pop(name, None)


def _same_text(one: Hearing, other: Hearing) -> bool:
    return one.replies[0].fields == other.replies[0].fields
