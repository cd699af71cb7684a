"""Which link a URL needs."""

from __future__ import annotations

from urllib.parse import SplitResult, urlsplit

from cobotwire.errors import UsageError
from cobotwire.transport.interface import Link

HIGHEST_BAUDRATE = 2**31 - 1
NETWORK = ("socket://", "rfc2217://")


def open_link(url: str, baudrate: int) -> Link:
    """Open a serial port, ``socket://host:port``, or any other URL that pyserial opens.

    Args:
        url: the port's name or the URL.
        baudrate: bits a second. TCP has none, but there is a serial line behind it: the time that a
            write may take is measured by it.

    Raises:
        UsageError: the URL or baud rate is none.
        LinkError: the port is not there, is taken by another program, or cannot be opened.
    """
    parts = _check(url)
    whole = isinstance(baudrate, int) and not isinstance(baudrate, bool)
    if not whole or not 0 < baudrate <= HIGHEST_BAUDRATE:
        raise UsageError("baudrate", baudrate, f"a whole number 1..{HIGHEST_BAUDRATE}")
    if parts is not None and parts.scheme == "socket":
        from cobotwire.transport.tcp import TcpLink

        return TcpLink(url, baudrate, _host(parts), parts.port or 0)
    # Imported where it is used: pyserial takes as long to load as all the rest of the package.
    from cobotwire.transport.serial import open_serial

    return open_serial(url, baudrate)


def _check(url: object) -> SplitResult | None:
    """The parts of a network URL; None for what is none."""
    if not isinstance(url, str) or not url or not url.isprintable():
        raise UsageError("port", url, "the name of a serial port, or a URL, in printable text")
    if not url.lower().startswith(NETWORK):
        return None
    try:
        parts = urlsplit(url)
        if parts.hostname and parts.port:
            _plain_socket(url, parts)
            return parts
    except UsageError:
        raise
    except ValueError:
        pass
    raise UsageError("port", url, "scheme://host:port with a port number 1..65535")


def _plain_socket(url: str, parts: SplitResult) -> None:
    if parts.scheme == "socket" and (parts.path.strip("/") or parts.query or parts.username):
        raise UsageError("port", url, "socket://host:port and nothing behind it")


def _host(parts: SplitResult) -> str:
    assert parts.hostname is not None, "checked before"
    return parts.hostname
