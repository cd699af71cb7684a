"""What to do so that a port can be opened, on each system.

The errors of opening a port and ``cobotwire ports --fix`` take their texts from here. Each remedy
is a function of facts about the computer, so the remedies of all systems can be tested on one.
"""

from __future__ import annotations

import errno
import re
from collections.abc import Sequence
from shlex import quote
from string import digits
from typing import Literal, NamedTuple

from cobotwire.protocol.printable import printable
from cobotwire.transport.serial.chips import CHIPS

RULES_FILE = "/etc/udev/rules.d/70-cobotwire.rules"
# The errors of a port that another program has locked: against every open(), or by pyserial.
BUSY = errno.EBUSY, errno.EAGAIN
_HOST_AND_PORT = re.compile(r"[\w.-]+:\d+", re.ASCII)
# The most ports that a message names; `cobotwire ports` lists all.
MOST_NAMED = 4
# macOS has two devices for each port; their names begin with these texts.
_DIAL_IN, _CALL_OUT = "/dev/tty.", "/dev/cu."
_WHY_CALL_OUT = "the names with tty wait for a signal that these arms do not send"


class Computer(NamedTuple):
    """What is known about the computer that opens a port.

    Attributes:
        system: ``linux``, ``darwin`` or ``win32``, as in ``sys.platform``.
        devices: the names of its serial ports, likely ones first.
        user: the name of the user.
        group: the group that may open serial ports; empty if none may.
        member: whether the user belongs to the group.
        in_login: whether this login has the group, or is root's; a login from before the change
            lacks it.
    """

    system: str
    devices: Sequence[str] = ()
    user: str = ""
    group: str = ""
    member: bool = False
    in_login: bool = False


class Remedy(NamedTuple):
    """Something to do before a port can be opened; ``commands`` are lines for a shell."""

    name: Literal["cable", "busy", "group", "udev", "brltty", "device name", "driver"]
    text: str
    state: Literal["needed", "done", "optional"] = "optional"
    commands: tuple[str, ...] = ()


def remedies(computer: Computer, busy: Sequence[tuple[str, str]] = ()) -> list[Remedy]:
    """Return what to do on a computer.

    ``busy`` has the ports in use, and the programs that use them.
    """
    found = [Remedy("busy", f"{name}: {in_use(computer, by)}", "needed") for name, by in busy]
    if computer.system == "linux":
        return [*found, _group(computer), _udev(), _BRLTTY]
    if computer.system == "darwin":
        text = f"open {_CALL_OUT}NAME, not {_DIAL_IN}NAME: {_WHY_CALL_OUT}"
        return [*found, Remedy("device name", text), *_drivers("no driver")]
    text = "ports have names such as COM3; the Device Manager lists them under Ports (COM & LPT)"
    drivers = _drivers("no driver, from Windows 10 on", ", shown as {}")
    return [*found, Remedy("device name", text), *drivers]


# The first words of --fix if no port is likely to lead to an arm.
CABLE = Remedy(
    "cable",
    "no arm was found: check that it has power, and that its USB cable carries data, since some "
    "only charge",
    "needed",
)


def explain(computer: Computer, device: str, number: int | None, reason: str, by: str = "") -> str:
    """Return why a port cannot be opened, and what to do.

    ``number`` is that of the error, as in ``errno``, and ``reason`` its text; ``by`` are the
    programs that have the port open, as far as known.
    """
    denied = number in (errno.EACCES, errno.EPERM)
    if computer.system == "darwin" and device.startswith(_DIAL_IN):
        return f"{reason}; open {device.replace(_DIAL_IN, _CALL_OUT)} instead: {_WHY_CALL_OUT}"
    if number == errno.ENOTTY:
        return "it is not a serial port; `cobotwire ports` lists those of this computer"
    if number == errno.ENOENT:
        return f"{reason}; {missing(computer, device)}"
    # Windows opens a port for one program, and denies access to any other.
    if number in BUSY or (denied and computer.system == "win32"):
        return in_use(computer, by)
    if not denied or computer.system != "linux":
        return reason
    group = _group(computer)
    if group.state == "done":
        return f"{reason}, although {group.text}"
    return f"{reason}; {group.text}; `cobotwire ports --fix` prints what to enter"


