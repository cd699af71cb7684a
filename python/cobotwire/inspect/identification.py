"""Find out which edition an arm speaks, and connect to it with the client of that edition.

First a query that every edition has, and for which every arm has a reply. Then, for one edition
after another, one query that no other edition has. A legal reply to it decides.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from cobotwire import editions
from cobotwire.client.opening import open_port
from cobotwire.protocol.errors import EditionUnknown, ProtocolError, ReplyTimeout
from cobotwire.protocol.table import Command, Table
from cobotwire.transport import Transport
from cobotwire.transport.tapped import borrowed

if TYPE_CHECKING:
    from cobotwire.client import Client
    from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
    from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280


class Evidence(NamedTuple):
    """A query that was sent, and what it shows.

    Attributes:
        query: the name of the command.
        edition: the only edition that has the query; empty if all have it.
        replied: whether a legal reply came.
        result: the result of the query; None without a reply.
        text: what happened, in words.
    """

    query: str
    edition: str
    replied: bool
    result: Any
    text: str


class Identification(NamedTuple):
    """What an arm is, and by what evidence.

    Attributes:
        url: the port.
        edition: the edition that the arm speaks; empty if it is not known.
        firmware: the version of the firmware, such as ``7.3``; empty if the arm does not report it.
        evidence: the queries in the order in which they were sent.
    """

    url: str
    edition: str
    firmware: str
    evidence: tuple[Evidence, ...]

    @property
    def replied(self) -> bool:
        """Whether the arm sent a legal reply to any query."""
        return any(each.replied for each in self.evidence)


def own_query(table: Table) -> Command | None:
    """Return a harmless query that only this edition has: that of its version, if it has one.

    It has no arguments. None: each query of the edition exists in another edition, too.
    """
    others = [editions.load(n).TABLE for n in editions.names() if n != table.edition]
    ids = {command.id for other in others for command in other.commands}
    own = [c for c in _bare_queries(table) if c.id not in ids]
    return min(own, key=lambda command: command.role != "version", default=None)


def ask(client: Client, command: Command, edition: str = "") -> Evidence:
    """Send a query; return what it shows.

    Raises:
        LinkError: the transport is gone.
    """
    try:
        result = getattr(client, command.name)()
    except ReplyTimeout:
        return Evidence(command.name, edition, False, None, "no reply")
    except ProtocolError as error:
        return Evidence(command.name, edition, False, None, f"an illegal reply: {error}")
    return Evidence(command.name, edition, True, result, f"replied {result}")


def own_evidence(transport: Transport, names: list[str], **options: Any) -> Iterator[Evidence]:
    """Send the own query of one edition after another, until one is replied to.

    Raises:
        LinkError: the transport is gone.
    """
    for name in names:
        package = editions.load(name)
        command = own_query(package.TABLE)
        if command is not None:
            with closing(package.CLIENT(borrowed(transport), **options)) as client:
                found = ask(client, command, name)
            yield found
            if found.replied:
                return


def other_edition(
    client: Client, table: Table, transport: Transport, *, timeout: float
) -> tuple[Evidence, Evidence | None]:
    """Check that an arm speaks the edition of its client.

    Returns:
        What the edition's own query shows, and the evidence that the arm speaks another edition;
        None: there is none. An own query of another edition is only sent if that of the client's
        edition gets no legal reply.

    Raises:
        LinkError: the transport is gone.
    """
    command = own_query(table)
    own = Evidence("", table.edition, False, None, "the edition has no query of its own")
    if command is not None:
        own = ask(client, command, table.edition)
    if command is None or own.replied:
        return own, None
    # A device whose frames differ is no arm of the others, and is not sent their frames.
    others = [name for name in newest_first() if name != table.edition]
    others = [name for name in others if _same_frames(editions.load(name).TABLE, table)]
    found = list(own_evidence(transport, others, timeout=timeout))
    return own, found[-1] if found and found[-1].replied else None


def newest_first() -> list[str]:
    """Return the names of the editions: first those that can report their version."""
    return sorted(
        editions.names(), key=lambda name: (not _version(editions.load(name).TABLE), name)
    )


def identify_on(transport: Transport, *, timeout: float | None = None) -> Identification:
    """Find out which edition the arm on an open transport speaks; nothing moves.

    Raises:
        LinkError: the transport is gone.
    """
    names = newest_first()
    first = editions.load(names[0])
    with closing(first.CLIENT(borrowed(transport), timeout=timeout)) as client:
        evidence = [ask(client, first.TABLE.in_role("powered"))]
    if evidence[0].text != "no reply":
        evidence += own_evidence(transport, names, timeout=timeout)
    last = evidence[-1]
    edition = last.edition if last.replied else ""
    firmware = str(last.result) if edition and _version(editions.load(edition).TABLE) else ""
    return Identification(transport.url, edition, firmware, tuple(evidence))


def identify(
    port: str, *, baudrate: int | None = None, timeout: float | None = None
) -> Identification:
    """Find out which edition an arm speaks, with at most three harmless queries; nothing moves.

    Args:
        port: a serial port or a URL; it is closed at the end.
        baudrate: bits a second; default: that of the editions.
        timeout: seconds that the arm has for each reply, all attempts included.

    Raises:
        UsageError: an argument is not allowed.
        LinkError: the port does not exist, cannot be opened, or disappears.
    """
    transport = _open(port, baudrate)
    try:
        return identify_on(transport, timeout=timeout)
    finally:
        transport.close()


def connect(port: str, *, baudrate: int | None = None, **options: Any) -> MyCobot280 | MyCobot:
    """Find out which edition an arm speaks; return a client of that edition, which holds the port.

        with cobotwire.connect("/dev/ttyACM0") as arm:
            print(type(arm).__name__, arm.get_angles())

    At most three harmless queries are sent; nothing moves. ``record`` does not record them, since
    the edition of the recording is not known before.

    Args:
        port: a serial port or a URL.
        baudrate: bits a second; default: that of the editions.
        options: further arguments of the client, such as ``timeout``, ``limits`` and ``record``.

    Raises:
        UsageError: an argument is not allowed.
        LinkError: the port does not exist, cannot be opened, or disappears.
        EditionUnknown: no arm replied, or its replies do not show its edition.
    """
    transport = _open(port, baudrate)
    try:
        edition = _known(identify_on(transport, timeout=options.get("timeout")))
        client: Any = editions.load(edition).CLIENT(transport, baudrate=baudrate, **options)
    except BaseException:
        transport.close()
        raise
    found: MyCobot280 | MyCobot = client
    return found


async def connect_async(
    port: str, *, baudrate: int | None = None, **options: Any
) -> AsyncMyCobot280 | AsyncMyCobot:
    """Do the same as :func:`connect` for asyncio; return an open client.

        async with await cobotwire.connect_async("/dev/ttyACM0") as arm:
            print(await arm.get_angles())

    The port is opened twice: the queries are sent by another thread.

    Raises:
        UsageError: an argument is not allowed.
        LinkError: the port does not exist, cannot be opened, or disappears.
        EditionUnknown: no arm replied, or its replies do not show its edition.
    """
    import asyncio  # slow to import

    timeout = options.get("timeout")
    found = await asyncio.to_thread(identify, port, baudrate=baudrate, timeout=timeout)
    client: Any = editions.load(_known(found)).ASYNC_CLIENT(port, baudrate=baudrate, **options)
    await client.open()
    opened: AsyncMyCobot280 | AsyncMyCobot = client
    return opened


def _known(found: Identification) -> str:
    if not found.edition:
        raise EditionUnknown(found.url, tuple(f"{e.query}: {e.text}" for e in found.evidence))
    return found.edition


def _open(port: str, baudrate: int | None) -> Transport:
    usual = editions.load(editions.DEFAULT).TABLE.baudrate
    return open_port(port, usual if baudrate is None else baudrate)


def _bare_queries(table: Table) -> list[Command]:
    return [
        command
        for command in table.commands
        if command.safety == "query"
        and command.reply
        and not any(v.fields for v in command.request)
    ]


def _same_frames(one: Table, other: Table) -> bool:
    first, second = one.frame, other.frame
    return replace(first, maximum_length=second.maximum_length) == second


def _version(table: Table) -> bool:
    return table.find_role("version") is not None
