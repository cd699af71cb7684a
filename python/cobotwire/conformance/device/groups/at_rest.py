"""What queries prove while the arm rests: scale and order of angles, coordinates and limits."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.motion import REACHED
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.device.requests import request_of, units
from cobotwire.conformance.device.selection import reported, reporters
from cobotwire.conformance.mistakes import Pair, likely_mistake
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.inspect.readings import LINKS_APART, LINKS_TURNED
from cobotwire.kinematics.forward import coords_of
from cobotwire.kinematics.geometry import Geometry, geometry_of
from cobotwire.kinematics.pose import Pose
from cobotwire.protocol.roles import ANGLES, COORDS, KINDS, as_reached_query
from cobotwire.protocol.table import Command, Table

GEOMETRY = TestCase(
    "geometry", "The coordinates match the angles, by the links that the edition states."
)
LIMITS = TestCase(
    "limits", "The joints' limits have the same scale as those that the edition states."
)

COORDINATES = (*3 * ("millimetre",), *3 * ("degree",))
NEAR = {"millimetre": LINKS_APART, "degree": LINKS_TURNED}
# Far from the present value, in the units of angles and of coordinates.
FAR = {"degree": 25.0, "millimetre": 60.0}
LIMIT_STATES = {"lowest", "highest"}
# A wrong scale multiplies all limits by one of these factors, within a tenth.
FACTORS = (0.01, 0.1, 10.0, 100.0)


def _stated_geometry(table: Table, command: Command) -> Geometry | None:
    """Return the links of the edition, if they determine the coordinates that a query reports."""
    if command.role != "coordinates" or table.find_role("joints") is None:
        return None
    row = units(command.reply[0].fields[0].cases[0].numbers)
    return geometry_of(table) if row == COORDINATES else None


def _geometry(probe: Probe, geometry: Geometry) -> None:
    """Compare the coordinates with those computed from the angles."""
    device, field = probe.device, probe.command.reply[0].fields[0]
    joints = device.table.in_role("joints")
    for state, label in (("reference_frame", "the base"), ("end_type", "the flange")):
        # The first choice is the default.
        for query in (each.query for each in reporters(device.table, state)):
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
    pairs = [
        Pair(f"{field.name}.{number.name}", a, b, NEAR[number.unit], number)
        for number, a, b in zip(field.cases[0].numbers, right, reported)
    ]
    if mistake := likely_mistake(pairs):
        reason += f": if {joints.name} is right, {probe.command.name} has {mistake}"
    near = apart <= NEAR["millimetre"] and turned <= NEAR["degree"]
    probe.expect(GEOMETRY, near, reason)


def _is_reached_query(table: Table, command: Command) -> bool:
    """Return whether a query reports that the arm has reached a position or an angle."""
    one = not any(field.many for field in command.request[0].fields)
    single = one and "reached" in reported(command) and _angle(table) is not None
    return command.role == "reached" or single


def _angle(table: Table) -> Command | None:
    """Return the query of one joint's angle, in degrees."""
    for query in (each.query for each in reporters(table, "angles") if each.at):
        if query.reply[0].fields[-1].cases[0].numbers[0].unit == "degree":
            return query
    return None


def _reached_by_one(probe: Probe) -> None:
    """Send the present angle of joint 1, and another angle."""
    angle = _angle(probe.device.table)
    assert angle is not None, "the group selects editions with it"
    here = probe.device.require(request_of(angle, 1)).result
    for target, there in ((here, True), (here + FAR["degree"], False)):
        query = request_of(probe.command, target, KINDS[ANGLES])
        call = f"at rest, {probe.command.name}({target:.4g})"
        probe.expect_flag(REACHED, query, there, call)


def _reached(probe: Probe) -> None:
    """Send the present position, and others that differ in one joint or axis."""
    if not any(field.many for field in probe.command.request[0].fields):
        _reached_by_one(probe)
        return
    query = as_reached_query(probe.command)
    for kind, role in ((ANGLES, "joints"), (COORDS, "coordinates")):
        source = probe.device.command(role) if kind in query.kinds else None  # type: ignore[arg-type]
        reply = None if source is None else probe.device.read(source.request_type())
        if source is None or reply is None:
            continue
        here, targets = tuple(reply.result), [(tuple(reply.result), True)]
        for at, number in enumerate(source.reply[0].fields[0].cases[0].numbers):
            away = FAR[number.unit] if here[at] <= 0 else -FAR[number.unit]
            targets.append(((*here[:at], here[at] + away, *here[at + 1 :]), False))
        for target, there in targets:
            call = f"at rest, {probe.command.name}({_short(target)}, {kind})"
            probe.expect_flag(REACHED, query.request(target, kind), there, call)


def _reports_limits(table: Table, command: Command) -> bool:
    """Return whether a query reports one limit, in degrees, of each joint."""
    limits = LIMIT_STATES & set(reported(command)) if table.robot.joint_limits else ()
    return bool(limits) and bool(command.request[0].fields)


def _limits(probe: Probe) -> None:
    """Compare the limits of all joints with those that the edition states."""
    stated = probe.device.table.robot.joint_limits
    parts = range(1, len(stated) + 1)
    found = [probe.device.require(request_of(probe.command, part)).result for part in parts]
    side = 0 if "lowest" in reported(probe.command) else 1
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
    *for_found(_stated_geometry, _geometry),
    sends="The queries of the joints, the coordinates and the frames.",
    subject="the query of the coordinates, if the edition states the links of the arm",
)
REACHED_AT_REST = Group(
    "reached at rest",
    (REACHED,),
    _reached,
    _is_reached_query,
    sends="The query with the present position, and with others that differ in one joint or axis.",
    subject="the query that reports whether the arm is in a position",
)
JOINT_LIMITS = Group(
    "joint limits",
    (LIMITS,),
    _limits,
    _reports_limits,
    sends="The query for each joint.",
    subject="each query of the joints' limits, if the edition states them",
)
