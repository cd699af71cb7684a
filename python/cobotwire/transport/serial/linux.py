"""What Linux says about users and serial ports."""

from __future__ import annotations

import grp
import os
import pwd
import stat
from collections.abc import Sequence
from contextlib import suppress

from cobotwire.transport.serial.remedies import Computer

# The names of the group of serial ports: Debian and Fedora; Arch.
GROUPS = ("dialout", "uucp")
_BOTH = stat.S_IRGRP | stat.S_IWGRP


def this_computer(devices: Sequence[str], device: str = "") -> Computer:
    """Return facts about this computer, user and login; ``device`` is the port to open."""
    number = os.getuid()
    user, group = str(number), _group_of(device) if device else _usual_group(devices)
    with suppress(KeyError):
        user = pwd.getpwuid(number).pw_name
    if number == 0 or group is None:
        return Computer("linux", devices, user, in_login=number == 0)
    name, member = str(group), False
    with suppress(KeyError):
        member = group in os.getgrouplist(user, pwd.getpwuid(number).pw_gid)
        name = grp.getgrgid(group).gr_name
    return Computer("linux", devices, user, name, member, group in os.getgroups())


def _group_of(device: str) -> int | None:
    """Return the group that may read and write a port; None if only users may."""
    with suppress(OSError):
        status = os.stat(device)
        # Users should not join the group of root.
        return status.st_gid if status.st_mode & _BOTH == _BOTH and status.st_gid else None
    return None


def _usual_group(devices: Sequence[str]) -> int | None:
    known = (each.gr_gid for name in GROUPS for each in grp.getgrall() if each.gr_name == name)
    return next(filter(None, [*map(_group_of, devices), *known]), None)
