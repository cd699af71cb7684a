"""Make a table with other limits for targets, narrower or wider than the edition's.

The limits of an edition are the ranges of its request fields, which the codec checks before a byte
is sent. With other limits the codec checks other ranges, so no other code has to check them.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import NamedTuple

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.roles import picked, row_index
from cobotwire.protocol.table import Case, Command, Field, Number, Role, Table, Variant

# No number on the wire is that large, and scaling it does not overflow.
BEYOND = 1e100
Range = tuple[float, float]
Ranges = Sequence[Range | None]


class Limits(NamedTuple):
    """The lowest and the highest target of each joint and coordinate.

    None keeps the edition's limit of one part, or of all parts. Only targets are limited. Commands
    that move the arm by a distance (``jog_increment``), or until it is stopped, are not limited.

    Attributes:
        joints: a range in degrees for each joint, base first.
        coords: a range for each coordinate: x, y, z in millimetres, then rx, ry, rz in degrees.
        wider: whether ranges may exceed the edition's, up to what the wire can carry.
    """

    joints: Ranges | None = None
    coords: Ranges | None = None
    wider: bool = False


def limited(table: Table, limits: Limits) -> Table:
    """Return the table of the same edition with other limits.

    Raises:
        UsageError: a range is not a pair of numbers, or is wider than the edition's (with
            ``wider``: than the wire can carry), or the edition has no such targets.
    """
    rules: dict[str, _Rule] = {}
    if limits.joints is not None:
        rule = _Rule("joints", limits.joints, table.in_role("joint targets"), limits.wider)
        rules |= {"joint targets": rule, "joint target": rule}
    if limits.coords is not None:
        rule = _Rule("coords", limits.coords, table.in_role("coordinate targets"), limits.wider)
        rules |= {"coordinate targets": rule, "coordinate target": rule}
    commands = (
        _command(command, rules[command.role]) if command.role in rules else command
        for command in table.commands
    )
    return table._replace(commands=tuple(commands))


def joint_limits(table: Table) -> list[Range]:
    """Return the limits of each joint: the ranges of targets, or else those that are stated.

    A range that holds every number of the wire is no limit. Empty: the edition states no limit.
    """
    return _ranges(table) or list(table.robot.joint_limits)


def _ranges(table: Table) -> list[Range]:
    command = table.find_role("joint targets")
    if command is None:
        return []
    variant = command.request[0]
    numbers = variant.fields[row_index(variant)].cases[0].numbers
    if any(number.raw_range == (number.minimum, number.maximum) for number in numbers):
        return []
    return [(n.physical(n.minimum), n.physical(n.maximum)) for n in numbers]


class _Rule:
    """The given ranges, and the names of the parts that they limit."""

    def __init__(self, what: str, ranges: Ranges, row: Command, wider: bool) -> None:
        self._what = what
        self._wider = wider
        numbers = row.request[0].fields[row_index(row.request[0])].cases[0].numbers
        self.names = [number.name for number in numbers]
        allowed = f"{len(self.names)} ranges"
        if isinstance(ranges, str) or not isinstance(ranges, Sequence):
            raise UsageError(f"limits.{what}", ranges, allowed)
        if len(ranges) != len(self.names):
            raise UsageError(f"len(limits.{what})", len(ranges), allowed)
        self._ranges = [self._checked(part, given) for part, given in enumerate(ranges)]

    def number(self, part: int, number: Number) -> Number:
        """Return a number of a target with the limits of its part."""
        given = self._ranges[part]
        if given is None:
            return number
        lowest, highest = _raw_range(number, given)
        inside = number.raw_range if self._wider else (number.minimum, number.maximum)
        if lowest < inside[0] or highest > inside[1] or lowest > highest:
            low, high = map(number.physical, inside)
            why = (
                "what the wire carries" if self._wider else "the edition's; wider=True allows more"
            )
            allowed = f"a range inside {low:g}..{high:g} {number.units}, {why}"
            raise UsageError(f"limits.{self._what}[{part}]", given, allowed)
        return number._replace(minimum=lowest, maximum=highest)

    def _checked(self, part: int, given: object) -> Range | None:
        if given is None:
            return None
        pair = list(given) if isinstance(given, Sequence) and not isinstance(given, str) else []
        if len(pair) == 2 and all(map(_is_number, pair)) and pair[0] <= pair[1]:
            return pair[0], pair[1]
        raise UsageError(f"limits.{self._what}[{part}]", given, "a pair (lowest, highest), or None")


def _command(command: Command, rule: _Rule) -> Command:
    narrow = _row if command.role in _ROWS else _single
    return command._replace(request=tuple(narrow(variant, rule) for variant in command.request))


_ROWS: tuple[Role, ...] = ("joint targets", "coordinate targets")


def _row(variant: Variant, rule: _Rule) -> Variant:
    """Limit a variant in which one field holds the targets of all parts."""
    at = row_index(variant)
    row = variant.fields[at]
    numbers = (rule.number(part, number) for part, number in enumerate(row.cases[0].numbers))
    return _with(variant, at, row._replace(cases=(Case((), tuple(numbers)),)))


def _single(variant: Variant, rule: _Rule) -> Variant:
    """Limit a variant in which one field picks the part and another one is its target."""
    picker_at, at = picked(variant)
    picker, target = variant.fields[picker_at], variant.fields[at]
    cases = []
    for part, name in enumerate(rule.names):
        value = _value_of(picker, name, part)
        case = target.case(value)
        assert case is not None, f"{name} has a case"
        cases.append(Case((value,), (rule.number(part, case.numbers[0]),)))
    return _with(variant, at, target._replace(cases=tuple(cases), selector=picker_at))


def _with(variant: Variant, at: int, field: Field) -> Variant:
    fields = variant.fields
    return variant._replace(fields=(*fields[:at], field, *fields[at + 1 :]))


def _value_of(picker: Field, name: str, part: int) -> int:
    """Return the raw value that picks a part: by its label, or else counted from 1."""
    labels = [label.lower() for label in picker.labels]
    return picker.choices[labels.index(name)] if name in labels else part + 1


def _raw_range(number: Number, given: Range) -> tuple[int, int]:
    """Return a range as raw values, rounded inwards; 0.1 is one tenth, not the float next to it."""
    low, high = given
    if number.encoding == "float":
        # A lower limit of zero includes -0.0.
        return number.raw(low or -0.0), number.raw(high or 0.0)
    low, high = (min(max(end, -BEYOND), BEYOND) for end in given)
    lowest, highest = number.raw(low), number.raw(high)
    return lowest + (number.physical(lowest) < low), highest - (number.physical(highest) > high)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
