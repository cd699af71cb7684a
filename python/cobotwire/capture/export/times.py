"""Parse the start and the end of a time range."""

from __future__ import annotations

from datetime import UTC, datetime

from cobotwire.protocol.errors import UsageError

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def time_ns(text: str, argument: str) -> int:
    """Return a time as nanoseconds since 1970 (UTC).

    The time is ISO 8601, such as ``2026-11-23``, ``2026-11-23T14:30`` or
    ``2026-11-23T14:30:00.5+01:00``. Without a time zone it is UTC.

    Raises:
        UsageError: it is not a time in ISO 8601.
    """
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        message = f"{argument} is {text!r}; give a time in ISO 8601, such as 2026-11-23T14:30:00Z"
        raise UsageError(argument, text, message=message) from None
    if time.tzinfo is None:
        time = time.replace(tzinfo=UTC)
    passed = time - _EPOCH
    return ((passed.days * 86_400 + passed.seconds) * 1_000_000 + passed.microseconds) * 1000
