"""Make a table with other limits for targets, narrower or wider than the edition's.

The limits of an edition are the ranges of its request fields, which the codec checks before a byte
is sent. With other limits the codec checks other ranges, so no other code has to check them.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any, NamedTuple

from cobotwire.protocol.effects import Moves, effect_of
from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.roles import moves_arm, picked, row_index
from cobotwire.protocol.table import Case, Command, Field, Number, Role, Table, Variant

# No number on the wire is that large, and scaling it does not overflow.
BEYOND = 1e100
Range = tuple[float, float]
Ranges = Sequence[Range | None]
# The name and the unit of a number of a target.
Target = tuple[str, str]
AXES = ("x", "y", "z")


class Limits(NamedTuple):
    """The lowest and the highest target of each joint and coordinate.

    None keeps the edition's limit of one joint or coordinate, or of all. ``joints`` and ``coords``
    limit only targets: commands that move the arm by a distance (``jog_increment``), or until it
    is stopped, stay as they are. ``joints`` does not limit coordinates, since the arm chooses the
    angles for them; it refuses encoder targets, and motions that have no target in the request
    (``drag_teach_execute``). ``coords`` does not limit coordinates in another frame
    (``send_base_coords``). ``speed`` and ``workspace`` limit everything that moves the arm:
    commands that could exceed them are refused (``protocol/refusals``). Nothing limits ``stop``.

    Attributes:
        joints: a range in degrees for each joint, base first.
        coords: a range for each coordinate: x, y, z in millimetres, then rx, ry, rz in degrees.
        wider: whether ranges may exceed the edition's, up to what the wire can carry.
        speed: the highest speed in percent.
        workspace: ranges for x, y and z in millimetres: where the end of the arm may be sent, also
            by angles of joints. The path to a target is not checked. Coordinates are those of the
            flange in the frame of the base. Before its first target in coordinates, a client
            queries the reference frame and the end type of the arm (``get_reference_frame``,
            ``get_end_type``), and refuses the target if another program has changed one. A change
            that another program makes later is not noticed, nor one that the edition cannot query.
    """

    joints: Ranges | None = None
    coords: Ranges | None = None
    wider: bool = False
    speed: float | None = None
    workspace: Ranges | None = None


def limited(table: Table, limits: Limits) -> Table:
    """Return the table of the same edition with other limits.

    Raises:
        UsageError: a range is not a pair of numbers, or is wider than the edition's (with
            ``wider``: than the wire can carry), or the edition has no such targets.
    """
    rules: list[tuple[tuple[Role, Role], _Rule]] = []
    joints: tuple[Role, Role] = ("joint targets", "joint target")
    coords: tuple[Role, Role] = ("coordinate targets", "coordinate target")
    for what, ranges, targets in (
        ("joints", limits.joints, joints),
        ("coords", limits.coords, coords),
    ):
        if ranges is not None:
            rules.append((targets, _Rule(what, ranges, _targets(table, targets[0]), limits.wider)))
    if limits.workspace is not None:
        rules.append((coords, _Workspace(limits.workspace, _targets(table, coords[0]))))
    commands = table.commands
    for roles, rule in rules:
        commands = tuple(
            _command(each, rule) if each.role in roles else _other(table, each, rule)
            for each in commands
        )
    if limits.speed is not None:
        cap = _checked_speed(limits.speed)
        commands = tuple(_slower(command, cap) for command in commands)
    return table._replace(commands=commands)


def joint_limits(table: Table) -> list[Range]:
    """Return the limits of each joint: the ranges of targets, or else those that are stated.

    A range that allows every raw value of the wire is no limit. Empty: the edition states none.
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


def _targets(table: Table, row: Role) -> list[Target]:
    """Return the names and units of the joints or coordinates that one command moves together."""
    variant = table.in_role(row).request[0]
    return _row_of(variant.fields[row_index(variant)])


def _row_of(field: Field) -> list[Target]:
    return [(number.name, number.unit) for case in field.cases[:1] for number in case.numbers]


class _Rule:
    """The given ranges, and the joints or coordinates that they limit."""

    # Whether ranges that reach beyond the edition's are cut to these.
    _cuts = False

    def __init__(
        self, what: str, ranges: Ranges, targets: list[Target], wider: bool = False
    ) -> None:
        self._what, self._wider, self.targets = what, wider, targets
        self._ranges = checked_ranges(what, ranges, len(targets))

    def number(self, part: int, number: Number) -> Number:
        """Return a number of a target with the limits of its joint or coordinate."""
        given = self._ranges[part]
        if given is None:
            return number
        lowest, highest = _raw_range(number, given)
        inside = number.raw_range if self._wider else (number.minimum, number.maximum)
        if self._cuts:
            lowest, highest = max(lowest, inside[0]), min(highest, inside[1])
        if lowest < inside[0] or highest > inside[1] or lowest > highest:
            kind = "workspace" if self._cuts else "wider-limit" if self._wider else "limit"
            low, high = (f"{number.physical(end):g}" for end in inside)
            allowed = error_text(kind, low=low, high=high, unit=number.units)
            raise UsageError(f"limits.{self._what}[{part}]", given, allowed)
        return number._replace(minimum=lowest, maximum=highest)


