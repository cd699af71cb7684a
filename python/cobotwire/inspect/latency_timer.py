"""Read for how long a USB adapter holds short replies back."""

from __future__ import annotations

import os
from pathlib import Path

SYSTEM = Path("/sys")


def latency_timer(url: str, system: Path = SYSTEM) -> tuple[int, Path] | None:
    """Return the latency timer in milliseconds, and its file; None if the system has none.

    Linux has one for FTDI adapters.
    """
    if "://" in url:
        return None
    name = os.path.basename(os.path.realpath(url))
    path = system / "class" / "tty" / name / "device" / "latency_timer"
    try:
        return int(path.read_text()), path
    except (OSError, ValueError):
        return None
