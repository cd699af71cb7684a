"""Find serial ports, with the maker's function names."""

from __future__ import annotations

from cobotwire.transport.serial.ports import ports

# The USB product number of the board in an M5Stack Basic.
_BASIC = "EA60"


def get_port_list() -> list[str]:
    """Return the names of all serial ports."""
    return [port.device for port in ports()]


def detect_port_of_basic() -> str | None:
    """Return the port of the first M5Stack Basic, or None."""
    return next((port.device for port in ports() if port.usb.endswith(f":{_BASIC}")), None)
