"""Query an arm, and publish the diagnostics of its port and its state."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

from cobotwire import codec as codecs
from cobotwire.capture.export.ros_messages import Message, header
from cobotwire.client.aio import AsyncClient
from cobotwire.inspect.readiness import ROLES, problems
from cobotwire.inspect.traffic_listener import DiagnosingListener
from cobotwire.protocol.errors import ProtocolError, ReplyTimeout
from cobotwire.protocol.table import Command

OK, WARN, ERROR = 0, 1, 2
# If a query had no reply this often while others had one, it is sent again only after a pause:
# firmware may lack it, and waiting for it delays the joints.
UNANSWERED, PAUSE_SECONDS = 2, 60.0
# Readings of the servos themselves, found by the unit of the reply.
_HEALTH = {"degree_celsius", "volt"}


class Diagnostics:
    """Sends queries to an arm, and publishes the status of each part."""

    def __init__(self, arm: AsyncClient, url: str, publish: Callable[[Message], None]) -> None:
        self._arm, self._url, self._publish = arm, url, publish
        self._traffic = DiagnosingListener(codecs.load(arm.table))
        arm.add_traffic_listener(self._traffic)
        self._failed, self._last_error, self._before = 0, "", (0, 0, 0)
        self._unanswered: dict[str, int] = {}
        self._due: dict[str, float] = {}
        self._servos = [each for each in arm.table.commands if _reports_health(each)]
        self._values: dict[Any, object] = {}
        self._parts: dict[str, Message] = {}

    def note(self, part: str, level: int, text: str, values: Mapping[Any, object] = {}) -> None:
        """Publish the new status of a part, with the status of the other parts."""
        pairs = [{"key": key, "value": str(value)} for key, value in values.items()]
        named = {"level": level, "name": f"cobotwire: {part}", "message": text}
        self._parts[part] = {**named, "hardware_id": self._url, "values": pairs}
        self._publish({"header": header(time.time_ns()), "status": [*self._parts.values()]})

    async def query(self, command: Command) -> Any:
        """Return the result of a query; None if it is not due, or the arm does not reply.

        Raises:
            LinkError: the port is gone.
        """
        name, now = command.name, time.monotonic()
        if now < self._due.get(name, now):
            return None
        try:
            result = await getattr(self._arm, name)()
        except (ReplyTimeout, ProtocolError) as error:
            self._failed, self._last_error = self._failed + 1, str(error)
            self._unanswered[name] = self._unanswered.get(name, 0) + 1
            if self._unanswered[name] >= UNANSWERED and 0 in self._unanswered.values():
                self._due[name] = now + PAUSE_SECONDS
            return None
        self._unanswered[name] = 0
        return result

    async def problems(self) -> str:
        """Return why the arm would not obey a motion; empty if its replies name no reason."""
        table = self._arm.table
        queries = [(role, query) for role in ROLES if (query := table.find_role(role)) is not None]
        states = {role: await self.query(query) for role, query in queries}
        self._values |= states
        if states and set(states.values()) == {None}:
            return "the arm does not reply"
        return "; ".join(problem.text for problem in problems(table, states, self._url))

    async def report(self, rate: float) -> None:
        """Publish all statuses; each time, query one more value of the servos."""
        found = await self.problems()
        if self._servos:
            query = self._servos.pop(0)
            self._servos.append(query)
            reply = await self.query(query)
            self._values[query.name] = " ".join(map(str, reply)) if reply else "no reply"
        self.note("arm", ERROR if found else OK, found or "obeys motions", self._values)
        traffic = self._traffic
        traffic.flush()
        counts = (self._failed, traffic.late, traffic.noise)
        worse, self._before = counts != self._before, counts
        text = "replies are missing, late or damaged" if worse else "replies come in time"
        values = {
            "samples a second": f"{rate:.1f}",
            "requests": traffic.sent,
            "without a reply": self._failed,
            "late": traffic.late,
            "bytes of noise": traffic.noise,
            "noise": traffic.findings,
            "last error": self._last_error,
        }
        self.note("line", WARN if worse else OK, text, values)


def _reports_health(command: Command) -> bool:
    if command.safety != "query" or any(variant.fields for variant in command.request):
        return False
    fields = [field for variant in command.reply for field in variant.fields]
    return bool(
        _HEALTH & {n.unit for field in fields for case in field.cases for n in case.numbers}
    )
