"""The files in which sessions leave notes on their ports, for other processes of this user.

They lie in a folder that only this user can write. Each says until when late replies are expected.
That is a time of ``time.monotonic()``, a clock that all processes of a machine share and that
starts anew at each boot. So the note also says in which boot it was written. A file that is not a
note (a damaged file, a pipe) is removed with a warning.
"""

from __future__ import annotations

import binascii
import json
import os
import stat
import threading
import time
from contextlib import suppress
from typing import Any

from cobotwire.session.alignment import Part
from cobotwire.session.outstanding import LateFrame, PersistedState
from cobotwire.transport.log import Log

# The longest time for which a late reply is expected; every grace of ``RetryPolicy`` is shorter.
LONGEST = 3600
# A note has at most this many entries of each kind, and this many bytes.
MOST_ENTRIES = 64
MOST_BYTES = 65536
BOOT_ID = "/proc/sys/kernel/random/boot_id"
# Do not wait for a pipe, do not follow a link, and do not let a terminal become the controlling
# terminal of the process. Some systems lack some of these flags.
READING = os.O_RDONLY | sum(
    getattr(os, name, 0)
    for name in ("O_NONBLOCK", "O_NOFOLLOW", "O_NOCTTY", "O_CLOEXEC", "O_BINARY")
)
_log = Log("cobotwire.client")


def write_note(key: str, state: PersistedState) -> None:
    """Write the note on a port.

    Raises:
        OSError: it cannot be written, or this user has no folder for it.
    """
    note = {
        "port": key,
        "boot": _boot(),
        "clocks": [time.monotonic(), time.time()],
        "late": [[late.request.hex(), late.until] for late in state.late],
        "parts": [[part.request.hex(), part.written] for part in state.parts],
    }
    path = _path(key, create=True)
    new = f"{path}.{os.getpid()}.{threading.get_ident()}"
    with suppress(FileNotFoundError):
        os.unlink(new)
    with open(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
        json.dump(note, file)
    os.replace(new, path)


def take_note(key: str) -> PersistedState:
    """Return the note on a port, and remove it; warn if there is one that cannot be used."""
    try:
        path = _path(key)
        text = _take(path)
    except FileNotFoundError:
        return PersistedState()
    except (OSError, ValueError) as error:
        return _unusable(error)
    try:
        return _read(json.loads(text), key)
    # No content of a file may keep a port from being opened.
    except Exception as error:
        return _unusable(ValueError(f"{path} is not a note of a session: {error!r:.200}"))


def _unusable(error: Exception) -> PersistedState:
    message = "%s; a late reply to an earlier session on this port may not be recognized"
    _log.load().warning(message, error)
    return PersistedState()


def _take(path: str) -> bytes:
    """Return what a file holds, and remove it.

    Raises:
        OSError: it does not exist, or cannot be read.
        ValueError: it is not a file of this user, or is too large.
    """
    try:
        descriptor = os.open(path, READING)
        try:
            found = os.fstat(descriptor)
            if not stat.S_ISREG(found.st_mode) or not _is_ours(found):
                raise ValueError(f"{path} is not a file of this user")
            if found.st_size > MOST_BYTES:
                raise ValueError(f"{path} has {found.st_size} bytes, and no note is that large")
            return os.read(descriptor, MOST_BYTES)
        finally:
            os.close(descriptor)
    finally:
        # Anything but a folder is removed, even if it is no note: the next note needs the path.
        with suppress(OSError):
            os.unlink(path)


def _read(note: dict[str, Any], key: str) -> PersistedState:
    """Return what a note says; raise some exception if it is damaged."""
    if note["port"] != key:
        # Another port has the same file name.
        return PersistedState()
    written_at, wall = map(float, note["clocks"])
    late = [_late(_frame(frame), until, written_at) for frame, until in note["late"]]
    parts = [_part(_frame(frame), written) for frame, written in note["parts"]]
    passed = time.monotonic() - written_at
    if note["boot"] != _boot() or passed < 0:
        # The machine has rebooted, so no late reply can come. But the arm may still hold the parts.
        return PersistedState((), tuple(parts))
    if not note["boot"]:
        # This system has no boot id. If the wall clock advanced more than the monotonic clock, a
        # reboot may have reset the latter, so the longer time counts.
        hidden = max(0.0, time.time() - wall - passed)
        late = [reply._replace(until=reply.until - hidden) for reply in late]
    return PersistedState(tuple(late), tuple(parts))


def _boot() -> str:
    """Return what identifies this boot of the machine; empty: nothing does on this system."""
    with suppress(OSError), open(BOOT_ID) as file:
        return file.read().strip()
    return ""


def _late(request: bytes, until: float, written_at: float) -> LateFrame:
    if not until - written_at <= LONGEST:
        raise ValueError("no reply is expected for that long")
    return LateFrame(request, float(until))


def _frame(text: str) -> bytes:
    """Return the bytes of a request, or the known bytes of one that was cut."""
    frame = bytes.fromhex(text)
    if not 0 < len(frame) <= 300:
        raise ValueError("no frame has this size")
    return frame


def _part(request: bytes, written: object) -> Part:
    if not isinstance(written, int) or not 0 < written <= len(request):
        raise ValueError("the written part of a request is longer than the request, or empty")
    return Part(request, written)


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
    # The folder that tempfile would choose; importing tempfile takes milliseconds.
    parent = os.environ.get("TMPDIR") or os.environ.get("TEMP") or "/tmp"  # noqa: S108 - see below
    folder = os.path.join(parent, f"cobotwire-{user}")
    if create:
        with suppress(FileExistsError):
            os.mkdir(folder, 0o700)
    found = os.lstat(folder)
    others_write = os.name == "posix" and found.st_mode & 0o022
    if not stat.S_ISDIR(found.st_mode) or not _is_ours(found) or others_write:
        raise PermissionError(f"{folder} is not a folder that only this user can write")
    return folder


def _is_ours(found: os.stat_result) -> bool:
    return not hasattr(os, "getuid") or found.st_uid == os.getuid()
