"""Arguments, results and setpoints of ``follow``; its first call imports the rest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

from cobotwire.session.request import EncodedRequest

Target = Sequence[float]
Ended = Literal["end", "silence", "stall", "short", "stopped"]


class Waypoint(NamedTuple):
    """A point of a path: angles in degrees, or coordinates in millimetres and degrees.

    Attributes:
        target: the angles, base first; or x, y, z, rx, ry, rz.
        time: when the arm is to be there, in seconds from the start of the path; None: as soon as
            the limits allow. Either all points of a path have times, or none has.
    """

    target: Target
    time: float | None = None


class PathLimits(NamedTuple):
    """How fast the joints may move: a number for all joints, or one for each.

    Attributes:
        velocity: degrees a second; None: what the speed of the call allows.
        acceleration: degrees per second squared; None: half of what the edition states, or 60.
        jerk: degrees per second cubed; None: ten times the acceleration.
    """

    velocity: float | Sequence[float] | None = None
    acceleration: float | Sequence[float] | None = None
    jerk: float | Sequence[float] | None = None


class FollowReport(NamedTuple):
    """How an arm followed a path.

    Attributes:
        ended: why it ended: at the end of the path or source; because the source was silent, the
            program stalled, another part of the program stopped the arm, or it stopped short of the
            end.
        rate: setpoints a second that were sent.
        sent: how many setpoints were sent.
        dropped: how many were late, and not sent.
        superseded: targets of the source for which there was no setpoint before a newer one came.
        deviation: the largest distance of a joint from its setpoint in degrees, as far as the arm
            replied; None: it did not.
        seconds: how long the motion took.
    """

    ended: Ended
    rate: float
    sent: int
    dropped: int
    superseded: int
    deviation: float | None
    seconds: float

    def __str__(self) -> str:
        away = "" if self.deviation is None else f"; at most {self.deviation:.1f} degrees away"
        return (
            f"{self.sent} setpoints at {self.rate:.1f} Hz in {self.seconds:.1f} s, "
            f"{self.dropped} dropped{away}"
        )


class Pause(NamedTuple):
    """Do nothing until the time ``until``."""

    until: float


class Send(NamedTuple):
    """Send this one-way request at once."""

    request: EncodedRequest


class Source:
    """A live source of targets; ``exhausted`` says whether no further target comes."""

    exhausted = False

    def take(self) -> list[Target]:
        """Return the targets that came since the last call; raise what the source raised."""
        raise NotImplementedError

    def close(self) -> None:
        """Take no more targets."""
