"""The device under test, as the bodies of test cases use it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from cobotwire.codec.interface import Codec
from cobotwire.conformance.device.connection import DeviceConnection
from cobotwire.conformance.device.permissions import Permissions
from cobotwire.conformance.device.requester import Requester, Timing
from cobotwire.conformance.device.response import Response
from cobotwire.conformance.device.samples import Known, units
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command, Role, Table
from cobotwire.session.request import EncodedRequest

Restore = Callable[[], object]

# How often a text is requested at most, until two replies are the same.
TEXT_ATTEMPTS = 5


class EnoughFailures(Exception):
    """A body has failed so often that the rest of it would show nothing new."""


class NotSupported(Exception):
    """A test case cannot run on this kind of device, or in its present state."""


class Device:
    """Sends requests, and remembers what the run has to report and to restore."""

    def __init__(
        self,
        connection: DeviceConnection,
        codec: Codec,
        *,
        permissions: Permissions,
        timing: Timing,
        retries: int = 0,
    ) -> None:
        self.connection = connection
        self.table: Table = codec.table
        self.permissions = permissions
        self.timing = timing
        self.requester = Requester(connection, codec, timing)
        self.retries = retries
        # Reply times in seconds, by command.
        self.reply_seconds: dict[str, list[float]] = {}
        # Commands that were replied to only when they were sent again.
        self.retried: set[str] = set()
        # For each command that may be acknowledged: whether it was.
        self.acknowledged: dict[str, bool] = {}
        # What to restore after a body, and what at the end of the run.
        self.restore_after_body: dict[str, Restore] = {}
        self.restore_at_end: dict[str, Restore] = {}

    def command(self, role: Role) -> Command | None:
        """Return the first command in a role; None if the edition has none."""
        return next((c for c in self.table.commands if c.role == role), None)

    def request(
        self,
        command: Command,
        values: Sequence[Any] = (),
        text: Mapping[str, str] | None = None,
    ) -> Response:
        """Send a request and return what came; a query is repeated as often as the run allows."""
        request = self.requester.prepare(command, values, text)
        if command.text is not None:
            return self._request_text(request)
        response = self.count(self.requester.send(request))
        retries = self.retries if command.safety == "query" else 0
        while retries and not response.replies:
            retries -= 1
            response = self.count(self.requester.send(request))
            if response.valid is not None:
                self.retried.add(command.name)
        return response

    def _request_text(self, request: EncodedRequest) -> Response:
        """Request a text until two replies agree, because noise after it looks like part of it."""
        earlier: list[Response] = []
        while len(earlier) < TEXT_ATTEMPTS:
            response = self.count(self.requester.send(request))
            if not response.replies or any(_same_text(response, other) for other in earlier):
                return response
            earlier.append(response)
        return earlier[-1]

    def count(self, response: Response) -> Response:
        """Count the reply time of a response, and return the response."""
        command = response.request.command
        if command.answers and response.valid is not None:
            self.reply_seconds.setdefault(command.name, []).append(response.valid.seconds)
        return response

    def read(self, command: Command, values: Sequence[Any] = ()) -> dict[str, Any] | None:
        """Return the fields of a query's valid reply; None if none came."""
        valid = self.request(command, values).valid
        return None if valid is None else valid.fields

    def is_set(self, query: Command) -> bool | None:
        """Return whether any flag of a query's reply is set; None if no valid reply came."""
        fields = self.read(query)
        return None if fields is None else any(fields.values())

    def known(self) -> Known:
        """Return the arm's position as rows of numbers, by their units, for its calculations."""
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

    def setter(self, query: Command, value: int) -> Command | None:
        """Return the command that makes the flag of a query have ``value``."""
        for command in self.table.commands:
            back = command.read_by
            if back and back.query == query.name and any(v == value for _, v in back.fields):
                return command
        return None

    def restore(self, what: dict[str, Restore]) -> None:
        """Restore what a body, or the run, has changed: the last change first.

        After an interrupt, what is not restored yet stays in ``what`` for the next call.
        """
        while what:
            name = next(reversed(what))
            # The old value may be one that cannot be sent; the body may have failed too often.
            with suppress(UsageError, EnoughFailures):
                what[name]()
            what.pop(name, None)


def _same_text(one: Response, other: Response) -> bool:
    return one.replies[0].fields == other.replies[0].fields
