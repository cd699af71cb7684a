"""What queries alone prove while the arm rests: scale and order of angles, coordinates, limits."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.motion import REACHED
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.requests import flag_text, request_of, units
from cobotwire.conformance.mistakes import Pair, likely_mistake
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.roles import ANGLES, COORDS, KINDS, ReachedQuery, as_reached_query
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.kinematics.forward import coords_of
from cobotwire.simulator.kinematics.geometry import geometry_of
from cobotwire.simulator.kinematics.pose import Pose

GEOMETRY = TestCase(
    "geometry", "The coordinates are those of the angles, by the links that the edition states."
)
LIMITS = TestCase("limits", "The joints' limits have the scale of those that the edition states.")

COORDINATES = (*3 * ("millimetre",), *3 * ("degree",))
# The links of an arm differ a little from those that the edition states.
NEAR_MILLIMETRES, NEAR_DEGREES = 15.0, 5.0
# Far from the present value, in the units of angles and of coordinates.
FAR = {"degree": 25.0, "millimetre": 60.0}
# A wrong scale multiplies all limits by the same of these factors, within a tenth.
FACTORS = (0.01, 0.1, 10.0, 100.0)


def _has_geometry(table: Table, command: Command) -> bool:
    """Return whether a query reports coordinates that the edition's links determine."""
    joints = table.find_role("joints")
    return (
        command.role == "coordinates"
        and joints is not None
        and geometry_of(table) is not None
        and units(command.reply[0].fields[0].cases[0].numbers) == COORDINATES
    )


def _geometry(probe: Probe) -> None:
    """Compare the coordinates with those of the angles."""
    device, table = probe.device, probe.device.table
    geometry, joints = geometry_of(table), table.in_role("joints")
    assert geometry is not None, "the group selects editions with a geometry"
    for query, label in _frames(table):
        reply = device.read(query.request_type())
        if reply is not None and any(reply.fields.values()):
            raise NotSupported(f"the coordinates are not those of {label}: see {query.name}")
    angles = device.require(joints.request_type()).result
    reported = tuple(device.require(probe.command.request_type()).result)
    right = coords_of(geometry, angles)
    apart, turned = Pose.of(right).distance(Pose.of(reported))
    reason = (
        f"{joints.name} reports {_short(angles)}, so the end is at {_short(right)}; "
        f"{probe.command.name} reports {_short(reported)}"
    )
    if mistake := likely_mistake(_pairs(probe.command, right, reported)):
        reason += f": if {joints.name} is right, {probe.command.name} has {mistake}"
    probe.expect(GEOMETRY, apart <= NEAR_MILLIMETRES and turned <= NEAR_DEGREES, reason)


def _pairs(query: Command, right: Sequence[float], came: Sequence[float]) -> list[Pair]:
    """Return the calculated coordinates with those that a query reports."""
    field = query.reply[0].fields[0]
    near = {"millimetre": NEAR_MILLIMETRES, "degree": NEAR_DEGREES}
    return [
        Pair(
            f"{field.name}.{number.name}",
            a,
            b,
            near[number.unit],
            number,
        )
        for number, a, b in zip(field.cases[0].numbers, right, came)
    ]


def _frames(table: Table) -> list[tuple[Command, str]]:
    """Return the queries that report a frame, or an end, which is the first of two by default."""
    labels = {("BASE", "WORLD"): "the base", ("FLANGE", "TOOL"): "the flange"}
    found = []
    for command in table.commands:
        fields = command.reply[0].fields if command.safety == "query" and command.reply else ()
        if len(fields) == 1 and fields[0].labels in labels and not command.request[0].fields:
            found.append((command, labels[fields[0].labels]))
    return found


def _is_reached_query(table: Table, command: Command) -> bool:
    return command.role == "reached" or _single_angle(table, command) is not None


def _single_angle(table: Table, command: Command) -> Command | None:
    """Return the query of a joint's angle, if a command is the query for a device with one joint.

    It is a variant of the query in the role ``reached``, with one number in place of a row.
    """
    reached, joints = table.find_role("reached"), table.find_role("joints")
    if reached is None or joints is None or command.id != reached.id or command is reached:
        return None
    if command.request[0].fields[0].many:
        return None
    return next((c for c in table.commands if joints.name in c.agrees_with and _is_angle(c)), None)


