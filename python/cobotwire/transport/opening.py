"""Open the transport that a URL needs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cobotwire.protocol.errors import UsageError
from cobotwire.transport.interface import OpenedTransport

if TYPE_CHECKING:
    from urllib.parse import SplitResult

HIGHEST_BAUDRATE = 2**31 - 1
NETWORK = ("socket://", "rfc2217://")


def open_transport(url: str, baudrate: int) -> OpenedTransport:
    """Open a serial port, ``socket://host:port``, or any other URL that pyserial opens.

    Args:
        url: the port's name or the URL.
        baudrate: bits a second. For TCP, the baud rate of the serial line at the other end, which
            limits the time of a write.

    Raises:
        UsageError: the URL or baud rate is not allowed.
        LinkError: the port does not exist, is in use by another program, or cannot be opened.
    """
    parts = _check(url)
    whole = isinstance(baudrate, int) and not isinstance(baudrate, bool)
    if not whole or not 0 < baudrate <= HIGHEST_BAUDRATE:
        raise UsageError("baudrate", baudrate, f"a whole number 1..{HIGHEST_BAUDRATE}")
    if parts is not None and parts.scheme == "socket":
        from cobotwire.transport.tcp import TcpTransport

        assert parts.hostname is not None, "checked before"
        return TcpTransport(url, baudrate, parts.hostname, parts.port or 0)
    # Imported here: pyserial takes as long to load as all the rest of the package.
    from cobotwire.transport.serial import open_serial

    return open_serial(url, baudrate)


def _check(url: object) -> SplitResult | None:
    """Return the parts of a network URL; None for any other name or URL."""
    if not isinstance(url, str) or not url or not url.isprintable():
        raise UsageError("port", url, "the name of a serial port, or a URL, in printable text")
    if not url.lower().startswith(NETWORK):
        return None
    # Imported here, because the name of a serial port needs no parser.
    from urllib.parse import urlsplit

    try:
        parts = urlsplit(url)
        complete = bool(parts.hostname and parts.port)
    except ValueError:
        complete = False
    if not complete:
        raise UsageError("port", url, "scheme://host:port with a port number 1..65535")
    if parts.scheme == "socket" and (parts.path.strip("/") or parts.query or parts.username):
        raise UsageError("port", url, "socket://host:port and nothing after it")
    return parts
