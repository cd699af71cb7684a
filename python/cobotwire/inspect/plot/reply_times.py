"""Pair the requests and replies of a recording, and measure the time between them."""

from __future__ import annotations

from dataclasses import dataclass, field

from cobotwire.protocol.table import Table


@dataclass
class ReplyTimes:
    """The times of requests, in seconds since the start of the recording, and of their replies.

    Attributes:
        all: the time of each request with a reply, and the seconds until the reply.
        late: the entries of ``all`` with a reply after the command's deadline.
        missing: the times of requests without a reply.
    """

    all: list[tuple[float, float]] = field(default_factory=list)
    late: list[tuple[float, float]] = field(default_factory=list)
    missing: list[float] = field(default_factory=list)


class Pairing:
    """Pairs each reply with the newest request of its id; the protocol has no sequence numbers.

    So if a request is repeated before its reply comes, the reply belongs to the repetition, and the
    first request counts as unanswered.
    """

    def __init__(self, table: Table) -> None:
        self.times = ReplyTimes()
        self._deadlines = {c.id: c.deadline_ms / 1000 for c in table.commands if c.requires_reply}
        self._open: dict[int, float] = {}

    def sent(self, at: float, id: int) -> None:
        """Take a request that was sent."""
        if id in self._deadlines:
            if id in self._open:
                self.times.missing.append(self._open[id])
            self._open[id] = at

    def received(self, at: float, id: int) -> None:
        """Take a reply that was received."""
        requested = self._open.pop(id, None)
        # A reply before its request: the recorder's clock was set back between the two.
        if requested is None or at < requested:
            return
        self.times.all.append((requested, at - requested))
        if at - requested > self._deadlines[id]:
            self.times.late.append((requested, at - requested))

    def finish(self) -> ReplyTimes:
        """Return the times; requests that are still open have no reply."""
        self.times.missing += self._open.values()
        self._open.clear()
        self.times.missing.sort()
        return self.times
