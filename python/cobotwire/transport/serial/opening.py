"""How each port of pyserial is opened, and what its failures mean."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.transport.descriptor import reason_of

# pyserial gives the number of a Windows error only in its text.
_NUMBER_OF_WINDOWS = re.compile(r"Error\((\d+), ")


def configure(port: Any, baudrate: int) -> None:
    """Set up a port that is not open yet; frames are 8N1 without flow control."""
    port.baudrate = baudrate
    port.timeout = 0
    # With flow control, a 0x13 in the data would stop the line; so would control lines that the
    # board does not connect.
    port.xonxoff = False
    port.rtscts = False
    port.dsrdtr = False
    # These lines hold the controller of some boards in reset while they are asserted. Set before
    # opening, they are low as soon as the port is open.
    port.dtr = False
    port.rts = False


def request_low_latency(port: Any) -> bool:
    """Have the driver pass received bytes on at once (the timer of an FTDI chip is 16 ms).

    Returns:
        Whether it does now: only Linux can, and not with every driver.
    """
    with suppress(AttributeError, NotImplementedError, ValueError, OSError):
        port.set_low_latency_mode(True)
        return True
    return False


@contextmanager
def opening(url: str, device: str = "") -> Iterator[None]:
    """Turn the errors of pyserial into UsageError or LinkError, on opening a ``device`` or URL."""
    try:
        yield
    # Each backend of pyserial fails in its own way, from KeyError to termios.error.
    except Exception as error:
        cause = _innermost(error)
        if isinstance(cause, ValueError | KeyError) and not isinstance(cause, OSError):
            message = f"pyserial cannot open {url}: {cause}"
            raise UsageError("port", url, message=message) from None
        raise LinkError(url, f"cannot be opened: {_explained(device, error, cause)}") from None


def _explained(device: str, error: Exception, cause: BaseException) -> str:
    """Return why a port cannot be opened, and what to do."""
    match = _NUMBER_OF_WINDOWS.search(str(error))
    number = getattr(cause, "errno", None) or (int(match[1]) if match else None)
    # termios.error has its number only among its arguments.
    number = number or next((each for each in cause.args if isinstance(each, int)), None)
    # pyserial lists no ports on some systems.
    with suppress(ImportError, OSError):
        # Imported here, since opening seldom fails.
        from cobotwire.transport.serial import ports, remedies

        if device:
            by = ports.programs_using(device) if number in remedies.BUSY else ""
            computer = ports.this_computer(device)
            return remedies.explain(computer, device, number, reason_of(error), by)
    return reason_of(error)


def _innermost(error: BaseException) -> BaseException:
    """Return the original error: pyserial wraps it in others, and fails while it formats some."""
    while error.__context__ is not None:
        error = error.__context__
    return error
