"""A reference of the tool or the world shifts the coordinates, which proves scales and axes.

Nothing moves: only what the arm reports changes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import settings_of
from cobotwire.conformance.device.requests import request_of, units
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.messages import Reply
from cobotwire.protocol.table import Command, Table

SHIFTS = TestCase(
    "reference-shifts",
    "A reference shifts the coordinates by its own length, and each axis in its own direction.",
)

Vector = tuple[float, float, float]
# How far the reference is set from zero, and by how much the shift may be wrong, in millimetres.
SHIFT, NEAR = 40.0, 2.0
TOOL, WORLD = ("FLANGE", "TOOL"), ("BASE", "WORLD")
AXES = "xyz"


def _is_reference(table: Table, command: Command) -> bool:
    """Return whether a setting takes coordinates, and another setting makes the arm use it."""
    source, fields = table.find_role("coordinates"), command.request[0].fields
    if source is None or command.safety != "setting" or len(fields) != 1:
        return False
    like = units(source.reply[0].fields[0].cases[0].numbers)
    row = units(fields[0].cases[0].numbers)
    return row == like and bool(settings_of(table, command)) and any(_choosers(table))


def _choosers(table: Table) -> Iterator[Command]:
    """Yield the settings that choose between flange and tool, or base and world."""
    for command in table.commands:
        fields = command.request[0].fields if command.request else ()
        chooses = len(fields) == 1 and fields[0].labels in (TOOL, WORLD)
        if command.safety == "setting" and chooses and settings_of(table, command):
            yield command


def _shifts(probe: Probe) -> None:
    """Set the reference along each axis, and compare the coordinates with and without it."""
    table = probe.device.table
    _keep(probe, probe.command)
    choosers = list(_choosers(table))
    for chooser in choosers:
        _keep(probe, chooser)
        probe.device.request(request_of(chooser, chooser.request[0].fields[0].choices[0]))
    for chooser in choosers:
        field = chooser.request[0].fields[0]
        shifts = [_shift(probe, chooser, axis) for axis in range(3)]
        probe.device.request(request_of(chooser, field.choices[0]))
        if any(math.hypot(*shift) > NEAR for shift in shifts):
            _judge(probe, shifts, field.labels == TOOL)
            return
    raise NotSupported("no setting makes the coordinates show the reference")


def _keep(probe: Probe, command: Command) -> None:
    """Plan to restore what a command sets.

    Raises:
        NotSupported: it cannot be read.
    """
    setting = settings_of(probe.device.table, command)[0]
    query = setting.queries[0]
    old = setting.again(query, probe.device.require(query))
    probe.device.restore_after_body[command.name] = partial(probe.device.request, old)


def _shift(probe: Probe, chooser: Command, axis: int) -> Vector:
    """Return by how much the coordinates change when a reference along an axis is used."""
    rows = len(probe.command.request[0].fields[0].cases[0].numbers)
    reference = tuple(SHIFT if at == axis else 0.0 for at in range(rows))
    probe.device.request(request_of(probe.command, reference))
    without, used = (_position(probe, chooser, choice) for choice in (0, 1))
    x, y, z = (a - b for a, b in zip(used, without))
    return x, y, z


def _position(probe: Probe, chooser: Command, choice: int) -> tuple[float, ...]:
    field = chooser.request[0].fields[0]
    probe.device.request(request_of(chooser, field.choices[choice]))
    source = probe.device.table.in_role("coordinates")
    reply: Reply[Any] = probe.device.require(source.request_type())
    return tuple(reply.result)[:3]


def _judge(probe: Probe, shifts: list[Vector], tool: bool) -> None:
    """Compare lengths and directions: those of a tool are turned with the end."""
    name = probe.command.name
    for axis, shift in zip(AXES, shifts):
        length = math.hypot(*shift)
        reason = f"{name}: {SHIFT:g} mm along {axis} shift the coordinates by {length:.1f} mm"
        probe.expect(SHIFTS, abs(length - SHIFT) <= NEAR, f"{reason}: {_short(shift)}")
        along = tool or abs(abs(shift[AXES.index(axis)]) - SHIFT) <= NEAR
        probe.expect(SHIFTS, along, f"{reason}, but not along {axis}: {_short(shift)}")
    if tool:
        x, y, z = shifts
        volume = sum(a * b for a, b in zip(_cross(x, y), z)) / SHIFT**3
        text = ", ".join(f"{axis} by ({_short(shift)})" for axis, shift in zip(AXES, shifts))
        probe.expect(
            SHIFTS,
            volume > 0.9,
            f"{name}: the axes shift the coordinates in directions that form no right-handed "
            f"frame: {text}",
        )


def _cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _short(vector: Vector) -> str:
    return ", ".join(f"{part:.1f}" for part in vector)


REFERENCES = Group(
    "references",
    (SHIFTS,),
    _shifts,
    _is_reference,
    sends="A reference of 40 mm along each axis; the coordinates are read with and without it.",
    subject="each setting that takes coordinates, if another one makes the arm use it",
)
