"""The one session with an arm: it polls the arm in a thread, and sends what pages request."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import nullcontext, suppress
from typing import Any, NamedTuple

from cobotwire.editions import Edition
from cobotwire.inspect.readiness import check_accepted, check_ready
from cobotwire.protocol.errors import LinkError, ProtocolError, ReplyTimeout
from cobotwire.protocol.limits import Limits
from cobotwire.protocol.roles import starts_motion
from cobotwire.protocol.table import Command, Role
from cobotwire.session import Traffic
from cobotwire.studio.sending import NotPermitted
from cobotwire.studio.turns import Turns
from cobotwire.transport import open_transport

POLLED: tuple[Role, ...] = ("joints", "coordinates")
# If a query had no reply this often although another one had, it is sent again only after a pause:
# an arm of unknown geometry may not report its coordinates, and waiting for them slows down the
# rest.
UNANSWERED, PAUSE_SECONDS = 2, 60.0
# A port that disappeared is opened again at most this often.
REOPEN_SECONDS = 1.0
# How many items of traffic wait for the server; then the oldest is dropped, and counted.
QUEUED = 20_000


class PortOptions(NamedTuple):
    """How the port is opened; None: the value of the edition, or no recording."""

    url: str
    baudrate: int | None = None
    record: str | None = None
    address: int | str | None = None
    limits: Limits | None = None


class _Poll:
    """A query that is sent again and again."""

    def __init__(self, command: Command) -> None:
        self.command, self.unanswered, self.due = command, 0, 0.0


class ArmLine:
    """Owns the port while its ``with`` block runs.

    Attributes:
        lost: how many items of traffic were dropped, because the server was too slow.
        problem: why the port cannot be used now; empty if it can.
        stops: how often a stop was requested.
        is_held: returns whether a page holds a motion now.
    """

    def __init__(self, edition: Edition, port: PortOptions, rate: float) -> None:
        """Open the port. The arm is polled ``rate`` times a second; 0: never.

        Raises:
            UsageError: the port, the baud rate, the address or the file is not allowed.
            LinkError: the port does not exist, or cannot be opened.
        """
        self.table, self.lost, self.problem = edition.TABLE, 0, ""
        self.stops = 0
        self.is_held: Callable[[], bool] = lambda: False
        # Held from sending a request until its reply. So a request is sent at once after the check
        # that it may still be sent, instead of waiting for other requests in between.
        self._replying = Turns()
        # Stops by their number: the newest that was sent, that failed, and that was written.
        self._numbering = threading.Lock()
        self._newest = self._failed = self._written = 0
        self.url = port.url
        self.baudrate = port.baudrate or self.table.baudrate
        self._rate = rate
        self._traffic: deque[Traffic] = deque(maxlen=QUEUED)
        self._transport = open_transport(port.url, self.baudrate)
        try:
            self._arm = edition.CLIENT(
                self._transport,
                trace=self._note,
                record=port.record,
                address=port.address,
                limits=port.limits,
                on_error="leave",
            )
        except BaseException:
            self._transport.close()
            raise
        roles = (self.table.find_role(role) for role in POLLED)
        self._polled = [_Poll(command) for command in roles if command is not None and rate]
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="cobotwire-studio", daemon=True)

    def __enter__(self) -> ArmLine:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._ended.set()
        self._thread.join(2.0)
        self._arm.close()

    def take(self) -> list[Traffic]:
        """Return the traffic since the last call."""
        taken = []
        while self._traffic:
            taken.append(self._traffic.popleft())
        return taken

    def call(
        self,
        command: Command,
        arguments: dict[str, Any],
        force: bool,
        permit: Callable[[], None],
        stops: int,
    ) -> Any:
        """Send a command and return its result; check first whether the arm obeys a motion.

        If the arm was stopped in the meantime, only a query is sent: a motion may have waited for a
        thread, for another request, or for the arm.

        Args:
            command: what to send.
            arguments: its arguments by name.
            force: whether a motion is sent without a check that the arm obeys.
            permit: raises an error if the command may no longer be sent; called just before.
            stops: the value of ``stops`` that the page knew when the user requested the command.

        Raises:
            CobotwireError: the command is not permitted, an argument is not allowed, the arm was
                stopped meanwhile, does not obey or does not reply, or the port is gone.
        """
        checks = starts_motion(self.table, command) and not force
        if checks:
            with self._replying:
                check_ready(self._arm, command.name, self.url)
        # What needs no reply is written at once, whatever other requests wait for.
        with self._replying if command.requires_reply else nullcontext():
            result = self._send(command, arguments, permit, stops)
        if checks:
            with self._replying:
                check_accepted(self._arm, command.name, self.url)
        return result

    def _send(
        self, command: Command, arguments: dict[str, Any], permit: Callable[[], None], stops: int
    ) -> Any:
        query = command.safety == "query"
        if not query and self.stops != stops:
            raise NotPermitted(
                f"{command.name} was not sent, because the arm was stopped meanwhile"
            )
        permit()
        try:
            return getattr(self._arm, command.name)(**arguments)
        finally:
            if not query and self.stops != stops:
                # The stop may have been sent before this command.
                self.send_stop()

    def stop(self) -> None:
        """Count a stop, and send the edition's stop at once, before any request that waits.

        Raises:
            UsageError: the edition has no stop.
            LinkError: the port is gone.
        """
        # The stop is counted first, so that no waiting motion is sent after it.
        self.stops += 1
        self.send_stop()

    def send_stop(self) -> None:
        """Send the edition's stop at once; the caller has counted it.

        Raises:
            UsageError: the edition has no stop.
            LinkError: the port is gone; stop is sent again as soon as it is back.
        """
        stop = getattr(self._arm, self.table.in_role("stop").name)
        with self._numbering:
            self._newest = number = self._newest + 1
        try:
            stop()
        except LinkError:
            self._note_failed(number)
            raise
        with self._numbering:
            self._written = max(self._written, number)

    def _note_failed(self, number: int) -> None:
        with self._numbering:
            self._failed = max(self._failed, number)

    def _repeat_stop(self) -> None:
        """Send stop if the newest one could not be sent: the arm may still move."""
        if self._failed > self._written and self.table.find_role("stop") is not None:
            with suppress(LinkError):
                self.send_stop()

    def _note(self, traffic: Traffic) -> None:
        # The thread that reads or writes runs this, so it only queues.
        self.lost += len(self._traffic) == QUEUED
        self._traffic.append(traffic)

    def _run(self) -> None:
        while not self._ended.is_set():
            try:
                self._repeat_stop()
                self._poll()
            except LinkError as error:
                self.problem = str(error)
                if self.is_held():
                    # While the port is gone, a release of the motion cannot stop the arm.
                    self._note_failed(self._written + 1)
                self._reopen()

    def _poll(self) -> None:
        due = time.monotonic() + (1 / self._rate if self._polled else 0.1)
        for poll in tuple(self._polled):
            if poll.due <= time.monotonic():
                self._query(poll)
        self._arm.listen(max(0.0, due - time.monotonic()))

    def _query(self, poll: _Poll) -> None:
        try:
            with self._replying:
                getattr(self._arm, poll.command.name)()
        except (ReplyTimeout, ProtocolError) as error:
            # Pages show what was received instead.
            if isinstance(error, ReplyTimeout) and error.refusal:
                self._polled.remove(poll)
                return
            poll.unanswered += 1
            others = any(not each.unanswered for each in self._polled)
            if poll.unanswered >= UNANSWERED and others:
                poll.due = time.monotonic() + PAUSE_SECONDS
        else:
            poll.unanswered = 0

    def _reopen(self) -> None:
        while not self._ended.wait(REOPEN_SECONDS):
            try:
                self._transport.reopen()
            except LinkError as error:
                self.problem = str(error)
            else:
                self.problem = ""
                return


Remark = Callable[[str, str], None]
"""Takes the kind of a remark about the line, and its text."""
