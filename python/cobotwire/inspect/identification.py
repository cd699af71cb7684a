"""Find out which edition an arm speaks, and connect to it with the client of that edition.

First a query that every edition has, and for which every arm has a reply. Then the number of
joints, by the length of the row of angles. Then queries that only some editions have; each legal
reply rules out the others. If several editions remain, a limit of a joint decides, as the arm
reports it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

from cobotwire import editions
from cobotwire.client.opening import open_port
from cobotwire.inspect.evidence import (
    Candidates,
    Evidence,
    ask,
    joint_counts,
    limits_apart,
    own_query,
)
from cobotwire.protocol.errors import EditionUnknown
from cobotwire.protocol.table import Command, Table
from cobotwire.transport import Transport
from cobotwire.transport.tapped import borrowed

if TYPE_CHECKING:
    from cobotwire.client import Client
    from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
    from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280


class Identification(NamedTuple):
    """What an arm is, and by what evidence.

    Attributes:
        url: the port.
        edition: the edition that the arm speaks; empty if it is not known.
        candidates: the editions that the replies allow; empty without a reply.
        firmware: the version of the firmware, such as ``7.3``; empty if the arm does not report it.
        evidence: the queries in the order in which they were sent.
    """

    url: str
    edition: str
    candidates: tuple[str, ...]
    firmware: str
    evidence: tuple[Evidence, ...]

    @property
    def replied(self) -> bool:
        """Whether the arm sent a legal reply to any query."""
        return any(each.replied for each in self.evidence)


def other_edition(
    client: Client, table: Table, transport: Transport, *, timeout: float
) -> tuple[Evidence, Evidence | None]:
    """Check that an arm speaks the edition of its client.

    Returns:
        What the edition's own query shows, and the evidence that the arm speaks another edition;
        None: there is none. Other queries are only sent if the own one gets no legal reply.

    Raises:
        LinkError: the transport is gone.
    """
    command = own_query(table, _others(table.edition))
    own = Evidence("", table.edition, False, None, "the edition has no query of its own")
    if command is not None:
        own = ask(client, command, table.edition)
    if own.replied:
        return own, None
    # A device whose frames differ is no arm of the others, and is not sent their frames.
    found, against = Candidates(_with_same_frames(newest_first(), table)), None
    for evidence in _narrowed(transport, found, timeout=timeout):
        if against is None and table.edition not in found.proven:
            against = evidence
    return own, against and against._replace(edition=" or ".join(found.proven))


def _narrowed(
    transport: Transport, found: Candidates, *, timeout: float | None
) -> Iterator[Evidence]:
    """Send one query after another, until one edition is left, or no query tells them apart."""
    yield from _row_evidence(transport, found, timeout=timeout)
    query = found.next_query()
    while query is not None and not found.known:
        name, command = query
        reply = found.evidence(_asked(transport, name, command, timeout=timeout), command)
        found.note(command, reply.replied)
        yield reply
        query = found.next_query()


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
    first = editions.load(newest_first()[0]).TABLE
    found, powered = Candidates(_with_same_frames(newest_first(), first)), first.in_role("powered")
    reply = _asked(transport, first.edition, powered, timeout=timeout)
    evidence = [found.evidence(reply, powered)]
    if reply.text == "no reply":
        return Identification(transport.url, "", (), "", tuple(evidence))
    found.note(powered, reply.replied)
    evidence += _narrowed(transport, found, timeout=timeout)
    edition, firmware = found.known, ""
    version = editions.load(edition or first.edition).TABLE.find_role("version")
    asked = {each.query: each for each in evidence}
    if version is not None and version.name in asked and asked[version.name].replied:
        firmware = str(asked[version.name].result)
    elif version is not None and edition:
        reply = _asked(transport, edition, version, timeout=timeout)
        evidence.insert(-1, reply._replace(shows="it does not tell the editions in question apart"))
        firmware = str(reply.result) if reply.replied else ""
    if not edition:
        limits = list(_limit_evidence(transport, found.proven, timeout=timeout))
        evidence += limits
        edition = limits[-1].edition if limits else ""
    candidates = (edition,) if edition else tuple(found.proven)
    return Identification(transport.url, edition, candidates, firmware, tuple(evidence))


def _row_evidence(
    transport: Transport, found: Candidates, *, timeout: float | None
) -> Iterator[Evidence]:
    """Read the row of angles with one number of joints after another, until one fits."""
    for count in joint_counts(found.proven):
        reply = _asked(transport, count.edition, count.command, timeout=timeout)
        joints = editions.load(count.edition).TABLE.joints
        shows = f"a row of {joints} joints, as in {', '.join(count.editions)}"
        only = count.editions[0] if len(count.editions) == 1 else ""
        if reply.replied:
            found.keep(count.editions)
        yield reply._replace(edition=only, shows=shows)
        if reply.replied:
            return


def _limit_evidence(
    transport: Transport, names: list[str], *, timeout: float | None
) -> Iterator[Evidence]:
    """Read limits of joints that differ between editions, until one decides; at most two."""
    for limit in islice(limits_apart(names), 2):
        found = _asked(transport, names[0], limit.command, limit.joint, timeout=timeout)
        edition = limit.edition_of(found.result) if found.replied else ""
        stated = ", ".join(f"{value:g} in {name}" for name, value in limit.editions.items())
        yield found._replace(edition=edition, shows=f"the limit is {stated}")
        if edition:
            return


def _asked(
    transport: Transport, name: str, command: Command, *arguments: int, timeout: float | None
) -> Evidence:
    with closing(editions.load(name).CLIENT(borrowed(transport), timeout=timeout)) as client:
        return ask(client, command, "", *arguments)


def identify(
    port: str, *, baudrate: int | None = None, timeout: float | None = None
) -> Identification:
    """Find out which edition an arm speaks, with a few harmless queries; nothing moves.

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

    A few harmless queries are sent; nothing moves. ``record`` does not record them, since
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
        evidence = tuple(f"{e.query}: {e.text}" for e in found.evidence)
        raise EditionUnknown(found.url, evidence, found.candidates)
    return found.edition


def _open(port: str, baudrate: int | None) -> Transport:
    usual = editions.load(editions.DEFAULT).TABLE.baudrate
    return open_port(port, usual if baudrate is None else baudrate)


def _others(name: str) -> list[Table]:
    return [editions.load(other).TABLE for other in editions.names() if other != name]


def _with_same_frames(names: list[str], table: Table) -> list[str]:
    return [name for name in names if _same_frames(editions.load(name).TABLE, table)]


def _same_frames(one: Table, other: Table) -> bool:
    first, second = one.frame, other.frame
    return replace(first, maximum_length=second.maximum_length) == second


def _version(table: Table) -> bool:
    return table.find_role("version") is not None
