"""A serial port of a POSIX system: opened by pyserial, read and written by its descriptor."""

from __future__ import annotations

import fcntl
import os
import struct
import termios
from contextlib import suppress

import serial

from cobotwire.transport.descriptor import DescriptorLink
from cobotwire.transport.serial.opening import ask_low_latency, configure, opening

DTR_AND_RTS = struct.pack("I", termios.TIOCM_DTR | termios.TIOCM_RTS)
PSEUDO_TERMINALS = "/dev/pts/"
HARDWARE = "hwgrep://"


class _QuietPort(serial.Serial):
    """Lowers DTR and RTS in one step.

    Linux raises both when a port is opened. Lowered one after the other, DTR first, they pass
    through DTR low and RTS high: with the usual two transistors that is the reset of an ESP32.
    """

    def _update_dtr_state(self) -> None:
        # Open calls this for DTR, then the same for RTS, which changes nothing any more.
        assert self.fd is not None, "called while opening"
        fcntl.ioctl(self.fd, termios.TIOCMBIC, DTR_AND_RTS)


class PortLink(DescriptorLink):
    """A serial port; see :class:`cobotwire.transport.interface.Link`.

    The URL is a device, or ``hwgrep://TEXT`` for one whose name or USB ids hold the text.

    Reading and writing go past pyserial, which waits by select() for each chunk once more, and does
    not tell how much of a write was taken.
    """

    kind = "serial"

    def __init__(self, url: str, baudrate: int) -> None:
        """Open the port.

        Raises:
            UsageError: the system has no such baud rate.
            LinkError: it is not there, no serial port, or another program has it open.
        """
        self._port: _QuietPort | None = None
        super().__init__(url, baudrate)

    def _connect(self) -> None:
        with opening(self.url):
            device = _device(self.url)
            port = _QuietPort()
            port.port = device
            configure(port, self._baudrate)
            # Two processes on one port would mix their bytes into each other's frames.
            port.exclusive = True
            port.open()
            self._port = port
            self.low_latency = ask_low_latency(port)
            # The lock of pyserial keeps out only programs that ask for it. This keeps out all. A
            # pty that its server holds open would stay locked if this process died.
            if not os.path.realpath(device).startswith(PSEUDO_TERMINALS):
                keep_others_out(port.fileno())

    def _release(self) -> None:
        if self._port is not None:
            # What is gone already need not be given back.
            with suppress(Exception):
                self._port.close()
            self._port = None

    def _descriptor(self) -> int:
        descriptor = None if self._port is None else self._port.fd
        return -1 if descriptor is None else descriptor

    def _end_of_data(self) -> str:
        return "it is gone, or another program reads from it"


def _device(url: str) -> str:
    """The port; that of ``hwgrep://`` is looked for each time, as a plug may get another number."""
    if not url.lower().startswith(HARDWARE):
        return url
    return str(serial.serial_for_url(url, do_not_open=True).port)


def keep_others_out(descriptor: int) -> None:
    """Let nobody else open this terminal (but root, who may) until its last user has closed it."""
    # What has no such lock is kept apart by pyserial's alone.
    with suppress(OSError):
        fcntl.ioctl(descriptor, termios.TIOCEXCL)
