"""What Linux says about users and serial ports."""

from __future__ import annotations

import glob
import grp
import os
import pwd
import stat
from collections.abc import Sequence
from contextlib import suppress

from cobotwire.protocol.printable import printable
from cobotwire.transport.serial.remedies import Computer

# The names of the group of serial ports: Debian and Fedora; Arch.
GROUPS = ("dialout", "uucp")


def this_computer(devices: Sequence[str], device: str = "") -> Computer:
    """Return what is known about this computer, user and login; ``device`` is what to open."""
    number = _group_of(device) if device else None
    if not device:
        number = next(filter(None, map(_group_of, devices)), _usual_group())
    user, group, member = str(os.getuid()), "" if number is None else str(number), False
    with suppress(KeyError):
        entry = pwd.getpwuid(os.getuid())
        user, member = entry.pw_name, number in os.getgrouplist(entry.pw_name, entry.pw_gid)
    if os.getuid() == 0:
        return Computer("linux", devices, user, in_login=True)
    with suppress(KeyError):
        group = group and grp.getgrgid(int(group)).gr_name
    return Computer("linux", devices, user, group, member, number in os.getgroups())


def _group_of(device: str) -> int | None:
    """Return the group that may read and write a port; None if only users may."""
    with suppress(OSError):
        status = os.stat(device)
        both = stat.S_IRGRP | stat.S_IWGRP
        # No one is meant to join the group of the administrator.
        if status.st_mode & both == both and status.st_gid:
            return status.st_gid
    return None


def _usual_group() -> int | None:
    for name in GROUPS:
        with suppress(KeyError):
            return grp.getgrnam(name).gr_gid
    return None


def programs_using(device: str) -> str:
    """Return the programs that have a device open; only root sees those of other users."""
    real, numbers = os.path.realpath(device), set()
    for path in glob.iglob("/proc/[0-9]*/fd/*"):
        with suppress(OSError):
            if os.readlink(path) == real:
                numbers.add(int(path.split("/")[2]))
    return ", ".join(_name(number) for number in sorted(numbers))


def _name(number: int) -> str:
    if number == os.getpid():
        return "this program itself"
    with suppress(OSError), open(f"/proc/{number}/comm", errors="replace") as file:
        return f"{printable(file.readline().strip())} (process {number})"
    return f"process {number}"
