"""Queue a request of a caller that uses an exchange without a client."""

from __future__ import annotations

from math import inf

from cobotwire.session import EncodedRequest, Exchange, PendingRequest, RetryPolicy


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