def _is_angle(command: Command) -> bool:
    """Return whether a query with one argument reports one angle."""
    reported = [field.cases[0].numbers[0].unit for field in command.reply[0].fields]
    return len(command.request[0].fields) == 1 and reported == ["degree"]


def _reached_by_one(probe: Probe, angle: Command) -> None:
    """Send the present angle of the only joint, and another one."""
    here = probe.device.require(request_of(angle, 1)).result
    for target, there in ((here, True), (here + FAR["degree"], False)):
        reported = probe.device.is_set(request_of(probe.command, target, KINDS[ANGLES]))
        call = f"{probe.command.name}({target:.4g})"
        _expect_flag(probe, call, reported, there)


def _reached(probe: Probe) -> None:
    """Send the present position, and others that differ in one part each."""
    angle = _single_angle(probe.device.table, probe.command)
    if angle is not None:
        _reached_by_one(probe, angle)
        return
    query = as_reached_query(probe.command)
    for kind, role in ((ANGLES, "joints"), (COORDS, "coordinates")):
        source = probe.device.command(role) if kind in query.kinds else None  # type: ignore[arg-type]
        reply = None if source is None else probe.device.read(source.request_type())
        if source is None or reply is None:
            continue
        here = tuple(reply.result)
        parts = source.reply[0].fields[0].cases[0].numbers
        _expect(probe, query, kind, here, True)
        for at, number in enumerate(parts):
            away = FAR[number.unit] if here[at] <= 0 else -FAR[number.unit]
            _expect(probe, query, kind, (*here[:at], here[at] + away, *here[at + 1 :]), False)


def _expect(
    probe: Probe, query: ReachedQuery, kind: str, target: Sequence[float], there: bool
) -> None:
    reported = probe.device.is_set(query.request(target, kind))
    _expect_flag(probe, f"{probe.command.name}({_short(target)}, {kind})", reported, there)


def _expect_flag(probe: Probe, call: str, reported: bool | None, there: bool) -> None:
    expected = f"at rest, {call}: expected {flag_text(probe.command, there)}"
    reason = f"{expected}; came {flag_text(probe.command, reported)}"
    probe.expect(REACHED, reported is there, reason)


def is_limit(table: Table, command: Command) -> bool:
    """Return whether a query reports one limit, in degrees, of each joint."""
    stated = table.robot.joint_limits
    if command.safety != "query" or len(command.request[0].fields) != 1 or not stated:
        return False
    part = command.request[0].fields[0].cases[0].numbers[0]
    reported = [field for v in command.reply[:1] for field in v.fields if not field.echo]
    is_set = any(c.read_by is not None and c.read_by.query == command.name for c in table.commands)
    angle = [field.cases[0].numbers[0].unit for field in reported] == ["degree"]
    return is_set and angle and not reported[0].many and part.maximum >= len(stated)


def _limits(probe: Probe) -> None:
    """Compare the limits of all joints with those that the edition states."""
    stated = probe.device.table.robot.joint_limits
    parts = range(1, len(stated) + 1)
    found = [probe.device.require(request_of(probe.command, part)).result for part in parts]
    side = 0 if sum(found) < 0 else 1
    ratios = [value / limits[side] for value, limits in zip(found, stated) if limits[side]]
    wrong = [f for f in FACTORS if ratios and all(0.9 * f <= r <= 1.1 * f for r in ratios)]
    right = ", ".join(f"{limits[side]:g}" for limits in stated)
    factor = wrong[0] if wrong else 1
    reason = f"{probe.command.name}: {_short(found)} degrees are {factor:g} times {right} degrees"
    probe.expect(LIMITS, not wrong, reason)


def _short(numbers: Sequence[float]) -> str:
    return ", ".join(f"{number:.4g}" for number in numbers)


GEOMETRIES = Group(
    "geometry",
    (GEOMETRY,),
    _geometry,
    _has_geometry,
    sends="The queries of the joints, the coordinates and the frames.",
    subject="the query of the coordinates, if the edition states the links of the arm",
)
REACHED_AT_REST = Group(
    "reached at rest",
    (REACHED,),
    _reached,
    _is_reached_query,
    sends="The query with the present position, and with positions that differ in one part each.",
    subject="the query whether the arm is in a position",
)
JOINT_LIMITS = Group(
    "joint limits",
    (LIMITS,),
    _limits,
    is_limit,
    sends="The query for each joint.",
    subject="each query of the joints' limits, if the edition states them",
)
