"""Compares requests, and which values they accept, with the maker's classes.

A call counts as a second source where the class and the unchanged edition agree: they send the same
bytes, or both reject the call. The other calls differ for reasons that ``tests/peers`` lists.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import redirect_stdout
from functools import lru_cache
from typing import Any

import vectors
from cobotwire.codec.interface import Codec
from cobotwire.protocol.addresses import find_address
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.radians import to_degrees
from cobotwire_codegen.model import Edition
from robots.arguments import Named
from robots.classes import ROBOTS
from robots.comparison import calls_of, sent_by_peer
from robots.robot import Call
from targets.expected import codec_of_edition

Expected = tuple[Call, bytes | None]


def requests(edition: Edition) -> Iterator[str]:
    """Report calls for which an edition sends other bytes than the maker's class, or rejects."""
    alike, _ = compared(edition.name)
    # A command that is as in the unchanged edition sends the same bytes.
    known = vectors.edition(edition.name) if alike else edition
    same = {c.name for c in edition.commands if known.by_name.get(c.name) == c}
    if known.frame != edition.frame:
        same = set()
    if calls := [each for each in alike if each[0].command not in same]:
        codec = codec_of_edition(edition)
        for call, wanted in calls:
            if _sent(codec, call) != wanted:
                yield f"{call.command}: {call.ours} differs from the maker's {call.method}"


@lru_cache(maxsize=32)
def compared(name: str) -> tuple[tuple[Expected, ...], int]:
    """Return the calls in which the class and the unchanged edition agree, and how many differ."""
    robot = next((each for each in ROBOTS.values() if each.edition == name), None)
    if robot is None:
        return (), 0
    codec = codec_of_edition(vectors.edition(name))
    names = {command.name for command in robot.table.commands}
    calls = [call for call in calls_of(robot) if call.command in names and not call.why]
    found, differ = [], 0
    for call in {_key(each): each for each in (*calls, *_beyond(calls))}.values():
        with open(os.devnull, "w") as nowhere, redirect_stdout(nowhere):  # some classes print
            theirs = sent_by_peer(robot, call)
        wanted = theirs if isinstance(theirs, bytes) else None
        if _sent(codec, call) == wanted:
            found.append((call, wanted))
        else:
            differ += 1
    return tuple(found), differ


def _key(call: Call) -> str:
    return repr((call.method, call.theirs, call.command, call.address))


def _beyond(calls: list[Call]) -> Iterator[Call]:
    """Yield calls with one number replaced by a neighbour, which may lie beyond a limit."""
    for call in calls:
        before = len(call.theirs) - len(call.ours)
        if isinstance(call.ours, Named) and before >= 0:
            for at, value in enumerate(call.ours):
                for other in _neighbours(value):
                    ours = Named((*call.ours[:at], other, *call.ours[at + 1 :]))
                    ours.names = call.ours.names
                    theirs = (*call.theirs[:before], *ours)
                    yield call._replace(theirs=theirs, ours=ours)


def _neighbours(value: Any) -> Iterator[Any]:
    if isinstance(value, list):
        for at, each in enumerate(value):
            for other in _neighbours(each):
                yield [*value[:at], other, *value[at + 1 :]]
    elif isinstance(value, int | float):
        yield from (value - 1, value + 1)


def _sent(codec: Codec, call: Call) -> bytes | None:
    """Return the frame of a call; None if the edition rejects it."""
    named = {}
    if isinstance(call.ours, Named):
        named = dict(zip(call.ours.names, call.ours, strict=True))
    if "radians" in named:
        named["radians"] = to_degrees(named["radians"])
    try:
        command = codec.table.command(call.command)
        request = command.request_type(*(() if named else call.ours), **named)
        known = None if call.address is None else find_address(codec.table, call.address)
        address = None if known is None else known.value
        return codec.encode(command.name, "request", request.values, address=address)
    except (UsageError, TypeError, ValueError):
        return None


RULES = (requests,)
