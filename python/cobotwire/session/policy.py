"""How often a query is sent, and for how long late replies are expected: the caller's choice."""

from __future__ import annotations

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.records import record
from cobotwire.protocol.table import Command

# The latest reply that was seen on a real line came 727 ms after its request.
GRACE_SECONDS = 1.0
MOST_ATTEMPTS = 100


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


@record(frozen=True, slots=True)
class RetryPolicy:
    """Splits the ``timeout`` of a query into attempts. Only queries are ever sent again.

    On real lines a reply comes within some 30 ms or never, so sending again beats waiting longer.
    The time to reply does not change: three attempts within 500 ms are one every 167 ms.

    Attributes:
        attempts: how often a query is sent at most, 1..100; 1 never repeats it.
        shortest_attempt: seconds that each attempt gets at least, above 0; a short timeout has
            fewer attempts.
        grace: seconds after an attempt during which its late reply is still expected, 0 or more.
            A later request whose reply would look the same is held until then, even if a late reply
            has come: it may be a copy.
    """

    attempts: int = 3
    shortest_attempt: float = 0.1
    grace: float = GRACE_SECONDS

    def __post_init__(self) -> None:
        """Check the values."""
        if not _is_number(self.attempts) or self.attempts not in range(1, MOST_ATTEMPTS + 1):
            raise UsageError("retry.attempts", self.attempts, f"a whole number 1..{MOST_ATTEMPTS}")
        if not _is_number(self.shortest_attempt) or not 0 < self.shortest_attempt < 3600:
            allowed = "seconds above 0 and below 3600"
            raise UsageError("retry.shortest_attempt", self.shortest_attempt, allowed)
        if not _is_number(self.grace) or not 0 <= self.grace < 3600:
            raise UsageError("retry.grace", self.grace, "seconds from 0 to below 3600")

    def attempts_of(self, command: Command, wait: float) -> int:
        """Return into how many attempts the ``wait`` of a request is split.

        A command that is not a query gets one. So does a text reply: two that follow each other
        look like one longer text.
        """
        if command.safety != "query" or command.text is not None:
            return 1
        # 0.3 s are three times 0.1 s, in spite of binary fractions.
        return max(1, min(self.attempts, int(wait / self.shortest_attempt + 1e-9)))
