"""What curves and the arm show: joints, coordinates, targets, reply times and noise over time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from cobotwire.codec.interface import DecodedMessage
from cobotwire.protocol.roles import picked, row_index
from cobotwire.protocol.table import Command, Field, Table, Variant
from cobotwire.simulator.kinematics import Geometry, geometry_of
from cobotwire.simulator.kinematics.forward import frames
from cobotwire.simulator.start import coordinates
from cobotwire.studio.entries import Entry

# Replies that are later than this belong to no request that a person would look for.
LONGEST_REPLY_SECONDS = 5.0

Sample = dict[str, Any]


class Sampler:
    """Takes the messages of a line in their order; returns samples for the pages.

    A sample has the time ``t`` in seconds, and some of: ``j`` joint angles, ``p`` the points where
    the links meet in millimetres, ``c`` coordinates of the end, ``r`` the reply time in
    milliseconds, ``z`` bytes of noise; the targets: ``tj`` and ``tp`` of the joints, ``te`` where
    the end goes.
    """

    def __init__(self, table: Table) -> None:
        self._geometry = geometry_of(table)
        self._places = coordinates(table)
        self._joints: list[float] = []
        self._target: list[float] = []
        # When the last request of each command was sent.
        self._sent: dict[str, float] = {}

    def take(self, entry: Entry, message: DecodedMessage | None) -> list[Sample]:
        """Return the samples of one entry; ``message`` is None if it is not a frame."""
        if entry.finding is not None:
            return [{"t": entry.time, "z": len(entry.data)}]
        if message is None:
            return []
        command = message.command
        if message.direction == "request":
            self._sent[command.name] = entry.time
            found = self._requested(command, message)
        else:
            found = self._replied(command, message)
            since = entry.time - self._sent.pop(command.name, math.inf)
            if 0 <= since < LONGEST_REPLY_SECONDS:
                found["r"] = round(since * 1000, 3)
        return [{"t": round(entry.time, 6), **found}] if found else []

    def _replied(self, command: Command, message: DecodedMessage) -> Sample:
        row = _row(message.variant, message.values)
        if command.role == "joints" and _finite(row):
            self._joints = row
            return {"j": _rounded(row), **_named("p", points(self._geometry, row))}
        if command.role == "coordinates" and _finite(row):
            return {"c": _rounded(row)}
        return {}

    def _requested(self, command: Command, message: DecodedMessage) -> Sample:
        row = _row(message.variant, message.values)
        if command.role == "joint targets" and _finite(row):
            self._target = row
        elif command.role == "joint target" and self._joints:
            where = picked(message.variant)
            joint, target = message.values[where.picker], message.values[where.target]
            if not isinstance(joint, int) or not 1 <= joint <= len(self._joints):
                return {}
            self._target = self._target or [*self._joints]
            self._target[joint - 1] = float(target)
        elif command.role == "coordinate targets" and _finite(row):
            position = dict(zip(self._places, row))
            end = [position.get(axis, 0.0) for axis in range(3)]
            return {"te": _rounded(end), "tj": None, "tp": None}
        else:
            return {}
        target = points(self._geometry, self._target)
        return {"tj": _rounded(self._target), "te": None, **_named("tp", target)}


def points(geometry: Geometry | None, angles: Sequence[float]) -> list[list[float]] | None:
    """Return where the links meet, the base first, in millimetres; None without a geometry.

    A link that goes along one axis and then along another has a point where it turns.
    """
    if geometry is None or len(angles) < geometry.joints:
        return None
    found, before, axis = [[0.0, 0.0, 0.0]], (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    for link, frame in zip(geometry.links, frames(geometry, angles)):
        # The link goes along the joint's axis first, then across it.
        corner = tuple(at + link.d * part for at, part in zip(before, axis))
        if link.d and link.a:
            found.append(_rounded(corner))
        before, axis = frame.origin, frame.z
        found.append(_rounded(before))
    return found


def _row(variant: Variant, values: Sequence[Any]) -> list[float]:
    """Return the row of numbers of a message; empty if it has none."""
    index = row_index(variant)
    if index < 0 or variant.fields[index].kind in ("bytes", "text"):
        return []
    field: Field = variant.fields[index]
    numbers = variant.case(field, values).numbers
    return [float(value) for value in field.flatten(values[index], len(numbers))]


def _finite(row: Sequence[float]) -> bool:
    return bool(row) and all(map(math.isfinite, row))


def _rounded(row: Sequence[float]) -> list[float]:
    return [round(value, 3) for value in row]


def _named(name: str, value: Any) -> Sample:
    return {} if value is None else {name: value}
