"""Report baud rates, deadlines, defaults, limits and joints that differ from the library's."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from fractions import Fraction
from functools import lru_cache
from math import ceil, floor

from cobotwire_codegen.model import Edition, Quantity
from pymycobot_classes import RobotLimit, library
from robots.classes import ROBOTS
from spec_statements.quantities import quantities_of

MAKER = library("MyCobot280")
# The edition of the document has the defaults of the class for newer firmware.
CLASSES = {robot.edition: robot for robot in ROBOTS.values()} | {"mycobot": ROBOTS["MyCobot280"]}
CLASSES["mercury_x1"] = CLASSES["mercury_b1"]
# For these the library waits longer: `read` in its common.py, `_read` in its myarm_api.py.
WAITS_MS = {
    "mercury": {"power_on": 8000},
    "pro": {"power_on": 8000},
    "myarm_": {"get_robot_error_status": 90000},
    "mycobot320": {"get_robot_status": 75000},
}
# Arguments whose default differs from the library's; tests/peers has the reasons.
RULED_DEFAULTS = (
    r"(mercury|pro)\S+ (pause|resume|stop) deceleration|(mercury|pro)\S+ write_move_c_r arc"
    r"|(mercury|pro)\S+ [sg]et_pro_gripper address|mycobot280_rdkx5 get_gripper_value gripper"
    r"|(myarm300|mybuddy) set_color \w+|mybuddy is_in_position kind|pro630 power_on mode"
    r"|mycobot320 set_hand_gripper_pinch_action \w+"
    r"|pro450 set_(control_mode mode|torque_comp damping|tool_serial_timeout timeout)"
    r"|(mercury|pro)\S+ \wet_(hand|pro)_gripper\w* (gripper|speed)"
)
# The servo bus runs at 1 Mbaud (Feetech, "Servo SCS Communication Protocol").
BUS_BAUDRATE = 1000000


def _baudrate(edition: str) -> int | None:
    """Return the baud rate at which the library opens a port by default."""
    if edition not in CLASSES:
        return BUS_BAUDRATE
    taken = inspect.signature(library(CLASSES[edition].peer).__init__).parameters
    return int(taken["baudrate"].default) if "baudrate" in taken else None


@lru_cache(maxsize=1)
def _wait_ms() -> int:
    """Return how long the library waits for a reply by default."""
    found = re.search(r"\belse:\s+wait_time = ([\d.]+)", inspect.getsource(MAKER._read))
    assert found, "the library states its default wait"
    return round(float(found[1]) * 1000)


def transport(edition: Edition) -> Iterator[str]:
    """Report another baud rate or deadline than the library uses."""
    if edition.frame.baudrate != (_baudrate(edition.name) or edition.frame.baudrate):
        yield f"{edition.frame.baudrate} baud; the maker's library has {_baudrate(edition.name)}"
    if edition.name in CLASSES:
        found = (w for prefix, w in WAITS_MS.items() if edition.name.startswith(prefix))
        waits = next(found, {})
        for command in edition.commands:
            wanted = waits.get(command.name, _wait_ms())
            if command.deadline_ms != wanted:
                yield f"{command.name}: {command.deadline_ms} ms; the maker's library {wanted} ms"


def defaults(edition: Edition) -> Iterator[str]:
    """Report arguments whose default differs from the default in the library's method.

    A command with the name of a library method has its arguments in the same order.
    """
    robot = CLASSES.get(edition.name)
    if robot is None:
        return
    for command in edition.commands:
        theirs = _defaults(robot.peer, robot.methods.get(command.name, command.name))
        fields = [f for variant in command.requests[:1] for f in variant if f.const is None]
        if command.arguments:
            fields.sort(key=lambda field: command.arguments.index(field.name))
        for field, default in zip(fields, theirs):
            ours = None if field.default is None else field.default[0]
            named = f"{edition.name} {command.name} {field.name}"
            if ours != default and not re.fullmatch(RULED_DEFAULTS, named):
                yield f"{command.name}: {field.name} has the default {ours}; the library {default}"


@lru_cache(maxsize=4096)
def _defaults(peer: str, name: str) -> tuple[int | None, ...]:
    """Return the defaults of a method of the library; None where an argument has none."""
    method = getattr(library(peer), name, None)
    given = [] if method is None else list(inspect.signature(method).parameters.values())[1:]
    return tuple(None if p.default in (p.empty, None) else int(p.default) for p in given)


# Tables of limits with another name than the class. The page on the X1 has the limits of
# MercurySocket; those of the class for serial ports differ in joint 12.
TABLES = {
    "mercury_a1": "Mercury",
    "mercury_b1": "MercurySocket",
    "mercury_x1": "MercurySocket",
    "mycobot280_rdkx5": "MyCobot280RDK-X5",
}
LIMITED = r"(j\d+|s\d|arm|flange|([xy]_)?reach|height)(_step)?(_angle|_radian|_limit|_encoder)?"
# The roles of commands whose arguments are targets.
TARGETS = ("joint target", "joint targets", "coordinate target", "coordinate targets")
AXES = {"x": "x_reach", "y": "y_reach", "z": "height"}
AXES |= dict.fromkeys(("rx", "ry", "rz", "theta"), "turn")
MOST = 0x7FFF  # what a signed word can hold
# The Pro 400 has no table; the maker sells it as an arm with six axes. A servo turns one joint.
JOINTS = {"pro400": 6, "servo_bus": 1}


@lru_cache(maxsize=32)
def _limits(edition: str) -> tuple[int | None, dict[str, tuple[float, float]]]:
    """Return the number of joints in the library's table of limits, and its limits by name."""
    name = TABLES.get(edition) or getattr(CLASSES.get(edition), "peer", "")
    table = RobotLimit.robot_limit.get(name)
    if table is None:
        return None, {}
    joints = table.get("joint_id", [*range(1, len(table["angles_min"]) + 1)])
    ends = {f"j{n}": e for n, e in zip(joints, zip(table["angles_min"], table["angles_max"]))}
    ends.update(arm=ends["j1"], flange=ends[f"j{min(6, len(ends))}"])
    encoders = zip(table.get("encoders_min", ()), table.get("encoders_max", ()))
    ends.update({f"s{n}": e for n, e in enumerate(encoders, 1)})
    two = edition != "mercury_a1" and "left_coords_min" in table
    sides = ["left_", "right_"] if two else [""] if "coords_min" in table else []
    for at, what in enumerate(("x_reach", "y_reach", "height", "turn") if sides else ()):
        low, high = ([table[f"{s}coords_{end}"][at] for s in sides] for end in ("min", "max"))
        ends[what] = min(low), max(high)
    if sides:
        ends["reach"] = ends["x_reach"]
    return sum(joint < 10 for joint in joints), ends


