"""The arguments that both clients take when they are opened, and how their ports are opened."""

from __future__ import annotations

import os
from math import inf
from typing import Literal, NamedTuple, TypedDict

from cobotwire import codec as codecs
from cobotwire.capture import Recording
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.lazy import load_parts
from cobotwire.protocol.limits import Limits, limited
from cobotwire.protocol.table import Address, Command, Table
from cobotwire.session import RetryPolicy
from cobotwire.session.request import RequestEncoder
from cobotwire.transport import Transport, open_transport
from cobotwire.transport.tapped import tapped

OnError = Literal["stop", "leave"]
RecordPath = str | os.PathLike[str]


class SharedOptions(TypedDict, total=False):
    """The arguments of a client that several arms may have in common."""

    baudrate: int | None
    timeout: float | None
    deadline: float | None
    retry: RetryPolicy | None
    limits: Limits | None
    codec: codecs.CodecName | None
    on_error: OnError


class Settings(NamedTuple):
    """How a client sends requests; ``timeout`` is in seconds, None: what the edition says."""

    codec: Codec
    timeout: float | None
    retry: RetryPolicy
    limits: Limits = Limits()

    def encoder(self, address: Address | None) -> RequestEncoder:
        """Return the encoder of requests to an address, within the limits."""
        joints, _, _, speed, workspace = self.limits
        if joints is None and speed is None and workspace is None:
            return RequestEncoder(self.codec, address)
        # Few clients have such limits, and kinematics take long to import.
        from cobotwire.client.limited import LimitedEncoder

        return LimitedEncoder(self.codec, address, self.limits)

    def at_most(self, longest: float, command: Command) -> float:
        """Return the deadline of a command in seconds, but ``longest`` at most."""
        usual = command.deadline_ms / 1000 if self.timeout is None else self.timeout
        return min(longest, usual)

    def for_stream(self, timeout: float | None) -> Settings:
        """Return the settings for a stream, which sends each request once per period.

        Raises:
            UsageError: the timeout is not allowed.
        """
        check_seconds("timeout", timeout)
        retry = RetryPolicy(1, self.retry.shortest_attempt, self.retry.grace)
        return self._replace(retry=retry, timeout=self.timeout if timeout is None else timeout)


def settings(
    table: Table,
    timeout: float | None,
    retry: RetryPolicy | None,
    codec: codecs.CodecName | None,
    limits: Limits | None,
) -> Settings:
    """Check a client's arguments and load its codec.

    Raises:
        UsageError: an argument is not allowed.
    """
    check_seconds("timeout", timeout)
    if retry is not None and not isinstance(retry, RetryPolicy):
        raise UsageError("retry", retry, "a RetryPolicy")
    limits = Limits() if limits is None else limits
    if not isinstance(limits, Limits):
        raise UsageError("limits", limits, "Limits")
    if limits != Limits():
        table = limited(table, limits)
    # Import this now, not in a call: Ctrl-C in an import could leave one of its locks held.
    package = table.commands[0].package if table.commands else ""
    if package:
        load_parts(f"{package}.messages")
    # Build the policy again, because its _replace() validates nothing.
    return Settings(codecs.load(table, codec), timeout, RetryPolicy(*(retry or ())), limits)


def check_seconds(argument: str, value: float | None) -> None:
    """Check a time limit; None is allowed.

    Raises:
        UsageError: it is not a number of seconds above 0 and below 3600.
    """
    right = isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < 3600
    if value is not None and not right:
        raise UsageError(argument, value, "seconds above 0 and below 3600")


def check_deadline(seconds: float | None) -> float:
    """Return how many seconds a call may take; None: inf.

    Raises:
        UsageError: it is not a number of seconds above 0 and below 3600.
    """
    check_seconds("deadline", seconds)
    return inf if seconds is None else seconds


def check_on_error(value: OnError) -> OnError:
    """Check what happens to a moving arm when the program fails.

    Raises:
        UsageError: it is neither "stop" nor "leave".
    """
    if value not in ("stop", "leave"):
        raise UsageError("on_error", value, "'stop' or 'leave'")
    return value


def check_port(port: str | Transport) -> None:
    """Check that a port is a name, a URL or an open transport.

    Raises:
        UsageError: it is something else.
    """
    if not isinstance(port, str | Transport):
        raise UsageError("port", port, "the name of a serial port, a URL, or a transport")


def open_port(port: str | Transport, baudrate: int) -> Transport:
    """Open a port by name or URL; return an open transport as it is.

    Raises:
        UsageError: the port, URL or baud rate is not allowed.
        LinkError: the port does not exist, or cannot be opened.
    """
    check_port(port)
    return open_transport(port, baudrate) if isinstance(port, str) else port


class OpenPort(NamedTuple):
    """An open transport, and the recording of its traffic, if there is one."""

    transport: Transport
    recording: Recording | None

    def close(self) -> None:
        """Close both. Closing twice is harmless.

        Raises:
            CaptureError: the recording is incomplete; the transport is closed nevertheless.
        """
        self.transport.close()
        self.close_recording()

    def close_recording(self) -> None:
        """Finish the recording. Doing so twice is harmless.

        Raises:
            CaptureError: it is incomplete.
        """
        if self.recording is not None:
            self.recording.close()


class PortOpener(NamedTuple):
    """What a client opens: its port, and the file to which it records, if any."""

    port: str | Transport
    baudrate: int
    codec: Codec
    record: RecordPath | None

    def check(self) -> None:
        """Check what can be checked before the port is opened.

        Raises:
            UsageError: the port or the path is not allowed.
        """
        check_port(self.port)
        if self.record is not None and not isinstance(self.record, str | os.PathLike):
            raise UsageError("record", self.record, "the path of a file")

    def open(self) -> OpenPort:
        """Open the port, then create the file. If one of them fails, neither remains.

        Raises:
            UsageError: the port, baud rate or path is not allowed, or the file exists already.
            LinkError: the port does not exist, or cannot be opened.
        """
        self.check()
        transport = open_port(self.port, self.baudrate)
        if self.record is None:
            return OpenPort(transport, None)
        try:
            recording = Recording(
                self.record, self.codec, url=transport.url, baudrate=self.baudrate
            )
        except BaseException:
            # A transport that the caller opened stays open.
            if transport is not self.port:
                transport.close()
            raise
        return OpenPort(tapped(transport, recording.record), recording)
