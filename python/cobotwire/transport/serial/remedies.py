"""What to do so that a port can be opened, on each system.

Both the errors of opening a port and ``cobotwire ports --fix`` take their texts from here. Each is
a function of facts about the computer, so those of all systems can be tested on one.
"""

from __future__ import annotations

import errno
from collections.abc import Callable, Sequence
from shlex import quote
from string import digits
from typing import Literal, NamedTuple

from cobotwire.protocol.printable import printable
from cobotwire.transport.serial.chips import CHIPS

RULES_FILE = "/etc/udev/rules.d/70-cobotwire.rules"
# The errors of a port that another program has locked: against every open(), or by pyserial.
BUSY = errno.EBUSY, errno.EAGAIN
# A message names so many ports; `cobotwire ports` lists all.
MOST_NAMED = 4
# The names of the two devices that macOS has for each port begin so.
_DIAL_IN = "/dev/tty."
_CALL_OUT = "the names with tty wait for a signal that these arms do not send"


class Computer(NamedTuple):
    """What is known about the computer that opens a port.

    Attributes:
        system: ``linux``, ``darwin`` or ``win32``, as in ``sys.platform``.
        devices: the names of its serial ports, likely ones first.
        user: the name of the user.
        group: the group that may open serial ports; empty if none may.
        member: whether the user belongs to the group.
        in_login: whether this login may open ports: it has the group, or is the administrator's. A
            login that is older than the membership lacks the group.
    """

    system: str
    devices: Sequence[str] = ()
    user: str = ""
    group: str = ""
    member: bool = False
    in_login: bool = False


class Remedy(NamedTuple):
    """Something to do before a port can be opened.

    Attributes:
        name: the subject: ``group``, ``udev``, ``brltty``, ``device name``, ``driver``, ``busy``.
        state: whether it is needed, done already, or helps only in some cases.
        text: what to do.
        commands: lines to enter in a shell.
    """

    name: str
    state: Literal["needed", "done", "optional"]
    text: str
    commands: tuple[str, ...] = ()


def remedies(computer: Computer, busy: Sequence[tuple[str, str]] = ()) -> list[Remedy]:
    """Return what to do on a computer; ``busy`` has ports that are in use, and by what."""
    found = [Remedy("busy", "needed", f"{device}: {in_use(computer, by)}") for device, by in busy]
    return found + _SYSTEMS.get(computer.system, _others)(computer)


def explain(computer: Computer, device: str, number: int | None, reason: str, by: str = "") -> str:
    """Return why a port cannot be opened, and what to do.

    Args:
        computer: where the port was opened.
        device: the name of the port.
        number: the number of the error, as in ``errno``.
        reason: what the system says.
        by: the programs that have the port open, as far as known.
    """
    denied = number in (errno.EACCES, errno.EPERM)
    if computer.system == "darwin" and device.startswith(_DIAL_IN):
        return f"{reason}; open /dev/cu.{device.removeprefix(_DIAL_IN)} instead: {_CALL_OUT}"
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
    """Return what to say about a port that does not exist; without a name, about having none."""
    if not computer.devices:
        return (
            "no serial port was found; check that the arm's cable is plugged in and its power is "
            "on; `cobotwire ports --fix` says what else can be wrong"
        )
    near = [each for each in computer.devices if each.rstrip(digits) == device.rstrip(digits)]
    named = ", ".join(map(printable, computer.devices[:MOST_NAMED]))
    more = ", and more" if len(computer.devices) > MOST_NAMED else ""
    guess = f"did you mean {printable(near[0])}? " if near else ""
    return f"{guess}this computer has {named}{more}; `cobotwire ports` says which are likely"


def in_use(computer: Computer, by: str = "") -> str:
    """Return what to do about a port that another program has open."""
    if by:
        return f"{by} has it open; end that first"
    if computer.system == "win32":
        return "another program has it open, such as a serial monitor or myStudio; end that first"
    return (
        "another program has it open, perhaps of another user; `sudo lsof` and its name says which"
    )


def _group(computer: Computer) -> Remedy:
    """Return the remedy for a missing permission on Linux."""
    you, group = f"you ({printable(computer.user)})", printable(computer.group)
    if computer.in_login and not group:
        return Remedy("group", "done", f"{you} may open every port")
    if computer.in_login:
        return Remedy("group", "done", f"{you} are in the group {group}, which opens serial ports")
    if not group:
        return Remedy("group", "optional", "no group opens it; the rule for udev may help")
    if computer.member:
        text = f"{you} are in the group {group}, but not in this login: log out and in again"
        return Remedy("group", "needed", text)
    text = (
        f"{you} are not in the group {group}, which opens serial ports: join it, then log in again"
    )
    command = f"sudo usermod -aG {quote(group)} {quote(printable(computer.user))}"
    return Remedy("group", "needed", text, (command,))


def _udev() -> Remedy:
    """Return the rule that gives the chips to whoever is logged in at the computer.

    systemd's 73-seat-late.rules reads the tag ``uaccess``, so the file's number is below 73.
    """
    rules = [
        f'SUBSYSTEM=="tty", ATTRS{{idVendor}}=="{chip.vendor:04x}", '
        f'ATTRS{{idProduct}}=="{chip.product:04x}", TAG+="uaccess"'
        for chip in CHIPS
    ]
    text = (
        "or let whoever sits at this computer open the USB chips of these arms, without a group; "
        "the rule does not hold for logins over the network"
    )
    reload = "sudo udevadm control --reload && sudo udevadm trigger --subsystem-match=tty"
    commands = (f"sudo tee {RULES_FILE} <<'END'", *rules, "END", reload)
    return Remedy("udev", "optional", text, commands)


def _linux(computer: Computer) -> list[Remedy]:
    # The maintainer's words: github.com/arduino/arduino-ide/issues/1788.
    braille = (
        "if a port disappears some seconds after it was plugged in: brltty before 6.5, as in "
        "Ubuntu 22.04, takes CP210x and CH340 for Braille displays; remove it unless you need it"
    )
    return [
        _group(computer),
        _udev(),
        Remedy("brltty", "optional", braille, ("sudo apt remove brltty",)),
    ]


def _macos(computer: Computer) -> list[Remedy]:
    text = f"open /dev/cu.NAME, not /dev/tty.NAME: {_CALL_OUT}"
    return [Remedy("device name", "optional", text), *_drivers("no driver")]


def _windows(computer: Computer) -> list[Remedy]:
    text = "ports have names such as COM3; the Device Manager lists them under Ports (COM & LPT)"
    return [
        Remedy("device name", "optional", text),
        *_drivers("no driver, from Windows 10 on", ", shown as {0.shown}"),
    ]


def _drivers(without: str, shown: str = "") -> list[Remedy]:
    found = []
    for chip in CHIPS:
        needs = f"the driver {chip.driver}" if chip.driver else without
        named = shown.format(chip) if chip.shown else ""
        text = f"{chip.name} ({chip.usb}), needs {needs}{named}"
        found.append(Remedy("driver", "optional", text))
    return found


def _others(computer: Computer) -> list[Remedy]:
    text = f"nothing is known about ports on {printable(computer.system)}"
    return [Remedy("device name", "optional", text)]


_SYSTEMS: dict[str, Callable[[Computer], list[Remedy]]] = {
    "linux": _linux,
    "darwin": _macos,
    "win32": _windows,
}
