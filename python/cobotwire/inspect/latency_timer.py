"""Read how long a USB adapter holds back short replies."""

from __future__ import annotations

import os
from pathlib import Path

SYSTEM = Path("/sys")


def latency_timer(url: str, system: Path = SYSTEM) -> tuple[int, Path] | None:
    """Return a port's latency timer in milliseconds, and the file that sets it.

    The result is None if the port has no latency timer. Linux has one for FTDI adapters.
    """
    if "://" in url:
        return None
    name = os.path.basename(os.path.realpath(url))
    path = system / "class" / "tty" / name / "device" / "latency_timer"
    try:
        return int(path.read_text()), path
    except (OSError, ValueError):
        return None
