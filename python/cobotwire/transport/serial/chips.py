"""The USB chips through which these arms are connected, with their drivers.

The maker's page on serial drivers (mycobot_docs, chapter 5.2) names the drivers of CP210x and
CH9102, and what Windows calls their ports; FTDI's note TN_105 and WCH name theirs. Espressif's page
on the USB-Serial-JTAG peripheral says that it needs none.
"""

from __future__ import annotations

from typing import NamedTuple


class Chip(NamedTuple):
    """A USB chip on the controllers of these arms.

    Attributes:
        usb: the ids of vendor and product, as in ``10C4:EA60``.
        name: the chip, and where it is found.
        driver: the driver that Windows and macOS need; empty if it is included.
        shown: how the Device Manager of Windows names the port; empty if no source says it.
    """

    usb: str
    name: str
    driver: str = ""
    shown: str = ""


CHIPS = (
    Chip(
        *("10C4:EA60", "CP2102/CP2104, the bridge of many M5Stack controllers"),
        *("CP210x VCP (Silicon Labs)", "Silicon Labs CP210x USB to UART Bridge"),
    ),
    Chip(
        *("1A86:55D4", "CH9102, the bridge of newer M5Stack and Atom controllers"),
        *("CH9102 VCP (WCH), which the maker calls CP34X", "USB-Enhanced-SERIAL CH9102"),
    ),
    Chip("1A86:7523", "CH340, the bridge of some carrier boards", "CH341SER (WCH)"),
    Chip("0403:6001", "FT232R, the bridge of Atom controllers", "VCP (FTDI)"),
    Chip("0403:6015", "FT231X, the bridge of some carrier boards", "VCP (FTDI)"),
    Chip("303A:1001", "the USB port of an ESP32-S3 or -C3 itself, as on AtomS3"),
)
