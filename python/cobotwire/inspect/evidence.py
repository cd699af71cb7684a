"""Evidence of the edition that an arm speaks: harmless queries, and the editions that remain."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from cobotwire import editions
from cobotwire.protocol.errors import ProtocolError, ReplyTimeout, UsageError
from cobotwire.protocol.roles import row_index
from cobotwire.protocol.table import Command, Table

if TYPE_CHECKING:
    from cobotwire.client import Client

# The queries by which an arm reports the limits of its joints, and how far a reported limit may be
# from that of an edition, in degrees.
LIMIT_QUERIES = ("get_joint_min_angle", "get_joint_max_angle")
NEAR = 0.5
NO_REPLY = "no reply"


class Evidence(NamedTuple):
    """A query that was sent, and what it shows.

    Attributes:
        query: the name of the command.
        edition: the only edition that has the query, or the reported limit; empty if several have.
        replied: whether a legal reply came.
        result: the result of the query; None without a reply.
        text: what happened, in words.
        shows: which editions have the query or the limit, in words.
    """

    query: str
    edition: str
    replied: bool
    result: Any
    text: str
    shows: str = ""


def ask(client: Client, command: Command, edition: str = "", *arguments: int) -> Evidence:
    """Send a query; return what it shows.

    Raises:
        LinkError: the transport is gone.
    """
    query = command.name + (f"({', '.join(map(str, arguments))})" if arguments else "")
    try:
        result = getattr(client, command.name)(*arguments)
    except ReplyTimeout:
        return Evidence(query, edition, False, None, NO_REPLY)
    except ProtocolError as error:
        return Evidence(query, edition, False, None, f"an illegal reply: {error}")
    return Evidence(query, edition, True, result, f"replied {result}")


def bare_queries(table: Table) -> list[Command]:
    """Return the queries of an edition that have no arguments."""
    return [
        command
        for command in table.commands
        if command.safety == "query"
        and not command.event
        and command.reply
        and not any(v.fields for v in command.request)
    ]


def own_query(table: Table, others: Iterable[Table]) -> Command | None:
    """Return a query without arguments to which only this edition has a legal reply; or None.

    If no other edition has as many joints, it is the query for their angles. Otherwise it is a
    query with an id that no other edition with as many joints has; the query of the version is
    preferred.
    """
    alike = [other for other in others if other.joints == table.joints]
    if not alike and table.find_role("joints") is not None:
        return table.in_role("joints")
    ids = {command.id for other in alike for command in other.commands}
    own = [command for command in bare_queries(table) if command.id not in ids]
    return min(own, key=lambda command: command.role != "version", default=None)


class JointCount(NamedTuple):
    """A query for the angles of all joints, for the editions with one and the same joint count.

    Attributes:
        edition: the edition with which the query is sent and the reply is read.
        command: the query.
        editions: the editions with this number of joints.
    """

    edition: str
    command: Command
    editions: list[str]


def joint_counts(names: Iterable[str]) -> list[JointCount]:
    """Return a query for each number of joints; empty if all editions have the same number."""
    groups: dict[int, list[str]] = {}
    for name in names:
        if _table(name).find_role("joints") is not None:
            groups.setdefault(_table(name).joints, []).append(name)
    found = [JointCount(n[0], _table(n[0]).in_role("joints"), n) for n in groups.values()]
    return found if len(found) > 1 else []


class Candidates:
    """The editions that an arm may speak, as far as the evidence shows.

    A legal reply proves that the arm knows the query. A missing reply proves nothing, since older
    firmware lacks queries too; it only makes an edition with the query less likely.

    Attributes:
        proven: the editions that have every query that was replied to.
        likely: the proven editions that lack every query without a reply.
    """

    def __init__(self, names: Iterable[str]) -> None:
        self.proven = list(names)
        self.likely = list(self.proven)
        self._sent: set[int] = set()

    def keep(self, names: Iterable[str]) -> None:
        """Rule out every other edition."""
        kept = set(names)
        self.proven = [name for name in self.proven if name in kept]
        self.likely = [name for name in self.likely if name in kept]

    def evidence(self, found: Evidence, command: Command) -> Evidence:
        """Return what a query shows, with the proven editions that have the query."""
        having = _having(command.id, self.proven)
        if len(having) == len(self.proven):
            return found._replace(shows="every edition in question has this query")
        only = having[0] if len(having) == 1 else ""
        shows = f"only {', '.join(having)} {'have' if having[1:] else 'has'} this query"
        return found._replace(edition=only, shows=shows)

    def next_query(self) -> tuple[str, Command] | None:
        """Return an edition, and a query of it that some of the likely editions lack; or None.

        The version comes first, then queries that about half of the editions have. If only
        one edition is likely, it is a query that few of the proven editions have.
        """
        among = self.likely if len(self.likely) > 1 else self.proven
        wanted = len(among) / 2 if among is self.likely else 1
        found = [
            (command.role != "version", abs(len(having) - wanted), name, command)
            for name in self.likely
            for command in bare_queries(_table(name))
            if command.id not in self._sent
            and len(having := _having(command.id, among)) < len(among)
        ]
        if not found:
            return None
        _, _, name, command = min(found, key=lambda each: each[:2])
        return name, command

    def note(self, command: Command, replied: bool) -> None:
        """Note that a query was sent, and whether a reply came."""
        self._sent.add(command.id)
        having = _having(command.id, self.proven)
        if replied:
            self.proven = having
            self.likely = [name for name in self.likely if name in having] or having
        else:
            self.likely = [name for name in self.likely if name not in having]

    @property
    def known(self) -> str:
        """The only edition that the replies allow; empty if they allow several."""
        return self.proven[0] if len(self.proven) == 1 else ""


class JointLimit(NamedTuple):
    """A query for the limit of a joint, and that limit in each edition."""

    command: Command
    joint: int
    editions: dict[str, float]

    def edition_of(self, reported: float) -> str:
        """Return the only edition with this limit; empty if none or several have it."""
        near = [name for name, limit in self.editions.items() if abs(limit - reported) <= NEAR]
        return near[0] if len(near) == 1 else ""


def limits_apart(names: list[str]) -> Iterator[JointLimit]:
    """Return the queries for limits that differ between editions, those that differ most first."""
    found = []
    for end, query in enumerate(LIMIT_QUERIES):
        rows = {name: target_ranges(_table(name)) for name in names}
        commands = {name: _command(_table(name), query) for name in names}
        command = next((each for each in commands.values() if each is not None), None)
        if command is None or None in commands.values():
            continue
        for joint in range(min(map(len, rows.values()))):
            limits = {name: row[joint][end] for name, row in rows.items()}
            apart = sorted(limits.values())
            gap = max(high - low for low, high in pairwise(apart))
            if gap > 2 * NEAR:
                found.append((-gap, JointLimit(command, joint + 1, limits)))
    yield from (limit for _, limit in sorted(found, key=lambda each: each[0]))


def target_ranges(table: Table) -> list[tuple[float, float]]:
    """Return the lowest and the highest target of each joint."""
    command = table.find_role("joint targets")
    if command is None:
        return []
    variant = command.request[0]
    numbers = variant.fields[row_index(variant)].cases[0].numbers
    return [(n.physical(n.minimum), n.physical(n.maximum)) for n in numbers]


def _command(table: Table, name: str) -> Command | None:
    try:
        return table.command(name)
    except UsageError:
        return None


@cache
def _table(name: str) -> Table:
    return editions.load(name).TABLE


def _having(id: int, names: Iterable[str]) -> list[str]:
    return [name for name in names if id in _ids(name)]


@cache
def _ids(name: str) -> frozenset[int]:
    return frozenset(command.id for command in bare_queries(_table(name)))
