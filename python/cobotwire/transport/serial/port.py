"""A serial port of a POSIX system: opened by pyserial, read and written by its descriptor."""

from __future__ import annotations

import fcntl
import os
import struct
import termios
from contextlib import suppress

import serial

from cobotwire.transport.descriptor import DescriptorTransport
from cobotwire.transport.serial.opening import configure, opening, request_low_latency

DTR_AND_RTS = struct.pack("I", termios.TIOCM_DTR | termios.TIOCM_RTS)
PSEUDO_TERMINALS = "/dev/pts/"
HARDWARE = "hwgrep://"


class _QuietPort(serial.Serial):
    """Lowers DTR and RTS in one step, and has one descriptor.

    Linux raises both when a port is opened. Lowering DTR first passes through DTR low and RTS high:
    with the usual two transistors that resets an ESP32.
    """

    def open(self) -> None:
        super().open()
        # Only pyserial's own read() and write() need these two pipes.
        for name in ("pipe_abort_read", "pipe_abort_write"):
            for end in ("r", "w"):
                os.close(getattr(self, f"{name}_{end}"))
                setattr(self, f"{name}_{end}", None)

    def close(self) -> None:
        if self.is_open:
            self.is_open = False
            descriptor, self.fd = self.fd, None
            if descriptor is not None:
                os.close(descriptor)

    def _update_dtr_state(self) -> None:
        # On opening, pyserial calls this, then its method for RTS, which has nothing left to do.
        assert self.fd is not None, "called while opening"
        fcntl.ioctl(self.fd, termios.TIOCMBIC, DTR_AND_RTS)


class SerialTransport(DescriptorTransport):
    """An :class:`OpenedTransport` over a serial port.

    The URL is a device, or ``hwgrep://TEXT`` for one whose name or USB ids contain the text.

    Reading and writing bypass pyserial, which calls select() once more for each chunk, and does not
    return how many bytes of a write were taken.
    """

    kind = "serial"

    def __init__(self, url: str, baudrate: int) -> None:
        """Open the port.

        Raises:
            UsageError: the system does not have this baud rate.
            LinkError: the port does not exist, is not serial, or another program has it open.
        """
        self._port: _QuietPort | None = None
        super().__init__(url, baudrate)

    def _connect(self) -> int:
        with opening(self.url):
            device = _device(self.url)
        with opening(self.url, device):
            port = _QuietPort()
            port.port = device
            configure(port, self._baudrate)
            # Two processes on one port would mix their bytes into each other's frames.
            port.exclusive = True
            port.open()
            self._port = port
            self.low_latency = request_low_latency(port)
            descriptor: int = port.fileno()
            # The lock of pyserial keeps out only programs that check it. This one keeps out all,
            # but a pty that its server holds open would stay locked if this process died.
            if not os.path.realpath(device).startswith(PSEUDO_TERMINALS):
                keep_others_out(descriptor)
            return descriptor

    def _release(self) -> None:
        if self._port is not None:
            # A port that is gone already cannot be closed.
            with suppress(Exception):
                self._port.close()
            self._port = None

    def _end_of_data(self) -> str:
        return "it is gone, or another program reads from it"


def _device(url: str) -> str:
    """Return the device; ``hwgrep://`` is searched for each time, as its number may change."""
    if not url.lower().startswith(HARDWARE):
        return url
    return str(serial.serial_for_url(url, do_not_open=True).port)


def keep_others_out(descriptor: int) -> None:
    """Have open() of this terminal fail, except for root, until every process has closed it."""
    # A device without this lock has only pyserial's lock.
    with suppress(OSError):
        fcntl.ioctl(descriptor, termios.TIOCEXCL)
