"""The USB chips through which these arms are connected, with their drivers."""

from __future__ import annotations

from typing import NamedTuple


class Chip(NamedTuple):
    """A USB chip on the controllers of these arms.

    The maker's page on serial drivers (mycobot_docs, chapter 5.2) names the drivers of CP210x and
    CH9102, and what Windows calls these ports; FTDI's note TN_105 and WCH's driver are the sources
    of theirs, Espressif's page on the USB-Serial-JTAG peripheral says that it needs none.

    Attributes:
        vendor: the USB vendor id.
        product: the USB product id.
        name: the chip, and where it is found.
        driver: what Windows and macOS need; empty if they bring it along.
        shown: how the Device Manager of Windows names the port; empty if no source says it.
    """

    vendor: int
    product: int
    name: str
    driver: str = ""
    shown: str = ""

    @property
    def usb(self) -> str:
        """Vendor and product, as in ``10C4:EA60``."""
        return f"{self.vendor:04X}:{self.product:04X}"


CHIPS = (
    Chip(
        *(0x10C4, 0xEA60, "CP2102/CP2104, the bridge of many M5Stack controllers"),
        *("CP210x VCP (Silicon Labs)", "Silicon Labs CP210x USB to UART Bridge"),
    ),
    Chip(
        *(0x1A86, 0x55D4, "CH9102, the bridge of newer M5Stack and Atom controllers"),
        *("CH9102 VCP (WCH), which the maker calls CP34X", "USB-Enhanced-SERIAL CH9102"),
    ),
    Chip(0x1A86, 0x7523, "CH340, the bridge of some carrier boards", "CH341SER (WCH)"),
    Chip(0x0403, 0x6001, "FT232R, the bridge of Atom controllers", "VCP (FTDI)"),
    Chip(0x0403, 0x6015, "FT231X, the bridge of some carrier boards", "VCP (FTDI)"),
    Chip(0x303A, 0x1001, "the USB port of an ESP32-S3 or -C3 itself, as on AtomS3"),
)
