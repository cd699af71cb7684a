"""Facts about each request and reply that the world knows, and the exchange has to find out."""

from __future__ import annotations

from dataclasses import dataclass, field

from cobotwire.session import Pending
from session.exploring.topics import KINDS, REQUESTS


@dataclass(eq=False)
class Call:
    """A request of a caller; ``pending`` is None if the caller does not wait."""

    kind: str
    ends_by: float
    pending: Pending | None = None
    ended: bool = False
    writes: list[float] = field(default_factory=list)
    received_by_arm: int = 0
    # The variants of its replies that were read while it waited.
    read: set[int] = field(default_factory=set)
    # The texts that were read while it waited for a text.
    texts: list[Arrival] = field(default_factory=list)
    answered: bool = False
    # If the reply to another request ended this call: the limit of the protocol that excuses it.
    misled: str | None = None

    @property
    def is_query(self) -> bool:
        """Whether it requires a reply."""
        return REQUESTS[self.kind].command.requires_reply

    @property
    def command(self) -> str:
        """The name of its command."""
        return KINDS[self.kind].command

    @property
    def waits(self) -> bool:
        """Whether the call has been ended neither by its caller nor by the exchange."""
        return not self.ended and self.pending is not None and not self.pending.done


@dataclass(eq=False)
class Reply:
    """A reply to a request that the arm received; it may come twice, or never."""

    call: Call
    requested_at: float
    times: int = 0


@dataclass(eq=False)
class Arrival:
    """Bytes that came to the host; ``copy`` is 2 for a doubled reply, ``form`` -1 if damaged."""

    data: bytes
    time: float
    reply: Reply | None = None
    copy: int = 1
    form: int = 0
