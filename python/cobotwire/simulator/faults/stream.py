"""Damage a stream of bytes without requests and replies, to test and measure framing.

The faults that damage replies also damage places in the stream. The damage is returned as edits, so
that the caller knows which frames they leave undamaged.
"""

from __future__ import annotations

from collections.abc import Iterable
from random import Random
from typing import NamedTuple

from cobotwire.protocol.table import Table
from cobotwire.simulator.faults.exchange import Request
from cobotwire.simulator.faults.fault import Context, Damage
from cobotwire.simulator.faults.faulty_connection import FaultyConnection


class Edit(NamedTuple):
    """``removed`` bytes at ``place`` of the stream are replaced by ``data``."""

    place: int
    removed: int
    data: bytes


def edits(
    fault: Damage, data: bytes, places: Iterable[int], table: Table, random: Random
) -> list[Edit]:
    """Return what a fault does to single bytes of a stream.

    Args:
        fault: how each byte is damaged: it is dropped, corrupted, or something is added before it.
        data: the undamaged stream.
        places: the offsets of the bytes to damage.
        table: the edition of the frames in the stream.
        random: the source of the fault's random numbers.
    """
    context = _context(data, table, random)
    return [_edit(place, data[place : place + 1], fault, context) for place in places]


def damaged(fault: Damage, data: bytes, table: Table, random: Random) -> bytes:
    """Return what a fault leaves of a piece of a stream, such as a frame."""
    return fault.spoil(data, _context(data, table, random))


def _context(data: bytes, table: Table, random: Random) -> Context:
    connection = FaultyConnection(lambda: 0.0, lambda: None)
    return Context(Request(0.0, data, None, None), random, connection, table)


def _edit(place: int, byte: bytes, fault: Damage, context: Context) -> Edit:
    instead = fault.spoil(byte, context)
    if instead.endswith(byte):
        return Edit(place, 0, instead[: len(instead) - 1])
    return Edit(place, 1, instead)


def edited(data: bytes, edits: Iterable[Edit]) -> bytes:
    """Return a stream after edits; they must be sorted, and must not overlap."""
    pieces, at = [], 0
    for edit in edits:
        pieces += [data[at : edit.place], edit.data]
        at = edit.place + edit.removed
    return b"".join([*pieces, data[at:]])
