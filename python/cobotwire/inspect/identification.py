"""Find out which edition an arm speaks, and connect to it with the client of that edition.

First it sends a query that every edition has and every arm replies to: with the frames of most
editions, then with other frames (:mod:`cobotwire.inspect.frame_families`), until a reply comes.
Then the length of the row of angles shows the number of joints. Then it sends queries that only
some editions have; each legal reply rules out the others. If several editions remain, a limit of a
joint decides, as the arm reports it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from functools import partial
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

from cobotwire import editions
from cobotwire.client.opening import open_port
from cobotwire.client.persisted_state import PersistedSession
from cobotwire.inspect.cross_checks import doubts
from cobotwire.inspect.evidence import (
    NO_REPLY,
    Candidates,
    Evidence,
    ask,
    joint_counts,
    limits_apart,
    own_query,
)
from cobotwire.inspect.frame_families import Probes, families, with_same_frames
from cobotwire.protocol.errors import EditionUnknown
from cobotwire.protocol.frame_format import FrameFormat
from cobotwire.protocol.table import Command, Role, Table
from cobotwire.session.outstanding import PersistedState, merged
from cobotwire.transport import Transport
from cobotwire.transport.tapped import borrowed

if TYPE_CHECKING:
    from cobotwire.client import Client
    from cobotwire.editions.clients import AnyAsyncClient, AnyClient


# The queries that show whether an arm at rest is where it reports.
PLACE: tuple[Role, ...] = ("moving", "joints", "coordinates")
# Sends a query with the client of an edition; the last values are its arguments.
Ask = Callable[..., Evidence]


class Identification(NamedTuple):
    """What an arm is, and the evidence for it.

    Attributes:
        url: the port.
        edition: the edition that the arm speaks; empty if it is not known.
        candidates: the editions that the replies allow; empty without a reply.
        firmware: the version of the firmware, such as ``7.3``; empty if the arm does not report it.
        evidence: the queries in the order in which they were sent.
        baudrate: the baud rate of the last queries; 0 if the caller opened the transport.
        doubts: the mistakes of the edition that explain what the arm reports.
    """

    url: str
    edition: str
    candidates: tuple[str, ...]
    firmware: str
    evidence: tuple[Evidence, ...]
    baudrate: int = 0
    doubts: tuple[str, ...] = ()

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
        None if there is no such evidence. Other queries are only sent if the edition's own query
        gets no legal reply.

    Raises:
        LinkError: the transport is gone.
    """
    # Editions with other frames are left out, so that the device is not sent such frames.
    names = with_same_frames(newest_first(), table)
    others = [editions.load(name).TABLE for name in names if name != table.edition]
    command = own_query(table, others)
    own = Evidence("", table.edition, False, None, "the edition has no query of its own")
    if command is not None:
        own = ask(client, command, table.edition)
    if own.replied:
        return own, None
    found, against = Candidates(names), None
    for evidence in _narrowed(partial(_send, transport, timeout), found):
        if against is None and table.edition not in found.proven:
            against = evidence
    return own, against and against._replace(edition=" or ".join(found.proven))


def _narrowed(ask: Ask, found: Candidates) -> Iterator[Evidence]:
    """Send one query after another, until one edition is left, or no query distinguishes them."""
    yield from _row_evidence(ask, found)
    query = found.next_query()
    while query is not None and not found.known:
        name, command = query
        reply = found.evidence(ask(name, command), command)
        found.note(command, reply.replied)
        yield reply
        query = found.next_query()


def newest_first() -> list[str]:
    """Return the names of the editions: first those that can report their version."""
    return sorted(
        editions.names(), key=lambda name: (not _version(editions.load(name).TABLE), name)
    )


def identify_on(
    transport: Transport, *, timeout: float | None = None, among: Sequence[str] = ()
) -> Identification:
    """Find out which edition the arm on an open transport speaks; nothing moves.

    ``among`` are the editions in question; if it is empty, all are.

    Raises:
        LinkError: the transport is gone.
    """
    memory, probes = PersistedSession(transport), Probes(transport)
    left: list[PersistedState] = []

    def separate(format: FrameFormat) -> None:
        # The next session has another frame format, and drops outstanding replies of this one.
        left.append(memory.recall())
        probes.separate(format)

    try:
        ask = partial(_send, probes.transport, timeout)
        return identify_by(ask, separate, among)._replace(url=transport.url)
    finally:
        memory.leave(merged([*left, memory.recall()]))


