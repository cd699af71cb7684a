"""Serial ports, and whatever else pyserial opens. Only this folder imports pyserial."""

from __future__ import annotations

import os

from cobotwire.transport.interface import OpenedTransport
from cobotwire.transport.serial.url import UrlTransport

__all__ = ["open_serial"]


def open_serial(url: str, baudrate: int) -> OpenedTransport:
    """Open a port or URL; see :func:`cobotwire.transport.open_transport`."""
    scheme, separator, _ = url.partition("://")
    if os.name != "posix" or (separator and scheme.lower() != "hwgrep"):
        return UrlTransport(url, baudrate)
    from cobotwire.transport.serial.port import SerialTransport

    return SerialTransport(url, baudrate)
