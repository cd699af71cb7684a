"""List the serial ports of this machine, and guess which of them connect to an arm."""

from __future__ import annotations

import glob
import os
import sys
from contextlib import suppress
from typing import NamedTuple

from serial.tools import list_ports

from cobotwire.protocol.printable import printable
from cobotwire.transport.serial.chips import CHIPS
from cobotwire.transport.serial.remedies import Computer

# Arms with a computer in their base connect its built-in port to the controller. pyserial does not
# list the built-in port of the Jetson.
WIRED = {
    "/dev/ttyAMA": "the built-in port of a Raspberry Pi, to which Pi versions wire their arm",
    "/dev/ttyTHS": "the built-in port of a Jetson, to which its versions wire their arm",
}


class Port(NamedTuple):
    """A serial port of this machine.

    Attributes:
        device: what to open.
        likely: whether the port probably connects to an arm.
        why: the reason for ``likely``.
        accessible: whether this user has permission to open it, even if another program uses it.
        description: the system's name for the port.
        usb: vendor and product, ``10C4:EA60``; empty for other devices.
        serial_number: the serial number of the USB device; empty if it has none.
    """

    device: str
    likely: bool
    why: str
    accessible: bool
    description: str = ""
    usb: str = ""
    serial_number: str = ""


def ports() -> list[Port]:
    """Return the ports of this machine, likely ones first. No port is opened."""
    found = {
        info.device: _port(
            info.device, info.vid, info.pid, info.description or "", info.serial_number or ""
        )
        for info in list_ports.comports()
    }
    for prefix in WIRED:
        for device in glob.glob(f"{prefix}*"):
            found.setdefault(device, _port(device, None, None, "", ""))
    return sorted(found.values(), key=lambda port: (not port.likely, port.device))


def leads_to_device(url: str) -> bool:
    """Return whether a URL names a USB port, or a built-in port to which arms are wired.

    A program, such as a simulated arm, can be at any other port: a pseudo-terminal or a network.
    """
    names = (url, os.path.realpath(url))
    return any(port.device in names and bool(port.usb or port.likely) for port in ports())


def this_computer(device: str = "") -> Computer:
    """Return facts about this computer, from which the remedies for a port follow."""
    devices = [port.device for port in ports()]
    if sys.platform == "linux":
        from cobotwire.transport.serial import linux

        return linux.this_computer(devices, device)
    return Computer(sys.platform, devices)


def programs_using(device: str) -> str:
    """Return the programs that have a port open; empty if the system shows none to this user."""
    real, numbers = os.path.realpath(device), set()
    for path in glob.iglob("/proc/[0-9]*/fd/*"):
        with suppress(OSError):
            if os.readlink(path) == real:
                numbers.add(int(path.split("/")[2]))
    return ", ".join(map(_program, sorted(numbers)))


def _program(number: int) -> str:
    if number == os.getpid():
        return "this program itself"
    with suppress(OSError), open(f"/proc/{number}/comm", errors="replace") as file:
        return f"{printable(file.readline().strip())} (process {number})"
    return f"process {number}"


def recognise(device: str, usb: str) -> tuple[bool, str]:
    """Return whether a port probably connects to an arm, and the reason; ``usb`` are its ids."""
    if usb:
        names = [chip.name for chip in CHIPS if chip.usb == usb]
        return (True, names[0]) if names else (False, "a USB device that no such arm has")
    for prefix, why in WIRED.items():
        if device.startswith(prefix):
            return True, why
    return False, "neither a USB device nor a built-in port to which these arms are wired"


def _port(
    device: str, vendor: int | None, product: int | None, description: str, serial_number: str
) -> Port:
    usb = "" if vendor is None or product is None else f"{vendor:04X}:{product:04X}"
    likely, why = recognise(device, usb)
    return Port(
        device,
        likely,
        why,
        # Windows reports a missing permission only when the port is opened.
        os.access(device, os.R_OK | os.W_OK) or os.name != "posix",
        description if description != "n/a" else "",
        usb,
        serial_number,
    )
