"""The device under test, as the bodies of test cases use it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Container
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, TypeVar

from cobotwire.codec.interface import Codec
from cobotwire.conformance.device.connection import DeviceConnection
from cobotwire.conformance.device.permissions import Permissions
from cobotwire.conformance.device.requester import Requester, Timing
from cobotwire.conformance.device.requests import Known, units
from cobotwire.conformance.device.response import Response
from cobotwire.conformance.statement import Statement, without
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.messages import Reply, Request, Result
from cobotwire.protocol.table import Address, Command, Role, Table
from cobotwire.session.request import EncodedRequest

Reading = TypeVar("Reading")

# After SILENT queries in a row without any reply, another query shows whether the device is there;
# it is sent up to PINGS times.
SILENT, PINGS = 3, 2
# A text is requested until two replies are equal, at most this often.
TEXT_ATTEMPTS = 5


class EnoughFailures(Exception):
    """A body has failed so often that the rest of it would show nothing new."""


class NoMoreReplies(Exception):
    """The device has stopped replying to queries that it replied to before, or never replied."""


class NotSupported(Exception):
    """A test case cannot run on this kind of device, or in its present state."""


class Restores(dict[str, Callable[[], object]]):
    """The functions that undo what a body or the run changed, by the name of the changed thing."""

    def run(self) -> None:
        """Restore everything, the last change first.

        After an interrupt, what is not restored yet stays here for the next call.
        """
        while self:
            name = next(reversed(self))
            # The old value may be one that cannot be sent; the body may have failed too often.
            with suppress(UsageError, EnoughFailures, NoMoreReplies):
                self[name]()
            self.pop(name, None)


@dataclass(slots=True)
class Noticed:
    """What a run has observed of its device; only :class:`Device` writes it.

    Attributes:
        reply_seconds: the times of the valid replies, by command.
        retried: the commands that were replied to only when they were sent again.
        acknowledged: the response to the first request of each command that may be acknowledged.
        changes: how often each command that may be acknowledged was sent and checked.
        poses: the indices of the poses from which the arm has made a short motion, latest first.
    """

    reply_seconds: dict[str, list[float]] = field(default_factory=dict)
    retried: set[str] = field(default_factory=set)
    acknowledged: dict[str, Response] = field(default_factory=dict)
    changes: Counter[str] = field(default_factory=Counter)
    poses: list[int] = field(default_factory=list)


class Device:
    """Sends requests, and collects what the run has to report and to restore."""

    def __init__(
        self,
        connection: DeviceConnection,
        codec: Codec,
        *,
        permissions: Permissions,
        timing: Timing,
        retries: int = 0,
        address: Address | None = None,
        statement: Statement | None = None,
        optional: Container[str] = (),
    ) -> None:
        self.connection = connection
        self.statement = statement or Statement()
        self.address = address
        self._optional = optional
        # How many joints the device has: one of several devices may have fewer than the edition.
        self.joints = (address and address.joints) or codec.table.joints
        self.edition: Table = codec.table
        # The edition with the commands that the device has, as far as is known.
        self.table = without(codec.table, self.statement.deselected)
        self.permissions = permissions
        self.timing = timing
        self.requester = Requester(connection, codec, timing, address)
        self.retries = retries
        self.noticed = Noticed()
        # How many queries in a row had no reply, and the last query that had one.
        self._silent = 0
        self._replied: EncodedRequest | None = None
        # What to restore after a body, and what at the end of the run.
        self.restore_after_body = Restores()
        self.restore_at_end = Restores()

    def await_start(self, seconds: float) -> bool:
        """Repeat a query until a device that has just been started replies; return whether it does.

        The replies to all repetitions are received, so that none is taken for a later reply.
        """
        query = self.command("powered") or self.command("joints")
        if query is None:
            return False
        request, until = self.requester.prepare(query.request_type()), self.connection.now + seconds
        sent = 1
        response = self.requester.send(request)
        while not response.replies and self.connection.now < until:
            sent += 1
            response = self.requester.send(request)
        while response.replies and len(response.replies) < sent and self.connection.now < until:
            received = len(response.replies)
            self.requester.listen(response, self.timing.grace)
            if len(response.replies) == received:
                break
        return bool(response.replies)

    def command(self, role: Role) -> Command | None:
        """Return the first command in a role; None if the edition or the device has none."""
        return self.table.find_role(role)

    def request(self, request: Request[Any]) -> Response:
        """Send a request, return the response; a query is repeated as often as the run allows."""
        encoded = self.requester.prepare(request)
        if encoded.command.text is not None:
            return self._request_text(encoded)
        response = self.count(self.requester.send(encoded))
        retries = self.retries if encoded.command.safety == "query" else 0
        while retries and not response.replies:
            retries -= 1
            response = self.count(self.requester.send(encoded))
            if response.valid is not None:
                self.noticed.retried.add(request.command)
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
        """Record the reply time, or check that a silent device is still there; return it."""
        command = response.request.command
        if command.requires_reply and response.valid is not None:
            self.noticed.reply_seconds.setdefault(command.name, []).append(response.valid.seconds)
        if response.replies or response.others or response.findings:
            self._silent = 0
            plain = command.safety == "query" and command.text is None
            self._replied = response.request if plain and response.valid else self._replied
        elif command.requires_reply:
            name = command.name
            if name in self._optional and not self.noticed.reply_seconds.get(name):
                self.table = without(self.table, lambda other: other.name == name)
            self._silent += 1
            if self._silent >= SILENT:
                self._expect_alive(response.request)
        return response

    def note_change(self, response: Response) -> int:
        """Note the response to a change that may be acknowledged; return how often it was sent."""
        name = response.request.command.name
        self.noticed.acknowledged.setdefault(name, response)
        self.noticed.changes[name] += 1
        return self.noticed.changes[name]

    def note_motion(self, pose: int) -> None:
        """Note from which pose the arm has made a short motion."""
        self.noticed.poses = list(dict.fromkeys([pose, *self.noticed.poses]))

    def _expect_alive(self, request: EncodedRequest) -> None:
        """Repeat the last query that was replied to, or this one if none was.

        Raises:
            NoMoreReplies: nothing comes.
        """
        query = self._replied or request
        for _ in range(PINGS):
            response = self.requester.send(query)
            if response.replies or response.others or response.findings:
                self._silent = 0
                return
        calls = f"{SILENT} queries in a row, nor to {self.requester.describe(query)}"
        since = "which it replied to before" if self._replied else "sent again"
        raise NoMoreReplies(f"the device does not reply to {calls}, {since}")

    def read(self, query: Request[Result]) -> Reply[Result] | None:
        """Return the valid reply to a query; None if none came."""
        valid = self.request(query).valid
        return None if valid is None else valid.message

    def require(self, query: Request[Result]) -> Reply[Result]:
        """Return the valid reply to a query.

        Raises:
            NotSupported: none came.
        """
        reply = self.read(query)
        if reply is None:
            raise NotSupported(f"{query.command} reports nothing")
        return reply

    def is_set(self, query: Request[Any]) -> bool | None:
        """Return whether any flag of a query's reply is set; None if no valid reply came."""
        reply = self.read(query)
        return None if reply is None else any(reply.fields.values())

    def known(self, command: Command | None = None) -> Known:
        """Return the arm's angles and coordinates by their units, for queries that take a position.

        A value is empty if no valid reply reports it. If ``command`` takes no list of numbers,
        nothing is read.
        """
        if command is not None and not any(f.many for v in command.request for f in v.fields):
            return {}
        found: dict[tuple[str, ...], tuple[float, ...]] = {}
        for role in ("joints", "coordinates"):
            command, query = self.edition.find_role(role), self.command(role)
            if command is None:
                continue
            reply = None if query is None else self.read(query.request_type())
            field = command.reply[0].fields[0]
            row = () if reply is None else getattr(reply, field.name)
            found[units(field.cases[0].numbers)] = row
        return found

    def cannot_send(self, request: Request[Any]) -> str:
        """Return why the edition does not allow a request; empty if it does."""
        try:
            self.requester.prepare(request)
        except UsageError as error:
            return str(error)
        return ""

    def poll(
        self,
        read: Callable[[], Reading],
        done: Callable[[Reading], object],
        seconds: float,
        every: float,
    ) -> Reading:
        """Repeat a reading until it is ``done`` or ``seconds`` have passed; return the last one."""
        until = self.connection.now + seconds
        while not done(reading := read()) and self.connection.now < until:
            self.rest(every)
        return reading

    def rest(self, seconds: float) -> None:
        """Let time pass without a request."""
        self.connection.clock.sleep(seconds)


def _same_text(one: Response, other: Response) -> bool:
    return one.replies[0].message == other.replies[0].message
