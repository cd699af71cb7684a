"""What a run may send: by class, and for motion how fast and where."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from cobotwire.conformance.workspace import Range
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command

# What can be permitted, by name. Queries need no permission.
PERMISSIONS: dict[str, str] = {
    "setting": "change what a power cycle resets, and restore it",
    "persistent-write": "change what outlives a power cycle, after a backup, and restore it",
    "power": "switch the arm's power, hold and release joints",
    "motion": "move the arm; needs a speed limit and a workspace",
    "malformed": "send malformed requests: wrong LEN, unknown ids, values out of range",
    "irreversible": "send what cannot be restored: calibrations, deletions, what no query reads",
}
ALL_PERMISSIONS = frozenset(PERMISSIONS)
SPEEDS = range(1, 101)


@dataclass(frozen=True, slots=True)
class Permissions:
    """What a run may do in addition to sending queries.

    ``workspace`` holds the lowest and highest angle of each joint in degrees, ``max_speed`` is in
    percent of the highest. Motion needs both.
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
    ) -> Permissions:
        """Validate what a caller permits; ``workspace`` is by joint, from 1.

        Raises:
            UsageError: an unknown class, motion without a speed limit or a whole workspace, or
                an invalid range. Nothing has been sent.
        """
        allowed = frozenset(classes)
        for name in sorted(allowed - ALL_PERMISSIONS):
            raise UsageError("allow", name, f"one of {', '.join(PERMISSIONS)}")
        ranges = tuple((workspace or {}).get(joint, (1.0, 0.0)) for joint in range(1, joints + 1))
        if "motion" in allowed:
            if max_speed not in SPEEDS:
                needs = "motion needs max_speed, 1 to 100 percent" if max_speed is None else ""
                raise UsageError("max_speed", max_speed, "1 to 100 percent", message=needs)
            for joint, (low, high) in enumerate(ranges, 1):
                if not -180 <= low < high <= 180:
                    span = (workspace or {}).get(joint)
                    place = f"workspace of joint {joint}"
                    wanted = "LOW..HIGH in degrees within -180..180"
                    needs = f"motion needs the {place}, {wanted}" if span is None else ""
                    raise UsageError(place, span, wanted, message=needs)
        return cls(allowed, max_speed, ranges if "motion" in allowed else ())

    def missing(self, needed: frozenset[str]) -> str:
        """Return the classes that are needed and not permitted, in words; empty if all are."""
        return ", ".join(name for name in PERMISSIONS if name in needed - self.classes)


def class_of(command: Command) -> frozenset[str]:
    """Return the permission that a command needs by its safety class."""
    return (
        frozenset() if command.safety == "query" else frozenset({command.safety.replace(" ", "-")})
    )