class _Workspace(_Rule):
    """The ranges of x, y and z."""

    _cuts = True

    def __init__(self, workspace: Ranges, targets: list[Target]) -> None:
        box = dict(zip(AXES, checked_ranges("workspace", workspace, len(AXES))))
        names = [name for name, _ in targets]
        if not {*AXES} <= {*names}:
            message = error_text("no-coordinates", names=names)
            raise UsageError("limits.workspace", workspace, message=message)
        super().__init__("workspace", [box.get(name) for name in names], targets)


def checked_ranges(what: str, ranges: Ranges, count: int) -> list[Range | None]:
    """Return ranges as pairs of numbers, or None for each that is not limited.

    Raises:
        UsageError: there are not ``count`` of them, or one is neither None nor a pair of numbers.
    """
    allowed = error_text("ranges", count=count)
    if isinstance(ranges, str) or not isinstance(ranges, Sequence):
        raise UsageError(f"limits.{what}", ranges, allowed)
    if len(ranges) != count:
        raise UsageError(f"len(limits.{what})", len(ranges), allowed)
    return [_checked(f"limits.{what}[{part}]", given) for part, given in enumerate(ranges)]


def _checked(argument: str, given: object) -> Range | None:
    if given is None:
        return None
    pair = list(given) if isinstance(given, Sequence) and not isinstance(given, str) else []
    if len(pair) == 2 and all(map(_is_number, pair)) and pair[0] <= pair[1]:
        return pair[0], pair[1]
    raise UsageError(argument, given, error_text("pair"))


def _checked_speed(speed: float) -> float:
    if _is_number(speed) and 1 <= speed <= 100:
        return speed
    raise UsageError("limits.speed", speed, error_text("speed"))


def _slower(command: Command, cap: float) -> Command:
    """Return a command with each of its speeds in percent at most ``cap``."""
    rows = [
        tuple(_capped(field, cap) if is_speed(field) else field for field in variant.fields)
        for variant in command.request
    ]
    return command._replace(request=tuple(map(Variant, rows)))


def _capped(field: Field, cap: float) -> Field:
    cases = []
    for case in field.cases:
        numbers = (n._replace(maximum=_raw_range(n, (0, cap))[1]) for n in case.numbers)
        cases.append(Case(case.when, tuple(numbers)))
    return field._replace(cases=tuple(cases))


def is_speed(field: Field) -> bool:
    """Return whether a field is a speed in percent."""
    # How far a gripper opens is in percent too.
    return field.name == "speed" and all(number.unit == "percent" for number in field.numbers)


def _command(command: Command, rule: _Rule) -> Command:
    narrow = _row if command.role in _ROWS else _single
    return command._replace(request=tuple(narrow(variant, rule) for variant in command.request))


_ROWS: tuple[Role, ...] = ("joint targets", "coordinate targets")


def _other(table: Table, command: Command, rule: _Rule) -> Command:
    """Limit the same joints or coordinates in a motion that has another role, or none."""
    if not (moves_arm(table, command) and isinstance(effect_of(command), Moves)):
        return command
    variants = []
    for variant in command.request:
        for at, field in enumerate(variant.fields):
            if _row_of(field) == rule.targets:
                variant = _row_at(variant, at, rule)
        variants.append(variant)
    return command._replace(request=tuple(variants))


def _row(variant: Variant, rule: _Rule) -> Variant:
    """Limit a variant in which one field holds all targets."""
    return _row_at(variant, row_index(variant), rule)


def _row_at(variant: Variant, at: int, rule: _Rule) -> Variant:
    row = variant.fields[at]
    numbers = (rule.number(part, number) for part, number in enumerate(row.cases[0].numbers))
    return _with(variant, at, row._replace(cases=(Case((), tuple(numbers)),)))


def _single(variant: Variant, rule: _Rule) -> Variant:
    """Limit a variant in which one field picks a joint or coordinate, and another is its target."""
    picker_at, at = picked(variant)
    picker, target = variant.fields[picker_at], variant.fields[at]
    cases = []
    for part, (name, _) in enumerate(rule.targets):
        value = _value_of(picker, name, part)
        case = target.case(value)
        assert case is not None, f"{name} has a case"
        cases.append(Case((value,), (rule.number(part, case.numbers[0]),)))
    return _with(variant, at, target._replace(cases=tuple(cases), selector=picker_at))


def _with(variant: Variant, at: int, field: Field) -> Variant:
    fields = variant.fields
    return variant._replace(fields=(*fields[:at], field, *fields[at + 1 :]))


def _value_of(picker: Field, name: str, part: int) -> int:
    """Return the raw value that picks a joint or coordinate: by its label, or else its number."""
    labels = [label.lower() for label in picker.labels]
    return picker.choices[labels.index(name)] if name in labels else part + 1


def _raw_range(number: Number, given: Range) -> tuple[int, int]:
    """Return a range as raw values, rounded inwards. Its ends are decimals: 0.1 is one tenth."""
    low, high = given
    if number.encoding == "float":
        # A lower limit of zero includes -0.0.
        return number.raw(low or -0.0), number.raw(high or 0.0)
    low, high = (min(max(end, -BEYOND), BEYOND) for end in given)
    lowest, highest = number.raw(low), number.raw(high)
    return lowest + (number.physical(lowest) < low), highest - (number.physical(highest) > high)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
