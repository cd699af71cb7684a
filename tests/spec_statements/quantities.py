"""States units and flags by the words of names and descriptions."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cobotwire_codegen.model import Edition, Field, Quantity

# The last words of a quantity's name, and its unit.
UNITS = (
    (r"(\w+_)?(angle|rotation|radian|limit)", "degree"),
    (r"(\w+_)?(length|reach|height|reach_step|height_step|distance)", "millimetre"),
    (r"(gripper_)?speed|(\w+_)?opening", "percent"),
    (r"(measured_)?encoder", "tick"),
    (r"(target_)?servo_speed", "step_per_second"),
    (r"voltage", "volt"),
    (r"temperature", "degree_celsius"),
    (r"(reported_)?current", "milliampere"),
    (r"frequency", "hertz"),
)
# The names of fields, and the units that their types then have; other fields have no unit.
FIELDS = (
    (r"angles?|radians", {"degree"}),
    (r"coords?|target", {"millimetre", "degree"}),
    (r"distance", {"millimetre"}),
    (r"speed", {"percent"}),
    (r"encoders?", {"tick"}),
    (r"speeds", {"step_per_second"}),
    (r"point", {"tick", "step_per_second"}),
    (r"voltages", {"volt"}),
    (r"temperatures", {"degree_celsius"}),
    (r"current", {"milliampere"}),
    (r"frequency", {"hertz"}),
)


PARTS = (
    (r"[xyz]", "millimetre"),
    (r"r[xyz]", "degree"),
    (r"j\d_encoder", "tick"),
    (r"j\d_speed", "step_per_second"),
)


def _quantities(field: Field) -> Iterator[Quantity]:
    for type in (field.type, *(case for _, case in field.cases)):
        for _, part in type.parts:
            if isinstance(part, Quantity):
                yield part


def units(edition: Edition) -> Iterator[str]:
    """Report quantities with another unit than their name tells."""
    for type in edition.types:
        if isinstance(type, Quantity):
            found = [unit for name, unit in UNITS if re.fullmatch(name, type.name)] or [""]
            if found != [type.unit]:
                yield f"{type.name} has the unit {type.unit!r}, but its name says {found}"


def field_units(edition: Edition) -> Iterator[str]:
    """Report fields with other units than their name tells."""
    for command in edition.commands:
        for field in command.fields:
            wanted: set[str] = set()
            for name, units in FIELDS:
                if re.fullmatch(name, field.name):
                    wanted = units
            if field.name == "increment":
                wanted = {"millimetre", "degree"} if field.selector else {"degree"}
            elif field.name == "value" and "gripper" in command.name:
                wanted = {"percent"}
            given = {part.unit for part in _quantities(field)}
            if given and given != (wanted or {""}):
                yield f"{command.name}: {field.name} has {given}; wanted {wanted}"


def part_units(edition: Edition) -> Iterator[str]:
    """Report parts of value types with another unit than their name tells."""
    for type in edition.types:
        for label, part in type.parts:
            for name, unit in PARTS:
                if re.fullmatch(name, label) and part.unit != unit:
                    yield f"{type.name}: {label} has the unit {part.unit!r}; wanted {unit}"


def case_units(edition: Edition) -> Iterator[str]:
    """Report fields that an axis selects, with another unit than the axis has."""
    for command in edition.commands:
        for field in command.fields:
            for member, type in field.cases:
                wanted = [unit for name, unit in PARTS if re.fullmatch(name, member.name.lower())]
                if wanted and isinstance(type, Quantity) and type.unit not in wanted:
                    yield f"{command.name}: {field.name} for {member.name} has {type.unit!r}"


def radians(edition: Edition) -> Iterator[str]:
    """Report fields that are shown in radians without such a name, or the reverse."""
    for command in edition.commands:
        for field in command.fields:
            for part in _quantities(field):
                if part.unit == "degree" and part.radians != ("radian" in command.name):
                    yield f"{command.name}: {field.name} and its type {part.name} differ in radians"


def flags(edition: Edition) -> Iterator[str]:
    """Report fields that are described as true or false, and have a type that is no flag."""
    for command in edition.commands:
        for field in command.fields:
            if re.match(r"True\b", field.doc) and field.type.kind != "flag":
                yield f"{command.name}: {field.name} is a {field.type.kind}, but is true or false"


RULES = (units, field_units, part_units, case_units, radians, flags)
