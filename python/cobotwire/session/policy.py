"""How a question is asked again, and for how long its answers are expected: the caller's choice."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.errors import UsageError
from cobotwire.table import Command

# A reply was seen 727 ms after its request on a real line; none later.
GRACE_SECONDS = 1.0
MOST_TRIES = 100


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


@dataclass(frozen=True, slots=True)
class RetryPolicy:
    """Splits the time that an answer may take into a few tries. Only queries are asked again.

    On real lines a reply comes within some 30 ms or never, so asking again beats waiting longer.
    The deadline stays what it is: three tries within 500 ms are one every 167 ms.

    Attributes:
        tries: how often a query is asked at most, 1..100; 1 is never again.
        shortest: seconds that each try gets at least, above 0; a short deadline has fewer tries.
        grace: seconds for which the reply to a try that seems lost is still expected, 0 or more.
            The next question that it could be taken to answer is held so long, or until it came.
    """

    tries: int = 3
    shortest: float = 0.1
    grace: float = GRACE_SECONDS

    def __post_init__(self) -> None:
        """Check the parts."""
        if not _is_number(self.tries) or self.tries not in range(1, MOST_TRIES + 1):
            raise UsageError("retry.tries", self.tries, f"a whole number 1..{MOST_TRIES}")
        if not _is_number(self.shortest) or not 0 < self.shortest < 3600:
            raise UsageError("retry.shortest", self.shortest, "seconds above 0 and below 3600")
        if not _is_number(self.grace) or not 0 <= self.grace < 3600:
            raise UsageError("retry.grace", self.grace, "seconds from 0 to below 3600")

    def tries_of(self, command: Command, wait: float) -> int:
        """Into how many tries the ``wait`` of a question is split.

        What is not a query is never asked twice. Nor is a text outside any frame: two that follow
        each other could not be told from a longer one.
        """
        if command.safety != "query" or command.text is not None:
            return 1
        # 0.3 s are three times 0.1 s, whatever binary fractions say.
        return max(1, min(self.tries, int(wait / self.shortest + 1e-9)))


ASK_ONCE = RetryPolicy(tries=1)
