"""What all users of a run share: the client's class, the record, and the end of the run."""

from __future__ import annotations

import itertools
from concurrent.futures import CancelledError
from importlib import import_module
from random import Random
from typing import Any

from attack.calls import Drawn, draw, draw_flood
from attack.plans import Plan
from attack.record import Call, Record
from cobotwire import LinkError, ProtocolError, ReplyTimeout, RetryPolicy
from cobotwire import codec as codecs
from cobotwire.protocol.table import Table
from cobotwire.transport.descriptor import WRITE_SECONDS
from probe_client import NODE, ProbeClient, Stopped

CLASSES = {
    ("mycobot280", "blocking"): "MyCobot280",
    ("mycobot280", "asyncio"): "AsyncMyCobot280",
    ("mycobot", "blocking"): "MyCobot",
    ("mycobot", "asyncio"): "AsyncMyCobot",
}
HONEST = (LinkError, ReplyTimeout, ProtocolError)


class Setting:
    """The plan of a run, its record, and what users need to call.

    Attributes:
        over: whether users are to stop.
        flooding: whether users send only one-way requests, to fill a line that nobody reads.
        flood: the name of these requests; if empty, any are drawn.
        longest: the most seconds that a correct call takes, including the wait for its turn.
        options: the arguments of the clients.
        processes: the ids of the processes that clients start.
        stops: when the run stopped a client's process, and for how many seconds.
    """

    def __init__(self, plan: Plan, url: str) -> None:
        self.plan = plan
        self.url = url
        self.record = Record()
        self.over = False
        self.flooding = False
        self.flood = ""
        self.processes: list[str] = []
        self.stops: list[tuple[float, float]] = []
        edition = import_module(f"cobotwire.editions.{plan.edition}")
        self.client: Any = (
            self._open_probe if plan.apart else getattr(edition, CLASSES[plan.edition, plan.client])
        )
        self.table = table_of(plan)
        self.baudrate = self.table.baudrate
        self.codec = codecs.load(self.table, "reference")
        self.retry = RetryPolicy(attempts=plan.attempts, shortest_attempt=0.05, grace=plan.grace)
        self.options: dict[str, Any] = {
            "codec": plan.codec,
            "timeout": plan.timeout,
            "retry": self.retry,
            "deadline": plan.deadline,
        }
        turn = plan.timeout + plan.grace
        if plan.profile.stalls:
            turn += WRITE_SECONDS
        self.longest = plan.users * turn + 1.0
        self._numbers = itertools.count(1)

    def _open_probe(self) -> ProbeClient:
        """Start a client in a process of its own, whose writes and times are recorded."""
        client = ProbeClient(
            self.url,
            self.plan.edition,
            written=self.record.note_write,
            ended=self.record.note_times,
            command=NODE if self.plan.client == "node" else (),
            tasks=self.plan.client == "rust async",
            small=self.plan.profile.stalls,
            timeout=self.plan.timeout,
            deadline=self.plan.deadline,
            attempts=self.plan.attempts,
            shortest_attempt=self.retry.shortest_attempt,
            grace=self.plan.grace,
        )
        self.processes.append(str(client.process.pid))
        stopped = self.record.filling = Stopped(client.process.pid)
        self.stops = stopped.times
        return client

    def draw(self, random: Random) -> Drawn:
        """Draw the next call of a user."""
        number = next(self._numbers)
        if self.flooding:
            return draw_flood(random, number, self.flood)
        return draw(random, self.table, number, self.plan.profile.one_way)

    def begin(self, user: int, drawn: Drawn) -> Call:
        """Note that a call begins; end the run if it is the last one."""
        frame = self.codec.encode(drawn.name, "request", drawn.arguments)
        query = self.table.command(drawn.name).requires_reply
        call = self.record.begin(user, drawn.name, frame, drawn.ack_within, query)
        self.over |= call.number >= self.plan.calls
        return call

    def note_error(self, call: Call, error: BaseException) -> bool:
        """Note the error that ended a call; return False if the transport failed."""
        if isinstance(error, KeyboardInterrupt | CancelledError):
            self.record.end(call, "interrupted", None)
        else:
            text = f"{type(error).__name__}: {error}"
            self.record.end(call, "error" if isinstance(error, HONEST) else "exception", text)
        return not isinstance(error, LinkError)


def table_of(plan: Plan) -> Table:
    """Return the table of the plan's edition."""
    table: Table = import_module(f"cobotwire.editions.{plan.edition}").TABLE
    return table
