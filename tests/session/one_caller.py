"""A caller that uses an exchange alone, for tests of single requests."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Any

from cobotwire.codec.interface import Codec
from cobotwire.session import (
    EncodedRequest,
    Exchange,
    PendingRequest,
    RetryPolicy,
)
from cobotwire.session.request import RequestEncoder

ONCE = RetryPolicy(attempts=1)


def submit(
    exchange: Exchange,
    request: EncodedRequest,
    now: float,
    policy: RetryPolicy,
    wait: float | None = None,
    ends_by: float = inf,
) -> PendingRequest:
    """Queue a request; the arm has ``wait`` seconds to reply, None: as the edition states."""
    pending = PendingRequest(request, wait, policy, now, ends_by)
    exchange.enqueue(pending)
    return pending


class OneCaller:
    """Send one request after another, each once; the test provides bytes and times."""

    def __init__(self, codec: Codec) -> None:
        self.exchange = Exchange(codec)
        self._encoder = RequestEncoder(codec)
        self.pending: PendingRequest | None = None
        self.receive = self.exchange.receive
        self.wake = self.exchange.wake

    def request(
        self, name: str, values: Sequence[Any], now: float, timeout: float | None = None
    ) -> bytes:
        """Send a request; return its bytes, empty while it is held."""
        request = self._encoder.encode(name, values)
        if not request.command.requires_reply:
            return self.exchange.send_one_way(request, now)[0]
        self.pending = submit(self.exchange, request, now, ONCE, timeout)
        return self.exchange.outgoing(now, drained=True)

    @property
    def waiting(self) -> bool:
        """Whether the last request waits for its reply."""
        return self.pending is not None and not self.pending.done

    def give_up(self) -> None:
        """Stop waiting, as Ctrl-C does."""
        if self.pending is not None:
            self.exchange.give_up(self.pending)
