"""Which documented limit of the protocol explains a wrong result."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator

from attack.arm import Made, Span, result_of
from attack.delivery import Delivery, Found
from attack.line import Delivered
from attack.record import Call, Record
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import ProtocolError
from cobotwire.session.pending import GRACE_SECONDS

# The names of the limits, as docs/contribute/attack.md explains them.
DAMAGE = "damage"
ECHO = "echo"
COPY = "copy"
TOO_LATE = "too late"
# A byte may be delivered this long before the client's clock says that the request was handed over.
SLACK = 0.02
# While no client is connected, bytes wait for the next client, for at most this time.
KEPT_SECONDS = 3.0


class Evidence:
    """Finds the replies that a call can have taken, and the limit that explains a wrong result."""

    def __init__(
        self,
        codec: Codec,
        spans: list[Span],
        delivered: list[Delivered],
        record: Record,
        grace: float,
    ) -> None:
        self._codec = codec
        self._grace = grace
        self._limits: dict[int, str] = {}
        self._of_request: dict[bytes, list[Call]] = {}
        for call in record.calls:
            self._of_request.setdefault(call.request, []).append(call)
        self._record = record
        self._delivery = Delivery(codec.table.frame, spans, delivered)

    def limit_of(self, call: Call, kept: bool) -> str:
        """Return the known limit of the protocol that explains a wrong result; empty: none does.

        ``kept``: whether bytes may have waited for a new connection.
        """
        return self._limit_of_query(call, kept) if call.query else self._limit_of_ack(call)

    def _limit_of_query(self, call: Call, kept: bool) -> str:
        # A call ends with the reply that it takes, so if several replies are equal, it took the
        # last one.
        last = self._last_handed(call.request, call.ended)
        for since in (last - SLACK, call.began - SLACK, call.began - (KEPT_SECONDS * kept)):
            found = list(self._replies(call, since))
            if found:
                return self._limit(found[-1])
        return ""

    def explain(self, call: Call) -> list[str]:
        """Return when the value of a call was delivered, and as a reply, copy, echo or damage."""
        return [
            f"delivered at {found.at:.3f}{' torn' if found.torn else ''}: "
            + ", ".join(self._origin(span, copy) for span, copy in found.spans)
            for found in self._replies(call, call.began - KEPT_SECONDS)
        ][-6:]

    def handed_at(self, call: Call) -> float | None:
        """Return when the call's request was first handed to the system; None: never."""
        handed = self._record.handed
        index = bisect_right(handed, (call.began, b""))
        while index < len(handed) and handed[index][0] <= call.ended:
            if handed[index][1].endswith(call.request):
                return handed[index][0]
            index += 1
        return None

    def written_at(self, call: Call, handed: float) -> float | None:
        """Return when the system had taken all of a request; None: never."""
        taken = self._record.taken
        index = bisect_right(taken, (handed, b""))
        while index < len(taken) and taken[index][0] <= call.ended:
            # A request that was taken in pieces ends with the last piece.
            if call.request.endswith(taken[index][1]):
                return taken[index][0]
            index += 1
        return None

    def _origin(self, span: Span, copy: bool) -> str:
        what = "copy" if copy else span.label
        made = span.made
        if made is None:
            return what
        damaged = " damaged" if made.damaged else ""
        handed = self._last_handed(made.request, made.at)
        request = f"{damaged} {made.request.hex()}, sent {handed:.3f}, arrived {made.at:.3f}"
        return f"{what} of the reply to{request}"

    def _replies(self, call: Call, since: float) -> Iterator[Found]:
        """Yield the delivered frames that give the result of a call, from a time on."""
        for found in self._delivery.frames(since, call.ended):
            try:
                value = result_of(self._codec, call.name, found.data)
            except ProtocolError:
                continue
            if value == call.value:
                yield found

    def _limit(self, found: Found) -> str:
        for span, _ in found.spans:
            if span.label == "damage":
                return DAMAGE
            if span.label == "echo":
                return ECHO
        [(span, copy), *others] = found.spans
        made = span.made
        if others or found.torn or made is None:
            return ""
        if made.damaged:
            return DAMAGE
        if found.at - self._last_handed(made.request, made.at) > self._grace:
            return TOO_LATE
        if copy:
            return COPY if self._answered(made) else ""
        return self._displaced(found, made)

    def _displaced(self, found: Found, made: Made) -> str:
        """Return the known limit that explains why the call of this reply took another reply."""
        for call in self._calls_of(made):
            # A call cannot take a reply that was delivered after its end, even of equal value.
            took_another = call.value != made.value or call.ended < found.at
            if call.ending == "value" and took_another:
                limit = self._limit_of_taken(call)
                if limit:
                    return limit
        return ""

    def _limit_of_taken(self, call: Call) -> str:
        if call.number not in self._limits:
            # Calls that took each other's replies may form a cycle: end it at this call.
            self._limits[call.number] = ""
            self._limits[call.number] = self._limit_of_query(call, kept=False)
        return self._limits[call.number]

    def _limit_of_ack(self, call: Call) -> str:
        """Return the limit that explains an acknowledgement of a request that did not arrive."""
        for found in self._delivery.frames(call.began - GRACE_SECONDS, call.ended):
            try:
                self._codec.decode("reply", found.data, of=call.name)
            except ProtocolError:
                continue
            limit = self._limit(found)
            if limit or any(copy for _, copy in found.spans):
                return limit or COPY
        return ""

    def _last_handed(self, request: bytes, before: float) -> float:
        """Return when a request was last handed over before a time; if never, that time."""
        handed = self._record.handed
        for index in range(bisect_right(handed, (before, b"\xff")) - 1, -1, -1):
            if handed[index][1].endswith(request):
                return handed[index][0]
        return before

    def _answered(self, made: Made) -> bool:
        """Return whether the call that a reply belongs to got a value."""
        return any(call.ending == "value" for call in self._calls_of(made))

    def _calls_of(self, made: Made) -> list[Call]:
        """Return the calls that can have sent the request of a reply."""
        sent = self._last_handed(made.request, made.at)
        calls = self._of_request.get(made.request, ())
        return [call for call in calls if call.began <= sent <= call.ended]