def missing(computer: Computer, device: str = "") -> str:
    """Return the advice for a port that does not exist.

    Without a ``device``, return the advice for a computer without ports.
    """
    if _HOST_AND_PORT.fullmatch(device):
        return f"did you mean socket://{device}?"
    check = "check its cable and power; `cobotwire ports --fix` says what else can be wrong"
    if device.startswith(("tty", "cu.")):
        return f"did you mean /dev/{device}?"
    if not computer.devices:
        return f"this computer has no serial port; if the arm is connected to it, {check}"
    near = [each for each in computer.devices if each.rstrip(digits) == device.rstrip(digits)]
    guess = f"did you mean {printable(near[0])}? " if near else ""
    named = ", ".join(map(printable, computer.devices[:MOST_NAMED]))
    more = ", and more" if len(computer.devices) > MOST_NAMED else ""
    return f"{guess}this computer has {named}{more}; if the arm's port is not listed, {check}"


def in_use(computer: Computer, by: str = "") -> str:
    """Return what to do about a port that another program has open."""
    if by:
        return f"{by} has it open; end that first"
    if computer.system == "win32":
        return "another program has it open, such as a serial monitor or myStudio; end that first"
    return "another program has it open, perhaps another user's; `sudo lsof` on it says which"


def _group(computer: Computer) -> Remedy:
    """Return the remedy for a missing permission on Linux."""
    you, group = f"you ({printable(computer.user)})", printable(computer.group)
    if computer.in_login:
        why = (
            f"are in the group {group}, which opens serial ports" if group else "may open any port"
        )
        return Remedy("group", f"{you} {why}", "done")
    if not group:
        return Remedy("group", "no group opens it; the rule for udev may help")
    if computer.member:
        text = f"{you} are in the group {group}, but not in this login: log out and in again"
        return Remedy("group", text, "needed")
    text = f"{you} are not in the group {group}, which opens serial ports: join, then log in again"
    command = f"sudo usermod -aG {quote(group)} {quote(printable(computer.user))}"
    return Remedy("group", text, "needed", (command,))


def _udev() -> Remedy:
    """Return the rule that gives the chips to whoever is logged in at the computer.

    systemd's 73-seat-late.rules reads the tag ``uaccess``, so the file's number is below 73.
    """
    rule = 'SUBSYSTEM=="tty", ATTRS{{idVendor}}=="{}", ATTRS{{idProduct}}=="{}", TAG+="uaccess"'
    rules = [rule.format(*chip.usb.lower().split(":")) for chip in CHIPS]
    text = (
        "or let whoever sits at this computer open the USB chips of these arms, without a group; "
        "the rule does not hold for logins over the network"
    )
    reload = "sudo udevadm control --reload && sudo udevadm trigger --subsystem-match=tty"
    commands = (f"sudo tee {RULES_FILE} <<'END'", *rules, "END", reload)
    return Remedy("udev", text, commands=commands)


# The maintainer's words: github.com/arduino/arduino-ide/issues/1788.
_BRLTTY = Remedy(
    "brltty",
    "if a port disappears some seconds after it was plugged in: brltty before 6.5, as in Ubuntu "
    "22.04, takes CP210x and CH340 for Braille displays; remove it unless you need it",
    commands=("sudo apt remove brltty",),
)


def _drivers(without: str, shown: str = "") -> list[Remedy]:
    texts = (
        f"{chip.name} ({chip.usb}), needs {f'the driver {chip.driver}' if chip.driver else without}"
        f"{shown.format(chip.shown) if chip.shown else ''}"
        for chip in CHIPS
    )
    return [Remedy("driver", text) for text in texts]
