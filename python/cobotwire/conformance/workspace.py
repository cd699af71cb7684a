"""Read a workspace: the angles that an arm may move in."""

from __future__ import annotations

from cobotwire.protocol.errors import UsageError

Range = tuple[float, float]


def words(text: str) -> list[str]:
    """Return the words of a comma-separated list."""
    return [word.strip() for word in text.split(",") if word.strip()]


def parse_workspace(text: str, joints: int) -> dict[int, Range]:
    """Parse a workspace: one range for all joints, or ``JOINT=LOW:HIGH`` for each.

    Raises:
        UsageError: the text has neither form.
    """
    found: dict[int, Range] = {}
    for word in words(text):
        joint, equals, span = word.rpartition("=")
        low, colon, high = span.partition(":")
        try:
            if not colon:
                raise ValueError(span)
            which = [int(joint)] if equals else list(range(1, joints + 1))
            found |= dict.fromkeys(which, (float(low), float(high)))
        except ValueError:
            allowed = "LOW:HIGH in degrees, or JOINT=LOW:HIGH for each joint"
            raise UsageError("workspace", word, allowed) from None
    return found
