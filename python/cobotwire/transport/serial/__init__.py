"""Serial ports, and whatever else pyserial opens. This folder is its only importer."""

from __future__ import annotations

import os

from cobotwire.transport.interface import Link
from cobotwire.transport.serial.url import UrlLink

__all__ = ["open_serial"]


def open_serial(url: str, baudrate: int) -> Link:
    """Open a port or URL; :func:`cobotwire.transport.open_link` says the rest."""
    scheme, separator, _ = url.partition("://")
    if os.name != "posix" or (separator and scheme.lower() != "hwgrep"):
        return UrlLink(url, baudrate)
    from cobotwire.transport.serial.port import PortLink

    return PortLink(url, baudrate)
