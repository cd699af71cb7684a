"""Observe the machine of a run: its load, and whether its clocks agree."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, field

from cobotwire.conformance.report import Host

# Clocks that are disciplined by NTP differ by at most 500 millionths; reading both takes time.
SHARE, READING = 0.001, 0.1


def load() -> float:
    """Return the load average divided by the number of processors; 0 if it is unknown."""
    try:
        return round(os.getloadavg()[0] / (os.cpu_count() or 1), 2)
    except (AttributeError, OSError):
        return 0.0


@dataclass(frozen=True, slots=True)
class HostWatch:
    """Observes the machine from its creation on."""

    monotonic: float = field(default_factory=time.monotonic)
    wall: float = field(default_factory=time.time)
    load: float = field(default_factory=load)

    def host(self) -> Host:
        """Return what was observed until now."""
        monotonic, wall = time.monotonic() - self.monotonic, time.time() - self.wall
        return Host(round(monotonic, 3), round(wall, 3), self.load, load())


def clock_mistake(host: Host) -> str:
    """Return how the clocks differ; empty if they agree."""
    apart = host.wall_seconds - host.monotonic_seconds
    if abs(apart) <= READING + SHARE * host.monotonic_seconds:
        return ""
    return (
        f"The clocks of the host disagree: during the run the wall clock moved {apart:+.3f} s "
        "against the monotonic clock; it was set, or the host was suspended."
    )
