"""How every port of pyserial is opened, and what its failures mean."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

from cobotwire.errors import LinkError, UsageError
from cobotwire.transport.descriptor import reason_of


def configure(port: Any, baudrate: int) -> None:
    """Set up a port that is not open yet; frames are 8N1 without flow control."""
    port.baudrate = baudrate
    port.timeout = 0
    # A 0x13 in the data would stop the line, and lines that the board does not have would too.
    port.xonxoff = False
    port.rtscts = False
    port.dsrdtr = False
    # Asserted, these lines hold the controller of some boards in reset. Set before opening, they
    # are low as soon as the port is open.
    port.dtr = False
    port.rts = False


def ask_low_latency(port: Any) -> bool:
    """Have the driver pass on what comes at once (an FTDI chip's timer goes from 16 to 1 ms)."""
    # Only Linux has it, and there not every driver: a pty has not.
    with suppress(AttributeError, NotImplementedError, ValueError, OSError):
        port.set_low_latency_mode(True)
        return True
    return False


@contextmanager
def opening(url: str) -> Iterator[None]:
    """Turn what pyserial raises into UsageError or LinkError."""
    try:
        yield
    # Each backend of pyserial fails in its own way, from KeyError to termios.error.
    except Exception as error:
        cause = _innermost(error)
        if isinstance(cause, ValueError | KeyError) and not isinstance(cause, OSError):
            raise UsageError("port", url, f"what pyserial opens ({cause})") from None
        raise LinkError(url, f"cannot be opened: {reason_of(error)}") from error


def _innermost(error: BaseException) -> BaseException:
    """What went wrong first: pyserial wraps it in errors, and some of these fail in themselves."""
    while error.__context__ is not None:
        error = error.__context__
    return error
