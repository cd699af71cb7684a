"""Limits of targets, narrower or wider than the edition's: a table made out of a table.

The edition's own limits are the ranges of its request fields, and both codecs check these before a
byte is sent. Other limits are the same table with other ranges, so that nothing else has to check.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil, floor, isfinite

from cobotwire.errors import UsageError
from cobotwire.table import Case, Command, Field, Layout, Number, Role, Table

Range = tuple[float, float]
Ranges = Sequence[Range | None]


@dataclass(frozen=True, slots=True)
class Limits:
    """Where the arm may be sent: the lowest and the highest target of each part.

    None leaves a part, or all of them, to the edition. Only targets are limited; what moves the
    arm by a distance (``jog_increment``), or until it is stopped, goes as far as the arm lets it.

    Attributes:
        joints: degrees, a range for each joint, base first.
        coords: millimetres for x, y, z, then degrees for rx, ry, rz.
        wider: allows ranges beyond the edition's; never beyond what the wire can carry.
    """

    joints: Ranges | None = None
    coords: Ranges | None = None
    wider: bool = False


def limited(table: Table, limits: Limits) -> Table:
    """The same edition with other limits.

    Raises:
        UsageError: a range is none, or wider than the edition's without ``wider``, or than the
            wire; or the edition has no such targets.
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
    return replace(table, commands=tuple(commands))


class _Rule:
    """The ranges that were given, and the names of the parts that they are for."""

    def __init__(self, what: str, ranges: Ranges, row: Command, wider: bool) -> None:
        self._what = what
        self._wider = wider
        self.names = [number.name for number in row.request[0].fields[0].cases[0].numbers]
        if isinstance(ranges, str) or not isinstance(ranges, Sequence):
            raise UsageError(f"limits.{what}", ranges, f"{len(self.names)} ranges")
        if len(ranges) != len(self.names):
            given = len(ranges)
            raise UsageError(f"len(limits.{what})", given, f"{len(self.names)} ranges")
        self._ranges = [self._checked(part, given) for part, given in enumerate(ranges)]

    def number(self, part: int, number: Number) -> Number:
        """How a part's target is limited."""
        given = self._ranges[part]
        if given is None:
            return number
        step = Fraction(number.divide, number.multiply)
        # Inwards: what is between two steps outside is not allowed.
        lowest, highest = ceil(_exact(given[0]) * step), floor(_exact(given[1]) * step)
        wire = _wire(number)
        inside = wire if self._wider else (number.minimum, number.maximum)
        if lowest < inside[0] or highest > inside[1] or lowest > highest:
            low, high = (float(bound / step) for bound in inside)
            why = (
                "what the wire carries" if self._wider else "the edition's; wider=True allows more"
            )
            allowed = f"a range inside {low:g}..{high:g} {number.unit}, {why}"
            raise UsageError(f"limits.{self._what}[{part}]", given, allowed)
        return replace(number, minimum=lowest, maximum=highest)

    def _checked(self, part: int, given: object) -> Range | None:
        if given is None:
            return None
        pair = list(given) if isinstance(given, Sequence) and not isinstance(given, str) else []
        if len(pair) == 2 and all(map(_is_number, pair)) and pair[0] <= pair[1]:
            return pair[0], pair[1]
        raise UsageError(f"limits.{self._what}[{part}]", given, "a pair (lowest, highest), or None")


def _command(command: Command, rule: _Rule) -> Command:
    narrow = _row if command.role in _ROWS else _single
    return replace(command, request=tuple(narrow(form, rule) for form in command.request))


_ROWS: tuple[Role, ...] = ("joint targets", "coordinate targets")


def _row(form: Layout, rule: _Rule) -> Layout:
    """The first field is the whole row."""
    row, *rest = form.fields
    numbers = (rule.number(part, number) for part, number in enumerate(row.cases[0].numbers))
    return Layout((replace(row, cases=(Case((), tuple(numbers)),)), *rest))


def _single(form: Layout, rule: _Rule) -> Layout:
    """The first field picks the part, the second is its target: a case for each part."""
    picker, target, *rest = form.fields
    cases = []
    for part, name in enumerate(rule.names):
        value = _value_of(picker, name, part)
        [number] = next(c.numbers for c in target.cases if not c.when or value in c.when)
        cases.append(Case((value,), (rule.number(part, number),)))
    return Layout((picker, replace(target, cases=tuple(cases), selector=0), *rest))


def _value_of(picker: Field, name: str, part: int) -> int:
    """The number that picks a part: by its label, or counted from one."""
    labels = [label.lower() for label in picker.labels]
    return picker.choices[labels.index(name)] if name in labels else part + 1


def _wire(number: Number) -> tuple[int, int]:
    """The whole numbers that the wire can carry."""
    top = 256**number.width
    return (0 if number.signed_at == top - 1 else number.signed_at + 1 - top), number.signed_at


def _exact(value: float) -> Fraction:
    """The number as it was written: 0.1 is a tenth."""
    return Fraction(str(value))


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
