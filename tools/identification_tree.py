"""Write the decisions of ``cobotwire identify`` as trees, which the page live/ follows.

A node has a query, the edition with which it is sent, and what follows each outcome. A leaf has the
editions that remain. The Python code is run for every outcome, so the rules exist only there.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import pairwise, product
from typing import Any

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.inspect.evidence import LIMIT_QUERIES, NEAR, NO_REPLY, Evidence, target_ranges
from cobotwire.inspect.identification import identify_by, rates_of
from cobotwire.protocol.frame_format import FrameFormat
from cobotwire.protocol.table import Command
from cobotwire.session.alignment import fill_bytes
from cobotwire.session.request import RequestEncoder

# How often the page sends a query, and how many differing commands it names, at most.
ATTEMPTS, MOST_NAMED = 3, 8


class _Open(Exception):
    """Raised when a query has no outcome yet; the argument is the node of that query."""


def trees() -> list[dict[str, Any]]:
    """Return the baud rates in the order in which they are tried, each with its tree."""
    rates = rates_of("")
    return [{"baudrate": rate, "near": NEAR, "tree": _tree(names, ())} for rate, names in rates]


def _tree(among: Sequence[str], outcomes: tuple[Evidence, ...]) -> dict[str, Any]:
    """Return the node, or the leaf, after some outcomes."""
    try:
        remain = _remaining(among, outcomes)
    except _Open as query:
        [node] = query.args
    else:
        return {"editions": remain, "alike": _alike(remain)}

    def after(text: str, result: Any = None) -> dict[str, Any]:
        outcome = Evidence("", "", text == "replied", result, text)
        return _tree(among, (*outcomes, outcome))

    silent = after(NO_REPLY)
    # After the first reply, an illegal reply shows no more than silence does.
    first = all(outcome.text == NO_REPLY for outcome in outcomes)
    illegal = after("an illegal reply") if first else silent
    limits = _limits(node, silent) if node["given"] else [None]
    replied = [(limit, after("replied", limit)) for limit in limits]
    telling = [(limit, found) for limit, found in replied if found != silent]
    if not telling and illegal == silent:
        return silent
    node |= {} if illegal == silent else {"illegal": illegal}
    return {**node, "replied": telling, "silent": silent}


def _remaining(among: Sequence[str], outcomes: Sequence[Evidence]) -> tuple[str, ...]:
    """Return the editions that remain after some outcomes.

    Raises:
        _Open: another query follows.
    """
    left, sent, fill = iter(outcomes), list[list[bytes]](), b""

    def separate(format: FrameFormat) -> None:
        nonlocal fill
        fill = fill_bytes(format, [b"".join(chosen) for chosen in product(*sent)])
        sent.append([fill])

    def ask(name: str, command: Command, *arguments: int) -> Evidence:
        nonlocal fill
        given = dict(zip((field.name for field in command.request[0].fields), arguments))
        outcome = next(left, None)
        if outcome is None:
            node = {"edition": name, "query": command.name, "given": given, "fill": fill.hex()}
            raise _Open(node)
        encoder = RequestEncoder(codecs.load(editions.load(name).TABLE), None)
        frame = encoder.encode_request(command.request_type.from_fields(given)).frame
        sent.append([frame * times for times in range(1, ATTEMPTS + 1)])
        fill = b""
        return outcome._replace(query=command.name)

    return identify_by(ask, separate, among).candidates


def _limits(node: dict[str, Any], silent: dict[str, Any]) -> list[float]:
    """Return the limits that the remaining editions state; after silence, ``silent`` follows."""
    while "editions" not in silent:
        silent = silent["silent"]
    end, joint = LIMIT_QUERIES.index(node["query"]), node["given"]["joint"]
    rows = [target_ranges(editions.load(name).TABLE) for name in silent["editions"]]
    found = sorted({row[joint - 1][end] for row in rows})
    assert all(high - low > 2 * NEAR for low, high in pairwise(found)), "two limits are too close"
    return found


@cache
def _alike(names: tuple[str, ...]) -> str:
    """Return in words what is the same in several editions."""
    if len(names) < 2:
        return ""
    tables = [{c.name: c for c in editions.load(name).TABLE.commands} for name in names]
    every = dict.fromkeys(name for table in tables for name in table)

    def messages(command: Command | None) -> object:
        return command and (command.id, command.request, command.reply, command.text)

    differ = [name for name in every if len({messages(t.get(name)) for t in tables}) > 1]
    same = f"{len(every) - len(differ)} of their {len(every)} commands are the same"
    more = len(differ) - MOST_NAMED
    also = f" and {more} more" if more > 0 else ""
    return f"{same}; these differ: {', '.join(differ[:MOST_NAMED])}{also}" if differ else same
