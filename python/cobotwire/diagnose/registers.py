"""Name the registers of Feetech's STS and SMS servos.

The sources are the maker's memory tables (Feetech's "STS memory table analysis" at
wiki.juxitech.com) and public drivers (RIOT OS, ``feetech_protocol.h``, for the SCS15). The SCS
series has some of the lower registers elsewhere; those of position, speed, load, voltage and
temperature are the same.
"""

from __future__ import annotations

# Address to name and width in bytes; two bytes are little-endian (STS and SMS).
REGISTERS: dict[int, tuple[str, int]] = {
    0x00: ("firmware major version", 1),
    0x01: ("firmware minor version", 1),
    0x03: ("model number", 2),
    0x05: ("id", 1),
    0x06: ("baud rate", 1),
    0x07: ("return delay", 1),
    0x08: ("status return level", 1),
    0x09: ("minimum position", 2),
    0x0B: ("maximum position", 2),
    0x0D: ("maximum temperature", 1),
    0x0E: ("maximum voltage", 1),
    0x0F: ("minimum voltage", 1),
    0x10: ("maximum torque", 2),
    0x12: ("phase", 1),
    0x13: ("unloading condition", 1),
    0x14: ("LED alarm condition", 1),
    0x15: ("P coefficient", 1),
    0x16: ("D coefficient", 1),
    0x17: ("I coefficient", 1),
    0x18: ("minimum starting force", 2),
    0x1A: ("clockwise dead zone", 1),
    0x1B: ("counterclockwise dead zone", 1),
    0x1C: ("protection current", 2),
    0x1E: ("angular resolution", 1),
    0x1F: ("position offset", 2),
    0x21: ("operating mode", 1),
    0x22: ("protective torque", 1),
    0x23: ("protection time", 1),
    0x24: ("overload torque", 1),
    0x28: ("torque enable", 1),
    0x29: ("acceleration", 1),
    0x2A: ("goal position", 2),
    0x2C: ("goal time", 2),
    0x2E: ("goal speed", 2),
    0x30: ("torque limit", 2),
    0x37: ("lock", 1),
    0x38: ("present position", 2),
    0x3A: ("present speed", 2),
    0x3C: ("present load", 2),
    0x3E: ("present voltage", 1),
    0x3F: ("present temperature", 1),
    0x40: ("registered write", 1),
    0x41: ("status", 1),
    0x42: ("moving", 1),
    0x45: ("present current", 2),
}


def register_name(address: int) -> str | None:
    """Return the name of the register at ``address``; None if it is not publicly known."""
    if address in REGISTERS:
        return REGISTERS[address][0]
    before, width = REGISTERS.get(address - 1, ("", 1))
    return f"{before}, high byte" if width == 2 else None
