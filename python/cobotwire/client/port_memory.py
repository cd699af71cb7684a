"""Remember what a session left on its port, for the next session of any process of this user.

A reply that comes after its session has ended looks like the reply to the first like request of the
next one. Half a request that was written completes with the first request of the next one. So a
session that ends with one of these leaves a note: in this process, and in a file for other ones.
Most sessions leave nothing and write no file.

The file lies in a folder that only this user can write. Its times are those of
``time.monotonic()``, which all processes of a machine share until it restarts. A process that is
killed, or never closes its client, leaves no note.
"""

from __future__ import annotations

import binascii
import os
import stat
import time
from contextlib import suppress
from typing import Any

from cobotwire.session.alignment import Part
from cobotwire.session.leftover import LateFrame, Leftover
from cobotwire.transport import Transport
from cobotwire.transport.interface import OpenedTransport
from cobotwire.transport.timing import times_of

# The kinds of transport that lead to the same arm when they are opened again.
LASTING = ("serial", "socket", "rfc2217")

# Every grace is shorter than this many seconds: a note that says more is from before a restart.
LONGEST = 3600
# A note has at most this many entries of each kind, and this many bytes.
MOST_ENTRIES = 64
MOST_BYTES = 65536
PSEUDO_TERMINALS = "/dev/pts/"


class PortMemory:
    """The notes on one port.

    Only what leads to the same arm again has notes: a serial port or a socket, in real time. An
    open transport of the user's own has none, since its URL need not identify a port.
    """

    def __init__(self, transport: Transport) -> None:
        same_again = (
            isinstance(transport, OpenedTransport)
            and transport.kind in LASTING
            and times_of(transport).real
        )
        self._keys = _keys(transport.url) if same_again else ()

    def recall(self) -> Leftover:
        """Return the notes on the port, and remove them."""
        found: list[Leftover] = []
        for key in self._keys:
            found.append(_here.pop(key, Leftover()))
            # A missing or damaged file has no notes, nor has a folder that others can write.
            with suppress(OSError, ValueError, TypeError, KeyError, RecursionError):
                found.append(_read(_path(key), key))
        now = time.monotonic()
        late = {late for note in found for late in note.late if now < late.until <= now + LONGEST}
        parts = {part for note in found for part in note.parts}
        return Leftover(tuple(sorted(late, key=lambda late: late.until)), tuple(parts))

    def leave(self, leftover: Leftover) -> None:
        """Leave a note on the port, unless the line is aligned and silent."""
        if leftover.empty:
            return
        leftover = Leftover(leftover.late[-MOST_ENTRIES:], leftover.parts[-MOST_ENTRIES:])
        for key in self._keys:
            _here[key] = leftover
            # Without a folder of its own, this process alone remembers.
            with suppress(OSError):
                _write(_path(key, create=True), key, leftover)

    def leave_to_parent(self) -> None:
        """Leave no note from now on: after a fork the session is the parent's."""
        self._keys = ()


_here: dict[str, Leftover] = {}


def _keys(url: str) -> tuple[str, ...]:
    """Return what identifies a port: its device, and a link that keeps its name after a replug."""
    if "://" in url:
        return (url,)
    device, link = os.path.realpath(url), os.path.abspath(url)
    links = (link,) if link != device else ()
    if device.startswith(PSEUDO_TERMINALS):
        # The next pseudo-terminal with this number is another line.
        with suppress(OSError):
            return f"{device} {os.stat(device).st_ctime_ns}", *links
    return device, *links


def _path(key: str, create: bool = False) -> str:
    return os.path.join(
        _folder(create), f"{binascii.crc32(key.encode(errors='surrogateescape')):08x}.json"
    )


def _folder(create: bool) -> str:
    """Return this user's own folder.

    Raises:
        OSError: it does not exist or cannot be made, or others can write it.
    """
    user = str(os.getuid()) if hasattr(os, "getuid") else "user"
    # As tempfile chooses it; importing that takes milliseconds.
    parent = os.environ.get("TMPDIR") or os.environ.get("TEMP") or "/tmp"  # noqa: S108 - see below
    folder = os.path.join(parent, f"cobotwire-{user}")
    if create:
        with suppress(FileExistsError):
            os.mkdir(folder, 0o700)
    found = os.lstat(folder)
    ours = not hasattr(os, "getuid") or found.st_uid == os.getuid()
    others_write = os.name == "posix" and found.st_mode & 0o022
    if not stat.S_ISDIR(found.st_mode) or not ours or others_write:
        raise PermissionError(f"{folder} is not a folder that only this user can write")
    return folder


def _write(path: str, key: str, leftover: Leftover) -> None:
    import json

    note = {
        "port": key,
        "late": [[late.request.hex(), late.until] for late in leftover.late],
        "parts": [[part.request.hex(), part.written] for part in leftover.parts],
    }
    new = f"{path}.{os.getpid()}"
    with open(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w") as file:
        json.dump(note, file)
    os.replace(new, path)


def _read(path: str, key: str) -> Leftover:
    """Read and remove a note; raise what a damaged one raises."""
    with open(path) as file:
        text = file.read(MOST_BYTES)
    os.unlink(path)
    import json

    note: dict[str, Any] = json.loads(text)
    if note["port"] != key:
        return Leftover()
    return Leftover(
        tuple(LateFrame(_frame(frame), float(until)) for frame, until in note["late"]),
        tuple(_part(_frame(frame), int(written)) for frame, written in note["parts"]),
    )


def _frame(text: str) -> bytes:
    frame = bytes.fromhex(text)
    if not 4 <= len(frame) <= 300:
        raise ValueError("no frame has this size")
    return frame


def _part(request: bytes, written: int) -> Part:
    if not 0 < written <= len(request):
        raise ValueError("a part is a part of its request")
    return Part(request, written)
