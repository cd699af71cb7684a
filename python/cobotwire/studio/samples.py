"""What curves and the arm show: joints, coordinates, targets, reply times and noise over time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from cobotwire.codec.interface import DecodedMessage
from cobotwire.protocol.effects import Does, Moves, each_case, effect_of
from cobotwire.protocol.roles import picked, row_index
from cobotwire.protocol.table import Command, Field, Table, Variant
from cobotwire.simulator.start import coordinates
from cobotwire.studio.entries import Entry

# If a reply takes longer, its reply time is not shown.
LONGEST_REPLY_SECONDS = 5.0
# An arm within this distance of its target has reached it.
REACHED_DEGREES, REACHED_MILLIMETRES = 0.5, 1.0

Sample = dict[str, Any]


class Sampler:
    """Takes the messages of a line in their order; returns samples for the pages.

    A sample has the time ``t`` in seconds, and some of: ``j`` joint angles, ``c`` coordinates of
    the end, ``r`` the reply time in milliseconds, ``z`` bytes of noise; the targets: ``tj`` of the
    joints, ``te`` where the end goes, in millimetres. A target that is None has ended: the arm has
    reached it, was stopped, or got another kind of target.
    """

    def __init__(self, table: Table) -> None:
        self._places = coordinates(table)
        self._joints: list[float] = []
        self._target: list[float] = []
        self._end: list[float] = []
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
            reached = _near(row, self._target, REACHED_DEGREES)
            return {"j": _rounded(row), **(self._no_target() if reached else {})}
        if command.role == "coordinates" and _finite(row):
            reached = _near(self._end_of(row), self._end, REACHED_MILLIMETRES)
            return {"c": _rounded(row), **(self._no_target() if reached else {})}
        return {}

    def _requested(self, command: Command, message: DecodedMessage) -> Sample:
        row = _row(message.variant, message.values)
        if command.role == "joint targets" and _finite(row):
            self._target, self._end = row, []
        elif command.role == "joint target" and self._joints:
            where = picked(message.variant)
            joint, target = message.values[where.picker], message.values[where.target]
            if not isinstance(joint, int) or not 1 <= joint <= len(self._joints):
                return {}
            self._target, self._end = self._target or [*self._joints], []
            self._target[joint - 1] = float(target)
        elif command.role == "coordinate targets" and _finite(row):
            self._target, self._end = [], self._end_of(row)
        elif self._target or self._end:
            return self._no_target() if ends_target(command) else {}
        else:
            return {}
        return {"tj": _rounded(self._target) or None, "te": _rounded(self._end) or None}

    def _end_of(self, row: Sequence[float]) -> list[float]:
        position = dict(zip(self._places, row))
        return [position.get(axis, 0.0) for axis in range(3)]

    def _no_target(self) -> Sample:
        self._target, self._end = [], []
        return {"tj": None, "te": None}


def ends_target(command: Command) -> bool:
    """Return whether a command stops the arm, or may move it to an unknown target."""
    return any(
        effect.what in ("stop", "halt", "forget")
        if isinstance(effect, Does)
        else isinstance(effect, Moves) and effect.part != "gripper"
        for effect in each_case(effect_of(command))
    )


def _near(row: Sequence[float], target: Sequence[float], distance: float) -> bool:
    return bool(target) and all(abs(at - to) < distance for at, to in zip(row, target))


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
