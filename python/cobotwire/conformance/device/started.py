"""Run a program as the device under test: start it, connect to it, and stop it."""

from __future__ import annotations

import os
import re
import shlex
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from types import TracebackType
from typing import Literal, Self

from cobotwire.conformance.device.program_transport import DescriptorEnd, WatchedTransport
from cobotwire.conformance.programs import end, ending, start
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.transport import Transport, open_transport

Attach = Literal["stdio", "pty", "port"]
ATTACH: tuple[Attach, ...] = ("stdio", "pty", "port")
# The placeholder in a command for the path of the pseudo-terminal.
PORT_WORD = "{port}"
# A URL or device name that a program prints, and that can be opened as a port.
PRINTED_PORT = re.compile(rb"(?:socket|rfc2217)://\S+|/dev/\S+|\bCOM\d+\b")
# The limit, in seconds, for the program to print its port.
STARTING = 10.0
# The output is searched for a port every POLL seconds, in its first READ_SIZE bytes.
POLL = 0.02
READ_SIZE = 4096


def parse_command(text: str, attach: str | None) -> tuple[list[str], Attach]:
    """Return the words of a command, and how to connect to it.

    The default is a pseudo-terminal if the command contains ``{port}``, else the standard input and
    output.

    Raises:
        UsageError: the text is not a command, or does not fit ``attach``.
    """
    try:
        command = shlex.split(text)
    except ValueError as error:
        raise UsageError("command", text, message=f"--command {text!r}: {error}") from None
    if not command:
        raise UsageError("command", text, message="--command is empty; name a program")
    named = any(PORT_WORD in word for word in command)
    for each in ATTACH:
        if each == (attach or ("pty" if named else "stdio")):
            if named and each != "pty":
                message = f"{PORT_WORD} stands for a pseudo-terminal: use --attach pty, or omit it"
                raise UsageError("attach", attach, message=message)
            return command, each
    raise UsageError("attach", attach, f"one of {', '.join(ATTACH)}")


class StartedDevice:
    """A program that runs as a device in a ``with`` block; ``transport`` connects to it."""

    def __init__(self, command: Sequence[str], attach: Attach, baudrate: int) -> None:
        """Start the program, in a session of its own.

        Args:
            command: the program and its arguments.
            attach: how to connect. ``stdio``: to its standard input and output. ``pty``: by a
                pseudo-terminal; its path replaces ``{port}`` in the command, and without ``{port}``
                it is the standard input and output. ``port``: to the port that it prints.
            baudrate: bits per second of a printed serial port.

        Raises:
            LinkError: the program cannot be started, or prints no port.
        """
        self.name = f"command {shlex.join(command)}"
        # Diagnostics go to a file, because a pipe that nobody reads would block when it is full.
        self._diagnostics = tempfile.TemporaryFile()  # noqa: SIM115  (closed by stop)
        self._output = tempfile.TemporaryFile()  # noqa: SIM115  (closed by stop)
        self._ends: list[int] = []
        self._how = ""
        try:
            self._process, inner = self._start(list(command), attach, baudrate)
        except BaseException:
            self._release()
            raise
        self.transport: Transport = WatchedTransport(inner, self.name, self.ended)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.stop()

    def ended(self) -> str:
        """Return how the program ended; empty while it runs."""
        code = self._process.poll()
        if not self._how and code is not None:
            self._how = ending(code, self._diagnostics)
        return self._how

    def stop(self) -> None:
        """Close the transport, and end the program and the programs that it has started."""
        self.transport.close()
        end(self._process)
        self.ended()
        self._release()

    def _start(
        self, command: list[str], attach: Attach, baudrate: int
    ) -> tuple[subprocess.Popen[bytes], Transport]:
        if attach == "port":
            output = self._output.fileno()
            process = start(command, self.name, subprocess.DEVNULL, output, self._diagnostics)
            try:
                return process, open_transport(self._printed_port(process), baudrate)
            except BaseException:
                end(process)
                raise
        ours, theirs, path = _pty() if attach == "pty" else _pair()
        self._ends.append(theirs)
        inner = DescriptorEnd(ours, self.name)
        placed = [word.replace(PORT_WORD, path) for word in command]
        named = placed != command
        ends = (subprocess.DEVNULL, self._output.fileno()) if named else (theirs, theirs)
        try:
            process = start(placed, self.name, *ends, self._diagnostics)
        except BaseException:
            inner.close()
            raise
        if not named:
            # Only the program has its end open, so that reads report when it has ended.
            os.close(self._ends.pop())
        return process, inner

    def _printed_port(self, process: subprocess.Popen[bytes]) -> str:
        """Wait until the program prints a port or URL."""
        until = time.monotonic() + STARTING
        while True:
            code = process.poll()
            self._output.seek(0)
            found = PRINTED_PORT.search(self._output.read(READ_SIZE))
            if found:
                return found[0].decode(errors="replace")
            if code is not None:
                raise LinkError(self.name, ending(code, self._diagnostics))
            if time.monotonic() >= until:
                message = f"it printed no port (/dev/..., socket://HOST:PORT) in {STARTING:g} s"
                raise LinkError(self.name, message)
            time.sleep(POLL)

    def _release(self) -> None:
        while self._ends:
            os.close(self._ends.pop())
        self._diagnostics.close()
        self._output.close()


def _pair() -> tuple[int, int, str]:
    """Return our end and the program's end of a connection."""
    if sys.platform == "win32":
        message = "Windows cannot wait for a program's output: use --attach port"
        raise UsageError("attach", "stdio", message=message)
    ours, theirs = socket.socketpair()
    return ours.detach(), theirs.detach(), ""


def _pty() -> tuple[int, int, str]:
    """Return our end and the program's end of a pseudo-terminal, and the path of the latter."""
    if sys.platform == "win32":
        raise UsageError(
            "attach", "pty", message="Windows has no pseudo-terminals: use --attach port"
        )
    import tty

    ours, theirs = os.openpty()
    # Raw mode: a terminal would echo the requests and swallow some of their bytes.
    tty.setraw(theirs)
    return ours, theirs, os.ttyname(theirs)
