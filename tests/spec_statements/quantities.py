"""Derive units and flags of fields from their names and descriptions."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cobotwire_codegen.model import Edition, Field, Quantity

# The units that a field with such a name may have; other fields have no unit.
FIELDS = (
    (r"angles?|radians|(current|target)_angle", {"degree"}),
    (r"coords?|target|through|end", {"millimetre", "degree"}),
    (r"distance|radius", {"millimetre"}),
    (r"speed|duty|thresholds?|compensations?|positions|linear|angular", {"percent"}),
    (r"encoders?", {"tick"}),
    (r"speeds", {"step_per_second"}),
    (r"point", {"tick", "step_per_second"}),
    (r"voltages", {"volt"}),
    (r"temperatures", {"degree_celsius"}),
    (r"currents?", {"milliampere"}),
    (r"frequency", {"hertz"}),
    (r"baud", {"baud"}),
    (r"timeout", {"millisecond"}),
)
# Fields with other units than their names suggest: the edition or a base of it, command and field.
OTHERWISE = (
    # The class has a method of its own for coordinates.
    (r"(mercury_a1|myarm300) is_in_position target", {"degree"}),
    (r"mercury_a1 get_pos_over positions", {""}),
    (r"mycobot280 set_pwm_output duty", {""}),
    (r"mercury_a1 get_max_speed speed", {""}),
    (r"mercury_a1 set_max_speed speed", {"degree_per_second", "millimetre_per_second"}),
    (r"mercury_a1 set_max_acc acceleration", {"", "millimetre_per_second_squared"}),
    (r"mercury_a1 get_servo_speeds speeds", {"revolution_per_minute"}),
    (r"mercury_a1 set_hand_gripper_angles angles", {""}),
    (r"mercury_a1 jog_increment_angle increment", {"degree"}),
    (r"mybuddy (collision left|collision right)", {"degree"}),
    (r"mybuddy (is_robot_in_position|get_base_coords) \w+", {"millimetre", "degree"}),
    (r"mybuddy (get_coord coord|[sg]et_joint_current current|jog_increment increment)", {""}),
    (r"mybuddy set_pwm_output frequency", {""}),
    (r"mybuddy set_plan_acceleration acceleration", {"percent"}),
    (r"mycobot320 set_pro_gripper value", {"", "percent"}),
    (r"mycobot320 \wet_pro_gripper_(\w*angle|speed|open|close) value", {"percent"}),
    (r"mycobot320 \wet_hand_gripper_(default_speed|speed|angle) value", {"percent"}),
    (r"\S+ \wet_(pro|hand)_gripper\w* value", {""}),
    (r"pro450 get_motor_temps temperatures", {""}),
    (r"pro450 get_torque_comp compensations", {"", "percent"}),
)


# Types with these prefixes are not checked: the numbers of their parts need not start at 1.
OTHER_NUMBERS = ("further_", "right_")
PARTS = (
    (r"[xyz]", "millimetre"),
    (r"r[xyz]", "degree"),
    (r"j\d_encoder", "tick"),
    (r"j\d_speed", "step_per_second"),
)


def quantities_of(field: Field) -> Iterator[Quantity]:
    """Yield the quantities that a field may hold."""
    for type in (field.type, *(case for _, case in field.cases)):
        for _, part in type.parts:
            if isinstance(part, Quantity):
                yield part


def names(edition: Edition) -> tuple[str, ...]:
    """Return the name of an edition, then those of its bases."""
    return (edition.name, *edition.bases)


def field_units(edition: Edition) -> Iterator[str]:
    """Report fields whose unit differs from what their name says."""
    for command in edition.commands:
        for field in command.fields:
            full = f"{command.name} {field.name}"
            wanted: set[str] = set()
            for name, units in FIELDS:
                if re.fullmatch(name, field.name):
                    wanted = units
            if field.name == "increment":
                wanted = {"millimetre", "degree"} if field.selector else {"degree"}
            elif field.name == "value" and "gripper" in command.name:
                wanted = {"percent"}
            for pattern, units in reversed(OTHERWISE):
                if any(re.fullmatch(pattern, f"{of} {full}") for of in names(edition)):
                    wanted = units
            given = {part.unit for part in quantities_of(field)}
            if given and given != (wanted or {""}):
                yield f"{command.name}: {field.name} has {given}; wanted {wanted}"


def case_units(edition: Edition) -> Iterator[str]:
    """Report fields that an axis selects, if their unit differs from that of the axis."""
    for command in edition.commands:
        for field in command.fields:
            for member, type in field.cases:
                wanted = [unit for name, unit in PARTS if re.fullmatch(name, member.name.lower())]
                if wanted and isinstance(type, Quantity) and type.unit not in wanted:
                    yield f"{command.name}: {field.name} for {member.name} has {type.unit!r}"


def cases(edition: Edition) -> Iterator[str]:
    """Report cases of a joint or rotation with another type than the neighbouring cases."""
    for command in edition.commands:
        for field in command.fields:
            rows: dict[str, set[str]] = {}
            # Each servo may have its own range, and each register its own type.
            for member, type in field.cases if field.selector in ("joint", "axis") else ():
                row = re.sub(r"^\d+|(?<=^R)[XYZ]$", "#", member.name)
                name = re.sub(rf"^j{member.name}(?=_)|^(arm|flange)(?=_)", "#", type.name)
                rows.setdefault(row, set()).add(name)
            for row, names_of_types in rows.items():
                if "#" in row and len(names_of_types) > 1:
                    yield f"{command.name}: {field.name} has the types {sorted(names_of_types)}"


def flags(edition: Edition) -> Iterator[str]:
    """Report fields that are described as true or false but are not flags."""
    for command in edition.commands:
        for field in command.fields:
            if re.match(r"True\b", field.doc) and field.type.kind != "flag":
                yield f"{command.name}: {field.name} is a {field.type.kind}, but is true or false"


def uniform(edition: Edition) -> Iterator[str]:
    """Report a numbered part with another type than its neighbours, or a gap in the numbers.

    Joints, servos and fingers count from 1. Only a type with a number or letter in its name is for
    a single joint or axis.
    """
    for type in edition.types:
        rows: dict[str, list[tuple[str, str]]] = {}
        for label, part in type.parts if len(type.parts) > 1 else ():
            row = re.sub(r"\d+", "#", label)
            kind = re.sub(r"^[js]\d(?=_)|^(arm|flange)(?=_)|\d+$", "#", part.name)
            rows.setdefault(row, []).append((label, kind))
        if type.name.startswith(OTHER_NUMBERS):
            continue
        for row, parts in rows.items():
            if "#" in row and len({kind for _, kind in parts}) > 1:
                yield f"{type.name}: {parts} differ"
            numbers = [int(n) for label, _ in parts for n in re.findall(r"\d+", label)[:1]]
            if numbers != [*range(1, len(numbers) + 1)]:
                yield f"{type.name} has the numbers {numbers}"


RULES = (uniform, field_units, case_units, cases, flags)
