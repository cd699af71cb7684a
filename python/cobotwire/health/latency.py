"""For how long a USB bridge holds short replies back, where the system tells it."""

from __future__ import annotations

import os
from pathlib import Path

SYSTEM = Path("/sys")


def latency_timer(url: str, system: Path = SYSTEM) -> tuple[int, Path] | None:
    """Milliseconds, and the file that holds them; None where the driver of the port has none.

    Linux tells it for FTDI bridges.
    """
    if "://" in url:
        return None
    name = os.path.basename(os.path.realpath(url))
    path = system / "class" / "tty" / name / "device" / "latency_timer"
    try:
        return int(path.read_text()), path
    except (OSError, ValueError):
        return None
