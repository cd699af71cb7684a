"""Leave a stale or damaged note of an earlier session on the port of a run."""

from __future__ import annotations

import json
import os
import time
from contextlib import suppress
from pathlib import Path
from random import Random

from cobotwire.client import port_notes

GET_ENCODER = "FE FE 03 3B 01 FA"
# The most that a clock of another boot may be ahead.
AHEAD_SECONDS = 3000.0
# Of another boot, by its name or its clock; with another number, other bytes; no file.
KINDS = ("boot", "before", "number", "bytes", "pipe")


def leave_note(url: str, random: Random) -> None:
    """Leave a note that must not be used: of another boot, damaged, or no file at all."""
    key = url if "://" in url else os.path.abspath(url)
    path, now = Path(port_notes._path(key, create=True)), time.monotonic()
    with suppress(FileNotFoundError):
        path.unlink()
    kind = random.choice(KINDS)
    if kind == "pipe":
        os.mkfifo(path)
        return
    until = random.choice((float("inf"), float("nan"), 10**400, "soon"))
    note = {
        "port": key,
        "boot": "another" if kind == "boot" else port_notes._boot(),
        "clocks": [now + AHEAD_SECONDS if kind == "before" else now, time.time()],
        "late": [[GET_ENCODER, until if kind == "number" else now + AHEAD_SECONDS]],
        "parts": [],
    }
    path.write_bytes(random.randbytes(200) if kind == "bytes" else json.dumps(note).encode())