def _limited(edition: Edition) -> Iterator[tuple[str, str, bool, Quantity]]:
    """Yield the types that must have limits, by their names or by the roles of commands.

    Each comes with a name, the name of its limits, and whether it is a step.
    """
    for command in edition.commands:
        for field in command.fields:
            for type in quantities_of(field):
                if found := re.fullmatch(LIMITED, type.name):
                    yield type.name, found[1], bool(found[3]), type
        for field in command.fields if command.role in TARGETS else ():
            cases = [(member.name, part) for member, t in field.cases for _, part in t.parts]
            for label, part in cases or field.type.parts:
                what = f"j{label}" if label.isdigit() else label.lower()
                # A single number may be for any joint or axis.
                if isinstance(part, Quantity) and part.unit in ("degree", "millimetre"):
                    yield f"{command.name} {label}", AXES.get(what, what), False, part


def limits(edition: Edition) -> Iterator[str]:
    """Report targets and steps with another limit than the library's."""
    # The document states no limits of targets.
    ends = _limits(edition.name)[1] if edition.name != "mycobot" else {}
    for name, what, step, type in _limited(edition) if ends else ():
        if what not in ends:
            if re.fullmatch(r"(j\d+)?", what):
                yield f"{name}: the library's table has limits for each joint, but not for this"
            continue
        low, high = (Fraction(str(end)) for end in ends[what])
        if step:
            low, high = low - high, high - low
        steps = [max(-MOST, ceil(low / type.scale)), min(MOST, floor(high / type.scale))]
        if [*type.bounds] != steps:
            yield f"{name} has the bounds {type.bounds}; the library's table {steps}"


def joints(edition: Edition) -> Iterator[str]:
    """Report another number of joints than the library's table has."""
    wanted = JOINTS.get(edition.name, _limits(edition.name)[0])
    if wanted is None:
        return
    if edition.joints != wanted:
        yield f"there are {edition.joints} joints; the library's table has {wanted}"
    for type in {f.type.name: f.type for c in edition.commands for f in c.fields}.values():
        numbers = [int(n) for label, _ in type.parts for n in re.findall(r"^j(\d)(?!\d)", label)]
        if numbers and max(numbers) != wanted:
            yield f"{type.name} ends with joint {max(numbers)}; the library's table with {wanted}"


def commands(edition: Edition) -> Iterator[str]:
    """Report commands without a method in the library's class, and without a reason for that."""
    robot = CLASSES.get(edition.name)
    if robot is not None and edition.name != "mycobot":  # the document is older than the class
        methods = {*robot.public, *robot.lacking}
        for command in edition.commands:
            known = {command.name, robot.methods.get(command.name)} & methods
            if not command.event and not known:
                yield f"the library's class has no {command.name}"


# What other sources say. An earlier version of the library: "Atom 7.0 Delete this interface". The
# pages on firmware in myArm_MC_docs: "v1.1-beta: add read current position and speed interfaces".
ELSEWHERE = {
    ("mycobot280", "jog_stop"): {"until": Fraction(7)},
    ("myarm_c650", "get_servos_encoder_drag"): {"since": Fraction("1.1")},
    ("myarm_m750", "get_servos_encoder_drag"): {"since": Fraction("1.1")},
}


def firmware(edition: Edition) -> Iterator[str]:
    """Report commands that need other firmware than the descriptions of the library say."""
    robot = CLASSES.get(edition.name)
    if robot is None or edition.name == "mycobot":  # the document is older than the class
        return
    for command in edition.commands:
        doc = getattr(library(robot.peer), command.name, None).__doc__ or ""
        newer = re.search(r"firmware version must be greater than (\d+\.\d+)", doc)
        wanted = {"since": Fraction(newer[1])} if newer else {}
        wanted |= ELSEWHERE.get((edition.name, command.name), {})
        stated = {} if command.firmware is None else dict(command.firmware.versions)
        stated.pop("reply_since", None)  # only the changelog states it
        if stated != wanted:
            yield f"{command.name} depends on firmware {stated}; the library says {wanted}"


RULES = (transport, defaults, limits, joints, commands, firmware)
