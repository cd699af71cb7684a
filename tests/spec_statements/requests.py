"""Compares requests, and which values they accept, with the maker's classes.

A call counts as a second source where the class and the unchanged edition agree: they send the same
bytes, or both reject the call. The other calls are only counted, in docs/robots.md.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import redirect_stdout
from dataclasses import replace
from functools import lru_cache
from typing import Any

import vectors
from cobotwire.codec.interface import Codec
from cobotwire.protocol.addresses import find_address
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.radians import to_degrees
from cobotwire.session.request import RequestEncoder
from cobotwire_codegen.model import Edition
from pymycobot_classes import library
from robots.arguments import Named
from robots.classes import ROBOTS
from robots.comparison import calls_of, sent_by_peer
from robots.robot import Call, Robot
from targets.expected import codec_of_edition

Expected = tuple[Call, bytes | None]
OLDEST = ROBOTS["MyCobot"]


def requests(edition: Edition) -> Iterator[str]:
    """Report calls that an edition encodes differently from the maker's class, or rejects."""
    alike, _ = compared(edition.name)
    # A command that equals that of the unchanged edition sends the same bytes.
    known = vectors.edition(edition.name) if alike else edition
    same = {c.name for c in edition.commands if known.by_name.get(c.name) == c}
    if known.frame != edition.frame:
        same = set()
    if calls := [each for each in alike if each[0].command not in same]:
        codec = codec_of_edition(edition)
        for call, wanted in calls:
            if _sent(codec, call) != wanted:
                yield f"{call.command}: {call.ours} differs from the maker's {call.method}"


def unequal(name: str) -> set[str]:
    """Return the commands of an edition for which no call sends the bytes of the maker's class."""
    equal = {call.command for call, frame in compared(name)[0] if frame is not None}
    return {call.command for robot in _robots(name) for call in _calls(robot)} - equal


@lru_cache(maxsize=32)
def compared(name: str) -> tuple[tuple[Expected, ...], int]:
    """Return the calls in which the class and the unchanged edition agree, and how many differ."""
    codec = codec_of_edition(vectors.edition(name))
    found, differ = [], 0
    for robot in _robots(name):
        for call in _calls(robot):
            with open(os.devnull, "w") as nowhere, redirect_stdout(nowhere):  # some classes print
                theirs = sent_by_peer(robot, call)
            if _sent(codec, call) == theirs:
                found.append((call, theirs))
            else:
                differ += 1
    return tuple(found), differ


def _robots(name: str) -> Iterator[Robot]:
    """Yield the class for an edition; for the oldest edition also newer classes."""
    yield from (robot for robot in ROBOTS.values() if robot.edition == name)
    if name == OLDEST.edition:
        for newer in ("MyCobot280", "MyPalletizer260"):
            yield replace(ROBOTS[newer], edition=name, calls=())


def _calls(robot: Robot) -> list[Call]:
    """Return the different calls of the edition's commands, with values in and beyond limits."""
    names = {command.name for command in robot.table.commands}
    calls = [call for call in calls_of(robot) if call.command in names]
    if robot.edition == OLDEST.edition and robot is not OLDEST:
        calls = [call for call in calls if not hasattr(library(OLDEST.peer), call.method)]
    return list({_key(each): each for each in (*calls, *_beyond(calls))}.values())


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
    """Return the frame of a call and the text after it; None if the edition rejects the call."""
    named = {}
    if isinstance(call.ours, Named):
        named = dict(zip(call.ours.names, call.ours, strict=True))
    if "radians" in named:
        named["radians"] = to_degrees(named["radians"])
    try:
        command = codec.table.command(call.command)
        request = command.request_type(*(() if named else call.ours), **named)
        address = None if call.address is None else find_address(codec.table, call.address)
        encoded = RequestEncoder(codec, address).encode_request(request)
        return encoded.frame + encoded.text
    except (UsageError, TypeError, ValueError):
        return None


RULES = (requests,)
