"""The constants of the maker's library that programs use."""

from __future__ import annotations

# The serial port and the speed of a 280 with a Raspberry Pi.
PI_PORT = "/dev/ttyAMA0"
PI_BAUD = 1_000_000