def identify_by(
    ask: Ask, separate: Callable[[FrameFormat], object], among: Sequence[str] = ()
) -> Identification:
    """Find out the edition by a function that sends queries; its errors are raised.

    ``separate`` is called with another frame format before the first query that has it.
    """
    evidence: list[Evidence] = []
    for names in families([n for n in newest_first() if not among or n in among]):
        found = Candidates(names)
        if evidence:
            separate(editions.load(names[0]).TABLE.frame)
        for name, command in _first_queries(names):
            reply = ask(name, command)
            shown = found.evidence(reply, command)
            if len(names) == 1:
                shown = shown._replace(edition=name, shows=f"only {name} has these frames")
            evidence.append(shown)
            found.note(command, reply.replied)
            if reply.text != NO_REPLY:
                return _identified(ask, found, evidence)
    return Identification("", "", (), "", tuple(evidence))


def _first_queries(names: list[str]) -> Iterator[tuple[str, Command]]:
    """Yield an edition and a query; an arm that knows the query always replies to it.

    It is the query of the power or, for arms without motors, that of the version.
    """
    tables = {name: editions.load(name).TABLE for name in names}
    for role in ("powered", "version"):
        having = [name for name in names if tables[name].find_role(role) is not None]
        if having:
            yield having[0], tables[having[0]].in_role(role)
        if all(tables[name].find_role("powered") is not None for name in names):
            return


def _identified(ask: Ask, found: Candidates, evidence: list[Evidence]) -> Identification:
    """Find out which edition an arm speaks, of those with the frames that it replied to."""
    first = editions.load(found.proven[0]).TABLE
    evidence += _narrowed(ask, found)
    edition, firmware = found.known, ""
    version = editions.load(edition or first.edition).TABLE.find_role("version")
    by_query = {each.query: each for each in evidence}
    if version is not None and version.name in by_query and by_query[version.name].replied:
        firmware = str(by_query[version.name].result)
    elif version is not None and edition:
        reply = ask(edition, version)
        evidence.insert(
            -1, reply._replace(shows="it does not distinguish the editions in question")
        )
        firmware = str(reply.result) if reply.replied else ""
    if not edition:
        limits = list(_limit_evidence(ask, found.proven))
        evidence += limits
        edition = limits[-1].edition if limits else ""
    candidates = (edition,) if edition else tuple(found.proven)
    return Identification("", edition, candidates, firmware, tuple(evidence))


def _row_evidence(ask: Ask, found: Candidates) -> Iterator[Evidence]:
    """Read the angles, for one number of joints after another, until one fits."""
    for count in joint_counts(found.proven):
        reply = ask(count.edition, count.command)
        joints = editions.load(count.edition).TABLE.joints
        shows = f"a row of {joints} joints, as in {', '.join(count.editions)}"
        only = count.editions[0] if len(count.editions) == 1 else ""
        if reply.replied:
            found.keep(count.editions)
        yield reply._replace(edition=only, shows=shows)
        if reply.replied:
            return


def _limit_evidence(ask: Ask, names: list[str]) -> Iterator[Evidence]:
    """Read limits of joints that differ between editions, until one decides; at most two."""
    for limit in islice(limits_apart(names), 2):
        found = ask(names[0], limit.command, limit.joint)
        edition = limit.edition_of(found.result) if found.replied else ""
        stated = ", ".join(f"{value:g} in {name}" for name, value in limit.editions.items())
        yield found._replace(edition=edition, shows=f"the limit is {stated}")
        if edition:
            return


def _send(
    transport: Transport, timeout: float | None, name: str, command: Command, *arguments: int
) -> Evidence:
    with closing(editions.load(name).CLIENT(borrowed(transport), timeout=timeout)) as client:
        return ask(client, command, "", *arguments)


