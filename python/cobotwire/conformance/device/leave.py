"""What a run may send: by class, and for motion how fast and how far."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from cobotwire.errors import UsageError
from cobotwire.table import Command

# What can be allowed by name. Queries need no leave.
CLASSES: dict[str, str] = {
    "setting": "set what is gone with the power, and set it back",
    "persistent-write": "set what outlives a power cycle, after a backup, and set it back",
    "power": "switch the arm's power, hold and release joints",
    "motion": "move the arm; needs a speed limit and a workspace",
    "malformed": "send what is no legal request: wrong LEN, unknown ids, values out of range",
    "irreversible": "send what cannot be set back: calibrations, deletions, what no query reads",
}
EVERYTHING = frozenset(CLASSES)
SPEEDS = range(1, 101)

Range = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Leave:
    """What a run may do beside asking.

    ``workspace`` holds the lowest and highest angle of each joint in degrees, ``max_speed`` is in
    percent of the fastest. Without both nothing moves.
    """

    classes: frozenset[str] = frozenset()
    max_speed: int | None = None
    workspace: tuple[Range, ...] = ()

    @classmethod
    def of(
        cls,
        classes: Iterable[str],
        *,
        joints: int,
        max_speed: int | None = None,
        workspace: Mapping[int, Range] | None = None,
    ) -> Leave:
        """Check what a caller allows; ``workspace`` is by joint, from 1.

        Raises:
            UsageError: an unknown class, motion without a speed limit or a whole workspace, or
                a range that is none. No byte was sent.
        """
        allowed = frozenset(classes)
        for name in sorted(allowed - EVERYTHING):
            raise UsageError("allow", name, f"one of {', '.join(CLASSES)}")
        ranges = tuple((workspace or {}).get(joint, (1.0, 0.0)) for joint in range(1, joints + 1))
        if "motion" in allowed:
            if max_speed not in SPEEDS:
                raise UsageError("max_speed", max_speed, "1 to 100 percent: motion needs it")
            for joint, (low, high) in enumerate(ranges, 1):
                if not -180 <= low < high <= 180:
                    given = (workspace or {}).get(joint)
                    wanted = "LOW..HIGH in degrees within -180..180: motion needs a range a joint"
                    raise UsageError(f"workspace of joint {joint}", given, wanted)
        return cls(allowed, max_speed, ranges if "motion" in allowed else ())

    def lacks(self, needed: frozenset[str]) -> str:
        """The classes that a test needs and that are not allowed, in words; empty: none."""
        return ", ".join(name for name in CLASSES if name in needed - self.classes)


def class_of(command: Command) -> frozenset[str]:
    """The leave that a command needs by its safety class."""
    return (
        frozenset() if command.safety == "query" else frozenset({command.safety.replace(" ", "-")})
    )


def words(text: str) -> list[str]:
    """The words of a list with commas."""
    return [word.strip() for word in text.split(",") if word.strip()]


def workspace_of(text: str, joints: int) -> dict[int, Range]:
    """The workspace as it is written: one range for all joints, or ``JOINT=LOW:HIGH`` for each.

    Raises:
        UsageError: it is no such text.
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
