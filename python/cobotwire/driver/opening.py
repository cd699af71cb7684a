"""What both drivers take when they are opened, checked; and how their links are opened."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.errors import UsageError
from cobotwire.session import RetryPolicy
from cobotwire.table import Command, Table
from cobotwire.transport import Transport, open_link

if TYPE_CHECKING:
    from cobotwire.limits import Limits


class Settings(NamedTuple):
    """How a driver asks: ``timeout`` is seconds, None what the edition says of each command."""

    codec: Codec
    timeout: float | None
    retry: RetryPolicy

    def at_most(self, longest: float, command: Command) -> float:
        """The seconds that a command's answer may take, where there are no more than so many."""
        usual = command.deadline_ms / 1000 if self.timeout is None else self.timeout
        return min(longest, usual)

    def for_stream(self, timeout: float | None) -> Settings:
        """The same for the questions of a stream, which are sent once: the next slot asks again.

        Raises:
            UsageError: the timeout is not allowed.
        """
        seconds("timeout", timeout)
        retry = replace(self.retry, tries=1)
        return self._replace(retry=retry, timeout=self.timeout if timeout is None else timeout)


def settings(
    table: Table,
    timeout: float | None,
    retry: RetryPolicy | None,
    codec: codecs.CodecName | None,
    limits: Limits | None,
) -> Settings:
    """Check what a caller wants.

    Raises:
        UsageError: an argument is not allowed.
    """
    seconds("timeout", timeout)
    if retry is not None and not isinstance(retry, RetryPolicy):
        raise UsageError("retry", retry, "a RetryPolicy")
    if limits is not None:
        # Here, not above: few programs have limits of their own, and all of them import this.
        from cobotwire.limits import Limits, limited

        if not isinstance(limits, Limits):
            raise UsageError("limits", limits, "Limits")
        table = limited(table, limits)
    return Settings(codecs.load(table, codec), timeout, retry or RetryPolicy())


def seconds(argument: str, value: float | None) -> None:
    """A time limit, or None.

    Raises:
        UsageError: it is none.
    """
    right = isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < 3600
    if value is not None and not right:
        raise UsageError(argument, value, "seconds above 0 and below 3600")


def check_port(port: str | Transport) -> None:
    """What can be opened, or is open.

    Raises:
        UsageError: it is neither.
    """
    if not isinstance(port, str | Transport):
        raise UsageError("port", port, "the name of a serial port, a URL, or a transport")


def opened(port: str | Transport, table: Table, baudrate: int | None) -> Transport:
    """The link: opened by name or URL, or as it was handed over.

    Raises:
        UsageError: it is neither, or is no URL, or the baud rate is none.
        LinkError: it is not there, or cannot be opened.
    """
    check_port(port)
    if not isinstance(port, str):
        return port
    return open_link(port, table.baudrate if baudrate is None else baudrate)
