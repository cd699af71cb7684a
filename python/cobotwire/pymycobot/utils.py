"""Find serial ports, with the maker's function names."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cobotwire.transport.serial.ports import Port

# The USB product number of the board in an M5Stack Basic.
_BASIC = "EA60"


def get_port_list() -> list[str]:
    """Return the names of all serial ports."""
    return [port.device for port in _ports()]


def detect_port_of_basic() -> str | None:
    """Return the port of the first M5Stack Basic; None if there is none."""
    return next((port.device for port in _ports() if port.usb.endswith(f":{_BASIC}")), None)


def _ports() -> list[Port]:
    # Imported here: most programs name their port, and this takes long.
    from cobotwire.transport.serial.ports import ports

    return ports()