def identify(
    port: str, *, baudrate: int | None = None, timeout: float | None = None
) -> Identification:
    """Find out which edition an arm speaks, with a few harmless queries; nothing moves.

    Args:
        port: a serial port or a URL; it is closed at the end.
        baudrate: bits a second; default: those of the editions, 115,200 first.
        timeout: seconds that the arm has for each reply, all attempts included.

    Raises:
        UsageError: an argument is not allowed.
        LinkError: the port does not exist, cannot be opened, or disappears.
    """
    found, transport = _found(port, baudrate, timeout)
    try:
        return found._replace(doubts=tuple(_doubts(found, transport, timeout)))
    finally:
        transport.close()


def _doubts(found: Identification, transport: Transport, timeout: float | None) -> list[str]:
    """Return the mistakes of a known edition that explain the position that its arm reports."""
    table = editions.load(found.edition).TABLE if found.edition else None
    if table is None or table.robot.geometry is None:
        return []
    results = {evidence.query: evidence.result for evidence in found.evidence}
    for command in filter(None, map(table.find_role, PLACE)):
        if results.get(command.name) is None:
            evidence = _send(transport, timeout, found.edition, command)
            results[command.name] = evidence.result
    return doubts(table, results)


def connect(port: str, *, baudrate: int | None = None, **options: Any) -> AnyClient:
    """Find out which edition an arm speaks; return a client of that edition, which holds the port.

        with cobotwire.connect("/dev/ttyACM0") as arm:
            print(type(arm).__name__, arm.get_angles())

    A few harmless queries are sent; nothing moves. ``record`` does not record them, since
    the edition of the recording is not known before.

    Args:
        port: a serial port or a URL.
        baudrate: bits a second; default: those of the editions, 115,200 first.
        options: further arguments of the client, such as ``timeout``, ``limits`` and ``record``.

    Raises:
        UsageError: an argument is not allowed.
        LinkError: the port does not exist, cannot be opened, or disappears.
        EditionUnknown: no arm replied, or its replies do not show its edition.
    """
    identified, transport = _found(port, baudrate, options.get("timeout"))
    try:
        edition, rate = _known(identified), identified.baudrate
        client: Any = editions.load(edition).CLIENT(transport, baudrate=rate, **options)
    except BaseException:
        transport.close()
        raise
    found: AnyClient = client
    return found


async def connect_async(
    port: str, *, baudrate: int | None = None, **options: Any
) -> AnyAsyncClient:
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
    edition = editions.load(_known(found))
    client: Any = edition.ASYNC_CLIENT(port, baudrate=found.baudrate, **options)
    await client.open()
    opened: AnyAsyncClient = client
    return opened


def _known(found: Identification) -> str:
    if not found.edition:
        evidence = tuple(f"{e.query}: {e.text}" for e in found.evidence)
        raise EditionUnknown(found.url, evidence, found.candidates)
    return found.edition


def _found(
    port: str, baudrate: int | None, timeout: float | None
) -> tuple[Identification, Transport]:
    """Identify the arm at a port; return the result and the open transport."""
    evidence: list[Evidence] = []
    rates = rates_of(port, baudrate)
    while True:
        rate, names = rates.pop(0)
        transport = open_port(port, rate)
        try:
            found = identify_on(transport, timeout=timeout, among=names)
        except BaseException:
            transport.close()
            raise
        at = f", at {rate:,} baud" if evidence else ""
        evidence += [each._replace(shows=each.shows + at) for each in found.evidence]
        if found.replied or not rates:
            return found._replace(evidence=tuple(evidence), baudrate=rate), transport
        transport.close()


def rates_of(port: str, baudrate: int | None = None) -> list[tuple[int, list[str]]]:
    """Return the baud rates to try, without duplicates, each with the editions to look for.

    The first rate looks for all editions, since a pseudo-terminal or an adapter has its own rate.
    At another rate, only queries with the frames of an edition that states this rate are sent.
    """
    tables = {name: editions.load(name).TABLE for name in editions.names()}
    usual = tables[editions.DEFAULT].baudrate
    if baudrate is not None or not isinstance(port, str) or "://" in port:
        return [(usual if baudrate is None else baudrate, [])]
    others = sorted({table.baudrate for table in tables.values()} - {usual})
    stated = {rate: [t for t in tables.values() if t.baudrate == rate] for rate in others}
    return [(usual, [])] + [
        (rate, [name for table in stated[rate] for name in with_same_frames([*tables], table)])
        for rate in others
    ]


def _version(table: Table) -> bool:
    return table.find_role("version") is not None
