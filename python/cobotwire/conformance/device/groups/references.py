"""A reference of the tool or the world shifts the coordinates, which proves scales and axes.

Nothing moves: only what the arm reports changes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.device.read_back import Setting, restorable_value, settings_of
from cobotwire.conformance.device.requests import request_of
from cobotwire.conformance.device.selection import first, stored
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Table

SHIFTS = TestCase(
    "reference-shifts",
    "A reference shifts the coordinates by its length, along its axis.",
)

Vector = tuple[float, float, float]
# How far the reference is set from zero, and by how much the shift may be wrong, in millimetres.
SHIFT, NEAR = 40.0, 2.0
AXES = "xyz"
# For each reference: the state whose second choice makes the coordinates include it.
CHOSEN_BY = {"tool": "end_type", "world": "reference_frame"}


class _Reference(NamedTuple):
    """The setting of a reference, and the setting that chooses whether the arm uses it."""

    own: Setting
    chooser: Setting


def _reference(table: Table, command: Command) -> _Reference | None:
    """Return the settings of the reference that a command stores."""
    [chosen] = [CHOSEN_BY[state] for state in stored(command) if state in CHOSEN_BY] or [""]
    chooser = first(table, lambda _, other: stored(other) == (chosen,))
    settings = [settings_of(table, each)[:1] for each in (command, chooser) if each is not None]
    found = [setting for one in settings for setting in one if setting.command.safety == "setting"]
    known = table.find_role("coordinates") is not None
    return _Reference(*found) if len(found) == 2 and known else None


def _shifts(probe: Probe, reference: _Reference) -> None:
    """Set the reference along each axis, and compare the coordinates with and without it."""
    device, chooser = probe.device, reference.chooser
    for setting in reference:
        old = restorable_value(device, setting, setting.queries[0]).old
        device.restore_after_body[setting.command.name] = partial(device.request, old)
    choices = chooser.variant.fields[0].choices
    shifts = [_shift(probe, chooser.command, choices, axis) for axis in range(3)]
    device.request(request_of(chooser.command, choices[0]))
    if all(math.hypot(*shift) <= NEAR for shift in shifts):
        raise NotSupported("no setting makes the coordinates show the reference")
    _check(probe, shifts, "tool" in stored(probe.command))


def _shift(probe: Probe, chooser: Command, choices: Sequence[int], axis: int) -> Vector:
    """Return by how much the coordinates change when a reference along an axis is used."""
    device, row = probe.device, probe.command.request[0].fields[0].cases[0].numbers
    reference = tuple(SHIFT if at == axis else 0.0 for at in range(len(row)))
    device.request(request_of(probe.command, reference))
    source, positions = device.table.in_role("coordinates"), []
    for choice in choices[:2]:
        device.request(request_of(chooser, choice))
        positions.append(device.require(source.request_type()).result[:3])
    x, y, z = (used - without for without, used in zip(*positions))
    return x, y, z


def _check(probe: Probe, shifts: list[Vector], tool: bool) -> None:
    """Compare lengths and directions; the directions of a tool turn with the end."""
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
    *for_found(_reference, _shifts),
    sends="A reference of 40 mm along each axis; the coordinates are read with and without it.",
    subject="each setting that takes coordinates, if another one makes the arm use it",
)
